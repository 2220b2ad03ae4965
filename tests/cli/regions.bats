# SPDX-License-Identifier: GPL-3.0-or-later
# Several regions in one surface: octree-mesh fills each, or refuses walls and says how to
# get the outer surface.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    [ -x "${TM_BUILD:?}/bin/octree-mesh" ] || skip "there is no p4est"
}

# boxes N FORMAT [each]: N x N x N unit cubes with all walls between them, once, or with
# `each` as a skin of each cube; faces turn as chance has it, or outward for `each`. FORMAT
# is off, poly, smesh, stl or stream; poly has a region in each cube.
boxes() {
    python3 - "$@" <<'END'
import itertools, random, sys
n, form, each = int(sys.argv[1]), sys.argv[2], len(sys.argv) > 3
random.seed(n)
number, quads = {}, []

def node(p):
    return number.setdefault(p, len(number))

def quad(k, at):
    u, w = (k + 1) % 3, (k + 2) % 3
    def corner(i, j):
        c = list(at)
        c[u] += i
        c[w] += j
        return node(tuple(c))
    return [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]

cells = list(itertools.product(range(n), repeat=3))
for c in cells:
    for k in range(3):
        up = list(c)
        up[k] += 1
        if each:
            quads += [quad(k, c)[::-1], quad(k, up)]
            continue
        quads += [quad(k, up)] + ([quad(k, c)] if c[k] == 0 else [])
if not each:
    quads = [q[::random.choice((1, -1))] for q in quads]
xyz = list(number)

def triangles():
    for q in quads:
        m = q.index(min(q)) # both sides of a wall have the same diagonal
        q = q[m:] + q[:m]
        yield q[0], q[1], q[2]
        yield q[0], q[2], q[3]

def rows(of):
    return ''.join(' '.join(map(str, r)) + '\n' for r in of)

if form == 'off':
    print('OFF\n%d %d 0' % (len(xyz), len(quads)))
    print(rows(xyz) + rows([len(q)] + q for q in quads), end='')
elif form == 'stl':
    print('solid s')
    for t in triangles():
        print('facet normal 0 0 0\nouter loop')
        print(rows(('vertex',) + xyz[v] for v in t) + 'endloop\nendfacet')
    print('endsolid s')
elif form == 'stream':
    t = list(triangles())
    print('termesh 1\n.node\n%d 3 0 0' % len(xyz))
    print(rows((v + 1,) + p for v, p in enumerate(xyz)), end='.face\n')
    print('%d 0' % len(t))
    print(rows((i + 1,) + tuple(v + 1 for v in c) for i, c in enumerate(t)), end='.end\n')
else:
    print('%d 3 0 0' % len(xyz))
    print(rows((v + 1,) + p for v, p in enumerate(xyz)), end='')
    print(len(quads), 0)
    for q in quads:
        print('1\n' * (form == 'poly') + rows([[4] + [v + 1 for v in q]]), end='')
    print('0\n%d' % len(cells))
    print(rows((i + 1, c[0] + .5, c[1] + .5, c[2] + .5, i + 1, -1) for i, c in enumerate(cells)), end='')
END
}

volume() {
    mesh-check --json - "$1" | python3 -c 'import json, sys; print("%.9g" % json.load(sys.stdin)["volume"])'
}

# volumes FILE: of each region, in order.
volumes() {
    python3 - "$1" <<'END'
import sys
from collections import Counter
face_of = {4: ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)),
           5: ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
           6: ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
           8: ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1),
               (4, 5, 6, 7))}
xyz, volume, block = {}, Counter(), None
for line in open(sys.argv[1]):
    w = line.split()
    if line[0] == '#' or w == ['termesh', '1']:
        continue
    if w[0].lstrip('surface').startswith('.'):
        block, first = w[0], True
    elif first:
        first = False
    elif block == '.node':
        xyz[int(w[0])] = [float(c) for c in w[1:4]]
    elif block == '.mix':
        k = int(w[1])
        node = [int(n) for n in w[2:2 + k]]
        for corners in face_of[k]:
            p = [xyz[node[c]] for c in corners]
            m = [sum(c) / len(p) for c in zip(*p)]
            for a, b in zip(p, p[1:] + p[:1]):
                volume[int(w[2 + k])] += (a[0] * (b[1] * m[2] - b[2] * m[1])
                    + a[1] * (b[2] * m[0] - b[0] * m[2])
                    + a[2] * (b[0] * m[1] - b[1] * m[0])) / 6
for region, v in sorted(volume.items()):
    print(region, '%.9g' % v)
END
}

@test "walls between regions: each is filled, to its volume" {
    for n in 2 3; do
        for boxes in "off" "off each" "poly" "smesh" "stl" "stl each" "stream"; do
            # shellcheck disable=SC2086 # words
            boxes "$n" $boxes >surface.in
            octree-mesh -q -s 3 -o mesh.tm surface.in
            run -0 mesh-check -q mesh.tm
            run -0 jens-stats --fail-below 0.3 mesh.tm
            # numbers from 1, or those of the file, and all of them 1
            volumes mesh.tm | diff - <(for i in $(seq $((n * n * n))); do echo "$i 1"; done)
        done
    done
}

# sharp NAME [TURN]: regions that end at angles well below 90 degrees, as OFF, turned about
# two axes by so much: tetrahedron (four, around its centre), wedges (a box cut along both
# diagonals of its base), corner (cut off a cube).
sharp() {
    python3 - "$@" <<'END'
import itertools, math, sys
name, turn = sys.argv[1], float((sys.argv + ['0'])[2])
cube = [(i & 1, i >> 1 & 1, i >> 2) for i in range(8)]
if name == 'tetrahedron':
    xyz = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1), (0, 0, 0)]
    faces = list(itertools.combinations(range(4), 3))
    faces += [(a, b, 4) for a, b in itertools.combinations(range(4), 2)]
elif name == 'wedges':
    xyz = cube + [(.5, .5, 0), (.5, .5, 1)]
    base = ((0, 1), (1, 3), (3, 2), (2, 0))
    faces = [(a, b, 8) for a, b in base] + [(a + 4, b + 4, 9) for a, b in base]
    faces += [(a, b, b + 4, a + 4) for a, b in base] + [(a, 8, 9, a + 4) for a in range(4)]
else:
    xyz = cube + [(.4, 0, 0), (0, .4, 0), (0, 0, .4)]
    faces = [(8, 9, 10), (0, 8, 9), (0, 9, 10), (0, 8, 10), (8, 1, 3, 2, 9),
             (8, 1, 5, 4, 10), (9, 2, 6, 4, 10), (1, 3, 7, 5), (2, 6, 7, 3), (4, 5, 7, 6)]

def turned(p, a, b, by):
    p = list(p)
    c, s = math.cos(by), math.sin(by)
    p[a], p[b] = c * p[a] - s * p[b], s * p[a] + c * p[b]
    return p

print('OFF\n%d %d 0' % (len(xyz), len(faces)))
for p in xyz:
    print('%.17g %.17g %.17g' % tuple(turned(turned(p, 0, 1, turn), 1, 2, 1.6 * turn)))
for f in faces:
    print(len(f), *f)
END
}

@test "regions that end at sharp angles are filled to their volumes, in one piece, on their walls" {
    # the volume of each region, or of the smaller one
    while read -r name volume; do
        for turn in 0 0.37; do
            sharp "$name" "$turn" >surface.off
            octree-mesh -q -s 4 --json report -o mesh.tm surface.off
            run -0 mesh-check -q mesh.tm
            run -0 jens-stats --fail-below 0.05 mesh.tm
            python3 -c 'import json
report = json.load(open("report"))
assert not any(report[k] for k in ("lost_corners", "lost_edges", "lost_regions"))
assert report["held_back"] < 5'
            volumes mesh.tm | sort -g -k 2 | awk -v v="$volume" '
                { if (NR == 1 || v > 0.1) d = ($2 - v) / v; if (d * d > 1e-6) exit 1 }'
        done
    done <<'END'
tetrahedron 0.666666666667
wedges 0.25
corner 0.0106666666667
END
}

@test "reports where regions touch: of the outer boundary, and walls are no surface that is missed" {
    sharp wedges >surface.off
    octree-mesh -q -s 4 --json mesh.json -o mesh.tm surface.off
    run -0 octree-repair -q --json repair.json -o repaired.tm mesh.tm
    python3 - <<'END'
import json
mesh, repair = json.load(open("mesh.json")), json.load(open("repair.json"))
assert (mesh["components"], mesh["euler"], mesh["regions"]) == (1, 2, 4)
for state in (repair["before"], repair["after"]):
    assert (state["components"], state["euler"]) == (1, 2)
    for key in ("to_surface", "from_surface", "to_sharp", "from_sharp"):
        assert 0 <= state[key] < 1e-9, (key, state[key])
END
}

# touching WHICH: two solids of STL side by side whose common faces have different
# diagonals, or one a node more, or are of different height.
touching() {
    python3 - "$1" <<'END'
import sys
sides = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]

def solid(low, high=1, turned=False, split=False):
    xyz = [(low + (i & 1), i >> 1 & 1, high * (i >> 2)) for i in range(8)]
    xyz.append((low, .5, high / 2))
    for i, q in enumerate(sides):
        if i == 0 and turned:
            q = q[1:] + q[:1]
        cut = [(q[0], q[1], q[2]), (q[0], q[2], q[3])]
        if i == 0 and split:
            cut = [(a, b, 8) for a, b in zip(q, q[1:] + q[:1])]
        for t in cut:
            print('facet normal 0 0 0\nouter loop')
            for v in t:
                print('vertex', *xyz[v])
            print('endloop\nendfacet')

print('solid s')
solid(0)
solid(1, **{'diagonals': dict(turned=True), 'node': dict(split=True),
            'height': dict(high=.5)}[sys.argv[1]])
print('endsolid s')
END
}

@test "solids whose common faces do not have the same triangles: what is said helps" {
    for which in diagonals node height; do
        touching "$which" >surface.stl
        run -3 --separate-stderr octree-mesh -s 3 surface.stl
        [ "$output" = "" ]
        [[ "$stderr" == *"overlap"*"where solids touch, both need the same triangles on all of their common face"* ||
            "$stderr" == *"meet near (1, "*"in one plane: where solids touch, both need the same triangles"* ]]
    done
}

@test "walls are refused with --lenient and --cavities, and what is said gives the outer surface" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    for boxes in "off" "off each" "poly" "stl each"; do
        # shellcheck disable=SC2086 # words
        boxes 2 $boxes >surface.in
        for option in --cavities --lenient; do
            run -3 --separate-stderr octree-mesh "$option" surface.in
            [ "$output" = "" ]
            [[ "$stderr" == "octree-mesh: surface.in: the surface has walls inside, between several regions: "*"'tetgen-mesh FILE | off-export'"* ]]
        done
        tetgen-mesh --quiet surface.in | off-export >outer.off
        octree-mesh -s 3 -o mesh.tm outer.off
        mesh-check -q mesh.tm
        [ "$(volume mesh.tm)" = 8 ]
    done
}

@test "holes and numbers of .poly where walls meet" {
    # cells 1 to 27, of which the middle one is a hole, one has a number, the others the next
    boxes 3 poly >all.poly
    { sed '/^0$/,$d' all.poly && printf '%s\n' 1 '1 1.5 1.5 1.5' 1 '1 2.5 0.5 0.5 40 -1'; } >hole.poly
    octree-mesh -q -s 3 -o mesh.tm hole.poly
    run -0 mesh-check -q mesh.tm
    volumes mesh.tm | diff - <(for i in $(seq 40 65); do echo "$i 1"; done)
    sed 's/^1 1.5 1.5 1.5/1 0.5 1.5 1.5/' hole.poly >outer.poly
    run -3 --separate-stderr octree-mesh -s 3 outer.poly
    [[ "$stderr" == *"walls inside the surface: there is no region on either side of facet "* ]]
    sed 's/^1 2.5 0.5 0.5/1 7 0.5 0.5/' hole.poly >outside.poly
    run -3 --separate-stderr octree-mesh -s 3 outside.poly
    [[ "$stderr" == *"region 1, at (7, 0.5, 0.5), is outside" ]]
}

@test "a wall that does not close a region in is refused" {
    # a ring of eight cubes with one wall across it
    python3 - >ring.off <<'END'
number, quads = {}, []
has = lambda c: c[2] == 0 and 0 <= c[0] < 3 and 0 <= c[1] < 3 and c != (1, 1, 0)
for x in range(4):
    for y in range(4):
        for z in range(2):
            for k in range(3):
                c, below = (x, y, z), tuple(v - (i == k) for i, v in enumerate((x, y, z)))
                if has(c) == has(below) and (k, c) != (0, (1, 0, 0)):
                    continue
                q = []
                for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    p = list(c)
                    p[(k + 1) % 3] += i
                    p[(k + 2) % 3] += j
                    q.append(number.setdefault(tuple(p), len(number)))
                quads.append(q)
print('OFF\n%d %d 0' % (len(number), len(quads)))
for p in number:
    print(*p)
for q in quads:
    print(4, *q)
END
    run -3 --separate-stderr octree-mesh -s 3 ring.off
    [[ "$stderr" == *"walls inside the surface: the same region is on both sides of facet "* ]]
}

# A cube in a cube, in .poly: nested REGIONS…, points on the diagonal.
nested() {
    python3 - "$@" <<'END'
import sys
v, faces = [], []
for lo, hi in ((0, 3), (1, 2)):
    b = len(v)
    v += [(x, y, z) for z in (lo, hi) for y in (lo, hi) for x in (lo, hi)]
    faces += [[i + b for i in q] for q in [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4),
                                           (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]]
print(len(v), 3, 0, 0)
for i, x in enumerate(v):
    print(i + 1, *x)
print(len(faces), 0)
for q in faces:
    print('1\n4', *[i + 1 for i in q])
print('0\n%d' % len(sys.argv[1:]))
for i, p in enumerate(sys.argv[1:]):
    print(i + 1, p, p, p, i + 1, -1)
END
}

@test "regions of .poly: each has its number, with --cavities only those outside of holes" {
    regions() {
        rows .mix "$1" | awk '{ print $NF }' | sort -nu | paste -sd ' '
    }
    nested 0.5 1.5 >filled.poly
    octree-mesh -q -s 3 -o mesh.tm filled.poly
    [ "$(volume mesh.tm)" = 27 ]
    [ "$(regions mesh.tm)" = "1 2" ]
    run -3 --separate-stderr octree-mesh -s 3 --cavities filled.poly
    [ "$output" = "" ]
    [[ "$stderr" == *"octree-mesh: filled.poly: region 2, at (1.5, 1.5, 1.5), is outside, or in a cavity that is left empty" ]]
    nested 7 >outside.poly
    run -3 --separate-stderr octree-mesh -s 3 outside.poly
    [[ "$stderr" == *"region 1, at (7, 7, 7), is outside" ]]
    # who has no number gets the next one
    nested 0.5 >one.poly
    octree-mesh -q -s 3 -o mesh.tm one.poly
    [ "$(regions mesh.tm)" = "1 2" ]
    nested 1.5 | sed '$s/1 -1$/5 -1/' >inner.poly
    octree-mesh -q -s 3 -o mesh.tm inner.poly
    [ "$(regions mesh.tm)" = "5 6" ]
    octree-mesh -q -s 3 --cavities -o mesh.tm one.poly
    [ "$(volume mesh.tm)" = 26 ]
    nested 0.5 2.5 >two.poly
    run -0 --separate-stderr octree-mesh -s 3 -o mesh.tm two.poly
    [[ "$stderr" == *"octree-mesh: two.poly: 1 regions that are in one with another before: left out"* ]]
    run -3 octree-mesh -s 3 --strict -o strict.tm two.poly
    [ ! -e strict.tm ]
}

@test "holes of .poly stay holes" {
    nested 0.5 | awk '$1 == 0 && NF == 1 && !done { print 1; print 1, 1.5, 1.5, 1.5; done = 1
        next } { print }' >hole.poly
    octree-mesh -s 3 -o mesh.tm hole.poly 2>message
    [ "$(volume mesh.tm)" = 26 ]
    run ! grep 'not in the mesh' message
    # one that would take the outermost region away is refused
    sed 's/^1 1.5 1.5 1.5$/1 0.5 0.5 0.5/' hole.poly >outer.poly
    run -3 --separate-stderr octree-mesh -s 3 outer.poly
    [[ "$stderr" == *"hole 1, at (0.5, 0.5, 0.5), is in a region that is outermost, or within two others: that cannot be left empty" ]]
}

@test "tetgen-mesh: of faces in one place the first is taken" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    boxes 2 stl each >each.stl
    run -0 --separate-stderr tetgen-mesh -o mesh.tm each.stl
    [ "${stderr_lines[-1]}" = \
        "tetgen-mesh: faces in the place of an earlier one, which are dropped: 24" ]
    mesh-check -q mesh.tm
    [ "$(volume mesh.tm)" = 8 ]
    surface cube off >cube.off
    tetgen-mesh --no-history cube.off >expected
    awk 'NR == 2 { $2 += 12 } { print } NR > 10 { print 3, $4, $2, $3 }' cube.off >twice.off
    tetgen-mesh --no-history --quiet twice.off | cmp - expected
}
