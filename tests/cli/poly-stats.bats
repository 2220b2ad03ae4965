# SPDX-License-Identifier: GPL-3.0-or-later
# poly-stats: tables, JSON, figure, exit statuses.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

setup() {
    load helpers
    cd "$BATS_TEST_TMPDIR" || exit
    # Six tetrahedra made a unit cube, and a tetrahedron on top of one of its sides; node
    # 9 is inside of the cube, and no facet uses it.
    cat >two.tm <<'END'
termesh 1
# made by hand
.node
10 3 0 0
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
9 0.5 0.5 0.5
10 0.5 0.25 2
.facet
10 0
1 1 -1 4 1 4 3 2
2 1 -1 4 1 2 6 5
3 1 -1 4 2 3 7 6
4 1 -1 4 3 4 8 7
5 1 -1 4 4 1 5 8
6 1 2 3 5 6 7
7 1 -1 3 5 7 8
8 2 -1 3 5 6 10
9 2 -1 3 6 7 10
10 2 -1 3 7 5 10
.cell
2 1
1 7 1 2 3 4 5 6 7 12
2 4 6 8 9 10 1
.end
END
    printf 'termesh 1\n.node\n0 3 0 0\n.facet\n0 0\n.cell\n0 0\n.end\n' >none.tm
}

# Makes one polyhedron of the boxes with the same random number below $1, as they touch
# or not: joined NUMBER <boxes.
joined() {
    python3 -c '
import random, sys

random.seed(3)
lines = sys.stdin.read().splitlines()
def block(name):
    start = lines.index(name) + 2
    return start, start + int(lines[start - 1].split()[0])
first, end = block(".facet")
cells = block(".cell")
count = int(sys.argv[1])
label = [i if i < count else random.randrange(count) for i in range(cells[1] - cells[0])]
tets = [6 * label.count(c) for c in range(count)]
facets, faces = [], [[] for _ in range(count)]
for row in lines[first:end]:
    number, a, b, k, *nodes = map(int, row.split())
    a, b = label[a], label[b] if b >= 0 else -1
    if a != b:
        for c in (a, b):
            if c >= 0:
                faces[c].append(len(facets))
        facets.append([a, b, k] + nodes)
print("\n".join(lines[:first - 2]))
print(".facet\n%d 0" % len(facets))
for f, row in enumerate(facets):
    print(f, *row)
print(".cell\n%d 1" % count)
for c, f in enumerate(faces):
    print(c, len(f), *f, tets[c])
print(".end")' "$1"
}

@test "the tables of two known polyhedra" {
    run -0 --separate-stderr poly-stats two.tm
    [ "$stderr" = "" ]
    diff - <(echo "$output" | sed 's/^  *//; s/   */  /g') <<'END'
polyhedra  2
facets  10
edges  16
nodes  9
swallowed vertices  1
volume  1.166667

not simple  0
an edge without two facets  0
a vertex with more than one fan  0
boundary not connected  0
Euler's formula fails  0
not star-shaped  0

per polyhedron  mean  largest
facets  5.50  7
tetrahedra  6.50  12

of the tetrahedra  before  now  less, %
elements  13  2  84.62
nodes  10  9  10.00

smallest volume  0.1667
smallest facet  0.5
shortest edge  1
smallest dihedral angle  50.7060
largest dihedral angle  180.0000
largest diameter  1.732
centroids outside of the kernel  0
indicator for virtual elements  0.835

of each polyhedron  smallest  mean
shortest edge / diameter  0.5774  0.6422
radius of the kernel's ball / diameter  0.1542  0.2214
volume of the kernel / volume  1  1
depth of the centroid in it / diameter  0.1231  0.2059
rho 1: kernels  1  1
rho 2: sizes  0.4797  0.5462
rho 3: numbers of facets and edges  0.6964  0.8482

from the centroids of cells and facets
largest non-orthogonality  16.72
mean  16.72
facets above 70  0
facets above 90  0
largest skewness  0.500
facets above 4  0
smallest pyramid  0.04167
pyramids without volume  0
facets that are not all seen  0
facets that are seen as no fan  0
largest bend of a facet  0
volumes, 95 % to 5 %  6.00
smallest weight of a facet  0.3333
facets below 0.05  0
smallest ratio of volumes side by side  0.1667
facets below 0.01  0
smallest determinant of a cell  0.0000
cells below 0.001  2
cells concave by planes of facets  1

histogram of facets per polyhedron, %
4 to 5  50.00  ******************************
6 to 7  50.00  ******************************

histogram of tetrahedra per polyhedron, %
1  50.00  ******************************
2  0.00
3  0.00
4 to 5  0.00
6 to 7  0.00
8 to 11  0.00
12 to 15  50.00  ******************************

histogram of volume of the kernel / volume, %
0.0 to 0.1  0.00
0.1 to 0.2  0.00
0.2 to 0.3  0.00
0.3 to 0.4  0.00
0.4 to 0.5  0.00
0.5 to 0.6  0.00
0.6 to 0.7  0.00
0.7 to 0.8  0.00
0.8 to 0.9  0.00
0.9 to 1.0  100.00  ******************************
END
    [ "$(poly-stats <two.tm)" = "$output" ]
    [ "$(poly-stats - <two.tm)" = "$output" ]
}

@test "--json has the documented keys, in a file or on standard output" {
    poly-stats --json out.json -o table two.tm
    run -0 --separate-stderr poly-stats --json - two.tm
    [ "$output" = "$(cat out.json)" ]
    python3 - out.json <<'END'
import json, math, sys
s = json.load(open(sys.argv[1]))
assert list(s) == [
    "polyhedra", "facets", "edges", "nodes", "non_simple", "non_simple_by",
    "euler_failures", "not_star_shaped", "swallowed_vertices", "faces_per_polyhedron",
    "largest_faces", "tets_per_polyhedron", "largest_tets", "input",
    "reduction_percent", "volume", "min_volume", "min_edge", "min_face_area",
    "min_dihedral", "max_dihedral", "max_diameter", "centroid_outside", "vem_indicator",
    "finite_volume", "fit_for", "edge_ratio", "kernel_radius", "kernel_ratio",
    "centroid_depth", "rho1", "rho2", "rho3",
    "faces_histogram", "tets_histogram", "kernel_ratio_histogram"]
assert list(s["non_simple_by"]) == ["edges", "vertices", "pieces", "euler"]
assert s["input"] == {"elements": 13, "faces": None, "edges": None, "nodes": 10}
assert s["reduction_percent"]["faces"] is None
assert abs(s["volume"] - 7 / 6) < 1e-15
assert s["faces_histogram"] == [[2, 0], [3, 0], [4, 0], [6, 1], [8, 1]]
assert sum(n for end, n in s["kernel_ratio_histogram"]) == 2
assert abs(s["kernel_ratio"]["min"] - 1) < 1e-12
END
}

@test "without the tetrahedra's number the input is not known" {
    sed 's/^2 1$/2 0/; s/^\([12] .*\) 12*$/\1/; s/^1 7 .*/1 7 1 2 3 4 5 6 7/' two.tm |
        sed '/^\.cell/,$s/^2 4 .*/2 4 6 8 9 10/' >plain.tm
    run -0 poly-stats --json out.json plain.tm
    [[ "$output" != *tetrahedra* ]]
    [ "$(json out.json tets_per_polyhedron)" = null ]
    [ "$(json out.json largest_tets)" = null ]
    [ "$(json out.json input elements)" = null ]
    [ "$(json out.json tets_histogram)" = "[]" ]
    # Nor is it where the attribute is something else.
    sed 's/ 12$/ 0.5/' two.tm >half.tm
    poly-stats --json half.json -o table half.tm
    cmp out.json half.json
}

@test "faces and edges of the input, where all polyhedra are simple and made of triangles" {
    boxes 3 0.1 >boxes.tm
    poly-stats --json out.json -o table boxes.tm
    # 27 boxes of 6 tetrahedra with 7 edges of their own: 6 diagonals, shared, and 1.
    [ "$(json out.json input elements)" = 162 ]
    [ "$(json out.json input faces)" = 378 ]
    [ "$(json out.json facets)" = 216 ]
    [ "$(json out.json input edges)" = 279 ]
    [ "$(json out.json edges)" = 252 ]
    [ "$(json out.json reduction_percent nodes)" = 0 ]
}

@test "non-simple polyhedra by cause, as another program counts them" {
    boxes 8 0.1 | joined 60 >joined.tm
    boxes 8 0.1 | joined 470 >more.tm
    boxes 6 | joined 100 >boxes.tm
    for mesh in joined.tm more.tm boxes.tm; do
        poly-stats --json out.json -o table "$mesh"
        python3 - "$mesh" out.json <<'END'
import json, sys
lines = open(sys.argv[1]).read().splitlines()
stats = json.load(open(sys.argv[2]))

def block(name):
    start = lines.index(name) + 2
    return [row.split() for row in lines[start:start + int(lines[start - 1].split()[0])]]

def groups(items, pairs):
    """How many groups the pairs make of the items."""
    parent = {i: i for i in items}
    def root(i):
        while parent[i] != i:
            i = parent[i]
        return i
    for i, j in pairs:
        parent[root(i)] = root(j)
    return sum(parent[i] == i for i in items)

facets = [[int(n) for n in row[1:]] for row in block('.facet')]
count = dict(edges=0, vertices=0, pieces=0, euler=0)
simple = 0
for c, row in enumerate(block('.cell')):
    loops = []
    for f in row[2:2 + int(row[1])]:
        a, b, k, *nodes = facets[int(f)]
        loops.append(nodes if a == c else nodes[::-1])
    edges = {}
    for f, loop in enumerate(loops):
        for p, q in zip(loop, loop[1:] + loop[:1]):
            edges.setdefault((min(p, q), max(p, q)), []).append(f)
    nodes = {p for loop in loops for p in loop}
    wrong = set()
    if any(len(f) != 2 for f in edges.values()):
        wrong.add('edges')
    for p in nodes:
        pairs = [(f[0], g) for e, f in edges.items() if p in e for g in f]
        if groups([f for f, loop in enumerate(loops) if p in loop], pairs) != 1:
            wrong.add('vertices')
    if groups(nodes, edges) != 1:
        wrong.add('pieces')
    if len(nodes) - len(edges) + len(loops) != 2:
        wrong.add('euler')
    simple += not wrong
    for w in wrong:
        count[w] += 1
print(count, simple)
assert stats['non_simple_by'] == count, stats
assert stats['euler_failures'] == count['euler']
assert stats['non_simple'] == stats['polyhedra'] - simple
assert 0 < stats['non_simple']
END
        # The boxes fill the block, however they are joined.
        side=8
        [ "$mesh" != boxes.tm ] || side=6
        [ "$(json out.json volume | python3 -c "print(abs(float(input()) - $side ** 3) < 1e-10)")" = True ]
    done
}

@test "facets that belong to other polyhedra than they name: the user is told" {
    sed 's/^6 1 2 3 5 6 7/6 1 -1 3 5 6 7/' two.tm >wrong.tm
    run -0 --separate-stderr poly-stats wrong.tm
    [ "$stderr" = "poly-stats: wrong.tm: 1 of 10 facets do not belong to the polyhedra \
that they name: see mesh-check" ]
    run -0 --separate-stderr poly-stats -q wrong.tm
    [ "$stderr" = "" ]
}

@test "a mesh without polyhedra" {
    run -0 poly-stats --json out.json --plot out.svg none.tm
    [[ "$output" =~ polyhedra\ +0 ]]
    [[ ! "$output" =~ [\ -](nan|inf) ]]
    [ "$(json out.json polyhedra)" = 0 ]
    [ "$(json out.json kernel_ratio min)" = 0 ]
    grep -q '<svg' out.svg
}

@test "--plot writes a figure with the number of polyhedra" {
    boxes 11 0.2 >boxes.tm
    poly-stats --plot figure.svg boxes.tm >table
    python3 -c 'import xml.dom.minidom, sys; xml.dom.minidom.parse(sys.argv[1])' figure.svg
    grep -q '1.*331 polyhedra, 0 not simple' figure.svg
    grep -q 'tetrahedra (grey) per polyhedron' figure.svg
    grep -q 'volume of the kernel' figure.svg
}

@test "--plot without gnuplot: exit 4 with the package's name, and no file" {
    program=$(command -v poly-stats)
    mkdir empty
    run -4 --separate-stderr env PATH="$PWD/empty" "$program" --plot figure.svg two.tm
    [ "$stderr" = "poly-stats: --plot needs gnuplot (package gnuplot-nox)" ]
    [ ! -e figure.svg ]
}

@test "-j 2 gives the bytes of -j 1" {
    boxes 12 0.2 | joined 1500 >many.tm
    for threads in 1 2 5; do
        poly-stats -j $threads --json $threads.json -o $threads.table many.tm
    done
    [ "$(json 1.json non_simple)" -gt 5 ]
    cmp 1.json 2.json
    cmp 1.json 5.json
    cmp 1.table 2.table
    cmp 1.table 5.table
}

@test "usage errors: exit 2" {
    run -2 poly-stats --no-such-option two.tm
    run -2 poly-stats two.tm two.tm
    run -2 poly-stats -j 0 two.tm
    run -2 poly-stats --plot
}

@test "bad input: exit 3 with file and line, and nothing on standard output" {
    head -n 20 two.tm >cut.tm
    run -3 --separate-stderr poly-stats cut.tm
    [ "$output" = "" ]
    [[ "$stderr" =~ ^poly-stats:\ cut\.tm:[0-9]+: ]]
    run -3 --separate-stderr poly-stats <cut.tm
    [[ "$stderr" =~ ^poly-stats:\ \<stdin\>:[0-9]+: ]]
}

@test "a stream of other elements: exit 3 and what measures them" {
    printf 'termesh 1\n.node\n0 3 0 0\n.ele\n0 4 0\n.end\n' >tets.tm
    run -3 --separate-stderr poly-stats tets.tm
    [ "$output" = "" ]
    [[ "$stderr" == "poly-stats: tets.tm: holds tetrahedra (.ele), but poly-stats takes \
polyhedra (.cell) "*"tet-stats, "* ]]
    printf 'termesh 1\n.node\n1 3 0 0\n1 0 0 0\n.mix\n0 0\n.end\n' >mixed.tm
    run -3 --separate-stderr poly-stats mixed.tm
    [[ "$stderr" == "poly-stats: mixed.tm: holds mixed elements (.mix), but "* ]]
}

@test "what cannot be read or written: exit 4" {
    run -4 poly-stats no-such-file.tm
    run -4 poly-stats -o /no-such-folder/out two.tm
    run -4 poly-stats --plot /no-such-folder/out.svg two.tm
    run -4 poly-stats --json /no-such-folder/out.json two.tm
    if [ -e /dev/full ]; then
        run -4 sh -c 'poly-stats two.tm >/dev/full'
        run -4 poly-stats --plot /dev/full two.tm
        run -4 poly-stats --json /dev/full two.tm
    fi
}

@test "from the centroids: of parallelepipeds what a few lines of Python find; of cubes nothing" {
    cubes >cubes.tm
    poly-stats --for fv --json cubes.json cubes.tm >table
    python3 - cubes.json <<'END'
import json, sys
found = json.load(open(sys.argv[1]))
assert abs(found["max_diameter"] - 3 ** 0.5) < 1e-15 and found["centroid_outside"] == 0
whole, face = 3 ** -0.5, 2 ** -0.5
rho2, rho3 = (whole + face) / 2, (4 / 6 + 3 / 4) / 2
assert abs(found["rho1"]["min"] - 1) < 1e-12 and abs(found["rho2"]["mean"] - rho2) < 1e-12
assert abs(found["rho3"]["mean"] - rho3) < 1e-12
assert abs(found["vem_indicator"] - ((rho2 + rho3) / 2) ** 0.5) < 1e-12
assert abs(found["centroid_depth"]["mean"] - whole / 2) < 1e-12
found = found["finite_volume"]
assert found.pop("max_skewness") < 1e-15
assert found.pop("volume_spread") == 1
assert abs(found.pop("min_weight") - 0.5) < 1e-15 and found.pop("min_volume_ratio") == 1
# One facet each is inside.
assert found.pop("small_determinants") == 2
assert abs(found.pop("min_pyramid") - 1 / 6) < 1e-15
assert len(found) == 13 and not any(found.values())
END
    [ "$(json cubes.json fit_for)" = '{"fv": true, "vem": true, "dg": true}' ]
    sheared_boxes 4 >boxes.tm
    poly-stats --json boxes.json boxes.tm >table
    python3 - boxes.tm boxes.json <<'END'
import json, math, sys
blocks, lines = {}, iter(open(sys.argv[1]))
for line in lines:
    if line[0] == '.' and line.strip() != '.end':
        blocks[line.strip()] = [next(lines).split() for _ in range(int(next(lines).split()[0]))]
xyz = {r[0]: [float(x) for x in r[1:4]] for r in blocks['.node']}
nodes = {}
for r in blocks['.facet']:
    for c in r[1:3]:
        nodes.setdefault(c, set()).update(r[4:4 + int(r[3])])
def mean(names):
    return [sum(xyz[n][k] for n in names) / len(names) for k in range(3)]
centre = {c: mean(names) for c, names in nodes.items()}
angles = []
for r in blocks['.facet']:
    if r[2] == '-1':
        continue
    a, b, c = (xyz[n] for n in r[4:7])
    u, v = ([q[k] - p[k] for k in range(3)] for p, q in ((a, b), (a, c)))
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    d = [centre[r[2]][k] - centre[r[1]][k] for k in range(3)]
    angles.append(math.degrees(math.acos(sum(p * q for p, q in zip(n, d))
                                         / math.hypot(*n) / math.hypot(*d))))
found = json.load(open(sys.argv[2]))["finite_volume"]
assert abs(found["max_non_orthogonality"] - max(angles)) < 1e-9
assert abs(found["mean_non_orthogonality"] - sum(angles) / len(angles)) < 1e-9
assert found["wrong_pyramids"] == found["unseen"] == 0 and found["volume_spread"] > 2
END
}

@test "--for: a mesh that is not fit is exit 1, with what is wrong" {
    awk 'BEGIN { srand(11); print 600, 3; for (i = 1; i <= 600; i++) print i, rand(), rand(), rand() }' |
        tetgen-mesh --quiet | polylla3d -q --star >stars.tm
    run -1 --separate-stderr poly-stats --for fv stars.tm
    [[ $stderr == *"not fit for fv"*"pyramids have no volume"* ]]
    poly-stats --for vem stars.tm >table
    poly-stats --for dg -q none.tm >table
    run -2 poly-stats --for fem stars.tm
}
