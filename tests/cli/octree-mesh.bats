# SPDX-License-Identifier: GPL-3.0-or-later
# octree-mesh: the mesh and what it says of it, every option, what is wrong with surfaces.
# The places of nodes are judged by code of this file, from the stream alone.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "there is no p4est"
    cd "$BATS_TEST_TMPDIR" || exit
    PATH=$PATH:$TM_BUILD/bench
    surface box off >box.off
    cat >judge.py <<'END'
import sys
from collections import Counter
import numpy as np

def blocks(name):
    found, block, header = {}, None, False
    for line in open(name):
        if line[0] == '.' or line.startswith('surface.'):
            block, header = found.setdefault(line.strip(), []), True
        elif header:
            header = False
        elif block is not None:
            block.append(line.split())
    return found

def distance(p, t):
    """From a point to the closest of triangles [n, 3, 3]."""
    a, b, c = t[:, 0], t[:, 1], t[:, 2]
    ab, ac, ap = b - a, c - a, p - a
    dot = lambda u, v: (u * v).sum(1)
    normal = np.cross(ab, ac)
    square = dot(normal, normal)
    v = dot(np.cross(ap, ac), normal) / square
    w = dot(np.cross(ab, ap), normal) / square
    inside = (v >= 0) & (w >= 0) & (v + w <= 1)
    best = np.where(inside, abs(dot(ap, normal)) / np.sqrt(square), np.inf)
    for u, x in ((a, b), (b, c), (c, a)):
        s = np.clip(dot(p - u, x - u) / dot(x - u, x - u), 0, 1)
        best = np.minimum(best, np.linalg.norm(u + s[:, None] * (x - u) - p, axis=1))
    return best.min()

sides = {4: ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)),
         5: ((0, 1, 2, 3), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
         6: ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
         8: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6),
             (3, 0, 4, 7))}
block = blocks(sys.argv[1])
first = int(block['.node'][0][0])
node = np.array([r[1:4] for r in block['.node']], float)
place = [int(r[4]) for r in block['.node']]
corner = np.array([r[1:4] for r in block['surface.node']], float)
triangle = corner[np.array([r[1:4] for r in block['surface.face']], int) - first]
faces = Counter()
for row in block['.mix']:
    n = [int(i) - first for i in row[2:2 + int(row[1])]]
    faces.update(frozenset(n[i] for i in side) for side in sides[len(n)])
boundary = {v for face, times in faces.items() if times == 1 for v in face}
assert boundary == {v for v, p in enumerate(place) if p != 0}
close = 1e-9 * np.linalg.norm(corner.max(0) - corner.min(0))
low, high = triangle.min(1) - close, triangle.max(1) + close
for v in boundary:
    assert abs(place[v]) <= 3
    if place[v] > 0:
        near = triangle[((low <= node[v]) & (node[v] <= high)).all(1)]
        assert len(near) and distance(node[v], near) <= close, (v, node[v])
count = Counter(place)
print(*(count[p] for p in range(4)), sum(p < 0 for p in place))
END
}

# Prints how many nodes are inside, on patches, on curves, on corners, and held back, when
# the boundary nodes are those that are marked, and on the surface.
judge() {
    /usr/bin/python3 -B judge.py "$1"
}

# A box file with the sides of the cube from LOW to HIGH: cube LOW HIGH LEVEL.
box_file() {
    printf 'n_regions 1 # one\n# a comment\n%s %s %s\n%s %s %s\n%s\n' "$1" "$1" "$1" \
        "$2" "$2" "$2" "$3"
}

# Prints a surface with more triangles: several OFF files as one.
together() {
    awk 'FNR == 2 { nodes = $1; faces = $2; before = all; all += $1; total += $2 }
        FNR > 2 && FNR <= nodes + 2 { node[++v] = $0 }
        FNR > nodes + 2 { line = $1; for (i = 2; i <= $1 + 1; i++) line = line " " $i + before
            face[++f] = line }
        END { print "OFF"; print all, total, 0
            for (i = 1; i <= v; i++) print node[i]
            for (i = 1; i <= f; i++) print face[i] }' "$@"
}

@test "a cube of one octant" {
    octree-mesh --no-history -q -u -a 0 --resolve 0 box.off >mesh.tm
    [ "$(head -n 3 mesh.tm)" = $'termesh 1\n.node\n16 3 1 0' ]
    diff - <(sed -n '/^\.mix/,/^surface.node/p' mesh.tm) <<'END'
.mix
7 1
1 8 1 2 4 3 5 6 8 7 0
2 8 1 5 7 3 9 13 15 11 0
3 8 2 4 8 6 10 12 16 14 0
4 8 1 2 6 5 9 10 14 13 0
5 8 3 7 8 4 11 15 16 12 0
6 8 1 3 4 2 9 11 12 10 0
7 8 5 6 8 7 13 14 16 15 0
.root
1 0
1 -0.0050000000000000044 -0.0050000000000000044 -0.0050000000000000044 1.01 0
.octant
1 0
1 0 0 0 0 1 8
surface.node
END
    [ "$(header surface.node mesh.tm)" = "8 3 0 0" ]
    [ "$(header surface.face mesh.tm)" = "12 0" ]
    mesh-check -q mesh.tm
}

@test "a cube has its corners and edges" {
    octree-mesh --json count.json -s 3 box.off >mesh.tm
    mesh-check --json check.json mesh.tm
    python3 -c '
import json
c = json.load(open("check.json"))
assert abs(c["volume"] - 1) < 1e-12 and abs(c["area"] - 6) < 1e-12, c'
    rows .node mesh.tm | awk '
        { sides = ($2 == 0) + ($2 == 1) + ($3 == 0) + ($3 == 1) + ($4 == 0) + ($4 == 1) }
        $5 < 0 || sides < $5 { print; wrong = 1 }
        $5 == 3 { corner[$2 $3 $4]++ }
        $5 == 2 { edge++ }
        END { for (c in corner) n += corner[c] == 1
            exit wrong || n != 8 || edge < 12 * 6 }'
    [ "$(json count.json lost_corners)" = 0 ]
    [ "$(json count.json lost_edges)" = 0 ]
}

@test "sphere, torus, gear, turned box: good meshes whose nodes are on the surface" {
    surface sphere off >sphere.off
    shapes torus 12 >torus.off
    shapes gear 1 >gear.off
    shapes turned 4 >turned.off
    for shape in sphere torus gear turned; do
        echo "$shape"
        octree-mesh --json count.json -s 4 "$shape.off" >mesh.tm
        mesh-check --json check.json mesh.tm >report
        read -r inside patch curve corner held <<<"$(judge mesh.tm)"
        [ "$(json count.json nodes)" = $((inside + patch + curve + corner + held)) ]
        [ "$(json count.json boundary_nodes)" = $((patch + curve + corner + held)) ]
        [ "$(json count.json held_back)" = "$held" ]
        [ "$(json count.json components)" = 1 ]
        [ "$(json check.json components)" = 1 ]
        [ "$(json count.json euler)" = $((2 * $(json check.json euler))) ]
        [ "$(json count.json inverted)" = 0 ]
        for kind in tetrahedra:tet pyramids:pyramid wedges:wedge hexahedra:hex; do
            [ "$(json check.json ${kind%:*})" = "$(json count.json elements ${kind#*:})" ]
        done
        [ "$(json count.json octants)" = "$(rows .octant mesh.tm | wc -l)" ]
        jens-stats --fail-below 0.29 --json quality.json mesh.tm >/dev/null
        [ "$(json quality.json negative)" = 0 ]
        case $shape in
        sphere) [ "$(json count.json euler) $curve $corner $held" = "2 0 0 0" ] ;;
        torus) [ "$(json count.json euler) $curve $corner $held" = "0 0 0 0" ] ;;
        gear) [ "$(json count.json euler)" = 0 ] && [ "$curve" -gt 100 ] &&
            [ "$corner" -gt 20 ] ;;
        turned) [ "$(json count.json euler) $corner $held" = "2 8 0" ] && [ "$curve" -gt 100 ] ;;
        esac
    done
}

@test "a surface in every format gives the same mesh" {
    surface sphere off | octree-mesh --no-history -s 3 >expected.tm
    for format in coff obj ply ply-little ply-big stl stl-binary mdl poly smesh; do
        echo "$format"
        surface sphere "$format" | octree-mesh --no-history -s 3 >got.tm
        cmp got.tm expected.tm
        surface sphere "$format" >named
        octree-mesh --no-history -s 3 named | cmp - expected.tm
    done
    # of a stream, with its history; a stream that is a surface alone
    surface sphere stream >sphere.tm
    octree-mesh --no-history -s 3 sphere.tm | sed '/^# made by hand$/d' |
        cmp - expected.tm
    octree-mesh -s 3 sphere.tm | head -n 3 >head.txt
    [ "$(sed -n 2p head.txt)" = '# made by hand' ]
    [[ "$(sed -n 3p head.txt)" == '# octree-mesh '*' -s3 sphere.tm: '*' octants, '*' elements' ]]
    surface sphere mdl | mdl-import --no-history | octree-mesh --no-history -s 3 >alone.tm
    judge alone.tm
    [ "$(header .mix alone.tm)" = "$(header .mix expected.tm)" ]
    [ "$(rows .node alone.tm | head -n 1 | cut -d ' ' -f 1)" = 0 ]
    # a mesh of a mesh's surface
    octree-mesh --no-history -s 3 expected.tm >again.tm
    cmp again.tm expected.tm
}

@test "the same input gives the same bytes, for every number of threads" {
    shapes gear 1 >gear.off
    octree-mesh -s 4 -j 1 --no-history gear.off >one.tm
    octree-mesh -s 4 -j 2 --no-history gear.off | cmp - one.tm
    octree-mesh -s 4 -j 2 --no-history -o two.tm gear.off
    cmp two.tm one.tm
    run -1 grep '^#' one.tm
}

@test "markers of the surface are those of the boundary faces beside them" {
    surface cube stream | awk '
        /^surface.face/ { print; getline; print $1, 1; faces = 1; next }
        faces && NF == 4 { print $0, 10 + int(i); i += 0.5; next }
        { print }' >cube.tm
    octree-mesh -s 3 cube.tm >mesh.tm
    mesh-check --json check.json mesh.tm
    [ "$(rows surface.face mesh.tm | cut -d ' ' -f 5 | sort | uniq -c | tr -s ' \n' ' ')" = \
        " 2 10 2 11 2 12 2 13 2 14 2 15 " ]
    [ "$(header .facet mesh.tm)" = "$(json check.json boundary_faces) 1" ]
    # sides in the order of their markers: z = 0, 1, y = 0, x = 1, y = 1, x = 0
    { rows .node mesh.tm; echo; rows .facet mesh.tm; } | awk '
        BEGIN { split("4 4 3 2 3 2", axis); split("0 1 0 1 1 0", at) }
        NF == 0 { facets = 1; next }
        !facets { for (i = 2; i <= 4; i++) x[$1, i] = $i; next }
        { side = $NF - 9; count[side]++
          for (i = 5; i < 5 + $4; i++)
              if (x[$i, axis[side]] != at[side] || $3 != -1) { print; wrong = 1 } }
        END { for (s = 1; s <= 6; s++) wrong = wrong || count[s] < 49; exit wrong }'
    octree-mesh -s 3 box.off >plain.tm
    run -1 grep '^\.facet' plain.tm
    [ "$(rows .mix plain.tm)" = "$(rows .mix mesh.tm)" ]
}

@test "-a, -s: levels everywhere or at the surface" {
    surface sphere off >sphere.off
    # levels OPTION… : the numbers of octants of each level
    levels() {
        octree-mesh -q "$@" sphere.off >mesh.tm
        rows .octant mesh.tm | cut -d ' ' -f 2 | sort -n | uniq -c | awk '{ print $2 ":" $1 }' |
            paste -sd ' '
    }
    [ "$(levels -a 3)" = 3:512 ]
    [ "$(levels -a 2 --resolve 0)" = 2:64 ]
    # octants outside need not be small
    [[ "$(levels -a 4)" == 3:*' 4:'* ]]
    [[ "$(levels -s 4)" == *3:*' 4:'* ]]
    [ "$(levels)" = "$(levels -s 5)" ]
    [ "$(levels -a 3 -a 2 -s 3)" = 3:512 ]
}

# sides FILE: the sides of its octants, as multiples of SIDE, ascending.
sides() {
    { rows .root "$1"; echo; rows .octant "$1" | cut -d ' ' -f 2 | sort -rnu; } | awk -v unit="$2" '
        NF == 0 { octants = 1; next }
        !octants { side = $5; next }
        { printf "%.6g ", side / 2 ^ $1 / unit }'
}

@test "-s: planes where the octants with the surface are dropped have faces of that level, too" {
    awk 'NR > 2 && NR <= 10 { print $1 * 2.3, $2, $3; next } { print }' box.off >long.off
    for resolve in 0 1; do
        octree-mesh -q -u -s 4 --resolve "$resolve" -o mesh.tm long.off
        # of each element the level, and its nodes at an end
        awk '/^[.]/ { block = $1; head = 1; next } head { head = 0; next }
            block == ".node" { end[$1] = $2 * $2 < 1e-18 || ($2 - 2.3) ^ 2 < 1e-18 }
            block == ".mix" {
                n = 0
                for (i = 3; i < 3 + $2; i++) n += end[$i]
                if (n >= 3) { faces++; if ($(3 + $2) != 4) coarse++ }
            }
            END { print coarse + 0; exit faces < 400 }' mesh.tm >coarse
        [ "$(cat coarse)" -eq 0 ]
    done
}

@test "--size, --inner-size: octants of a given size, whatever the shape is" {
    # the thin side of a plate says nothing of them
    awk 'NR > 2 && NR <= 10 { print $1 * 10, $2 * 10, $3; next } { print }' box.off >slab.off
    octree-mesh --size 0.2 -o mesh.tm slab.off
    [ "$(sides mesh.tm 0.2)" = "1 2 " ]
    mesh-check -q mesh.tm
    octree-mesh --size 0.2 --inner-size 0.25 -o fine.tm slab.off
    [ "$(rows .octant fine.tm | awk '$6 < $7' | cut -d ' ' -f 2 | sort -u | wc -l)" = 1 ]
    octree-mesh --inner-size 0.5 --resolve 0 -o inner.tm slab.off
    [[ "$(sides inner.tm 0.5)" == "1 "* ]]
    # thinner than one octant, where it is that the plate lies
    for z in 0 0.13 0.3 7; do
        awk -v z=$z 'NR > 2 && NR <= 10 { print $1 * 10, $2 * 10, $3 / 8 + z; next } { print }' \
            box.off >sheet.off
        octree-mesh --size 0.4 --resolve 0 -o mesh.tm sheet.off
        [[ "$(sides mesh.tm 0.4)" == "1 "* ]]
        mesh-check --json check.json mesh.tm >/dev/null
        python3 -c '
import json
assert abs(json.load(open("check.json"))["volume"] - 12.5) < 1e-9'
    done
}

# sides_where NAME TEST: the largest side of an octant of the mesh NAME whose centre (x, y, z)
# passes TEST, an expression of awk, and the smallest.
sides_where() {
    { rows .root "$1"; echo; rows .octant "$1"; } | awk '
        NF == 0 { octants = 1; next }
        !octants { for (i = 0; i < 3; i++) low[i] = $(2 + i); side = $5; unit = side / 2 ^ $6; next }
        { s = side / 2 ^ $2; x = low[0] + unit * $3 + s / 2; y = low[1] + unit * $4 + s / 2
          z = low[2] + unit * $5 + s / 2
          if ('"$2"') { if (s > most) most = s; if (!least || s < least) least = s } }
        END { print most, least }'
}

@test "--curvature: a cell spans no more than so much of a turn, and flat parts have larger ones" {
    # a cylinder of radius 1
    python3 - >cylinder.off <<'END'
import math
n = 96
print('OFF')
print(2 * n, n + 2, 0)
for z in (0, 2):
    for i in range(n):
        print(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n), z)
print(n, *range(n - 1, -1, -1))
print(n, *range(n, 2 * n))
for i in range(n):
    print(4, i, (i + 1) % n, n + (i + 1) % n, n + i)
END
    octree-mesh -s 6 --json all.json -o all.tm cylinder.off
    for turn in 5 10 20; do
        octree-mesh -s 6 --curvature $turn --json count.json -o mesh.tm cylinder.off
        mesh-check -q mesh.tm
        [ "$(json count.json held_back) $(json count.json lost_corners)" = "0 0" ]
        [ "$(json count.json elements hex)" -lt $(($(json all.json elements hex) / 3)) ]
        # at the wall, by the surface; at the middle of the ends
        read -r most _ <<<"$(sides_where mesh.tm 'x * x + y * y < 1 && sqrt(x * x + y * y) > 1 - s / 2 && z > 0.5 && z < 1.5')"
        read -r _ flat <<<"$(sides_where mesh.tm 'x * x + y * y < 0.1 && (z > 2 - s / 2 && z < 2 || z > 0 && z < s / 2)')"
        python3 -c '
import math, sys
most, flat, turn, finest = map(float, sys.argv[1:])
assert most <= math.radians(turn) * 1.1 and most > min(math.radians(turn), 4) / 2.2, most
assert flat >= 3.9 * finest, flat' "$most" "$flat" $turn "$(python3 -c 'print(2.02 / 64)')"
    done
    # no more than -s says, and no less than three levels less
    octree-mesh -s 4 --curvature 1 --resolve 0 -o mesh.tm cylinder.off
    read -r _ least <<<"$(sides_where mesh.tm 1)"
    python3 -c 'import sys; assert abs(float(sys.argv[1]) - 2.02 / 16) < 0.01' "$least"
    # the walls of a gap are flat, but there are two
    awk 'NR > 2 && NR <= 10 { print $1 + 1.1, $2, $3; next } { print }' box.off >right.off
    together box.off right.off >gap.off
    octree-mesh -s 6 --curvature 15 --resolve 0 --json count.json -o mesh.tm gap.off
    [ "$(json count.json components) $(json count.json euler)" = "2 4" ]
    [ "$(json count.json lost_octants) $(json count.json held_back)" = "0 0" ]
    mesh-check -q mesh.tm
    # with a size
    octree-mesh --size 0.05 --curvature 15 -o mesh.tm cylinder.off
    [ "$(sides mesh.tm 0.05 | cut -d ' ' -f 1)" -ge 1 ]
    mesh-check -q mesh.tm
}

@test "where a curve of the surface is lost, nodes stay on what is beside it" {
    # a slit that ends sharp, in a cube: its lower part is thinner than octants
    cat >slit.off <<'END'
OFF
14 13 0
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
0.4651 0.25 1
0.5349 0.25 1
0.5349 0.75 1
0.4651 0.75 1
0.5 0.25 0.5
0.5 0.75 0.5
4 0 3 2 1
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
4 4 5 9 8
4 5 6 10 9
4 6 7 11 10
4 7 4 8 11
4 8 12 13 11
4 9 10 13 12
3 8 9 12
3 10 11 13
END
    octree-mesh -q -s 5 --resolve 0 --json count.json -o mesh.tm slit.off
    [ "$(json count.json lost_edges)" -gt 0 ]
    [ "$(json count.json held_back)" = 0 ]
    judge mesh.tm
    # smaller octants where it is thinner than two of them: the more, the more of it is
    # there; its volume is 0.0698 / 16
    for levels in 0 1 2 3; do
        octree-mesh -q -s 4 --resolve $levels -o mesh.tm slit.off
        mesh-check --json $levels.json mesh.tm >/dev/null
    done
    python3 -c '
import json
lost = [abs(json.load(open("%d.json" % n))["volume"] - 1 + 0.0698 / 8) for n in range(4)]
assert lost[0] > 3 * lost[1] > 9 * lost[2] and lost[3] < 4e-4, lost'
}

@test "--resolve splits nothing at edges and corners that octants have to themselves" {
    surface cube off >cube.off
    octree-mesh -q --no-history -s 3 --resolve 0 -o plain.tm cube.off
    octree-mesh -q --no-history -s 3 --resolve 2 cube.off | cmp - plain.tm
}

@test "--most: what would be too much is refused, with what fits" {
    surface sphere off >sphere.off
    octree-mesh -q --json count.json -s 5 sphere.off >mesh.tm
    elements=$(header .mix mesh.tm | cut -d ' ' -f 1)
    octree-mesh -q -s 5 --most $((2 * elements)) -o again.tm sphere.off
    cmp again.tm mesh.tm || [ "$(rows .mix again.tm)" = "$(rows .mix mesh.tm)" ]
    echo old >out.tm
    run -3 --separate-stderr octree-mesh -o out.tm -s 5 --most $((elements / 2)) sphere.off
    [[ "$stderr" == 'octree-mesh: sphere.off: about '*' elements would be made, with octants down to '*' (--most); levels that are lower by 1 would fit, or octants of '*' (--size)' ]]
    [ "${#stderr_lines[@]}" -eq 1 ]
    [ "$(cat out.tm)" = old ]
    # what it says would fit does
    size=${stderr##*octants of }
    octree-mesh -q -s 4 --most $((elements / 2)) -o out.tm sphere.off
    octree-mesh -q --size "${size% *}" --most $((elements / 2)) -o out.tm sphere.off
    [ "$(header .mix out.tm | cut -d ' ' -f 1)" -lt "$elements" ]
    # a wedge of 1 degree: levels count from its thin side; a level that would take hours
    cat >wedge.off <<'END'
OFF
6 5 0
0 0 0
0 1 0
1 0 0
1 1 0
1 0 0.0174524
1 1 0.0174524
4 0 2 3 1
4 0 1 5 4
3 0 4 2
3 1 3 5
4 2 4 5 3
END
    run -3 --separate-stderr octree-mesh -s 9 wedge.off
    [[ "$stderr" == *'more than 5e+07 (--most); '* ]]
    octree-mesh -q --size 0.05 -o mesh.tm wedge.off
    [ "$(header .mix mesh.tm | cut -d ' ' -f 1)" -lt 200000 ]
    mesh-check -q mesh.tm
    # boxes, regions and everything count, too, where the solid is
    box_file -1 1 9 >all.reg
    run -3 octree-mesh -s 3 -b all.reg box.off
    box_file 3 4 17 >outside.reg
    octree-mesh -q -s 3 -b outside.reg -o mesh.tm box.off
    run -3 octree-mesh -s 3 -r sphere.off 9 box.off
    run -3 octree-mesh -a 9 box.off
}

@test "-b: boxes from a file with comments; -u: levels of the elements" {
    box_file 0 0.2 5 >fine.reg
    octree-mesh -u -s 3 -b fine.reg --resolve 0 box.off >mesh.tm
    rows .octant mesh.tm | awk '
        { side = 1.01 / 2 ^ $2; low = -0.005
          meets = 1
          for (i = 3; i <= 5; i++)
              meets = meets && low + $i * 1.01 / 32 <= 0.2
          if (meets && $2 < 5) { print; wrong = 1 }
          if (meets) fine++ }
        END { exit wrong || fine < 100 }'
    { rows .octant mesh.tm; echo; rows .mix mesh.tm; } | awk '
        NF == 0 { elements = 1; next }
        !elements { for (e = $6; e < $7; e++) level[e] = $2; next }
        $NF != level[$1] || NF != $2 + 3 { print; wrong = 1 }
        { seen[$NF]++ }
        END { exit wrong || !seen[3] || !seen[4] || !seen[5] }'
    judge mesh.tm
    mesh-check -q mesh.tm
}

@test "-r: on and in the surface of another file, in any format" {
    awk 'NR == 2 { nodes = $1 }
        NR > 2 && NR <= nodes + 2 { print $1 / 4, $2 / 4, $3 / 4; next } { print }' \
        box.off >small.off
    octree-mesh -s 3 -r small.off 5 --no-history box.off >mesh.tm
    box_file 0 0.25 5 >small.reg
    octree-mesh -s 3 -b small.reg --no-history box.off | cmp - mesh.tm
    octree-mesh -s 3 -r small.off 2 -r small.off 5 --no-history box.off | cmp - mesh.tm
    octree-mesh -s 3 -r small.off 5 box.off | grep -q '^# octree-mesh [^ ]* -s3 -rsmall.off 5 '
    # nothing of it is in the mesh
    [ "$(rows surface.node mesh.tm)" = "$(octree-mesh -s 3 box.off >m.tm; rows surface.node m.tm)" ]
}

@test "-l: octants of a list are split once more" {
    octree-mesh -a 2 --resolve 0 box.off >coarse.tm
    printf '# numbers from 0\n0\n' >first.ref
    octree-mesh -a 2 -l first.ref --resolve 0 box.off >mesh.tm
    # the first one became the first eight
    diff <(rows .octant mesh.tm | head -n 8 | cut -d ' ' -f 2-5) - <<'END'
3 0 0 0
3 1 0 0
3 0 1 0
3 1 1 0
3 0 0 1
3 1 0 1
3 0 1 1
3 1 1 1
END
    [ "$(rows .octant mesh.tm | wc -l)" = $(($(rows .octant coarse.tm | wc -l) + 7)) ]
    mesh-check -q mesh.tm
    echo 64 >none.ref
    run -3 --separate-stderr octree-mesh -a 2 -l none.ref box.off
    [[ "$stderr" == *64* ]]
}

@test "--feature-angle: an edge is kept where it is sharper" {
    octree-mesh -q -s 3 --feature-angle 80 box.off >kept.tm
    read -r _ _ curve corner _ <<<"$(judge kept.tm)"
    [ "$corner" = 8 ] && [ "$curve" -gt 50 ]
    octree-mesh -q -s 3 --feature-angle 100 box.off >round.tm
    read -r _ _ curve corner _ <<<"$(judge round.tm)"
    [ "$corner $curve" = "0 0" ]
    mesh-check -q round.tm
}

# A closed surface of rings, as OFF: standard input is Python that sets rings, around and
# nodes, which are both poles and then ring by ring.
revolved() {
    python3 -c '
import sys
exec(sys.stdin.read())
at = lambda r, a: 0 if r == 0 else 1 if r == rings else 2 + (r - 1) * around + a % around
faces = []
for r in range(rings):
    for a in range(around):
        p, q, s, t = at(r, a), at(r + 1, a), at(r + 1, a + 1), at(r, a + 1)
        faces += [f for f in ((p, q, s), (p, s, t)) if len(set(f)) == 3]
print("OFF")
print(len(nodes), len(faces), 0)
for p in nodes:
    print(*p)
for f in faces:
    print(3, *f)'
}

# noisy_sphere SEED AROUND RINGS BY: its nodes are in and out by up to so much.
noisy_sphere() {
    revolved <<END
import math, random
random.seed($1)
around, rings = $2, $3
nodes = [(0, 0, 1), (0, 0, -1)]
for r in range(1, rings):
    for a in range(around):
        u, w = math.pi * r / rings, 2 * math.pi * a / around
        d = 1 + $4 * random.uniform(-1, 1)
        nodes.append((d * math.sin(u) * math.cos(w), d * math.sin(u) * math.sin(w),
                      d * math.cos(u)))
END
}

@test "rough surfaces: every element is positive inside, too" {
    for seed in 1 3 6 7 10 13; do
        noisy_sphere "$seed" 24 12 0.2 >noisy.off
        for level in 4 5; do
            octree-mesh -q -s "$level" noisy.off >noisy.tm
            jens-stats --quiet --certify noisy.tm
        done
    done
}

@test "a rough body beside it leaves a smooth one its edges, and a note says so" {
    noisy_sphere 5 60 30 0.05 >noisy.off
    run -0 --separate-stderr octree-mesh -s 3 -o rough.tm noisy.off
    [ "$stderr" = 'octree-mesh: noisy.off: the surface is rough all over: no edge of it is kept as sharp' ]
    awk 'NR > 2 && NR <= 10 { print $1 * 2 + 2, $2 * 2 - 1, $3 * 2 - 1; next } { print }' \
        box.off >right.off
    octree-mesh -s 4 right.off >alone.tm
    read -r _ _ alone corner _ <<<"$(judge alone.tm)"
    together noisy.off right.off >both.off
    run -0 --separate-stderr octree-mesh -s 4 -o mesh.tm both.off
    [[ "${stderr_lines[0]}" == 'octree-mesh: both.off: '*' sharp edges are in rough parts of the surface and not kept (--feature-angle takes all)' ]]
    read -r _ _ curve corner _ <<<"$(judge mesh.tm)"
    [ "$corner" = 8 ] && [ "$curve" -gt $((alone * 3 / 4)) ]
}

@test "--resolve: smaller octants where a part would be lost, or a note that names it" {
    # a wall of 0.1 around a hollow
    awk 'NR > 2 && NR <= 10 { print $1 * 3.8 + 0.1, $2 * 3.8 + 0.1, $3 * 3.8 + 0.1; next }
        { print }' box.off >hollow.off
    awk 'NR > 2 && NR <= 10 { print $1 * 4, $2 * 4, $3 * 4; next } { print }' \
        box.off >large.off
    together large.off hollow.off >wall.off
    run -3 --separate-stderr octree-mesh -s 4 --resolve 0 wall.off
    [ "$output" = "" ]
    [[ "$stderr" == *'no leaf is inside the surface: it needs a finer level'* ]]
    octree-mesh -s 4 --json count.json wall.off >mesh.tm
    [ "$(json count.json components)" = 2 ]
    [ "$(json count.json euler)" = 4 ]
    mesh-check -q mesh.tm
    # two cubes with a gap that level 3 does not see
    awk 'NR > 2 && NR <= 10 { print $1 + 1.02, $2, $3; next } { print }' box.off >right.off
    together box.off right.off >gap.off
    run -0 --separate-stderr octree-mesh -s 3 --resolve 0 -o gap.tm gap.off
    [[ "$stderr" == *'octree-mesh: '*' octants with surface are too large for it: a thin part or a gap is lost near ('* ]]
    [[ "$stderr" == *'the boundary has 1 components and Euler number 2, the surface 2 and 4: '* ]]
    mesh-check -q gap.tm
    run -0 --separate-stderr octree-mesh -q -s 3 --resolve 0 -o gap.tm gap.off
    [ "$stderr" = "" ]
    octree-mesh -s 3 --resolve 4 --json count.json gap.off >mesh.tm
    [ "$(json count.json components) $(json count.json euler)" = "2 4" ]
}

@test "what is noted as lost is missing in the mesh, and what is missing is noted" {
    # six pyramids on a cube: octants at their tips have no boundary of octants near, but
    # the mesh is exact
    cat >star.off <<'END'
OFF
14 24 0
-0.125 -0.125 -0.125
0.125 -0.125 -0.125
-0.125 0.125 -0.125
0.125 0.125 -0.125
-0.125 -0.125 0.125
0.125 -0.125 0.125
-0.125 0.125 0.125
0.125 0.125 0.125
0 0 -0.5
0 0 0.5
0 -0.5 0
0.5 0 0
0 0.5 0
-0.5 0 0
END
    side=8
    for nodes in "0 2 3 1" "4 5 7 6" "0 1 5 4" "1 3 7 5" "3 2 6 7" "2 0 4 6"; do
        read -r a b c d <<<"$nodes"
        printf "3 %d %d %d\n" "$a" "$b" $side "$b" "$c" $side "$c" "$d" $side "$d" "$a" $side
        side=$((side + 1))
    done >>star.off
    run -0 --separate-stderr octree-mesh -s 4 --json count.json -o mesh.tm star.off
    [ "$stderr" = "" ]
    [ "$(json count.json lost_octants) $(json count.json rounded_tips)" = "0 0" ]
    mesh-check --json check.json mesh.tm >/dev/null
    # 8 octants of 1/4³ and six pyramids of height 3/8
    python3 -c '
import json
assert abs(json.load(open("check.json"))["volume"] - (1 / 64 + 6 * 3 / 8 / 3 / 16)) < 1e-12'
    # a needle that ends round is a tip without a corner, thinner than octants
    revolved >needle.off <<'END'
import math
rings, around = 60, 12
nodes = [(0, 0, 2), (0, 0, -1)]
def radius(z):
    if z > 0.8:
        return 0.02 * math.sqrt(1 - ((z - 0.8) / 1.2) ** 8)
    return math.sqrt(max(1 - z * z, 0)) * 0.98 / 0.6 * 0.6 if z < 0.75 else \
        0.02 + (math.sqrt(1 - 0.75 ** 2) * 0.98 - 0.02) * (0.8 - z) / 0.05
for r in range(1, rings):
    z = 2 - 3 * r / rings
    for a in range(around):
        w = 2 * math.pi * a / around
        nodes.append((radius(z) * math.cos(w), radius(z) * math.sin(w), z))
END
    for levels in 0 1; do
        run -0 --separate-stderr octree-mesh -s 3 --feature-angle 180 --resolve $levels \
            --json $levels.json -o mesh.tm needle.off
        [[ "$stderr" == *'octree-mesh: 1 tips or thin parts of the surface are rounded off, or missed, by up to '*', near ('*', 2)'* ]]
        [ "$(json $levels.json rounded_tips)" = 1 ]
    done
    # smaller octants lose no more
    [ "$(json 1.json lost_octants)" -le "$(json 0.json lost_octants)" ]
}

@test "what touches, bounds nothing, or is outside is said" {
    # two cubes with an edge in common
    awk 'NR > 2 && NR <= 10 { print $1 + 1, $2 + 1, $3; next } { print }' box.off >beside.off
    together box.off beside.off >edge.off
    run -0 --separate-stderr octree-mesh -s 3 --json count.json -o mesh.tm edge.off
    [[ "${stderr_lines[0]}" == 'octree-mesh: edge.off: parts of the surface touch at 2 nodes, and along edges between these: they count as apart there, and each has nodes of its own' ]]
    [ "$(json count.json components)" = 2 ]
    # a sheet in a cube
    printf 'OFF\n4 1 0\n0.3 0.3 0.5\n0.7 0.3 0.5\n0.7 0.7 0.5\n0.3 0.7 0.5\n4 0 1 2 3\n' \
        >sheet.off
    together box.off sheet.off >both.off
    run -0 --separate-stderr octree-mesh -s 4 --lenient --json count.json -o mesh.tm both.off
    [[ "$stderr" == *'octree-mesh: 1 pieces of the surface bound nothing and have no part in the mesh, as near (0.'*', 0.'*', 0.5)' ]]
    [ "$(json count.json dropped_pieces)" = 1 ]
    octree-mesh -s 4 --json count.json -o mesh.tm box.off
    [ "$(json count.json dropped_pieces)" = 0 ]
    # boxes and regions
    box_file 2 3 6 >far.reg
    run -0 --separate-stderr octree-mesh -s 3 -b far.reg -o mesh.tm box.off
    [ "$stderr" = 'octree-mesh: the box from (2, 2, 2) to (3, 3, 3) is wholly outside of the surface: no octant is split for it' ]
    awk 'NR > 2 && NR <= 10 { print $1 + 4, $2, $3; next } { print }' box.off >far.off
    run -0 --separate-stderr octree-mesh -s 3 -r far.off 6 -o mesh.tm box.off
    [ "$stderr" = 'octree-mesh: the region from (4, 0, 0) to (5, 1, 1) is wholly outside of the surface: no octant is split for it' ]
    # inside of it, around it, across it
    for box in "0.4 0.6" "-1 2" "0.5 2"; do
        # shellcheck disable=SC2086 # two numbers
        box_file $box 4 >near.reg
        awk -v box="$box" 'BEGIN { split(box, at) }
            NR > 2 && NR <= 10 { for (i = 1; i <= 3; i++) $i = at[$i + 1] } { print }' \
            box.off >near.off
        run -0 --separate-stderr octree-mesh -s 3 -b near.reg -r near.off 4 -o mesh.tm box.off
        [ "$stderr" = "" ]
    done
}

@test "a surface that is inverted is turned, and duplicates are dropped: both are said" {
    surface sphere off >sphere.off
    octree-mesh --no-history -s 3 sphere.off >expected.tm
    awk 'NF == 4 && NR > 2 { print 3, $4, $3, $2; next } { print }' sphere.off >inverted.off
    run -0 --separate-stderr octree-mesh --no-history -s 3 -o mesh.tm inverted.off
    [ "$stderr" = 'octree-mesh: inverted.off: triangles were turned, so that all look outward' ]
    diff <(rows .octant mesh.tm) <(rows .octant expected.tm)
    judge mesh.tm
    mesh-check -q mesh.tm
    # what a shell within another one becomes
    python3 - sphere.off >nested.off <<'END'
import sys
lines = open(sys.argv[1]).read().split('\n')
v, f, _ = map(int, lines[1].split())
points = [[float(x) for x in line.split()] for line in lines[2:2 + v]]
print('OFF\n%d %d 0' % (2 * v, 2 * f))
for size in 1, 0.5:
    for p in points:
        print(*(size * x for x in p))
for first in 0, v:
    for line in lines[2 + v:2 + v + f]:
        print(3, *(int(n) + first for n in line.split()[1:]))
END
    run -0 --separate-stderr octree-mesh --no-history -s 3 -o mesh.tm nested.off
    [ "$stderr" = 'octree-mesh: nested.off: triangles were turned, so that shells look outward, those within an odd number of others inward' ]
    # one side of the cube alone
    awk 'NR == 11 { print 4, $5, $4, $3, $2; next } { print }' box.off >side.off
    octree-mesh --no-history -s 3 box.off >expected.tm
    run -0 --separate-stderr octree-mesh --no-history -s 3 -o mesh.tm side.off
    [ "$stderr" = 'octree-mesh: side.off: triangles were turned, so that all look outward' ]
    [ "$(header .mix mesh.tm)" = "$(header .mix expected.tm)" ]
    awk 'NR == 2 { $2 += 20000 } { print }
        NR == 11 { for (i = 0; i < 20000; i++) print }' box.off >many.off
    run -0 --separate-stderr octree-mesh --no-history -s 3 -o mesh.tm many.off
    [ "$stderr" = 'octree-mesh: many.off: 40000 triangles were there twice and are dropped' ]
    cmp mesh.tm expected.tm
}

@test "--lenient takes surfaces that are open or cross themselves" {
    sed '$d; 2s/6/5/' box.off >open.off
    awk 'NR > 2 && NR <= 10 { print $1 + 0.5, $2 + 0.3, $3 + 0.4; next } { print }' \
        box.off >moved.off
    together box.off moved.off >cross.off
    run -0 --separate-stderr octree-mesh -s 4 --lenient -o mesh.tm open.off
    [[ "$stderr" == 'octree-mesh: open.off: the surface is open at 4 edges'* ]]
    mesh-check -q mesh.tm
    run -0 --separate-stderr octree-mesh -s 4 --lenient -o mesh.tm cross.off
    [[ "$stderr" == 'octree-mesh: cross.off: the surface crosses itself at '*' pairs of triangles'* ]]
    mesh-check --json check.json mesh.tm
    # 2 - 0.5 × 0.7 × 0.6: the union, but for what the level does to the edges inside
    python3 -c '
import json
assert abs(json.load(open("check.json"))["volume"] - 1.79) < 0.1'
}

@test "what is wrong with a surface: exit 3, what and where, and nothing is written" {
    # fails FILE MESSAGE [OPTION…]
    fails() {
        local file=$1 message=$2
        shift 2
        echo old >out.tm
        run -3 --separate-stderr octree-mesh -o out.tm "$@" "$file"
        # shellcheck disable=SC2053 # a pattern
        [[ "$stderr" == "octree-mesh: "$message ]]
        [ "${#stderr_lines[@]}" -eq 1 ]
        [ "$(cat out.tm)" = old ]
    }
    sed '$d; 2s/6/5/' box.off >open.off
    fails open.off 'open.off: the surface is open: edges with one triangle: 4* (surface-mend may mend it; --lenient takes it as it is)'
    awk 'NR > 2 && NR <= 10 { print $1 + 0.5, $2 + 0.3, $3 + 0.4; next } { print }' \
        box.off >moved.off
    together box.off moved.off >cross.off
    fails cross.off 'cross.off: two pieces of the surface cross: faces * meet near (*; --lenient takes it as it is)'
    : >empty.off
    fails empty.off 'empty.off: is empty*'
    printf 'OFF\n0 0 0\n' >none.off
    fails none.off 'none.off: the surface is empty: *'
    [[ "$stderr" != *lenient* ]] # which would not take it
    sed '4s/.*/0 nan 0/' box.off >nan.off
    fails nan.off "nan.off:4: the y coordinate: 'nan' is not a number"
    sed '4s/.*/0 1e200 0/' box.off >huge.off
    fails huge.off 'huge.off:*'
    printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >flat.off
    fails flat.off 'flat.off: *'
    head -c 200 /dev/urandom >noise.bin
    fails noise.bin 'noise.bin*'
    mixed >mixed.tm
    fails mixed.tm 'mixed.tm: holds mixed elements (.mix), but octree-mesh takes a surface*'
    fails open.off 'open.off: the surface is open*' -r box.off 4
    fails box.off 'open.off: the surface is open*' -r open.off 4
    # files of the options
    printf 'n_regions 2\n0 0 0 1 1 1 4\n' >short.reg
    fails box.off 'short.reg*' -b short.reg
    box_file 0 1 18 >deep.reg
    fails box.off 'deep.reg:*' -b deep.reg
    fails box.off 'leaves of 1e-09 are too small for the surface (* is the least for it)' --size 1e-9
    echo one >word.ref
    fails box.off 'word.ref:1: *' -l word.ref
}

@test "wrong command lines: exit 2" {
    # refuses MESSAGE OPTION…
    refuses() {
        local message=$1
        shift
        run -2 --separate-stderr octree-mesh "$@"
        [ "$output" = "" ]
        # shellcheck disable=SC2053 # a pattern
        [[ "${stderr_lines[0]}" == "octree-mesh: "$message ]]
    }
    for option in -a -s --resolve; do
        refuses "$option: '18' is not a whole number in 0 … 17" "$option" 18 box.off
        refuses "$option: '-1' is not a whole number*" "$option" -1 box.off
        refuses "$option: '2.5' is not a whole number*" "$option" 2.5 box.off
    done
    refuses "-r: '18' is not a whole number in 0 … 17" -r box.off 18 box.off
    refuses '-r box.off lacks its level: -r SURFACE L' -r box.off
    refuses "--size: '0' *" --size 0 box.off
    refuses "--inner-size: 'x' *" --inner-size x box.off
    refuses "--most: '0' *" --most 0 box.off
    refuses "--curvature: '0' *" --curvature 0 box.off
    refuses "--curvature: '91' *" --curvature 91 box.off
    refuses "--feature-angle: '181' *" --feature-angle 181 box.off
    refuses "--feature-angle: 'x' *" --feature-angle x box.off
    refuses '*' box.off box.off
}

@test "files that are not there: exit 4; the nodes of a .poly: 3" {
    for options in "-b nowhere" "-l nowhere" "-r nowhere 3"; do
        # shellcheck disable=SC2086 # words
        run -4 --separate-stderr octree-mesh -o out.tm $options box.off
        [ "$stderr" = "octree-mesh: nowhere: cannot open: No such file or directory" ]
        [ ! -e out.tm ]
    done
    # the nodes of a .poly file that has none
    surface cube poly | sed '1s/^8/0/; 2,9d' >lonely.poly
    run -3 --separate-stderr octree-mesh lonely.poly
    [ "$stderr" = \
        'octree-mesh: lonely.poly: has no nodes, and there is no file lonely.node with them' ]
}

@test "without a folder for temporary files, and without a home" {
    octree-mesh --no-history -s 3 box.off >expected.tm
    TMPDIR=/nowhere octree-mesh --no-history -s 3 box.off | cmp - expected.tm
    (cd / && HOME=/nowhere octree-mesh --no-history -s 3 "$OLDPWD/box.off") | cmp - expected.tm
}

@test "every filter for mixed elements reads the mesh" {
    surface cube stream | awk '
        /^surface.face/ { print; getline; print $1, 1; faces = 1; next }
        faces && NF == 4 { print $0, 7; next }
        { print }' | octree-mesh -u -s 3 -o mesh.tm
    for filter in vtu-export vtk-export m3d-export mvm-export visf-export getfem-export \
        off-export oct-export mesh-check jens-stats; do
        echo "$filter"
        run -0 --separate-stderr "$filter" -o out mesh.tm
        case $filter in
        m3d-export | mvm-export | visf-export | off-export | oct-export)
            [[ "$stderr" == *' markers of faces (.facet): left out' ]]
            ;;
        *) [ "$stderr" = "" ] ;;
        esac
        [ -s out ]
    done
    openfoam-export foam mesh.tm
    [ -s foam/owner ]
    # what comes back
    m3d-export mesh.tm | m3d-import --no-history >again.tm
    diff <(rows .mix again.tm | cut -d ' ' -f 2) <(rows .mix mesh.tm | cut -d ' ' -f 2)
    oct-export mesh.tm | oct-import --no-history >again.tm
    diff <(rows .octant again.tm | cut -d ' ' -f 2-5) \
        <(rows .octant mesh.tm | cut -d ' ' -f 2-5)
}

@test "what the environment says to Open MPI does not matter" {
    octree-mesh --no-history -s 2 box.off >expected
    for variable in OMPI_MCA_{btl,pml,coll,ess,shmem,btl_base_verbose}; do
        for value in tcp no_such_thing 100; do
            env "$variable=$value" octree-mesh --quiet --no-history -s 2 box.off >found 2>message
            cmp found expected
            [ ! -s message ]
        done
    done
}

@test "whatever memory there is, the mesh is whole, or the exit status is 4" {
    case ${TM_BUILD:?} in */san*) skip "memory has no limit under the sanitizers" ;; esac
    octree-mesh --no-history -s 2 box.off >expected
    statuses=
    for megabytes in 25 30 35 40 45 50 55 60 65 70 80 100 200; do
        run_limited "$megabytes"
        case $status in
        0) cmp found expected ;;
        4) grep 'out of memory' message ;;
        127) grep 'shared libraries' message ;; # not even they can be loaded
        *) return 1 ;;
        esac
        statuses+=$status
    done
    [[ "$statuses" == *4*0 ]]
}

# Runs it with so much memory; sets $status.
run_limited() {
    status=0
    (
        ulimit -v $(($1 * 1024))
        exec octree-mesh --no-history -j 1 -s 2 box.off
    ) >found 2>message || status=$?
}

@test "--most: --curvature is foreseen on thin parts too" {
    surface box off | awk 'NR > 2 && NF == 3 { $3 *= 0.06 } 1' >plate.off
    # A flat cone; both have two sides in the octants that flat parts have.
    awk 'BEGIN { print "OFF"; print 34, 64, 0; print 0, 0, 0; print 0, 0, 0.1
        for (i = 0; i < 32; i++) print cos(i * atan2(0, -1) / 16), sin(i * atan2(0, -1) / 16), 0
        for (i = 0; i < 32; i++) { a = 2 + i; b = 2 + (i + 1) % 32; print 3, 0, b, a; print 3, 1, a, b } }' >cone.off
    for of in plate cone; do
        octree-mesh --no-history -q -s 2 --curvature 20 --resolve 0 -o of.tm "$of.off"
        elements=$(header .mix of.tm | cut -d ' ' -f 1)
        run -0 --separate-stderr octree-mesh -s 2 --curvature 20 --resolve 0 --most $((3 * elements)) -o of.tm "$of.off"
        run -3 --separate-stderr octree-mesh -s 2 --curvature 20 --resolve 0 --most $((elements / 3)) -o of.tm "$of.off"
    done
}
