# SPDX-License-Identifier: GPL-3.0-or-later
# getfem-export: read by the grammar of GetFEM's files, mapped by the shape functions of its
# reference elements, faces by how it numbers them.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    # getfem.py FILE EXPRESSION: prints it, of points, convexes (name, nodes), regions and
    # jacobians, those of each convex at the middle and the volume by its shape functions.
    cat >getfem.py <<'END'
import re, sys
from itertools import product

words = re.sub('%.*', '', open(sys.argv[1]).read()).replace('/', ' / ').split()
at = 0

def take(*expected):
    global at
    word = words[at] if at < len(words) else None
    assert not expected or word in expected, (at, word, expected)
    at += 1
    return word

for word in 'BEGIN POINTS LIST POINT COUNT'.split():
    take(word)
count, points = int(take()), []
while take('POINT', 'END') == 'POINT':
    assert int(take()) == len(points)
    points.append([float(take()) for _ in range(3)])
for word in 'POINTS LIST BEGIN MESH STRUCTURE DESCRIPTION CONVEX COUNT'.split():
    take(word)
assert count == len(points)
size = {"'GT_PK(2,1)'": 3, "'GT_PK(3,1)'": 4, "'GT_PYRAMID(1)'": 5, "'GT_PRISM(3,1)'": 6,
        "'GT_QK(3,1)'": 8}
count, convexes = int(take()), []
while take('CONVEX', 'END') == 'CONVEX':
    assert int(take()) == len(convexes)
    name = take(*size)
    convexes.append((name[1:-1], [int(take()) for _ in range(size[name])]))
for word in 'MESH STRUCTURE DESCRIPTION'.split():
    take(word)
assert count == len(convexes)

# Faces by numbers of nodes; those of a simplex are opposite to each node.
faces = {'GT_PK(3,1)': [(1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2)],
         'GT_PYRAMID(1)': [(0, 1, 2, 3), (0, 1, 4), (1, 3, 4), (3, 2, 4), (2, 0, 4)],
         'GT_PRISM(3,1)': [(1, 2, 4, 5), (0, 2, 3, 5), (0, 1, 3, 4), (3, 4, 5), (0, 1, 2)],
         'GT_QK(3,1)': [(1, 3, 5, 7), (0, 2, 4, 6), (2, 3, 6, 7), (0, 1, 4, 5),
                        (4, 5, 6, 7), (0, 1, 2, 3)]}
regions = {}
while at < len(words):
    take('BEGIN'), take('REGION')
    region, members = take(), []
    while words[at] != 'END':
        c = int(take())
        if words[at] == '/':
            take()
            name, nodes = convexes[c]
            c = frozenset(nodes[i] for i in faces[name][int(take())])
        members.append(c)
    take('END'), take('REGION'), take(region)
    regions[int(region)] = members

# Shape functions of the reference elements, and points of a rule that is exact for them.
pk = lambda x, y, z: [1 - x - y - z, x, y, z]
qk = lambda x, y, z: [(x if i else 1 - x) * (y if j else 1 - y) * (z if k else 1 - z)
                      for k, j, i in product((0, 1), repeat=3)]
prism = lambda x, y, z: [t * f for f in (1 - z, z) for t in (1 - x - y, x, y)]
pyramid = lambda x, y, z: [f / 4 for f in (
    (1 - x - z) * (1 - y - z) / (1 - z), (1 + x - z) * (1 - y - z) / (1 - z),
    (1 - x - z) * (1 + y - z) / (1 - z), (1 + x - z) * (1 + y - z) / (1 - z), 4 * z)]
g = [0.5 - 3 ** -0.5 / 2, 0.5 + 3 ** -0.5 / 2]
rules = {'GT_PK(3,1)': (pk, [(0.25, 0.25, 0.25)], 1 / 6),
         'GT_QK(3,1)': (qk, list(product(g, repeat=3)), 1 / 8),
         'GT_PRISM(3,1)': (prism, [(1 / 3, 1 / 3, z) for z in g], 1 / 4),
         'GT_PYRAMID(1)': (pyramid, [(0, 0, 0.25)], 4 / 3)}

def jacobian(shape, p, nodes):
    h, columns = 1e-5, []
    for axis in range(3):
        a, b = list(p), list(p)
        a[axis] -= h
        b[axis] += h
        low, high = shape(*a), shape(*b)
        columns.append([sum((u - v) / (2 * h) * points[n][i]
                            for u, v, n in zip(high, low, nodes)) for i in range(3)])
    (a, b, c), (d, e, f), (p, q, r) = columns
    return a * (e * r - f * q) + b * (f * p - d * r) + c * (d * q - e * p)

def volume(convex):
    shape, places, weight = rules[convex[0]]
    values = [jacobian(shape, p, convex[1]) for p in places]
    assert min(values) > 0, (convex, values)
    return sum(values) * weight

print(eval(sys.argv[2]))
END
}

getfem() {
    python3 getfem.py "$@"
}

@test "mixed elements have their volumes in GetFEM's reference elements" {
    mixed >mixed.tm
    getfem-export mixed.tm >mixed.getfem
    [ "$(getfem mixed.getfem '[round(12 * volume(c), 6) for c in convexes]')" = \
        '[12.0, 4.0, 6.0, 1.0]' ]
    [ "$(getfem mixed.getfem '[c[0] for c in convexes]')" = \
        "['GT_QK(3,1)', 'GT_PYRAMID(1)', 'GT_PRISM(3,1)', 'GT_PK(3,1)']" ]
    [ "$(getfem mixed.getfem 'regions')" = \
        '{1000001: [0, 1], 1000002: [2], 1000003: [3]}' ]
}

@test "tetrahedra: volumes, points, regions of the inside and of the boundary" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    two_boxes >two.poly
    tetgen-mesh -q --switches A two.poly >two.tm
    getfem-export -j 3 two.tm >two.getfem
    getfem-export two.tm | cmp - two.getfem
    [ "$(getfem two.getfem 'round(sum(map(volume, convexes)), 6)')" = 2.0 ]
    [ "$(getfem two.getfem 'sorted(regions)')" = \
        '[11, 12, 13, 14, 15, 16, 20, 1000003, 1000007]' ]
    # the region of a marker is the triangles of .face that have it
    getfem two.getfem "'\\n'.join('%d %d %d %d' % (*sorted(f), m) for m in range(30)
        for f in regions.get(m, []))" | sort >faces
    rows .face two.tm | python3 -c "import sys
base = int(open('two.tm').read().split('.node\\n')[1].split('\\n')[1].split()[0])
for line in sys.stdin:
    i, *v, m = map(int, line.split())
    print(*sorted(n - base for n in v), m)" | sort >expected
    cmp faces expected
    getfem two.getfem "'\\n'.join('%.17g %.17g %.17g' % tuple(p) for p in points)" >points
    rows .node two.tm | awk '{ printf "%.17g %.17g %.17g\n", $2, $3, $4 }' | cmp - points
}

@test "triangles on mixed elements are faces of the right number" {
    { mixed | sed '$d'; printf '%s\n' .face '8 1' '1 7 8 9 31' '2 5 9 6 32' '3 5 8 9 33' \
        '4 2 3 10 34' '5 6 11 7 35' '6 9 12 7 36' '7 6 7 9 37' '8 1 2 3 38' .end; } >mixed.tm
    getfem-export mixed.tm >mixed.getfem
    # 8 is no face, 7 that between pyramid and tetrahedron
    [ "$(getfem mixed.getfem "[(m, sorted(n + 1 for f in r for n in f))
        for m, r in regions.items() if m < 1000]")" = '[(31, [7, 8, 9]), (32, [5, 6, 9]), '\
'(33, [5, 8, 9]), (34, [2, 3, 10]), (35, [6, 7, 11]), (36, [7, 9, 12]), (37, [6, 7, 9])]' ]
}

@test "a surface" {
    surface sphere mdl | mdl-import | getfem-export >sphere.getfem
    [ "$(getfem sphere.getfem '{c[0] for c in convexes}, regions')" = \
        "({'GT_PK(2,1)'}, {})" ]
}

@test "what GetFEM does not take: exit 3" {
    cubes >cubes.tm
    run -3 --separate-stderr getfem-export -o out cubes.tm
    [[ "$stderr" == 'getfem-export: cubes.tm: holds polyhedra (.cell), but '* ]]
    mixed | sed 's/^12 1 0.5 2/12 0 0 0/' >twice.tm
    run -3 --separate-stderr getfem-export -o out twice.tm
    [ "$stderr" = 'getfem-export: twice.tm: .node: nodes 1 and 12 are in the same place, '\
'which GetFEM does not allow' ]
    mixed | sed 's/^4 4 6 7 9 12 3/4 4 6 7 9 12 1000000/' >large.tm
    run -3 --separate-stderr getfem-export -o out large.tm
    [ "$stderr" = 'getfem-export: large.tm: an attribute is too large for the number of a '\
'region (below 1000000)' ]
    [ ! -e out ]
}
