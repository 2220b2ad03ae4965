# SPDX-License-Identifier: GPL-3.0-or-later
# mesh-check under a launcher: what 1, 2, 3, 4 and 7 ranks say is what one process says, of
# good meshes and of those that are wrong in every way that it finds; and poly-stats of
# wrong ones.

bats_require_minimum_version 1.5.0
load helpers
load ranks

setup() {
    need_mpirun
    cd "$BATS_TEST_TMPDIR" || exit
}

# A stream of n^3 cubes, each cut into six tetrahedra, or not: grid N tets|mixed [WRONG]. All
# rows of .face, .edge and .facet are right ones. WRONG changes one row of 97, in all ways;
# nodes are in an order without sense, then. Mixed: hexahedra, wedges and pyramids.
grid() {
    python3 - "$@" <<'END'
import itertools, random, sys

n, kind, wrong = int(sys.argv[1]), sys.argv[2], len(sys.argv) > 3
random.seed(n)
m = n + 1
xyz = [(x, y, z) for z in range(m) for y in range(m) for x in range(m)]
elements = []
for z, y, x in itertools.product(range(n), repeat=3):
    v = [(z + c // 4) * m * m + (y + c // 2 % 2) * m + x + c % 2 for c in range(8)]
    hexahedron = [v[i] for i in (0, 1, 3, 2, 4, 5, 7, 6)]
    if kind == 'tets':
        for a, b in ((1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1)):
            elements.append([v[0], v[a], v[b], v[7]])
    elif z == n // 2:
        h = hexahedron
        elements += [[h[i] for i in wedge] for wedge in ((0, 1, 4, 3, 2, 7), (1, 5, 4, 2, 6, 7))]
    elif z > n // 2:
        c, h = len(xyz), hexahedron
        xyz.append((x + .5, y + .5, z + .5))
        for q in ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)):
            elements.append([h[i] for i in q] + [c])
    else:
        elements.append(hexahedron)

faces_of = {4: ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
            5: ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
            6: ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
            8: ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))}
members = {}
for e, nodes in enumerate(elements):
    for f in faces_of[len(nodes)]:
        members.setdefault(tuple(sorted(nodes[i] for i in f)), []).append((e, [nodes[i] for i in f]))
outer = [v[0] for v in members.values() if len(v) == 1]
faces = [f for e, f in outer if len(f) == 3]
edges = [list(e) for e in sorted({(max(f[:2]), min(f[:2])) for e, f in outer})]
facets = [[v[0][0], v[1][0] if len(v) > 1 else -2] + v[0][1] for v in members.values()]
if kind == 'tets':
    facets = []

if wrong:
    some = lambda rows: range(random.randrange(97), len(rows), 97)
    for e in some(elements):
        elements[e] = random.choice((
            lambda r: r[::-1], lambda r: r[1:] + r[:1], lambda r: r[:-1] + r[:1],
            lambda r: elements[e // 2], lambda r: random.sample(range(len(xyz)), len(r)),
            lambda r: r[:-1] + [random.randrange(len(xyz))], lambda r: r[:1] + r[:0:-1]))(elements[e])
    if not facets:
        elements = [r for r in elements if random.random() > .01]
    for rows in faces, edges:
        for r in some(rows):
            rows[r] = random.choice((lambda r: r[::-1], lambda r: rows[0], lambda r: r[:-1] + r[:1],
                                     lambda r: [(v + 5) % len(xyz) for v in r]))(rows[r])
    for r in some(facets):
        facets[r] = random.choice((lambda r: r[:2] + r[:1:-1], lambda r: facets[0], lambda r: r[1::-1] + r[2:],
                                   lambda r: [r[0] // 2, r[1]] + r[2:], lambda r: r + [0, 1]))(facets[r])
    facets = [r if r[0] >= 0 else [0] + r[1:] for r in facets]
    xyz += random.sample(xyz, 50) + [(-1 - i, 0, 0) for i in range(50)]
    at = list(range(len(xyz)))
    random.shuffle(at)
    moved = [None] * len(xyz)
    for v, to in enumerate(at):
        moved[to] = xyz[v]
    xyz = moved
    renumber = lambda rows, first=0: [r[:first] + [at[v] for v in r[first:]] for r in rows]
    elements, faces, edges, facets = renumber(elements), renumber(faces), renumber(edges), renumber(facets, 2)

def block(name, header, rows):
    print('%s\n%d %s' % (name, len(rows), header))
    for i, row in enumerate(rows):
        print(i + 1, *row)

one = lambda row: [v + 1 for v in row]
print('termesh 1')
block('.node', '3 0 0', xyz)
if kind == 'tets':
    block('.ele', '4 0', [one(r) for r in elements])
else:
    block('.mix', '0', [[len(r)] + one(r) for r in elements])
block('.face', '0', [one(r) for r in faces])
block('.edge', '0', [one(r) for r in edges])
if facets:
    block('.facet', '0', [[r[0] + 1, r[1] + 1, len(r) - 2] + one(r[2:]) for r in facets])
print('.end')
END
}

# Changes boxes of helpers.bash in all ways: wrong_boxes N.
wrong_boxes() {
    boxes "$1" | python3 -c '
import random, sys
random.seed(1)
lines = sys.stdin.read().splitlines()
block, out = None, []
nodes = int(lines[2].split()[0])
facet = []
for line in lines:
    w = line.split()
    if line[0] == "." or len(w) < 4 or w[1:] == ["3", "0", "0"]:
        block = line if line[0] == "." else block
    elif block == ".facet":
        facet.append(w)
        change = random.randrange(400)
        if change == 0:
            w[4:] = w[:3:-1]
        elif change == 1:
            w[1], w[2] = (w[2], w[1]) if w[2] != "-1" else (w[1], w[1])
        elif change == 2:
            w[3:] = facet[len(facet) // 2][3:]
        elif change == 3:
            w[5] = w[4]
        elif change == 4:
            w[5] = str(random.randrange(nodes))
        elif change == 5:
            w[2] = "-1"
    elif block == ".cell":
        change = random.randrange(200)
        if change == 0:
            w[1:3] = [str(int(w[1]) - 1)]
        elif change == 1:
            w[2] = "0"
        elif change == 2:
            w[2:4] = w[3], w[3]
    elif block == ".node" and random.randrange(500) == 0:
        w[1:] = "1", "1", "1"
    out.append(" ".join(w))
print("\n".join(out))'
}

@test "tetrahedra: a good mesh and wrong ones" {
    grid 17 tets >good.tm
    RANKS=3 ranks_agree good.tm mesh-check
    grep -q 'nothing is wrong' one.out
    grid 17 tets wrong >wrong.tm
    ranks_agree wrong.tm mesh-check
    for defect in inverted degenerate unmatched_faces overlapping_faces open_edges non_manifold_edges \
        non_manifold_vertices duplicate_nodes dangling_faces repeated_faces dangling_edges repeated_edges; do
        [ "$(json one.json $defect)" -gt 0 ]
    done
    many 9000 >many.tm
    RANKS=7 ranks_agree many.tm mesh-check
}

@test "mixed elements: a good mesh and a wrong one" {
    grid 12 mixed >good.tm
    RANKS=3 ranks_agree good.tm mesh-check
    grep -q 'nothing is wrong' one.out
    grid 12 mixed wrong >wrong.tm
    RANKS='2 7' ranks_agree wrong.tm mesh-check
    for defect in inverted degenerate unmatched_faces overlapping_faces non_manifold_edges \
        non_manifold_vertices duplicate_nodes dangling_faces repeated_faces dangling_edges repeated_edges; do
        [ "$(json one.json $defect)" -gt 0 ]
    done
    grep -q 'is half of a quadrilateral' one.out
}

@test "polyhedra: a good mesh and a wrong one" {
    boxes 22 >good.tm
    RANKS=3 ranks_agree good.tm mesh-check
    grep -q 'nothing is wrong' one.out
    wrong_boxes 22 >wrong.tm
    RANKS='2 7' ranks_agree wrong.tm mesh-check
    for defect in inverted degenerate unmatched_faces open_edges non_manifold_edges \
        non_manifold_vertices duplicate_nodes repeated_faces unclosed_edges unoriented_edges; do
        [ "$(json one.json $defect)" -gt 0 ]
    done
    RANKS='2 7' ranks_agree wrong.tm poly-stats
    grep -q 'do not belong to the polyhedra that they name' several.err
}

@test "meshes so small that ranks have nothing, and what rank 0 does alone" {
    cubes >cubes.tm
    mixed >mixed.tm
    grid 1 tets >six.tm
    printf 'termesh 1\n.node\n0 3 0 0\n.ele\n0 4 0\n.end\n' >none.tm
    printf 'termesh 1\n.node\n0 3 0 0\n.mix\n0 0\n.end\n' >none-mixed.tm
    printf 'termesh 1\n.node\n0 3 0 0\n.facet\n0 0\n.cell\n0 1\n.end\n' >none-cells.tm
    surface cube stream >surface.tm
    for mesh in cubes mixed six none none-mixed none-cells surface; do
        RANKS=7 ranks_agree $mesh.tm mesh-check
    done
    RANKS=7 ranks_agree none-cells.tm poly-stats
    surface cube off >cube.off
    RANKS=2 ranks_agree six.tm mesh-check --against cube.off
    [ "$(on_ranks 3 mesh-check <cubes.tm)" = "$(mesh-check <cubes.tm)" ]
}

@test "errors: one message, the exit status, nothing on standard output" {
    grid 10 tets >mesh.tm
    sed '/^\.ele/,$ s/^5000 1 .*/5000 1 2 3 99999/; /^\.ele/,$ s/^5000 .*/5000 1 2 3 99999/' mesh.tm >range.tm
    run -3 --separate-stderr on_ranks 3 mesh-check range.tm
    [ "$output" = "" ]
    # shellcheck disable=SC2154 # run sets stderr
    [ "$(grep -c '^mesh-check: range.tm:[0-9]*: .ele: ' <<<"$stderr")" -eq 1 ]
    run -4 on_ranks 2 mesh-check no-such-file.tm
    run -2 on_ranks 2 mesh-check --no-such-option mesh.tm
}
