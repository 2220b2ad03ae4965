# SPDX-License-Identifier: GPL-3.0-or-later
# oct-export and oct-import: restart files of the octree mesher, against files that are
# made here with the octree's lattice, edges and triangles found in another way.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    cat >octree.py <<'END'
import random, sys
from itertools import product

def read(name):
    """A restart file with all numbers of points replaced by the points: octants with
    corners, level and triangles; edges with their middles; the elements of octants."""
    words = open(name).read().split()
    at = iter(words)
    take = lambda n, kind=int: [kind(next(at)) for _ in range(n)]
    points, edges, octants = take(3)
    p = [tuple(round(c, 6) for c in take(3, float)) for _ in range(points)]
    e = set()
    for _ in range(edges):
        a, b, m = take(3)
        assert a < b
        e.add((frozenset((p[a], p[b])), p[m] if m else None))
    assert len(e) == edges
    o = []
    for _ in range(octants):
        row = take(10)
        assert row[0] == 8
        k = take(1)[0]
        o.append(([p[i] for i in row[1:9]], row[9], take(k)))
    assert take(2, str) == ['Geometric', 'Transform'] and take(6, float)[3:] == [0] * 3
    return o, e, take(octants), list(at)

def inside(polygon, low, high):
    """The part of a polygon in a closed box, by cutting it along the box's planes."""
    for axis, bound, sign in [(a, b[a], s) for a in range(3)
                              for b, s in ((low, 1), (high, -1))]:
        depth = [sign * (v[axis] - bound) for v in polygon]
        cut = []
        for i, v in enumerate(polygon):
            if depth[i - 1] * depth[i] < 0:
                t = depth[i - 1] / (depth[i - 1] - depth[i])
                cut.append([a + t * (b - a) for a, b in zip(polygon[i - 1], v)])
            if depth[i] >= 0:
                cut.append(v)
        polygon = cut
    return polygon

class Octree:
    """A brick of 2 by 1 by 1 cubes of side 4, split at random, balanced over edges."""
    low, side, finest = (-1, 0.5, 2), 4, 4

    def __init__(self, seed):
        random.seed(seed)
        leaves = {(0, 0, 0, 0), (0, 16, 0, 0)}
        for _ in range(25):
            level, *anchor = random.choice(sorted(leaves))
            self.split(leaves, level, anchor)
        self.leaves = sorted(leaves, key=lambda leaf: leaf[1:])
        self.triangles = [[[random.uniform(-2, 8) for _ in range(3)] for _ in range(3)]
                          for _ in range(12)]
        # one with corners on the lattice and one along its planes
        self.triangles += [[self.xyz(q) for q in t] for t in (
            ((8, 0, 0), (8, 16, 0), (8, 0, 16)), ((16, 8, 8), (16, 8, 8), (24, 8, 8)))]
        self.elements = [random.choice((1, 1, 0, 2)) for _ in self.leaves]

    def size(self, level):
        return 1 << (self.finest - level)

    def split(self, leaves, level, anchor):
        if level == self.finest:
            return
        for other in sorted(leaves):
            size, big = self.size(level), self.size(other[0])
            gap = [max(a - b - big, b - a - size) for a, b in zip(anchor, other[1:])]
            if other[0] < level and max(gap) <= 0 and sum(g == 0 for g in gap) < 3 and \
                    other in leaves:
                self.split(leaves, other[0], other[1:])
        leaves.discard((level, *anchor))
        half = self.size(level + 1)
        for bits in product((0, 1), repeat=3):
            leaves.add((level + 1, *(a + b * half for a, b in zip(anchor, bits))))

    def xyz(self, q):
        return tuple(l + self.side / 16 * c for l, c in zip(self.low, q))

    def corners(self, leaf):
        order = ((0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0),
                 (0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0))
        return [tuple(a + self.size(leaf[0]) * b for a, b in zip(leaf[1:], bits))
                for bits in order]

    def meeting(self, leaf):
        q = self.corners(leaf)
        return [i for i, t in enumerate(self.triangles)
                if inside(t, self.xyz(q[0]), self.xyz(q[6]))]

    def write(self, name, other_version, extra='', ids=None):
        corners = [self.corners(leaf) for leaf in self.leaves]
        points = sorted({q for c in corners for q in c}, key=lambda q: (q[2], q[1], q[0]))
        number = {q: i for i, q in enumerate(points)}
        edges = {}
        for c in corners:
            for a, b in product(c, c):
                along = [y - x for x, y in zip(a, b)]
                if number[a] < number[b] and sum(d != 0 for d in along) == 1:
                    middle = tuple((x + y) / 2 for x, y in zip(a, b))
                    edges[number[a], number[b]] = number.get(middle, 0)
        with open(name, 'w') as f:
            count = [len(points), len(edges), len(corners)]
            if other_version:
                count.append(sum(self.elements))
            print(*count, '\n', file=f)
            for q in points:
                print(*('%+1.8E' % c for c in self.xyz(q)), sep='  ', file=f)
            print(file=f)
            for (a, b), m in sorted(edges.items()):
                print(a, b, m, file=f)
            print(file=f)
            if other_version:
                print(*self.elements, '\n', file=f)
            for i, (leaf, c) in enumerate(zip(self.leaves, corners)):
                print(8, *(number[q] for q in c), leaf[0], *(ids[i:i + 1] if ids else []), file=f)
                meeting = self.meeting(leaf)
                print(len(meeting), *meeting, file=f)
            print('\nGeometric Transform\n0.0 1.0 0.000000\n0.0 0 %s' % (extra or 0), file=f)
            if not other_version:
                print(file=f)
                print(*self.elements, file=f)

    def write_others(self, name):
        with open(name + '.m3d', 'w') as f:
            print('[Nodes, ARRAY1<STRING>]\n4\n\n1 0 0 0\n1 1 0 0\n1 0 1 0\n1 0 0 1\n', file=f)
            print('[Elements, ARRAY1<STRING>]\n%d\n' % sum(self.elements), file=f)
            for _ in range(sum(self.elements)):
                print('T 0 1 2 3 1000.0 0.45 1.0', file=f)
        with open(name + '.off', 'w') as f:
            print('OFF\n%d %d 0' % (3 * len(self.triangles), len(self.triangles)), file=f)
            for t in self.triangles:
                for q in t:
                    print(*map(repr, q), file=f)
            for i in range(len(self.triangles)):
                print(3, 3 * i, 3 * i + 1, 3 * i + 2, file=f)
END
}

make_octree() {
    python3 -c "from octree import *
o = Octree($1)
o.write('a.oct', False)
o.write('b.oct', True)
o.write_others('a')"
}

@test "what oct-import reads oct-export writes, of both versions" {
    for seed in 1 2 3; do
        make_octree "$seed"
        oct-import -m a.m3d --surface a.off a.oct >a.tm
        oct-export -j 3 -o again.oct a.tm
        oct-export a.tm | cmp - again.oct
        python3 -c "from octree import *
a, b = read('a.oct'), read('again.oct')
assert a[0] == b[0], [(x, y) for x, y in zip(a[0], b[0]) if x != y][:3]
assert a == b
assert b[3] == []"
        oct-import --no-history -m a.m3d -s a.off b.oct | cmp - <(sed '/^# /d' a.tm)
        sed 's/$/\r/' a.oct | oct-import --no-history -m a.m3d -s a.off |
            cmp - <(sed '/^# /d' a.tm)
    done
}

@test "materials of the elements are left out, as m3d-import says it" {
    make_octree 1
    sed '0,/^\([TPRH] .*\) 0\.45 /s//\1 0.3 /' a.m3d >soft.m3d
    run -1 cmp -s a.m3d soft.m3d
    run -0 --separate-stderr oct-import --no-history -m soft.m3d -o soft.tm a.oct
    [ "$stderr" = 'oct-import: a.oct: the constants of the material of 1 elements, which are others than 1000.0 0.45 1.0: left out' ]
    oct-import --no-history -m a.m3d a.oct | cmp - soft.tm
    run -3 oct-import --strict -m soft.m3d -o strict.tm a.oct
    [ ! -e strict.tm ]
}

@test "ids: kept as the attribute of .octant, in a file with --ids" {
    make_octree 9
    python3 -c "from octree import *
o = Octree(9)
ids = random.sample(range(4294967295), len(o.leaves))
o.write('a.ids', False, ids=ids)
o.write('b.ids', True, ids=ids)
print(*ids, sep='\n')" >ids
    oct-import -m a.m3d -s a.off a.oct >plain.tm
    for version in a b; do
        oct-import --no-history -m a.m3d -s a.off $version.ids >$version.tm
        [ "$(header .octant $version.tm)" = "$(wc -l <ids) 1" ]
        rows .octant $version.tm | awk '{ print $8 }' | diff - ids
        rows .octant $version.tm | sed 's/ [0-9]*$//' | diff - <(rows .octant plain.tm)
    done
    oct-export plain.tm >plain.oct
    oct-export a.tm | cmp - plain.oct
    oct-export --ids -j 3 a.tm >again.ids
    awk '/^8 / && NF == 11 { print $11; sub(/ [0-9]*$/, "") } { print >"stripped" }' again.ids |
        diff - ids
    cmp stripped plain.oct
    # where there are none an octant's id is its number from 0
    oct-export --ids plain.tm | awk '/^8 / && NF == 11 { print $11 }' |
        diff - <(seq 0 "$(($(wc -l <ids) - 1))")
}

@test "wrong ids: exit 3" {
    make_octree 9
    python3 -c "from octree import *
o = Octree(9)
o.write('a.ids', False, ids=list(range(10, len(o.leaves) + 10)))"
    run -3 --separate-stderr oct-import -o out.tm <(sed '/^8 .* 14$/s/14$/12/' a.ids)
    [[ "$stderr" == *": octants 2 and 4 both have the id 12" ]]
    run -3 --separate-stderr oct-import -o out.tm <(sed '/^8 .* 14$/s/ 14$//' a.ids)
    [[ "$stderr" == *": octant 4 has no id, but those before it have one" ]]
    run -3 --separate-stderr oct-import -o out.tm <(sed '/^8 .* 14$/s/14$/4294967295/' a.ids)
    [[ "$stderr" == *"the id of an octant: 4294967295 is out of range"* ]]
    run -3 --separate-stderr oct-import -o out.tm <(sed '/^8 .* 14$/s/14$/& 0/' a.ids)
    [[ "$stderr" == *"'0' follows the id of the octant"* ]]
    oct-import -m a.m3d -s a.off a.ids >a.tm
    for id in 0.5 -1 4294967295; do
        sed "/^\.octant/,/^\.root/s/ 14\$/ $id/" a.tm >wrong.tm
        run -3 --separate-stderr oct-export --ids -o out.oct wrong.tm
        [[ "$stderr" == *": .octant: row 4: "*" is no id of an octant"* ]]
        oct-export -o without.oct wrong.tm
    done
    sed '/^\.octant/,/^\.root/s/ 14$/ 12/' a.tm >wrong.tm
    run -3 --separate-stderr oct-export --ids -o out.oct wrong.tm
    [[ "$stderr" == *": .octant: octants 2 and 4 both have the id 12" ]]
    [ ! -e out.tm ] && [ ! -e out.oct ]
}

@test "octants and roots are where the file has them" {
    make_octree 4
    oct-import -m a.m3d a.oct >a.tm
    rows .root a.tm | diff - <(printf '%s\n' '0 -1 0.5 2 4 4' '1 3 0.5 2 4 4')
    python3 -c "from octree import *
o = Octree(4)
e = 0
for i, (leaf, k) in enumerate(zip(o.leaves, o.elements)):
    print(i, *leaf, e, e + k)
    e += k" | diff - <(rows .octant a.tm)
    [ -z "$(header surface.node a.tm)" ]
}

@test "without a mesh the octants are the elements" {
    make_octree 5
    oct-import a.oct >a.tm
    octants=$(header .octant a.tm | cut -d ' ' -f 1)
    [ "$(header .mix a.tm)" = "$octants 0" ]
    awk '$6 != $1 || $7 != $1 + 1 { exit 1 }' <(rows .octant a.tm)
    # their volume is that of the brick (x, y and z of the high corner are those of the
    # nodes 3, 4 and 1)
    { rows .node a.tm; echo; rows .mix a.tm; } | awk '
        NF == 0 { elements = 1; next }
        !elements { x[$1] = $2; y[$1] = $3; z[$1] = $4; next }
        { v += (x[$6] - x[$3]) * (y[$7] - y[$3]) * (z[$4] - z[$3])
          if ($2 != 8 || x[$6] <= x[$3]) exit 1 }
        END { exit !(v > 127.99999 && v < 128.00001) }'
}

@test "missing octants at the side of the brick: the lattice is found all the same" {
    make_octree 6
    # only the octants of level 2 and more with x > 1, and only their points
    python3 -c "from octree import *
o = Octree(6)
keep = [i for i, l in enumerate(o.leaves) if l[0] >= 2 and l[1] >= 8 and l[2] >= 4]
o.leaves = [o.leaves[i] for i in keep]
o.elements = [1 for i in keep]
o.write('part.oct', False)
print(len(keep), min(l[1] for l in o.leaves), min(l[2] for l in o.leaves),
      min(l[3] for l in o.leaves))
lowest = [min(l[i] for l in o.leaves) for i in (1, 2, 3)]
for i, l in enumerate(o.leaves):
    print(i, l[0], *(a - b for a, b in zip(l[1:], lowest)), i, i + 1, file=open('rows', 'a'))"
    oct-import part.oct >part.tm
    rows .octant part.tm | diff - rows
}

@test "what does not fit together: exit 3" {
    make_octree 7
    run -3 --separate-stderr oct-import -m a.m3d -o out.tm <(sed '$s/1/2/' a.oct)
    [[ "$stderr" == *" elements in its octants, but the mesh has "* ]]
    run -3 --separate-stderr oct-import -m a.m3d -o out.tm <(sed '$d' a.oct)
    [[ "$stderr" == *": the file ends where the number of elements in an octant should be" ]]
    python3 -c "from octree import *
Octree(7).write('turned.oct', False, 0.25)"
    run -3 --separate-stderr oct-import -o out.tm turned.oct
    [[ "$stderr" == *": the octree is turned by 0.25 "* ]]
    # a point that is moved by half a unit
    run -3 --separate-stderr oct-import -o out.tm <(sed '3s/-1.0/-1.1/' a.oct)
    [[ "$stderr" == *": octant "*" long, but octants of level "* ]]
    run -3 --separate-stderr oct-import -o out.tm <(head -n 40 a.oct)
    [[ "$stderr" == *": the file ends where "* ]]
    run -3 --separate-stderr oct-import -o out.tm <(echo 5 3 2 1 4)
    [[ "$stderr" == *":1: '4' follows the counts of the first line "* ]]
    run -4 --separate-stderr oct-import -m nowhere.m3d -o out.tm a.oct
    [[ "$stderr" == 'oct-import: nowhere.m3d: cannot open: '* ]]
    [ ! -e out.tm ]
}

@test "a stream that lacks what an .oct file has: exit 3, which block" {
    make_octree 8
    oct-import -m a.m3d -s a.off a.oct >a.tm
    oct-import -m a.m3d a.oct >bare.tm
    run -3 --separate-stderr oct-export -o out.oct bare.tm
    [ "$stderr" = 'oct-export: bare.tm: surface.node: has no rows in the stream (the nodes '\
'of the surface that octants meet)' ]
    mixed >mixed.tm
    run -3 --separate-stderr oct-export -o out.oct mixed.tm
    [[ "$stderr" == 'oct-export: mixed.tm: .octant: has no rows'* ]]
    # elements in another order than the octants; an octant twice; off its lattice
    awk '/^\.octant/ { octants = 1 } /^\.root/ { octants = 0 }
        octants && NF == 7 && $6 < $7 && ++n == 2 { $6 = $6 - 1; $7 = $7 - 1 } { print }' \
        a.tm >order.tm
    run -3 --separate-stderr oct-export -o out.oct order.tm
    [[ "$stderr" == *": .octant: row "*": its elements begin at "* ]]
    awk '/^\.octant/ { octants = 1 } octants && $1 == 1 && NF == 7 { $0 = "1" last $6 " " $7 }
        octants && $1 == 0 { last = " " $2 " " $3 " " $4 " " $5 " " } { print }' a.tm >twice.tm
    run -3 --separate-stderr oct-export -o out.oct twice.tm
    [[ "$stderr" == *": .octant: octants 0 and 1 overlap" ]]
    awk '/^\.octant/ { octants = 1 } octants && $1 == 0 && NF == 7 { $2 = 2; $3 = 1 } { print }' \
        a.tm >off.tm
    run -3 --separate-stderr oct-export -o out.oct off.tm
    [[ "$stderr" == *": .octant: row 0: 1 is no multiple of its side, 4" ]]
    [ ! -e out.oct ]
}
