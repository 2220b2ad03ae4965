# SPDX-License-Identifier: GPL-3.0-or-later
# tetgen-mesh: regions and holes, sizes, attributes of new nodes, refinement, time.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir folder
    export TMPDIR=$BATS_TEST_TMPDIR/folder
    # for Python: the rows of the mesh sys.argv[1], by block, and where its nodes are
    cat >rows.py <<'END'
import sys
rows = {}
for line in open(sys.argv[1]):
    if line[0] == '.':
        rows[line.strip()] = block = []
    elif line[0] != '#' and rows:
        block.append(line.split())
place = {r[0]: [float(c) for c in r[1:4]] for r in rows['.node'][1:]}
END
}

# Prints cubes as a surface: cubes FORMAT CORNER,SIDE,+|- …, turned outward or inward.
# FORMAT is off, obj, stl, ply or poly; that has the attribute 1 + 2x - 3y + z/2.
cubes() {
    python3 - "$@" <<'END'
import sys
triangles = []
for cube in sys.argv[2:]:
    corner, side, way = cube.split(',')
    corner, side = float(corner), float(side)
    v = [tuple(corner + side * (i >> k & 1) for k in range(3)) for i in range(8)]
    for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5),
                       (3, 2, 6, 7), (2, 0, 4, 6)):
        for t in ((a, b, c), (a, c, d)):
            triangles.append([v[i] for i in (t if way == '+' else t[::-1])])
number = {}
for t in triangles:
    for p in t:
        number.setdefault(p, len(number))
faces = [[number[p] for p in t] for t in triangles]
form = sys.argv[1]
if form == 'off':
    print('OFF\n%d %d 0' % (len(number), len(faces)))
elif form == 'ply':
    print('ply\nformat ascii 1.0\nelement vertex %d' % len(number))
    print('property double x\nproperty double y\nproperty double z')
    print('element face %d\nproperty list uchar int vertex_indices\nend_header' % len(faces))
elif form == 'poly':
    print(len(number), 3, 1, 0)
for i, p in enumerate(number):
    if form == 'obj':
        print('v', *p)
    elif form == 'poly':
        print(i, *p, 1 + 2 * p[0] - 3 * p[1] + p[2] / 2)
    elif form != 'stl':
        print(*p)
if form == 'poly':
    print(len(faces), 0)
if form == 'stl':
    print('solid')
for f, t in zip(faces, triangles):
    if form == 'obj':
        print('f', *(i + 1 for i in f))
    elif form == 'stl':
        print('facet normal 0 0 0\nouter loop')
        for p in t:
            print('vertex', *p)
        print('endloop\nendfacet')
    else:
        print(('1\n' if form == 'poly' else '') + '3', *f)
if form == 'stl':
    print('endsolid')
if form == 'poly':
    print('0\n0')
END
}

# The volume of each region of a mesh must be as said: volumes MESH REGION=VOLUME …
volumes_are() {
    python3 - "$@" <<'END'
import math, sys
from rows import place, rows
parts = {}
for r in rows['.ele'][1:]:
    a, b, c, d = (place[n] for n in r[1:5])
    u, v, w = ([q[k] - a[k] for k in range(3)] for q in (b, c, d))
    parts.setdefault(r[5] if len(r) > 5 else '', []).append((
        u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
        u[2] * (v[0] * w[1] - v[1] * w[0])) / 6)
found = {r: math.fsum(v) for r, v in parts.items()}
right = {k: float(v) for k, v in (a.split('=') for a in sys.argv[2:])}
assert found.keys() == right.keys(), found
for region, volume in right.items():
    assert abs(found[region] - volume) <= 1e-12 * volume, (region, found)
END
}

# The largest error of the first attribute of nodes, against 1 + 2x - 3y + z/2.
is_linear() {
    awk '/^\./ { block = $1; getline; next }
         block == ".node" { e = $5 - (1 + 2 * $2 - 3 * $3 + $4 / 2); if (e < 0) e = -e
                            if (e > most) most = e; n++ }
         END { exit !(n > 20 && most < 1e-12) }' "$1"
}

@test "shells within shells: said, numbered, left empty, of every format" {
    for format in off obj stl ply poly; do
        cubes $format 0,4,+ 1,1,- 2.5,1,+ >nested
        run -0 --separate-stderr tetgen-mesh -o mesh.tm nested
        [[ $stderr == 'tetgen-mesh: nested: 2 shells are within others, such as at ('*'): filled as all the rest (--regions '* ]]
        volumes_are mesh.tm =64
        run -0 --separate-stderr tetgen-mesh --regions -q -o mesh.tm nested
        [[ $stderr == 'tetgen-mesh: nested: 2 shells are within others, such as at ('*'): a region'* ]]
        volumes_are mesh.tm 1=62 2=1 3=1
        run -0 --separate-stderr tetgen-mesh --cavities -q -o mesh.tm nested
        [[ ${stderr_lines[0]} == *'nested: 1 shell within another looks inward, at (1.'*'): left empty' ]]
        [[ ${stderr_lines[1]} == *'nested: 1 shell is within another, at (2.'*'): filled, as it looks outward' ]]
        volumes_are mesh.tm =63
        tetgen-mesh --quiet --cavities --regions -a 0.1 -o mesh.tm nested
        volumes_are mesh.tm 1=62 2=1
    done
    cubes off 0,4,+ 5,1,+ >beside.off
    run -0 --separate-stderr tetgen-mesh beside.off -o mesh.tm
    [ -z "$stderr" ]
    tetgen-mesh --regions beside.off -o mesh.tm
    volumes_are mesh.tm 1=64 2=1
}

@test "regions with a common wall, and a shell within one of them" {
    # two boxes on each other, and a cube in the upper one
    { printf 'OFF\n20 23 0\n'
      for z in 0 1 3; do printf '0 0 %d\n2 0 %d\n2 2 %d\n0 2 %d\n' $z $z $z $z; done
      cubes off 1.25,0.5,- | sed -n 3,10p
      printf '4 %d %d %d %d\n' 3 2 1 0 4 5 6 7 8 9 10 11 \
          0 1 5 4 1 2 6 5 2 3 7 6 3 0 4 7 4 5 9 8 5 6 10 9 6 7 11 10 7 4 8 11
      cubes off 1.25,0.5,- | sed -n '11,$p' | awk '{ print 3, $2 + 12, $3 + 12, $4 + 12 }'
    } >walls.off
    tetgen-mesh --quiet --regions -q walls.off -o mesh.tm
    volumes_are mesh.tm 1=4 2=7.875 3=0.125
    tetgen-mesh --quiet --regions --cavities -q walls.off -o mesh.tm
    volumes_are mesh.tm 1=4 2=7.875
    mesh-check mesh.tm
}

@test "points in holes and regions" {
    cubes off 0,4,+ 1,1,+ 2.5,1,+ >nested.off
    tetgen-mesh --quiet --hole 1.5,1.5,1.5 nested.off -o mesh.tm
    volumes_are mesh.tm =63
    tetgen-mesh --quiet --hole 1.5,1.5,1.5 --hole 3,3,3 nested.off -o mesh.tm
    volumes_are mesh.tm =62
    tetgen-mesh --quiet --regions --region 1.5,1.5,1.5,7 --region .5,.5,.5 nested.off -o mesh.tm
    volumes_are mesh.tm 8=62 7=1 9=1
    tetgen-mesh --quiet --regions --hole 3,3,3 nested.off -o mesh.tm
    volumes_are mesh.tm 1=62 2=1
    tetgen-mesh --quiet --region 1.5,1.5,1.5,-3 nested.off -o mesh.tm
    grep -q ' -3$' mesh.tm
    for option in --hole --region; do
        run -3 --separate-stderr tetgen-mesh $option 9,1,1 nested.off
        [[ $stderr == *"nested.off: the ${option#--}, at (9, 1, 1), is outside the surface" ]]
        for wrong in 1,2 1,2,x 1,2,3,4,5 '' 1,,2 '1,2,3,'; do
            run -2 --separate-stderr tetgen-mesh $option "$wrong" nested.off
        done
    done
    run -2 --separate-stderr tetgen-mesh --region 1,1,1,0.5 nested.off
    printf '5 3\n1 0 0 0\n2 1 2 3\n3 2 1 3\n4 1 1 2\n5 4 5 8\n' >some.node
    run -2 --separate-stderr tetgen-mesh --regions some.node
    [ -z "$output" ]
}

# The share of tetrahedra whose mean edge is within a factor of 2 of what was asked for,
# at the middle, must be 95 % or more: sizes_hold MESH FORMULA (of x, y, z).
sizes_hold() {
    python3 - "$@" <<'END'
import math, sys
from rows import place, rows
good = 0
for r in rows['.ele'][1:]:
    p = [place[n] for n in r[1:5]]
    x, y, z = (sum(q[k] for q in p) / 4 for k in range(3))
    mean = sum(math.dist(p[i], p[k]) for i in range(4) for k in range(i)) / 6
    good += 0.5 <= mean / eval(sys.argv[2]) <= 2
count = len(rows['.ele']) - 1
print(good, count)
assert count > 500 and good >= 0.95 * count
END
}

@test "several regions in one part: the first counts; numbers that TetGen's have no place for" {
    cubes off 0,4,+ 1,1,+ >nested.off
    # with_regions "X Y Z NUMBER" …: nested.off with these as a .poly
    with_regions() {
        cubes poly 0,4,+ 1,1,+ | sed '$d'
        echo $#
        local i
        for ((i = 1; i <= $#; i++)); do echo "$i ${!i} -1"; done
    }
    python3 - >points <<'END'
import random
random.seed(4)
for _ in range(8):
    print(*(round(random.uniform(.1, 3.9), 3) for _ in 'xyz'))
END
    note='tetgen-mesh: *: 1 regions that are in one with another before: left out'
    while read -r x y z; do
        inner=$(awk -v x="$x" -v y="$y" -v z="$z" 'BEGIN { print (x > 1 && x < 2 && y > 1 && y < 2 && z > 1 && z < 2) }')
        [ "$inner" -eq 0 ] || continue
        run -0 --separate-stderr tetgen-mesh --region 0.5,0.5,0.5,9 --region "$x,$y,$z,7" \
            --region 1.5,1.5,1.5,3 -o mesh.tm nested.off
        # shellcheck disable=SC2053 # a pattern
        [[ "$stderr" == $note ]]
        volumes_are mesh.tm 9=63 3=1
        with_regions '0.5 0.5 0.5 9' "$x $y $z 7" >several.poly
        run -0 --separate-stderr tetgen-mesh --regions -o mesh.tm several.poly
        # shellcheck disable=SC2053 # a pattern
        [[ "$stderr" == *$note* ]]
        volumes_are mesh.tm 9=63 10=1
        run -3 tetgen-mesh --strict --regions -o strict.tm several.poly
        [ ! -e strict.tm ]
    done <points
    for number in 2147483647 -2147483647; do
        tetgen-mesh --quiet --region "0.5,0.5,0.5,$number" --region 1.5,1.5,1.5,1 -o mesh.tm nested.off
        volumes_are mesh.tm "$number=63" 1=1
    done
    for number in 2147483648 -2147483649 1e300; do
        run -2 --separate-stderr tetgen-mesh --region "0.5,0.5,0.5,$number" nested.off
        with_regions "0.5 0.5 0.5 $number" >large.poly
        run -3 --separate-stderr tetgen-mesh --regions large.poly
        [[ "$stderr" == *'large.poly: a region has the number '*' (-2147483647..2147483647)' ]]
    done
    # the next number has to be one, too
    run -3 tetgen-mesh --region 0.5,0.5,0.5,2147483647 --region 1.5,1.5,1.5 nested.off
    with_regions '0.5 0.5 0.5 2147483647' >full.poly
    run -3 tetgen-mesh --regions full.poly
}

@test "sizes: a length, and a field over the nodes, within a factor of 2 in 95 %" {
    cubes off 0,1,+ >cube.off
    tetgen-mesh --size 0.1 cube.off -o mesh.tm
    sizes_hold mesh.tm 0.1
    surface sphere off >sphere.off
    tetgen-mesh --size 0.25 sphere.off -o mesh.tm
    sizes_hold mesh.tm 0.25
    cubes poly 0,1,+ | awk 'NF == 5 { $5 = 0.04 + 0.2 * $2 } 1' >field.poly
    tetgen-mesh -m 1 field.poly -o mesh.tm
    sizes_hold mesh.tm '0.04 + 0.2 * x'
    awk '/^\./ { block = $1; getline; next }
         block == ".node" { e = $5 - 0.04 - 0.2 * $2; if (e * e > 1e-24) exit 1 }' mesh.tm
    # the same of tetrahedra, whose nodes have the field
    tetgen-mesh field.poly | tetgen-mesh --metric=1 -o fine.tm
    sizes_hold fine.tm '0.04 + 0.2 * x'
    run -2 --separate-stderr tetgen-mesh -m 2 field.poly
    [[ $stderr == *"the input's nodes have 1 attributes"* ]]
    run -2 --separate-stderr tetgen-mesh -m 1 --size 1 field.poly
    cubes poly 0,1,+ | awk 'NF == 5 { $5 = -1 } 1' >negative.poly
    run -3 --separate-stderr tetgen-mesh -m 1 negative.poly
    [[ $stderr == *'negative.poly: node 0: the length of edges, attribute 1, is -1 '* ]]
}

@test "new nodes get attributes: linear ones stay so, on the surface and inside" {
    cubes poly 0,4,+ 1,1,- 2.5,1,+ >linear.poly
    for options in '-q -a 0.1' '--size 0.4' '--cavities -q1.2' '-Y -a 0.2 --regions'; do
        echo "$options"
        # shellcheck disable=SC2086 # several
        tetgen-mesh --quiet $options linear.poly -o mesh.tm
        is_linear mesh.tm
        tetgen-mesh --quiet -a 0.05 mesh.tm -o fine.tm
        is_linear fine.tm
        [ "$(header .node mesh.tm)" != "$(header .node fine.tm)" ]
    done
}

@test "tetrahedra are refined: regions, markers, names and parts stay" {
    cubes off 0,4,+ 1,1,+ >nested.off
    tetgen-mesh --quiet --regions -q nested.off |
        sed 's/^\.end$/.group\n1 0\n1 3 2 core\n.end/' >coarse.tm
    tetgen-mesh -a 0.05 coarse.tm -o fine.tm
    volumes_are fine.tm 1=63 2=1
    mesh-check fine.tm
    [ "$(rows .group fine.tm)" = "$(rows .group coarse.tm)" ]
    grep -q '^# tetgen-mesh .*-q nested.off' fine.tm
    tetgen-mesh -a 0.05 -j 2 coarse.tm | cmp - fine.tm
    # the six sides, each with a marker: its area stays
    surface box off | python3 -c '
import sys
nodes, faces = 8, 6
lines = sys.stdin.read().split("\n")
print("8 3 0 1", *(f"{i} {p} 5" for i, p in enumerate(lines[2:10])), "6 1",
      *(f"{p} {k + 11}" for k, p in enumerate(lines[10:16])), "0", "0", sep="\n")' >box.smesh
    tetgen-mesh box.smesh | tetgen-mesh -q -a 0.01 -o fine.tm
    rows .face fine.tm | awk '{ n[$5]++ } END { for (m = 11; m <= 16; m++) if (n[m] < 3) exit 1; exit length(n) != 6 }'
    # and so with markers below 0, on faces and on the nodes that are put on them
    negative() { awk '/^[.]/ { block = $1 } block == ".face" && NF == 5 { $5 = -$5 } 1'; }
    tetgen-mesh box.smesh >coarse.tm
    negative <coarse.tm | tetgen-mesh -q -a 0.01 >negative.tm
    [ "$(rows .face fine.tm)" = "$(negative <negative.tm | rows .face /dev/stdin)" ]
    [ "$(rows .node fine.tm)" = "$(rows .node negative.tm | sed 's/ -\(1[1-6]\)$/ \1/')" ]
    rows .node negative.tm | grep -q ' -1[1-6]$'
    # of a stream with both, -r takes the tetrahedra
    surface cube stream | tetgen-mesh -a 0.1 -o both.tm
    tetgen-mesh -a 0.01 -r both.tm -o refined.tm
    [ "$(rows surface.face refined.tm)" = "$(rows surface.face both.tm)" ]
    fills refined.tm 1
}

@test "TetGen that does not come to an end: --timeout, and nothing is left" {
    surface cube off >cube.off
    printf '%s\n' '#!/bin/sh' "echo \$\$ >'$PWD/pid'" 'sleep 1000' >slow
    chmod +x slow
    run -4 --separate-stderr tetgen-mesh --timeout 0.2 --tetgen ./slow cube.off
    [ "$stderr" = "tetgen-mesh: './slow' was ended after 0.2 s (--timeout)" ]
    [ -z "$(ls folder)" ]
    while ps -p "$(cat pid)" -o stat= | grep -v Z; do sleep 0.02; done
    tetgen-mesh --timeout 1000 cube.off | mesh-check
    run -2 --separate-stderr tetgen-mesh --timeout=-1 cube.off
}

@test "tetgen-mesh is killed: TetGen dies, and the next run removes the folder" {
    surface cube off >cube.off
    printf '%s\n' '#!/bin/sh' "echo \$\$ >'$PWD/pid.new'" "mv '$PWD/pid.new' '$PWD/pid'" \
        'exec sleep 1000' >slow
    chmod +x slow
    tetgen-mesh --tetgen ./slow cube.off &
    while ! [ -e pid ]; do sleep 0.02; done
    kill -KILL $!
    while ps -p "$(cat pid)" -o stat= | grep -v Z; do sleep 0.02; done
    left=$(ls folder)
    [ -n "$left" ]
    # a young folder may be of one that begins
    tetgen-mesh cube.off -o mesh.tm
    [ "$(ls folder)" = "$left" ]
    mkdir folder/termesh-other.abcdef
    touch -d '1 hour ago' folder/*
    tetgen-mesh cube.off -o mesh.tm
    [ "$(ls folder)" = termesh-other.abcdef ]
}
