# SPDX-License-Identifier: GPL-3.0-or-later
# polylla3d: what it makes is judged by a program that shares nothing with it.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

setup_file() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    awk 'BEGIN {
        srand(11)
        print 600, 3
        for (i = 1; i <= 600; i++) print i, rand(), rand(), rand()
    }' >points.node
    tetgen-mesh --no-history points.node >points.tm
    surface sphere off | tetgen-mesh --no-history -q >sphere.tm
    write_gain
    two_boxes_and_a_ring
    grid 4 >grid.tm
    cat >judge.py <<'END'
"""judge.py POLYHEDRA TETRAHEDRA [simple]: every cell is closed and oriented, facets are
between the cells that they name, volumes are positive and sum up, the boundary and the
marked faces are there; with `simple` every cell is a ball; with `bent` facets need not be plane."""
import collections, itertools, sys

def blocks(path):
    found, lines = {}, iter(open(path))
    for line in lines:
        if line[0] == '.' and line.strip() != '.end':
            head = next(lines).split()
            found[line.strip()] = head, [next(lines).split() for _ in range(int(head[0]))]
    return found

poly, tet = blocks(sys.argv[1]), blocks(sys.argv[2])
assert poly['.node'] == tet['.node']
base = int(poly['.node'][1][0][0])
xyz = [[float(x) for x in row[1:4]] for row in poly['.node'][1]]
facets = []
for row in poly['.facet'][1]:
    k = int(row[3])
    nodes = [int(n) - base for n in row[4:4 + k]]
    assert len(set(nodes)) == k >= 3
    facets.append((int(row[1]) - base, int(row[2]), nodes, row[4 + k:]))
def minus(a, b): return [p - q for p, q in zip(a, b)]
def six_volumes(a, b, c, d):
    u, v, w = minus(b, a), minus(c, a), minus(d, a)
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
            + u[2] * (v[0] * w[1] - v[1] * w[0]))
named = collections.Counter()
total = 0
for c, row in enumerate(poly['.cell'][1]):
    k = int(row[1])
    edges, volume, nodes = collections.Counter(), 0, set()
    neighbours = collections.defaultdict(list)
    for f in (int(f) - base for f in row[2:2 + k]):
        first, second, loop, _ = facets[f]
        named[f] += 1
        assert c == first or c + base == second
        loop = loop if c == first else loop[::-1]
        nodes.update(loop)
        for a, b in zip(loop, loop[1:] + loop[:1]):
            edges[a, b] += 1
        for i in range(1, len(loop) - 1):
            volume -= six_volumes([0, 0, 0], *(xyz[loop[j]] for j in (0, i + 1, i)))
        for i, v in enumerate(loop):
            neighbours[v].append((loop[i - 1], loop[(i + 1) % len(loop)]))
    assert volume > 0 or 'bent' in sys.argv
    total += volume
    if 'simple' in sys.argv:
        assert all(n == 1 and edges[b, a] == 1 for (a, b), n in list(edges.items()))
        for v, corners in neighbours.items():
            follow, at, steps = dict(corners), corners[0][0], 0
            while True:
                at, steps = follow[at], steps + 1
                if at == corners[0][0]:
                    break
            assert steps == len(corners), 'a node with two fans'
        assert len(nodes) - len(edges) // 2 + k == 2
        reached, todo = set(), [next(iter(nodes))]
        while todo:
            v = todo.pop()
            if v not in reached:
                reached.add(v)
                todo += [n for corner in neighbours[v] for n in corner]
        assert reached == nodes
    else:
        assert all(n == edges[b, a] for (a, b), n in list(edges.items()))
for f, (first, second, _, _) in enumerate(facets):
    assert named[f] == (1 if second == -1 else 2), 'a facet without its cells'
tets = [[int(n) - base for n in row[1:5]] for row in tet['.ele'][1]]
whole = sum(abs(six_volumes(*(xyz[n] for n in t))) for t in tets)
if 'bent' in sys.argv:
    sys.exit()
assert abs(total / whole - 1) < 1e-12, (total, whole)
assert sum(float(row[2 + int(row[1])]) for row in poly['.cell'][1]) == len(tets)
def area2(loop):
    sums = [0, 0, 0]
    for i in range(1, len(loop) - 1):
        u, v = minus(xyz[loop[i]], xyz[loop[0]]), minus(xyz[loop[i + 1]], xyz[loop[0]])
        for k in range(3):
            sums[k] += u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2]
    return sum(s * s for s in sums) ** 0.5
faces = collections.Counter(f for t in tets for f in itertools.combinations(sorted(t), 3))
boundary = sum(area2(f) for f, n in faces.items() if n == 1)
ours = sum(area2(loop) for _, second, loop, _ in facets if second == -1)
assert abs(ours / boundary - 1) < 1e-12
if '.face' in tet and int(tet['.face'][0][1]):
    areas = collections.Counter(), collections.Counter()
    for row in tet['.face'][1]:
        areas[0][row[4]] += area2([int(n) - base for n in row[1:4]])
    for _, _, loop, marker in facets:
        areas[1][marker[0]] += area2(loop)
    for marker, area in areas[0].items():
        assert marker == '0' or abs(areas[1][marker] / area - 1) < 1e-12, marker
END
}

# gain.py POLYHEDRA: exit 1 where an error of one cell, that is of more than one tetrahedron
# or beside such a one, comes back to it as more than itself by OpenFOAM's scheme
# `corrected`, one iteration after the other.
write_gain() {
    cat >gain.py <<'END'
import sys
def rows(name):
    lines = iter(open(sys.argv[1]))
    for line in lines:
        if line.strip() == name:
            return [next(lines).split() for _ in range(int(next(lines).split()[0]))]
def minus(a, b): return [p - q for p, q in zip(a, b)]
def dot(a, b): return sum(p * q for p, q in zip(a, b))
def cross(a, b): return [a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)]
def times(s, a): return [s * p for p in a]
def plus(a, b): return [p + q for p, q in zip(a, b)]
nodes = rows('.node')
base, xyz = int(nodes[0][0]), [[float(x) for x in row[1:4]] for row in nodes]
cells = rows('.cell')
tets = [float(row[2 + int(row[1])]) for row in cells]
n = len(cells)
volume, centre, gradient, solved, back = [0] * n, [[0] * 3] * n, [[0] * 3] * n, [0] * n, [0] * n
faces = []
for row in rows('.facet'):
    a, b, c = (xyz[int(v) - base] for v in row[4:7])
    area, middle = times(0.5, cross(minus(b, a), minus(c, a))), times(1 / 3, plus(plus(a, b), c))
    sides = [int(row[1]) - base, int(row[2]) - base if row[2] != '-1' else None]
    faces.append((sides, area, middle))
    for i, side in enumerate(sides):
        if side is not None:
            part = (1 - 2 * i) * dot(area, middle) / 3
            volume[side] += part
            centre[side] = plus(centre[side], times(part * 3 / 4, middle))
centre = [times(1 / v, c) for v, c in zip(volume, centre)]
def parts(sides, area, middle):
    d = minus(centre[sides[1]], centre[sides[0]])
    part = dot(area, area) / dot(d, area)
    far = [abs(dot(area, minus(middle, centre[side]))) for side in sides]
    return part, minus(area, times(part, d)), [far[1 - i] / sum(far) for i in (0, 1)]
for sides, area, middle in faces:
    if sides[1] is None:
        solved[sides[0]] += dot(area, area) / dot(area, minus(middle, centre[sides[0]]))
        continue
    part, rest, weight = parts(sides, area, middle)
    for i, side in enumerate(sides):
        solved[side] += part
        gradient[side] = plus(gradient[side], times((1 - 2 * i) * weight[i] / volume[side], area))
beside = [1] * n
for sides, area, middle in faces:
    if sides[1] is None:
        continue
    part, rest, weight = parts(sides, area, middle)
    for i, side in enumerate(sides):
        back[side] += (1 - 2 * i) * weight[i] * dot(rest, gradient[side])
        back[side] -= weight[0] * weight[1] * dot(rest, area) / volume[sides[1 - i]]
        beside[side] = max(beside[side], tets[sides[0]], tets[sides[1]])
sys.exit(any(abs(b) > s and t > 1 for b, s, t in zip(back, solved, beside)))
END
}

setup() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    out=$BATS_TEST_TMPDIR
}

# boxes.tm: two boxes as two regions, one on the other; ring.tm: a box with a hole
# through it and a cavity inside.
two_boxes_and_a_ring() {
    two_boxes >boxes.poly
    tetgen-mesh --no-history -q1.6 -a 0.01 --switches A boxes.poly >boxes.tm
    grid 6 | awk '$1 ~ /^[0-9]+$/ && ele && NF >= 5 && !first { first = 1 } { print }
        /^\.ele/ { ele = 1 }' >whole.tm
    python3 - whole.tm >ring.tm <<'END'
import sys
lines = open(sys.argv[1]).read().split('\n')
at = lines.index('.ele')
nodes = [[float(x) for x in row.split()[1:4]] for row in lines[3:at]]
def inside(tet):
    x, y, z = (sum(nodes[n][k] for n in tet) / 4 for k in range(3))
    hole = 2 < x < 4 and 2 < y < 4
    cavity = 0 < x - 4 < 1 and 0 < y - 1 < 1 and 2 < z < 3
    return not (hole or cavity)
rows = [row.split()[1:5] for row in lines[at + 2:] if row and row[0] != '.']
rows = [row for row in rows if inside([int(n) for n in row])]
print('\n'.join(lines[:at + 1]))
print(len(rows), 4, 0)
for t, row in enumerate(rows):
    print(t, *row)
print('.end')
END
}

# A cube of n³ cells of six tetrahedra each, counted from 0: grid N.
grid() {
    awk -v n="$1" 'function v(x, y, z) { return (z * (n + 1) + y) * (n + 1) + x }
    BEGIN {
        print "termesh 1\n.node\n" (n + 1) ^ 3, 3, 0, 0
        for (z = 0; z <= n; z++) for (y = 0; y <= n; y++) for (x = 0; x <= n; x++)
            print v(x, y, z), x, y, z
        print ".ele\n" 6 * n ^ 3, 4, 0
        split("1 3 3 2 2 6 6 4 4 5 5 1", path)
        for (z = 0; z < n; z++) for (y = 0; y < n; y++) for (x = 0; x < n; x++)
            for (k = 1; k <= 12; k += 2)
                print t++, v(x, y, z), corner(path[k]), corner(path[k + 1]),
                    v(x + 1, y + 1, z + 1)
        print ".end"
    }
    function corner(c) { return v(x + c % 2, y + int(c / 2) % 2, z + int(c / 4)) }'
}

@test "in every mode and mesh, after repair: all balls, nothing lost" {
    local mesh options
    for mesh in points sphere boxes ring grid; do
        while read -r options; do
            # shellcheck disable=SC2086 # words
            polylla3d -q $options "$mesh.tm" >"$out/poly.tm"
            python3 judge.py "$out/poly.tm" "$mesh.tm" simple
        done <<'END'

--star
--star --absorb
--absorb --merge-coplanar
--mode edge
--mode face
--mode terminal-face --star
--mode face --face-metric inradius --no-swallow
--mode cavity --star --absorb --merge-coplanar
--max-tets 7
END
    done
}

@test "without repair: the regions as they are, nothing lost" {
    local mode
    for mode in terminal edge face terminal-face cavity; do
        polylla3d -q --no-repair --mode $mode --json "$out/$mode" points.tm >"$out/poly.tm"
        python3 judge.py "$out/poly.tm" points.tm
        [ "$(json "$out/$mode" regions)" -eq "$(json "$out/$mode" polyhedra)" ]
    done
    # One region for each terminal edge and for each longest edge.
    python3 - points.tm >"$out/counts" <<'END'
import sys
lines = open(sys.argv[1]).read().split('\n')
at = lines.index('.ele')
xyz = [[float(x) for x in row.split()[1:4]] for row in lines[lines.index('.node') + 2:at]
       if row[0] != '.']
count = int(lines[at + 1].split()[0])
def key(a, b): return (sum((p - q) ** 2 for p, q in zip(xyz[a], xyz[b])), max(a, b), min(a, b))
longest, around = [], {}
for row in lines[at + 2:at + 2 + count]:
    n = [int(v) - 1 for v in row.split()[1:5]]
    edges = [key(n[i], n[j]) for i in range(4) for j in range(i)]
    longest.append(max(edges))
    for e in edges:
        around.setdefault(e, []).append(max(edges))
print(sum(all(other == e for other in others) for e, others in around.items()),
      len(set(longest)))
END
    read -r terminal longest <"$out/counts"
    [ "$(json "$out/terminal" regions)" -eq "$terminal" ]
    [ "$(json "$out/edge" regions)" -eq "$longest" ]
}

@test "--mode face: joined across best faces, and no others are inside; about 3 each" {
    local mesh metric
    for mesh in points sphere grid; do
        for metric in area inradius; do
            polylla3d -q --no-repair --mode face --face-metric $metric --label $mesh.tm >"$out/face.tm"
            polylla3d -q --no-repair --mode terminal-face --face-metric $metric --label $mesh.tm >"$out/region.tm"
            python3 - "$out/face.tm" "$out/region.tm" $metric <<'END'
import itertools, math, sys
def rows(path, name):
    lines = iter(open(path))
    for line in lines:
        if line.strip() == name:
            return [next(lines).split() for _ in range(int(next(lines).split()[0]))]
xyz = {row[0]: [float(x) for x in row[1:4]] for row in rows(sys.argv[1], '.node')}
tets = [frozenset(row[1:5]) for row in rows(sys.argv[1], '.ele')]
cell, region = ([row[-1] for row in rows(path, '.ele')] for path in sys.argv[1:3])
def metric(face):
    a, b, c = (xyz[v] for v in face)
    sides = [math.dist(a, b), math.dist(b, c), math.dist(c, a)]
    u, w = ([q - p for p, q in zip(a, x)] for x in (b, c))
    area = math.hypot(*(u[k - 2] * w[k - 1] - u[k - 1] * w[k - 2] for k in range(3))) / 2
    return area if sys.argv[3] == 'area' else 2 * area / sum(sides)
best, at = [], {}
for t, tet in enumerate(tets):
    faces = [frozenset(f) for f in itertools.combinations(tet, 3)]
    most = max(map(metric, faces))
    best.append({f for f in faces if metric(f) >= most * (1 - 1e-12)})
    for f in faces:
        at.setdefault(f, []).append(t)
inside = links = 0
for f, sides in at.items():
    if len(sides) == 2 and cell[sides[0]] == cell[sides[1]]:
        assert f in best[sides[0]] | best[sides[1]], 'a barrier face'
        assert region[sides[0]] == region[sides[1]]
        inside += 1
    if len(sides) == 2 and region[sides[0]] == region[sides[1]]:
        links += f in best[sides[0]] | best[sides[1]]
assert len(tets) - inside == len(set(cell)), 'each is a tree of faces'
assert len(set(cell)) >= len(set(region))
assert links >= len(tets) - len(set(region))
END
        done
    done
    # As the paper has it, 70 % less than the tetrahedra.
    polylla3d -q --mode face --no-repair --json "$out/json" points.tm >"$out/poly.tm"
    awk -v n="$(json "$out/json" polyhedra)" -v tets="$(json "$out/json" tets)" \
        'BEGIN { exit !(tets / n > 2.8 && tets / n < 4.2) }'
    polylla3d -q --mode terminal-face --no-repair --json "$out/json" points.tm >"$out/poly.tm"
    awk -v n="$(json "$out/json" polyhedra)" -v tets="$(json "$out/json" tets)" \
        'BEGIN { exit !(tets / n > 5) }'
}

@test "regions and marked faces are between polyhedra, but for --ignore-markers" {
    polylla3d -q boxes.tm >"$out/poly.tm"
    # Each cell has one region, and their volumes are those of the boxes.
    rows .cell "$out/poly.tm" | awk '{ print $(3 + $2 + 1) }' | sort -u >"$out/regions"
    [ "$(tr '\n' ' ' <"$out/regions")" = '3 7 ' ]
    # A marked face inside of one region.
    cat >"$out/two.tm" <<'END'
termesh 1
.node
5 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0.3 0.3 0.5
5 0.3 0.3 -0.5
.ele
2 4 0
1 1 2 3 4
2 1 3 2 5
.face
1 1
1 1 2 3 8
.end
END
    [ "$(polylla3d -q --mode face "$out/two.tm" | header .cell /dev/stdin)" = '2 1' ]
    [ "$(polylla3d -q --mode face --ignore-markers "$out/two.tm" |
        header .cell /dev/stdin)" = '1 1' ]
    polylla3d -q --mode face "$out/two.tm" | rows .facet /dev/stdin |
        grep -qE '^[0-9]+ 1 2 3 .* 8$'
}

@test "--max-tets, --no-swallow, --absorb keep their word" {
    polylla3d -q --max-tets 5 points.tm | rows .cell /dev/stdin |
        awk '$(3 + $2) > 5 { exit 1 }'
    polylla3d -q --no-swallow points.tm >"$out/poly.tm"
    [ "$(rows .facet "$out/poly.tm" | awk '{ for (i = 5; i < 5 + $4; i++) print $i }' |
        sort -u | wc -l)" -eq 600 ]
    polylla3d -q --star --json "$out/star" points.tm >"$out/poly.tm"
    polylla3d -q --star --absorb --json "$out/absorb" points.tm >"$out/poly.tm"
    [ "$(json "$out/absorb" polyhedra)" -lt "$(json "$out/star" polyhedra)" ]
    [ "$(json "$out/absorb" absorbed)" -gt 0 ]
    # Where all are small, they do not all become one.
    awk 'BEGIN { print 1000, 3; for (i = 0; i < 1000; i++)
        print i, i % 10, int(i / 10) % 10, int(i / 100) }' | tetgen-mesh --quiet >"$out/grid.tm"
    for mesh in "$out/grid.tm" grid.tm; do
        for star in '' --star; do
            # shellcheck disable=SC2086 # a word or none
            polylla3d -q --absorb $star "$mesh" | rows .cell /dev/stdin |
                awk '$(3 + $2) > 32 { exit 1 }'
        done
    done
}

@test "--cells, --size: round cells of even size, which stay balls and stars" {
    local mesh
    for mesh in points sphere boxes grid; do
        polylla3d -q --no-history --cells 30 --star --absorb --json "$out/json" $mesh.tm >"$out/poly.tm"
        python3 judge.py "$out/poly.tm" $mesh.tm simple
        poly-stats --json "$out/stats" "$out/poly.tm" >"$out/table"
        [ "$(json "$out/stats" not_star_shaped)" -eq 0 ]
        [ "$(json "$out/json" polyhedra)" -ge 25 ]
    done
    # As many as asked for, and no larger than the mean by far.
    polylla3d -q --cells 60 --absorb sphere.tm | rows .cell /dev/stdin |
        awk '{ n = $(3 + $2); sum += n; most = n > most ? n : most }
            END { exit !(NR >= 55 && NR <= 70 && most < 4 * sum / NR) }'
    # a cube of side 0.5 for each of about 8 of the unit cube
    surface cube off | tetgen-mesh --quiet -q -a 0.002 >"$out/cube.tm"
    polylla3d -q --size 0.5 --json "$out/json" "$out/cube.tm" >"$out/poly.tm"
    [ "$(json "$out/json" regions)" -eq 8 ]
    # They are rounder than those of terminal edges: less area between as many.
    polylla3d -q --star --absorb --json "$out/json" "$out/cube.tm" >"$out/poly.tm"
    local cells
    cells=$(json "$out/json" polyhedra)
    polylla3d -q --star --absorb --cells "$cells" --json "$out/compact" "$out/cube.tm" >"$out/poly.tm"
    [ "$(json "$out/compact" facets)" -lt "$(json "$out/json" facets)" ]
    run -2 polylla3d --mode compact points.tm
    run -2 polylla3d --cells 5 --size 1 points.tm
    run -2 polylla3d --cells 5 --mode face points.tm
    run -2 polylla3d --cells 0 points.tm
    run -2 polylla3d --size 0 points.tm
}

@test "--star=R: a ball of that radius, by the extent, or it is said" {
    local mesh radius
    for mesh in points sphere; do
        for radius in 0 0.02 0.08; do
            run polylla3d -q --no-history --star=$radius --json "$out/json" -o "$out/poly.tm" $mesh.tm
            [ "$status" -eq "$(json "$out/json" not_star_shaped | awk '{ print ($1 > 0) }')" ]
            python3 judge.py "$out/poly.tm" $mesh.tm simple
            poly-stats --json "$out/stats" "$out/poly.tm" >"$out/table"
            [ "$(json "$out/stats" not_star_shaped)" -eq 0 ]
            awk -v no="$(json "$out/json" not_star_shaped)" -v radius=$radius \
                -v least="$(json "$out/stats" kernel_radius min)" \
                'BEGIN { exit !(no > 0 || least >= radius) }'
        done
    done
    # The more is asked for, the more cells there are.
    polylla3d -q --star=0.01 --json "$out/1" sphere.tm >"$out/poly.tm"
    [ "$(json "$out/1" not_star_shaped)" -eq 0 ]
    [ "$(json "$out/1" polyhedra)" -lt "$(json "$out/json" polyhedra)" ]
    run -2 polylla3d --star=0.6 points.tm
    run -2 polylla3d --star=-1 points.tm
    run -2 polylla3d --star=node points.tm
}

@test "--star=centroid: what finite volumes want, no worse than the tetrahedra" {
    local mesh options
    for mesh in points sphere boxes ring grid; do
        polylla3d -q --no-history --max-tets 1 $mesh.tm >"$out/tets.tm"
        poly-stats --json "$out/before" "$out/tets.tm" >"$out/table"
        for options in '' --absorb '--cells 40 --absorb' '--mode face'; do
            # shellcheck disable=SC2086 # words
            polylla3d -q --no-history --star=centroid $options --json "$out/json" $mesh.tm >"$out/poly.tm"
            python3 judge.py "$out/poly.tm" $mesh.tm simple
            poly-stats --json "$out/stats" "$out/poly.tm" >"$out/table"
            python3 - "$out/before" "$out/stats" <<'END'
import json, sys
before, now = (json.load(open(name))['finite_volume'] for name in sys.argv[1:])
assert now['wrong_pyramids'] == now['unseen'] == 0
assert now['max_non_orthogonality'] <= max(70 + 1e-6, before['max_non_orthogonality'])
END
            [ "$(json "$out/json" polyhedra)" -lt "$(json "$out/before" polyhedra)" ]
            python3 gain.py "$out/poly.tm"
        done
    done
    # Facets that are bent a little leave it so.
    polylla3d -q --star=centroid --merge-coplanar=20 sphere.tm >"$out/poly.tm"
    poly-stats --json "$out/stats" "$out/poly.tm" >"$out/table"
    [ "$(json "$out/stats" finite_volume wrong_pyramids)" -eq 0 ]
    # Others have cells by which a solver would not converge.
    polylla3d -q --no-history --star sphere.tm >"$out/poly.tm"
    run -1 python3 gain.py "$out/poly.tm"
}

@test "a mesh that is thin, or turned to be flat, gets stars as one that is not; what is single is said" {
    awk '/^\.node/ { print; getline; print; n = $1
        for (i = 0; i < n; i++) { getline; $4 = sprintf("%.17g", $4 / 1024); print }; next } { print }' \
        points.tm >"$out/thin.tm"
    polylla3d -q --star --mode face --json "$out/thick" points.tm >"$out/poly.tm"
    polylla3d -q --star --mode face --json "$out/thin" "$out/thin.tm" >"$out/poly.tm"
    awk -v a="$(json "$out/thick" polyhedra)" -v b="$(json "$out/thin" polyhedra)" \
        'BEGIN { exit !(b < 1.5 * a) }'
    poly-stats --json "$out/json" "$out/poly.tm" >"$out/table"
    [ "$(json "$out/json" not_star_shaped)" -eq 0 ]
    run -0 --separate-stderr polylla3d --star --max-tets 1 -o "$out/1.tm" points.tm
    [[ $stderr == *" polyhedra are of one tetrahedron: "* ]]
}

@test "--merge-coplanar: the sides of a box of one polyhedron" {
    grid 1 | polylla3d -q --mode cavity --merge-coplanar >"$out/cube.tm"
    [ "$(header .cell "$out/cube.tm")" = '1 1' ]
    [ "$(rows .facet "$out/cube.tm" | awk '{ print $4 }' | sort | uniq -c | tr -s ' ')" = ' 6 4' ]
    # With an angle there are fewer facets still, which are not plane then.
    polylla3d -q --merge-coplanar --json "$out/0" sphere.tm >"$out/poly.tm"
    polylla3d -q --merge-coplanar=20 --json "$out/20" sphere.tm >"$out/poly.tm"
    [ "$(json "$out/20" facets_joined)" -gt "$(json "$out/0" facets_joined)" ]
    python3 judge.py "$out/poly.tm" sphere.tm simple bent
}

@test "--label: the input with one attribute more, the same polyhedra" {
    polylla3d -q --no-history --label points.tm >"$out/label.tm"
    polylla3d -q --no-history --json "$out/json" points.tm >"$out/poly.tm"
    [ "$(rows .ele "$out/label.tm" | awk '{ print $6 }' | sort -un | wc -l)" -gt 10 ]
    diff <(rows .ele "$out/label.tm" | cut -d ' ' -f 1-5) <(rows .ele points.tm)
    tet-stats -q "$out/label.tm" >"$out/text"
    local mesh
    for mesh in points boxes grid; do
        polylla3d -q --no-history --label $mesh.tm >"$out/label.tm"
        polylla3d -q --no-history $mesh.tm >"$out/poly.tm"
        python3 - "$out/label.tm" "$out/poly.tm" "$(header .ele $mesh.tm | cut -d ' ' -f 3)" <<'END'
import itertools, sys
def rows(path, name):
    lines = iter(open(path))
    for line in lines:
        if line.strip() == name:
            return [next(lines).split() for _ in range(int(next(lines).split()[0]))]
faces = {}
for row in rows(sys.argv[1], '.ele'):
    for face in itertools.combinations(sorted(map(int, row[1:5])), 3):
        faces.setdefault(face, []).append(int(float(row[5 + int(sys.argv[3] or 0)])))
between = {face: sorted(cells) for face, cells in faces.items()
           if len(cells) == 1 or cells[0] != cells[1]}
written = {tuple(sorted(map(int, row[4:7]))): sorted(int(c) for c in row[1:3] if c != '-1')
           for row in rows(sys.argv[2], '.facet')}
assert between == written
END
    done
}

@test "--partition: cells that are given are repaired, and no others are made" {
    local mesh option
    for mesh in points sphere boxes ring grid; do
        polylla3d -q --no-history --label $mesh.tm >"$out/label.tm"
        polylla3d -q --no-history --partition "$out/label.tm" >"$out/again.tm"
        polylla3d -q --no-history $mesh.tm >"$out/poly.tm"
        cmp "$out/again.tm" "$out/poly.tm"
        # Slabs that have anything: pieces, holes, two regions. The last attribute says which.
        slabs $mesh.tm >"$out/slabs.tm"
        for option in '' --star --star=centroid '--absorb --merge-coplanar'; do
            # shellcheck disable=SC2086 # words
            polylla3d -q --partition $option "$out/slabs.tm" >"$out/poly.tm"
            python3 judge.py "$out/poly.tm" $mesh.tm simple
        done
    done
    # Of the sphere each slab is a ball already; the attribute is taken away.
    slabs sphere.tm >"$out/slabs.tm"
    polylla3d --partition=1 --json "$out/json" -o "$out/poly.tm" "$out/slabs.tm"
    [ "$(json "$out/json" regions)" -eq 4 ]
    [ "$(json "$out/json" polyhedra)" -lt 200 ]
    [ "$(header .cell "$out/poly.tm" | cut -d ' ' -f 2)" = 1 ]
    run -3 --separate-stderr polylla3d --partition=2 "$out/slabs.tm"
    [[ $stderr == *"has 1 attributes, but the partition is to be attribute 2"* ]]
    run -3 --separate-stderr polylla3d --partition sphere.tm
    for option in '--mode face' '--cells 5' --no-repair; do
        # shellcheck disable=SC2086 # words
        run -2 polylla3d --partition $option "$out/slabs.tm"
    done
}

# Another attribute for tetrahedra: in which quarter of the box their first node is.
slabs() {
    python3 - "$1" <<'END'
import sys
lines = open(sys.argv[1]).read().split('\n')
node, ele = lines.index('.node'), lines.index('.ele')
x = {row.split()[0]: float(row.split()[1]) for row in lines[node + 2:ele] if row and row[0] != '.'}
low, high = min(x.values()), max(x.values())
n, k, width = (int(word) for word in lines[ele + 1].split())
lines[ele + 1] = '%d %d %d' % (n, k, width + 1)
for t in range(ele + 2, ele + 2 + n):
    place = (x[lines[t].split()[1]] - low) / (high - low)
    lines[t] += ' %d' % min(3, int(4 * place))
print('\n'.join(lines))
END
}

@test "polyhedra are joined again: balls, or stars, and nothing is lost" {
    local mesh options
    for mesh in points sphere boxes ring grid; do
        polylla3d -q --star $mesh.tm >"$out/star.tm"
        while read -r options; do
            # shellcheck disable=SC2086 # words
            polylla3d -q --no-history $options --json "$out/json" "$out/star.tm" >"$out/poly.tm"
            python3 judge.py "$out/poly.tm" $mesh.tm simple
            [ "$(json "$out/json" polyhedra)" -le "$(json "$out/json" tets)" ]
            poly-stats --json "$out/stats" "$out/poly.tm" >"$out/table"
            [[ $options != *--star* || $(json "$out/stats" not_star_shaped) -eq 0 ]]
        done <<'END'

--cells 10
--size 0.7 --star
--star=0.02
END
    done
    # About an eighth, or as many as asked for; two regions stay two.
    polylla3d -q --mode edge points.tm >"$out/edge.tm"
    polylla3d -q --json "$out/json" "$out/edge.tm" >"$out/poly.tm"
    awk -v a="$(json "$out/json" tets)" -v b="$(json "$out/json" polyhedra)" \
        'BEGIN { exit !(b > a / 16 && b < a / 4) }'
    polylla3d -q --cells 50 --no-repair --json "$out/json" "$out/edge.tm" >"$out/poly.tm"
    [ "$(json "$out/json" polyhedra)" -eq 50 ]
    polylla3d -q boxes.tm | polylla3d -q --cells 1 | rows .cell /dev/stdin |
        awk '{ print $(3 + $2 + 1) }' | sort -u >"$out/regions"
    [ "$(tr '\n' ' ' <"$out/regions")" = '3 7 ' ]
    # Marked faces are between polyhedra, but for --ignore-markers.
    printf 'termesh 1\n.node\n5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0.3 0.3 0.5\n5 0.3 0.3 -0.5\n.ele\n2 4 0\n1 1 2 3 4\n2 1 3 2 5\n.face\n1 1\n1 1 2 3 8\n.end\n' |
        polylla3d -q >"$out/two.tm"
    [ "$(polylla3d -q --cells 1 "$out/two.tm" | header .cell /dev/stdin)" = '2 1' ]
    [ "$(polylla3d -q --cells 1 --ignore-markers "$out/two.tm" | header .cell /dev/stdin)" = '1 1' ]
}

@test "--levels: each polyhedron is the union of its children" {
    local mesh
    for mesh in points sphere boxes ring grid; do
        polylla3d -q --star --levels 3 --json "$out/json" -o "$out/levels.tm" $mesh.tm
        python3 - "$out/levels.tm" "$(json "$out/json" levels)" <<'END'
import collections, sys
blocks, lines = {}, iter(open(sys.argv[1]))
for line in lines:
    name = line.strip()
    if name.endswith(('.node', '.facet', '.cell')):
        blocks[name] = [next(lines).split() for _ in range(int(next(lines).split()[0]))]
base = int(blocks['.node'][0][0])
def volumes(part):
    xyz = [[float(x) for x in row[1:4]] for row in blocks[part + '.node']]
    volume = collections.Counter()
    for row in blocks[part + '.facet']:
        n = [xyz[int(v) - base] for v in row[4:4 + int(row[3])]]
        v = sum(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
                for a, b, c in ((n[0], n[i], n[i + 1]) for i in range(1, len(n) - 1))) / 6
        volume[int(row[1])] += v
        volume[int(row[2])] -= v if row[2] != '-1' else 0
    return volume
parts = [''] + ['level%d' % k for k in range(1, int(sys.argv[2]) + 1)]
assert len(parts) > 1 and parts[-1] + '.cell' in blocks
for child, parent in zip(parts, parts[1:]):
    below, above, sums = volumes(child), volumes(parent), collections.Counter()
    tets = collections.Counter()
    for row in blocks[child + '.cell']:
        sums[int(float(row[-1]))] += below[int(row[0])]
        tets[int(float(row[-1]))] += float(row[2 + int(row[1])])
    assert len(sums) == len(blocks[parent + '.cell']) < len(blocks[child + '.cell'])
    for row in blocks[parent + '.cell']:
        c = int(row[0])
        assert abs(sums[c] / above[c] - 1) < 1e-9 and tets[c] == float(row[2 + int(row[1])])
END
    done
    # Of polyhedra alone: they stay as they are, and what cannot go on is said.
    polylla3d -q --no-history sphere.tm >"$out/poly.tm"
    run -0 --separate-stderr polylla3d --levels 30 --json "$out/json" -o "$out/levels.tm" "$out/poly.tm"
    [[ $stderr == *"levels are all: on the last one nothing can be joined"* ]]
    diff <(rows .facet "$out/poly.tm") <(rows .facet "$out/levels.tm")
    # One ball in the end.
    [ "$(header "level$(json "$out/json" levels).cell" "$out/levels.tm")" = '1 1' ]
    # The levels before go where they are made again.
    polylla3d -q --levels 1 "$out/levels.tm" >"$out/again.tm"
    [ "$(grep -c '^level.*cell' "$out/again.tm")" -eq 1 ]
    [ "$(header .cell "$out/again.tm")" = "$(header .cell "$out/levels.tm")" ]
    # The parents are no regions: neither to others nor where it is joined again.
    [ "$(awk '$1 == ".cell" { getline; n = $1; next } n-- > 0 { print $(NF - 1) }' \
        "$out/levels.tm" | sort -u)" = 0 ]
    polylla3d -q --no-history "$out/levels.tm" >"$out/joined.tm"
    polylla3d -q --no-history "$out/poly.tm" >"$out/other.tm"
    diff <(rows .facet "$out/joined.tm") <(rows .facet "$out/other.tm")
    [ "$(header .cell "$out/joined.tm" | cut -d' ' -f1)" -lt "$(header .cell "$out/poly.tm" | cut -d' ' -f1)" ]
    [ "$(grep -c "^level" "$out/joined.tm")" -eq 0 ]
}

@test "the polyhedra do not depend on how the mesh is numbered" {
    local mesh options
    for mesh in points sphere boxes grid; do
        python3 "$BATS_TEST_DIRNAME/../bench/shuffle.py" 5 $mesh.tm "$out/other.tm"
        for options in '' --star '--star --absorb' '--cells 40 --star' '--mode face' '--mode edge' '--mode cavity'; do
            # shellcheck disable=SC2086 # words
            polylla3d -q --no-history $options $mesh.tm >"$out/1.tm"
            # shellcheck disable=SC2086
            polylla3d -q --no-history $options "$out/other.tm" >"$out/2.tm"
            python3 - "$out/1.tm" "$out/2.tm" <<'END'
import sys
def facets(path):
    blocks, lines = {}, iter(open(path))
    for line in lines:
        if line[0] == '.' and line.strip() != '.end':
            blocks[line.strip()] = [next(lines).split() for _ in range(int(next(lines).split()[0]))]
    place = {row[0]: tuple(row[1:4]) for row in blocks['.node']}
    base = int(blocks['.node'][0][0])
    return [(int(row[1]) - base, max(int(row[2]) - base, -1), [place[n] for n in row[4:4 + int(row[3])]]) for row in blocks['.facet']]
assert facets(sys.argv[1]) == facets(sys.argv[2])
END
        done
    done
}

@test "the same bytes for a file and a pipe" {
    polylla3d -q --no-history --star boxes.tm >"$out/1.tm"
    polylla3d -q --no-history --star <boxes.tm | cat | cmp "$out/1.tm" -
}

@test "the report counts what is written: tetrahedra, polyhedra, levels of both" {
    local from more
    for from in points.tm "$out/poly.tm"; do
        for more in '' '--levels 1' '--cells 20' '--cells 20 --levels 1'; do
            # shellcheck disable=SC2086 # words
            polylla3d -q $more --json "$out/json" -o "$out/made.tm" "$from"
            [ "$(json "$out/json" polyhedra)" -eq "$(header .cell "$out/made.tm" | cut -d ' ' -f 1)" ]
            [ "$(json "$out/json" facets)" -eq "$(header .facet "$out/made.tm" | cut -d ' ' -f 1)" ]
        done
        polylla3d -q -o "$out/poly.tm" points.tm
    done
}

@test "degenerate: nothing, one tetrahedron, a flat one, counted from 0" {
    run -0 --separate-stderr polylla3d --no-history <<<$'termesh 1\n.node\n0 3 0 0\n.ele\n0 4 0\n.end'
    [ "$(grep -c '^0' <<<"$output")" -eq 3 ]
    cat >"$out/flat.tm" <<'END'
termesh 1
.node
5 3 0 0
0 0 0 0
1 1 0 0
2 0 1 0
3 0 0 1
4 1 1 0
.ele
2 4 0
0 0 1 2 3
1 0 1 2 4
.end
END
    run -0 --separate-stderr polylla3d "$out/flat.tm"
    [[ $stderr == *"1 tetrahedra are flat"* ]]
    run -1 --separate-stderr polylla3d --star --mode edge "$out/flat.tm"
    [[ $stderr == *"1 polyhedra are no stars: flat tetrahedra"* ]]
    [ "${lines[-1]}" = .end ]
}

@test "wrong meshes are exit 3, wrong options exit 2" {
    local options head='termesh 1\n.node\n5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1\n'
    # shellcheck disable=SC2059 # the format is text
    printf "$head.ele\n2 4 0\n0 0 1 2 3\n1 0 1 2 4\n.end\n" >"$out/overlap.tm"
    run -3 --separate-stderr polylla3d "$out/overlap.tm"
    [ -z "$output" ]
    [[ $stderr == "polylla3d: $out/overlap.tm: .ele: tetrahedra 0 and 1 overlap"* ]]
    polylla3d -q points.tm >"$out/poly.tm"
    for options in --absorb '--mode face' --star=centroid --label; do
        # shellcheck disable=SC2086 # words
        run -3 --separate-stderr polylla3d $options "$out/poly.tm"
        [[ $stderr == *"other options are for tetrahedra"* ]]
    done
    while read -r options; do
        # shellcheck disable=SC2086 # words
        run -2 --separate-stderr polylla3d $options points.tm
        [ -z "$output" ]
        [[ ${stderr_lines[0]} == polylla3d:* ]]
    done <<'END'
--mode best
--face-metric area
--mode face --face-metric length
--no-repair --star
--no-repair --merge-coplanar
--label --merge-coplanar
--label --levels 2
--levels 0
--merge-coplanar=31
--max-tets 0
--nonsense
END
}

@test "--merge-coplanar leaves four facets to each polyhedron, and a stream that is read" {
    awk 'BEGIN { srand(5); print 1000, 3; for (i = 1; i <= 1000; i++) print i, rand(), rand(), rand() }' \
        >"$out/random.node"
    tetgen-mesh "$out/random.node" >"$out/random.tm"
    for degrees in '' =5 =10 =30; do
        polylla3d -q "--merge-coplanar$degrees" "$out/random.tm" >"$out/merged.tm"
        vtu-export -q "$out/merged.tm" >"$out/merged.vtu"
        # Stars stay stars, and volumes positive, where facets are not plane any more.
        polylla3d -q --star "--merge-coplanar$degrees" "$out/random.tm" >"$out/merged.tm"
        mesh-check -q "$out/merged.tm"
        poly-stats --json "$out/json" "$out/merged.tm" >"$out/table"
        [ "$(json "$out/json" not_star_shaped)" -eq 0 ]
    done
    printf "termesh 1\n.node\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n.ele\n1 4 0\n1 1 2 3 4\n.end\n" |
        polylla3d -q --merge-coplanar | vtu-export >"$out/flat.vtu"
}

# A grid of 4 x 4 x 4 cubes; the eight inside are those of two octants, four each.
two_octants() {
    python3 - <<'END'
n, m = 4, 5
node = lambda i, j, k: i + m * (j + m * k) + 1
cells = sorted(((i, j, k) for k in range(n) for j in range(n) for i in range(n)),
               key=lambda c: (not all(0 < x < n - 1 for x in c), c[2], c[1], c[0]))
print('termesh 1\n.node\n%d 3 0 0' % m ** 3)
for k in range(m):
    for j in range(m):
        for i in range(m):
            print(node(i, j, k), i, j, k)
print('.mix\n%d 1' % len(cells))
for e, (i, j, k) in enumerate(cells, 1):
    corners = [node(i + x, j + y, k + z) for z in (0, 1)
               for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    print(e, 8, *corners, 10 * k)
print('.root\n1 0\n1 0 0 0 4 2\n.octant\n3 0\n1 0 0 0 0 9 65\n2 1 0 0 0 1 5\n3 1 0 0 0 5 9\n.end')
END
}

@test "octants: polygons of facets in one plane, attributes, and what has none" {
    two_octants >"$out/two.tm"
    mesh-check -q "$out/two.tm"
    polylla3d -q --json "$out/json" "$out/two.tm" >"$out/poly.tm"
    mesh-check -q "$out/poly.tm"
    [ "$(json "$out/json" polyhedra)" = 58 ] # 56 cubes at the boundary
    [ "$(json "$out/json" facets_joined)" = 3 ]
    # four cubes each, with the attribute of their first one; eight nodes around one inside
    [ "$(rows .cell "$out/poly.tm" | awk '$(3 + $2) == 4 { print $(4 + $2) }' | paste -sd ' ')" = "10 20" ]
    [ "$(rows .facet "$out/poly.tm" | awk '$4 > 4 { print $4 }')" = 8 ]
    poly-stats -q --for fv --json "$out/stats" "$out/poly.tm" >"$out/table"
    [ "$(json "$out/stats" volume) $(json "$out/stats" swallowed_vertices)" = "64 1" ]
    run -3 --separate-stderr polylla3d <(sed '/^\.root/,$d' "$out/two.tm"; echo .end)
    [[ $stderr == *"has mixed elements, but no .octant that says which to join"* ]]
    run -3 --separate-stderr polylla3d --star "$out/two.tm"
    [[ $stderr == *"the options are for tetrahedra"* ]]
}

@test "octants: an octree's mesh becomes fewer cells that finite volumes can use" {
    local shape
    surface cube off >cube.off
    surface sphere off >sphere.off
    command -v octree-mesh >/dev/null || skip "there is no p4est"
    "$TM_BUILD/bench/shapes" gear 3 >gear.off
    for shape in cube sphere gear; do
        octree-mesh -q -s 4 $shape.off >"$out/mesh.tm"
        polylla3d -q --json "$out/json" "$out/mesh.tm" >"$out/poly.tm"
        mesh-check -q "$out/poly.tm"
        [ "$(json "$out/json" unfit)" = 0 ]
        cmp <(grep -v '^#' "$out/poly.tm") <(octree-mesh -q -s 4 --polyhedra $shape.off | grep -v '^#')
        poly-stats -q --for fv --json "$out/stats" "$out/poly.tm" >"$out/table"
        mesh-check --json "$out/mesh" "$out/mesh.tm" >"$out/table"
        python3 - "$out/mesh" "$out/stats" "$out/json" <<'END'
import json, sys
mesh, poly, run = (json.load(open(name)) for name in sys.argv[1:])
assert run["polyhedra"] == poly["polyhedra"] < 0.6 * mesh["elements"]
assert abs(poly["volume"] / mesh["volume"] - 1) < 1e-3 # facets of four nodes are bent
assert poly["largest_faces"] > 6 and poly["not_star_shaped"] == 0
END
        # All elements are in one, and the facets of the boundary are there.
        [ "$(rows .cell "$out/poly.tm" | awk '{ n += $(3 + $2) } END { print n }')" = \
            "$(header .mix "$out/mesh.tm" | cut -d ' ' -f 1)" ]
        [ "$(rows .facet "$out/poly.tm" | awk '$3 == -1' | wc -l)" = \
            "$(json "$out/mesh" boundary_faces)" ]
        openfoam-export -q "$out/foam" "$out/poly.tm"
        rm -rf "$out/foam"
    done
}
