# SPDX-License-Identifier: GPL-3.0-or-later
# lepp-improve: what it must keep, where it ends, what it says.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

setup_file() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    # Random points; two boxes, one on the other, as two regions with marked facets; a
    # sphere with a surface of its own.
    awk 'BEGIN {
        srand(7)
        print 300, 3, 1, 0
        for (i = 0; i < 300; i++) {
            x = rand(); y = rand(); z = rand()
            print i, x, y, z, 1 + x - 2 * y + 3 * z
        }
    }' >points.node
    two_boxes >boxes.poly
    tetgen-mesh --no-history points.node >points.tm
    tetgen-mesh --no-history -q1.6 -a 0.03 --switches A boxes.poly >boxes.tm
    surface sphere off | tetgen-mesh --no-history -q >sphere.tm
}

setup() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    out=$BATS_TEST_TMPDIR
}

# Prints what may not change: volume by region, area by marker, length by edge marker,
# what the attribute 1 + x - 2y + 3z is off by, where the mesh has such attributes.
invariants() {
    python3 - "$1" <<'END'
import collections, math, sys
lines = iter(open(sys.argv[1]))
blocks = {}
for line in lines:
    if line[0].isalpha() or line[0] == '.':
        name = line.strip()
        if name in ('.end', 'termesh 1'):
            continue
        head = [int(x) for x in next(lines).split()]
        blocks[name] = head, [[float(x) for x in next(lines).split()]
                              for _ in range(head[0])]
head, nodes = blocks['.node']
base = int(nodes[0][0])
xyz = [row[1:4] for row in nodes]
def sub(a, b): return [p - q for p, q in zip(a, b)]
def cross(a, b): return [a[1]*b[2]-a[2]*b[1], a[2]*b[0]-a[0]*b[2], a[0]*b[1]-a[1]*b[0]]
def dot(a, b): return sum(p * q for p, q in zip(a, b))
def of(row, n): return [xyz[int(i) - base] for i in row[1:1 + n]]
volume, area, length = (collections.defaultdict(float) for _ in range(3))
for row in blocks['.ele'][1]:
    a, b, c, d = of(row, 4)
    volume[tuple(row[5:])] += dot(cross(sub(b, a), sub(c, a)), sub(d, a)) / 6
for row in blocks.get('.face', ((), ()))[1]:
    a, b, c = of(row, 3)
    n = cross(sub(b, a), sub(c, a))
    area[tuple(row[4:])] += math.sqrt(dot(n, n)) / 2
for row in blocks.get('.edge', ((), ()))[1]:
    a, b = of(row, 2)
    length[tuple(row[3:])] += math.dist(a, b)
for name, sums in ('volume', volume), ('area', area), ('length', length):
    for key in sorted(sums):
        print(name, key, '%.9f' % sums[key])
if head[2]:
    worst = max(abs(r[4] - (1 + r[1] - 2 * r[2] + 3 * r[3])) for r in nodes)
    print('attribute', worst < 1e-5)
END
}

@test "invariants: every algorithm, measure and stop keeps volume, area, markers" {
    local mesh options
    for mesh in points boxes sphere; do
        invariants "$mesh.tm" >"$out/before"
        while read -r options; do
            # shellcheck disable=SC2086
            lepp-improve -q $options "$mesh.tm" >"$out/improved.tm" || [ $? = 1 ]
            invariants "$out/improved.tm" >"$out/after"
            diff "$out/before" "$out/after"
            mesh-check -q "$out/improved.tm"
        done <<'END'

-t 45 --max-growth 2
--max-growth 0.6
-Q volume
--ops smoothing,contraction,boundary-swap
--ops insertion,face-removal,edge-removal -s 3
-a selective
-a selective -m 1 -s original
-a selective -m 1.05 -s 2 -t 20
-a selective -Q volume -m 1.2
-a selective --path full
-a selective --with smooth
-a selective --with face-swap
-a selective --with both --path full
-a delaunay -t 20 --max-growth 4
-a swap-centroid
-a swap-centroid -s 2 -Q volume -t 15
-a bisection -t 20
-a centroid -t 25
-a wcentroid -t 25 -s 2
-a swap-centroid --path fixed
-a bisection --until-size 0.3 --max-growth 5
-a centroid --set box=0,0,0,0.5,0.5,0.5 --until-size 0.3 --max-growth 5
-a delaunay --set box=0,0,0,0.3,0.3,0.3 --until-size 0.3 --max-growth 4
-a selective --set box=0,0,0,0.3,0.3,0.3
--set box=0,0,0,0.5,0.5,0.5
-a selective --max-star 5 --max-growth 1.1
END
    done
}

@test "topology: mesh-check finds the same boundary and Euler number" {
    local mesh key options
    for mesh in points boxes sphere; do
        mesh-check --json "$out/before" "$mesh.tm" >"$out/text"
        for options in '-a improve' '-t 40 --max-growth 0.7' '-a selective -m 1'; do
            # shellcheck disable=SC2086 # words
            lepp-improve -q $options "$mesh.tm" >"$out/improved.tm" || [ $? = 1 ]
            mesh-check --json "$out/after" "$out/improved.tm" >"$out/text"
            for key in euler components open_edges non_manifold_edges inverted degenerate; do
                [ "$(json "$out/before" $key)" = "$(json "$out/after" $key)" ]
            done
        done
    done
}

@test "paths: nodes of the input stay where they are, and keep marker and attributes" {
    lepp-improve -q -a selective -m 1 boxes.tm >"$out/improved.tm"
    rows .node boxes.tm >"$out/before"
    rows .node "$out/improved.tm" | head -n "$(wc -l <"$out/before")" >"$out/after"
    cmp "$out/before" "$out/after"
    [ "$(rows .node "$out/improved.tm" | wc -l)" -gt "$(wc -l <"$out/before")" ]
}

@test "new boundary nodes have the marker of their facet, inner ones 0" {
    lepp-improve -q -a swap-centroid -s 2 -t 45 boxes.tm >"$out/improved.tm"
    rows .node "$out/improved.tm" | awk -v old="$(rows .node boxes.tm | wc -l)" '
        NR <= old { next }
        # In the plane between the boxes: 20; strictly inside a box: 0.
        $4 == 1 && $2 > 0 && $2 < 1 && $3 > 0 && $3 < 1 { plane++; if ($5 != 20) bad++ }
        $4 != 1 && $2 > 0 && $2 < 1 && $3 > 0 && $3 < 1 && $4 > 0 && $4 < 2 {
            inside++; if ($5 != 0) bad++
        }
        $4 == 0 && $2 > 0 && $2 < 1 && $3 > 0 && $3 < 1 { if ($5 != 11) bad++ }
        END { print plane + 0, inside + 0, bad + 0; exit bad > 0 || inside == 0 }'
}

@test "selective: better, and a second run on the output changes nothing and says so" {
    local mesh
    for mesh in points boxes sphere; do
        lepp-improve -a selective --json "$out/json" "$mesh.tm" >"$out/1.tm" 2>"$out/err"
        python3 - "$out/json" "$mesh" <<'END'
import json, sys
run = json.load(open(sys.argv[1]))
before, after = run["before"], run["after"]
assert after["bad_percent"] <= before["bad_percent"]
assert after["bad_percent"] < before["bad_percent"] or sys.argv[2] != "points"
assert after["min_dihedral"] >= before["min_dihedral"] - 1e-9
END
        lepp-improve -a selective --no-history "$out/1.tm" >"$out/2.tm" 2>"$out/err"
        cmp "$out/1.tm" "$out/2.tm"
        grep -q '^lepp-improve: nothing \(to improve\|found that helps\): ' "$out/err"
    done
}

@test "improve: fewer bad ones, no more extreme angle, no larger than is asked" {
    local mesh options growth
    for mesh in points boxes sphere; do
        while read -r growth options; do
            # shellcheck disable=SC2086 # words
            lepp-improve -q --json "$out/json" --max-growth $growth $options "$mesh.tm" \
                >"$out/1.tm"
            python3 - "$out/json" "$growth" "$options" <<'END'
import json, sys
run = json.load(open(sys.argv[1]))
before, after, growth = run["before"], run["after"], float(sys.argv[2])
words = sys.argv[3].split()
limit = float(words[words.index("-t") + 1]) if "-t" in words else 30
assert after["bad_percent"] * after["tets"] <= before["bad_percent"] * before["tets"]
assert after["min_dihedral"] >= min(before["min_dihedral"], limit)
assert after["max_dihedral"] <= max(before["max_dihedral"], 180 - limit)
assert after["tets"] <= growth * before["tets"]
assert abs(after["volume"] / before["volume"] - 1) < 1e-12
END
        done <<'END'
1
1.5 -t 45
3 -s 2
3 -t 20 -s converged
4 --ops insertion
1.2 --ops edge-removal,smoothing
0.9
END
    done
    # At half of its size it is still good; where there are no nodes to remove, that is said.
    [ "$(lepp-improve -q --max-growth 0.5 points.tm | header .ele /dev/stdin |
        cut -d ' ' -f 1)" -le $(($(header .ele points.tm | cut -d ' ' -f 1) / 2)) ]
    run --separate-stderr lepp-improve --max-growth 0.01 points.tm
    [ "$status" -eq 1 ]
    [ "${lines[-1]}" = .end ]
    [[ $stderr == *"could not be made as small as --max-growth says"* ]]
}

# Prints a grid of bricks of 1 x 1 x $1, 5 or $2 along each side, each cut into 6
# tetrahedra.
bricks() {
    awk -v height="$1" -v n="${2:-5}" 'BEGIN {
        m = n + 1
        print "termesh 1\n.node"
        print m * m * m, 3, 0, 0
        for (i = 0; i < m * m * m; i++)
            print i, i % m, int(i / m) % m, height * int(i / m / m)
        print ".ele"
        print 6 * n * n * n, 4, 0
        split("0137 0327 0267 0647 0457 0517", tet, " ")
        for (z = 0; z < n; z++) for (y = 0; y < n; y++) for (x = 0; x < n; x++)
            for (k = 1; k <= 6; k++) {
                row = t++
                for (i = 1; i <= 4; i++) {
                    c = substr(tet[k], i, 1)
                    row = row " " ((z + int(c / 4)) * m + y + int(c / 2) % 2) * m + x + c % 2
                }
                print row
            }
        print ".end"
    }'
}

# Points in a slab of that thickness, joined to tetrahedra.
slab() {
    awk -v height="$1" 'BEGIN {
        srand(3)
        print 80, 3
        for (i = 0; i < 80; i++) print i, rand(), rand(), height * rand()
    }' | tetgen-mesh --no-history
}

@test "improve: never worse than the input, and than a part of the operations by far" {
    local mesh options
    bricks 0.5 3 >"$out/bricks.tm"
    bricks 0.05 3 >"$out/flat.tm"
    slab 0.03 >"$out/slab.tm"
    slab 0.01 >"$out/thin.tm"
    for mesh in "$out"/{bricks,flat,slab,thin}.tm points.tm; do
        while read -r options; do
            # shellcheck disable=SC2086 # words
            lepp-improve -q --json "$out/json" $options "$mesh" >"$out/1.tm"
            python3 - "$out/json" "$options" <<'END'
import json, sys
run, words = json.load(open(sys.argv[1])), sys.argv[2].split()
before, after = run["before"], run["after"]
limit = float(words[words.index("-t") + 1]) if "-t" in words else 30
assert after["bad_percent"] <= before["bad_percent"]
assert after["bad_percent"] * after["tets"] <= before["bad_percent"] * before["tets"] + 1e-6
assert after["min_dihedral"] >= min(before["min_dihedral"], limit) - 1e-9
assert after["max_dihedral"] <= max(before["max_dihedral"], 180 - limit) + 1e-9
END
        done <<'END'

-t 20
-t 45
-t 60
-Q volume
-t 60 -Q volume --max-growth 1
--ops contraction
--ops contraction,smoothing -t 60
--ops insertion,face-removal
END
    done
    # Contraction does not take away what is good, nor does moving nodes close ways.
    for mesh in slab thin; do
        lepp-improve -q --json "$out/all" "$out/$mesh.tm" >"$out/1.tm"
        for options in edge-removal,boundary-swap,face-removal,smoothing,insertion \
            edge-removal,boundary-swap,face-removal,contraction,insertion; do
            lepp-improve -q --json "$out/some" "$out/$mesh.tm" --ops "$options" >"$out/1.tm"
            python3 - "$out/all" "$out/some" <<'END'
import json, sys
full, part = (json.load(open(name)) for name in sys.argv[1:])
assert full["after"]["tets"] > 0.5 * full["before"]["tets"]
assert full["after"]["bad_percent"] <= part["after"]["bad_percent"] + 1
END
        done
    done
    bricks 0.5 | lepp-improve -q --json "$out/json" >"$out/1.tm"
    [ "$(json "$out/json" after bad_percent | cut -d . -f 1)" -lt 5 ]
}

@test "improve: of a grid that is too fine in one direction whole layers go" {
    local height
    for height in 0.05 8 20; do
        bricks "$height" >"$out/bricks.tm"
        lepp-improve -q --json "$out/json" "$out/bricks.tm" >"$out/better.tm"
        mesh-check -q --against "$out/bricks.tm" --within 0 "$out/better.tm"
        tet-stats --json "$out/stats" "$out/better.tm" >"$out/table"
        python3 - "$out/json" "$out/stats" "$height" <<'END'
import json, sys
run, stats = (json.load(open(name)) for name in sys.argv[1:3])
assert run["after"]["bad_percent"] <= 10
assert run["after"]["min_dihedral"] > run["before"]["min_dihedral"]
assert run["after"]["max_dihedral"] <= 150
assert abs(stats["volume"] / (125 * float(sys.argv[3])) - 1) < 1e-12
END
    done
}

@test "what is bad and stays so is told from what is not bad" {
    bricks 0.5 >"$out/bricks.tm"
    run --separate-stderr lepp-improve --ops boundary-swap -t 20 "$out/bricks.tm"
    [[ $stderr == "lepp-improve: nothing to improve: 750 tetrahedra, 0.00% bad" ]]
    run --separate-stderr lepp-improve --ops boundary-swap "$out/bricks.tm"
    [[ $stderr == "lepp-improve: nothing found that helps: 750 tetrahedra, 66.67% bad; 500 bad left, "*" forced by the surface" ]]
    [[ ${lines[1]} == "# lepp-improve "*": nothing found that helps: "* ]]
}

@test "improve: where nothing is bad nothing changes; JSON tells what was done" {
    lepp-improve -q boxes.tm >"$out/1.tm"
    run --separate-stderr lepp-improve --no-history --json "$out/json" "$out/1.tm"
    [[ $stderr == "lepp-improve: nothing to improve: "*" 0.00% bad" ]]
    lepp-improve -q --no-history "$out/1.tm" | cmp - "$out/1.tm"
    lepp-improve -q --json "$out/json" points.tm >"$out/2.tm"
    python3 - "$out/json" <<'END'
import json, sys
run = json.load(open(sys.argv[1]))
done, nodes = run["operations"], run["nodes"]
assert done["edge_removals"] > 0 and done["face_removals"] > 0 and done["moves"] > 0
assert run["tried"]["moves"] >= done["moves"] and run["passes"] > 1
assert sum(nodes.values()) == run["before"]["nodes"]
assert nodes["inside"] > 0 and nodes["fixed"] > 0
added = done["insertions"] - done["contractions"] - done["swallowed_nodes"]
assert run["after"]["nodes"] == run["before"]["nodes"] + added
END
    run --separate-stderr lepp-improve --ops list
    [ "${#lines[@]}" -eq 8 ]
    [ "${lines[-1]}" = reconnection ]
    for op in "${lines[@]}"; do
        grep -q "^\.It Cm $op\$" "$BATS_TEST_DIRNAME/../../man/lepp-improve.1"
        lepp-improve --ops "$op" --surface-tolerance 0.001 points.tm >/dev/null
    done
    lepp-improve -q --ops "$(lepp-improve --ops list | paste -sd ,)" --no-history points.tm |
        cmp - <(lepp-improve -q --no-history points.tm)
}

# A wedge of so many degrees, three prisms long.
wedge() {
    awk -v degrees="$1" 'BEGIN {
        angle = degrees * atan2(0, -1) / 180
        print "termesh 1\n.node\n12 3 0 0"
        for (k = 0; k < 4; k++) {
            print 3 * k, 0, 0, k / 6
            print 3 * k + 1, 1, 0, k / 6
            printf "%d %.17g %.17g %.17g\n", 3 * k + 2, cos(angle), sin(angle), k / 6
        }
        print ".ele\n9 4 0"
        for (k = 0; k < 3; k++) {
            b = 3 * k
            print b, b, b + 1, b + 2, b + 5
            print b + 1, b, b + 1, b + 5, b + 4
            print b + 2, b, b + 4, b + 5, b + 3
        }
        print ".end"
    }'
}

@test "forced: all that is bad in a wedge of 10 degrees, nothing in a cube" {
    wedge 10 >"$out/wedge.tm"
    run --separate-stderr lepp-improve --json "$out/json" "$out/wedge.tm"
    python3 - "$out/json" "$stderr" <<'END'
import json, sys
run = json.load(open(sys.argv[1]))
forced = run["forced"]
bad = forced["bad"]
assert bad == forced["tets"] > 0
assert bad == round(run["after"]["bad_percent"] * run["after"]["tets"] / 100)
assert sys.argv[2].endswith("; %d bad left, %d forced by the surface" % (bad, bad))
assert sum(s["tets"] for s in forced["sectors"]) >= bad
for s in forced["sectors"]:
    assert abs(s["degrees"] - 10) < 1e-9
    assert s["midpoint"][:2] == [0, 0] and 0 < s["midpoint"][2] < 0.5
END
    # As many for every limit above that, none for one below.
    lepp-improve -q -t 9 --json "$out/json" "$out/wedge.tm" >"$out/1.tm"
    [ "$(python3 -c 'import json, sys
print(json.load(open(sys.argv[1]))["forced"])' "$out/json")" = \
        "{'bad': 0, 'tets': 0, 'sectors': []}" ]
    # Where much is bad but nothing is forced.
    surface cube off | tetgen-mesh --no-history -q >"$out/cube.tm"
    run --separate-stderr lepp-improve -t 60 --json "$out/json" "$out/cube.tm"
    [[ $stderr == *" bad left, 0 forced by the surface" ]]
    run --separate-stderr lepp-improve --json "$out/json" "$out/cube.tm"
    [[ $stderr != *"forced by"* ]]
}

@test "the worst: with reconnection and lower limits no angle and no count is worse" {
    local options
    while read -r options; do
        # shellcheck disable=SC2086 # words
        lepp-improve -q $options --json "$out/json" points.tm >"$out/1.tm"
        python3 - "$out/json" <<'END'
import json, sys
run = json.load(open(sys.argv[1]))
before, after = run["before"], run["after"]
assert after["min_dihedral"] >= before["min_dihedral"]
assert after["max_dihedral"] <= before["max_dihedral"]
assert after["bad_percent"] * after["tets"] <= before["bad_percent"] * before["tets"]
END
        mesh-check -q "$out/1.tm"
    done <<'END'
-t 10
-t 10 -s converged
-t 20 --ops reconnection
-t 15 --ops reconnection,smoothing
-t 10 --max-growth 1 -s converged
END
    # It does something.
    lepp-improve -q -t 20 --ops reconnection --json "$out/json" points.tm >"$out/1.tm"
    [ "$(python3 -c 'import json, sys
print(json.load(open(sys.argv[1]))["operations"]["reconnections"] > 0)' "$out/json")" = True ]
}

@test "delaunay: every face of the result is, by exact fractions" {
    lepp-improve -q -a delaunay -t 25 --json "$out/json" points.tm >"$out/improved.tm"
    python3 - "$out/improved.tm" "$out/json" <<'END'
import json, sys
from fractions import Fraction
lines = iter(open(sys.argv[1]))
block = {}
for line in lines:
    if line[0] == '.' and line.strip() != '.end':
        count = int(next(lines).split()[0])
        block[line.strip()] = [next(lines).split() for _ in range(count)]
base = int(block['.node'][0][0])
xyz = [[Fraction(float(x)) for x in row[1:4]] for row in block['.node']]
tets = [[int(n) - base for n in row[1:5]] for row in block['.ele']]
def det(m):
    if len(m) == 1:
        return m[0][0]
    return sum((-1) ** j * m[0][j] * det([r[:j] + r[j+1:] for r in m[1:]])
               for j in range(len(m)) if m[0][j])
def inside(tet, e):
    rows = []
    for n in tet:
        d = [a - b for a, b in zip(xyz[n], xyz[e])]
        rows.append(d + [sum(x * x for x in d)])
    return det(rows)
at = {}
for t, tet in enumerate(tets):
    for i in range(4):
        at.setdefault(tuple(sorted(tet[:i] + tet[i+1:])), []).append((t, tet[i]))
inner = [pair for pair in at.values() if len(pair) == 2]
# The sign of the determinant inside: that of a node in the middle of the first one.
xyz.append([sum(xyz[n][k] for n in tets[0]) / 4 for k in range(3)])
sign = 1 if inside(tets[0], len(xyz) - 1) > 0 else -1
wrong = sum(sign * inside(tets[t], apex) > 0 for (t, _), (_, apex) in inner)
assert wrong == 0, wrong
run = json.load(open(sys.argv[2]))
assert run["delaunay"]["wrong_faces_before"] == run["delaunay"]["wrong_faces_after"] == 0
assert run["operations"]["boundary_midpoints"] + run["operations"]["midpoints"] > 0
END
    # A mesh that is not Delaunay is worked on all the same, and that is said.
    lepp-improve -q boxes.tm >"$out/not.tm"
    run --separate-stderr lepp-improve -a delaunay -t 40 "$out/not.tm"
    [ "$status" -eq 0 ]
    [[ $stderr == *"the mesh is not Delaunay: "* ]]
}

@test "paths: all branches find no fewer stars, sweeps make the mesh better" {
    lepp-improve -q -a selective -s original --json "$out/simple" points.tm >"$out/1.tm"
    lepp-improve -q -a selective -s original --path full --json "$out/full" points.tm \
        >"$out/2.tm"
    lepp-improve -q -a selective --with both --json "$out/with" points.tm >"$out/3.tm"
    python3 - "$out/simple" "$out/full" "$out/with" <<'END'
import json, sys
simple, full, swept = (json.load(open(name)) for name in sys.argv[1:])
def mean(run): return run["stars"]["visits"] / run["targets"]
assert mean(full) >= mean(simple)
assert sum(full["stars"]["branches"]) == full["targets"]
assert "branches" not in simple["stars"] and "smoothing" not in simple
for key, what in ("smoothing", "moved"), ("face_swaps", "swapped"):
    sweep = swept[key]
    assert 0 < sweep[what] == sum(sweep["by_sweep"]) <= sweep["tried"]
    assert sweep["sweeps"] == swept["passes"]
assert swept["after"]["min_dihedral"] >= swept["before"]["min_dihedral"]
assert swept["after"]["max_dihedral"] <= swept["before"]["max_dihedral"]
END
}

@test "swap-centroid: all of the original bad tetrahedra are gone" {
    lepp-improve -q -a swap-centroid --json "$out/json" points.tm >"$out/improved.tm"
    tet-stats --list points.tm | awk '$2 < 30 || $3 > 150 { print $1 }' >"$out/bad"
    rows .ele points.tm | awk 'NR == FNR { bad[$1]; next } $1 in bad' "$out/bad" - |
        awk '{ split($0, v, " "); n = 0; for (i = 2; i <= 5; i++) a[i] = v[i] + 0
               for (i = 2; i <= 5; i++) for (j = i + 1; j <= 5; j++) if (a[j] < a[i]) {
                   t = a[i]; a[i] = a[j]; a[j] = t }
               print a[2], a[3], a[4], a[5] }' | sort >"$out/bad.nodes"
    rows .ele "$out/improved.tm" |
        awk '{ for (i = 2; i <= 5; i++) a[i] = $i + 0
               for (i = 2; i <= 5; i++) for (j = i + 1; j <= 5; j++) if (a[j] < a[i]) {
                   t = a[i]; a[i] = a[j]; a[j] = t }
               print a[2], a[3], a[4], a[5] }' | sort >"$out/nodes"
    [ -s "$out/bad.nodes" ]
    [ "$(comm -12 "$out/bad.nodes" "$out/nodes" | wc -l)" -eq 0 ]
}

@test "the same bytes for one thread and for two, and for a pipe" {
    local algorithm
    for algorithm in improve selective; do
        lepp-improve -q -a $algorithm --no-history -j 1 points.tm >"$out/1.tm"
        lepp-improve -q -a $algorithm --no-history -j 2 points.tm >"$out/2.tm"
        lepp-improve -q -a $algorithm --no-history <points.tm | cat >"$out/3.tm"
        cmp "$out/1.tm" "$out/2.tm"
        cmp "$out/1.tm" "$out/3.tm"
    done
}

@test "a larger factor makes a smaller mesh" {
    local m size last=1000000
    for m in 1 1.1 1.5; do
        size=$(lepp-improve -q -a selective -m $m points.tm | header .ele /dev/stdin | cut -d ' ' -f 1)
        [ "$size" -lt "$last" ]
        last=$size
    done
}

@test "TetGen reads the result: the same tetrahedra, and the same boundary" {
    lepp-improve -q points.tm >"$out/improved.tm"
    tetgen-export "$out/improved" "$out/improved.tm"
    mesh-check --json "$out/json" "$out/improved.tm" >"$out/text"
    run tetgen -rNEF "$out/improved.ele"
    [ "$status" -eq 0 ]
    [[ $output == *"Mesh tetrahedra: $(json "$out/json" elements)"$'\n'* ]]
    [[ $output == *"Mesh points: $(json "$out/json" nodes)"$'\n'* ]]
}

@test "the history tells what was done; parts pass, unknown blocks of the main mesh go" {
    sed '$d' points.tm >"$out/in.tm"
    cat >>"$out/in.tm" <<'END'
surface.node
1 3 0 0
0 1 2 3
.neighbours
0 1 2 3 4
.end
END
    run --separate-stderr lepp-improve -t 33 "$out/in.tm"
    [ "$status" -eq 0 ]
    [[ ${lines[1]} == "# lepp-improve "*" -t33 $out/in.tm: "*"% bad; "* ]]
    [[ $output == *surface.node* ]]
    [[ $output != *.neighbours* ]]
    [[ $stderr == *"the block .neighbours, as the tetrahedra have other numbers now: left out"* ]]
    run -3 lepp-improve --strict -t 33 -o "$out/strict.tm" "$out/in.tm"
    [ ! -e "$out/strict.tm" ]
    # Where nothing changes, nothing goes.
    run --separate-stderr lepp-improve --strict -t 0 "$out/in.tm"
    [[ $output == *.neighbours* ]]
}

@test "JSON: operations and stars add up" {
    lepp-improve -q -a selective --json "$out/json" points.tm >"$out/improved.tm"
    python3 - "$out/json" <<'END'
import json, sys
run = json.load(open(sys.argv[1]))
stars, done = run["stars"], run["operations"]
refused = stars["refused"]
assert sum(stars["sizes"]["closed"]) == stars["closed"] > 0
assert sum(stars["sizes"]["open"]) == stars["open"] > 0
assert sum(done.values()) + refused["closed"] + refused["open"] \
    == stars["closed"] + stars["open"]
assert sum(stars["visited"]) == run["targets"]
assert stars["visits"] >= sum(i * n for i, n in enumerate(stars["visited"]))
assert sum(stars["sizes"]["swapped"]) == done["edge_removals"] > 0
assert run["seconds"] >= 0 and run["passes"] >= 1
assert set(run["before"]) == set(run["after"])
END
    run --separate-stderr lepp-improve -q --json - points.tm
    [ "${stderr:0:1}" = '{' ]
    [ "${lines[0]}" = 'termesh 1' ]
}

@test "degenerate: none, one, flat, left-handed, duplicate and unused nodes" {
    printf 'termesh 1\n.node\n0 3 0 0\n.ele\n0 4 0\n.end\n' >"$out/none.tm"
    lepp-improve -q --no-history "$out/none.tm" | cmp - "$out/none.tm"
    cat >"$out/one.tm" <<'END'
termesh 1
.node
7 3 0 0
1 0 0 0
2 9 0 0
3 0 1 0
4 0 0 1
5 5 5 5
6 0 0 0
7 9 0 0
.ele
1 4 0
1 1 2 3 4
.end
END
    lepp-improve -q --no-history "$out/one.tm" | cmp - "$out/one.tm"
    sed 's/^1 1 2 3 4/1 1 3 2 4/' "$out/one.tm" >"$out/left.tm"
    run --separate-stderr lepp-improve --no-history "$out/left.tm"
    [ "$status" -eq 0 ]
    [[ $stderr == *"1 tetrahedra were left-handed and are turned"* ]]
    [[ $output == *"1 1 3 4 2"* ]]
    sed 's/^4 0 0 1/4 1 1 0/' "$out/one.tm" >"$out/flat.tm"
    run --separate-stderr lepp-improve --no-history "$out/flat.tm"
    [ "$status" -eq 0 ]
    [[ $stderr == *"1 tetrahedra are flat"* ]]
    [[ $output == *"1 1 2 3 4"* ]]
}

@test "wrong meshes are exit 3, with the block and the numbers of the file" {
    local head='termesh 1\n.node\n5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1\n'
    printf "$head.ele\n2 4 0\n0 0 1 2 3\n1 0 1 2 4\n.end\n" >"$out/overlap.tm"
    run --separate-stderr lepp-improve "$out/overlap.tm"
    [ "$status" -eq 3 ]
    [ -z "$output" ]
    [[ $stderr == "lepp-improve: $out/overlap.tm: .ele: tetrahedra 0 and 1 overlap"* ]]
    printf "$head.ele\n1 4 0\n0 0 1 2 2\n.end\n" | {
        run --separate-stderr lepp-improve
        [ "$status" -eq 3 ]
        [[ $stderr == "lepp-improve: <stdin>: .ele: tetrahedron 0 names a node twice" ]]
    }
    printf "$head.ele\n1 4 0\n0 0 1 2 9\n.end\n" | {
        run --separate-stderr lepp-improve
        [ "$status" -eq 3 ]
        [[ $stderr == "lepp-improve: <stdin>:11: .ele: node 9 is out of range (0..4)" ]]
    }
}

@test "usage errors are exit 2 and say what would be right" {
    local options
    while read -r options; do
        # shellcheck disable=SC2086
        run --separate-stderr lepp-improve $options points.tm
        [ "$status" -eq 2 ]
        [ -z "$output" ]
        [[ ${stderr_lines[0]} == lepp-improve:* ]]
    done <<'END'
-a nonsense
-a selective -m 0.9
-a selective -m x
-m 1.1
--ops nonsense
--ops smoothing,,insertion
--ops
--path full
--max-star 5
--with smooth
-s original
--max-growth 0
--max-growth -1
-a selective --ops smoothing
-a selective --max-growth 0.9
-a selective --path wide
-a selective --with all
-a centroid --with smooth
-a delaunay -s converged
-t 91
-Q shape
-s sometimes
-s 0
-a swap-centroid -s converged
-a swap-centroid -m 1.1
-a bisection -s converged
-a selective --max-star 0
-j 0
--nonsense
points.tm
END
}

@test "exit 4 for a missing file and a full disk, and -o leaves nothing half done" {
    run --separate-stderr lepp-improve "$out/missing.tm"
    [ "$status" -eq 4 ]
    [[ $stderr == *"missing.tm: cannot open"* ]]
    if [ -w /dev/full ]; then
        run --separate-stderr bash -c 'lepp-improve -q points.tm >/dev/full'
        [ "$status" -eq 4 ]
    fi
    run lepp-improve -o "$out/new.tm" "$out/missing.tm"
    [ ! -e "$out/new.tm" ]
    lepp-improve -q -o "$out/new.tm" points.tm
    [ "$(tail -n 1 "$out/new.tm")" = .end ]
    [ "$(find "$out" -name 'new.tm*' | wc -l)" -eq 1 ]
    lepp-improve -q --no-history -o "$out/new.tm" "$out/new.tm"
    [ "$(tail -n 1 "$out/new.tm")" = .end ]
}

# Angles of 1e-7 degrees are rounded so that a move to the same place may seem a gain.
@test "selective with sweeps ends on needles" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    for seed in 1 2 3 4 5 6 7 8 9 10; do
        awk -v seed=$seed 'BEGIN { srand(seed); print 40, 3
            for (i = 0; i < 40; i++) {
                if (i % 10 == 0) { x = rand(); y = rand(); z = rand() }
                printf "%d %.17g %.17g %.17g\n", i + 1, x + 1e-7 * rand(), y + 1e-7 * rand(), z + 1e-7 * rand()
            } }' >clusters.node
        tetgen-mesh --quiet -o clusters.tm clusters.node
        for sweeps in smooth face-swap both; do
            lepp-improve -q -a selective --with $sweeps -s 2000 --json report -o /dev/null clusters.tm
            [ "$(sed -n 's/.*"passes": *\([0-9]*\).*/\1/p' report)" -lt 2000 ]
        done
    done
}
