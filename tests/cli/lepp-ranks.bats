# SPDX-License-Identifier: GPL-3.0-or-later
# lepp-improve under a launcher gives the bytes and the status that it gives without one.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

setup_file() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    tetrahedra 600 >points.tm
}

setup() {
    load helpers
    load ranks
    need_mpirun
    cd "$BATS_FILE_TMPDIR" || exit
    out=$BATS_TEST_TMPDIR
}

# Prints the tetrahedra of so many random points in the unit cube.
tetrahedra() {
    awk -v n="$1" 'BEGIN {
        srand(3)
        print n, 3, 0, 0
        for (i = 1; i <= n; i++)
            print i, rand(), rand(), rand()
    }' | tetgen-mesh --no-history -
}

# Prints N^3 cubes of six tetrahedra each, as a mesh can be that ranks have trouble with: in
# a random order, half of them left-handed; two regions; cubes that only touch at edges and
# at nodes; rows of .face on the boundary and inside, with and without markers, and of
# .edge; attributes and markers of nodes; nodes that no tetrahedron has; and with "flat"
# flat ones, else nodes that are shaken.
troubled_cubes() {
    python3 - "$@" <<'END'
import itertools, random, sys
n, flat = int(sys.argv[1]), len(sys.argv) > 2
random.seed(n)
def node(p): return p[0] + (n + 1) * (p[1] + (n + 1) * p[2])
def place(p):
    by = [0, 0, 0]
    if flat:
        inside = 0 < min(p) and max(p) < n and {c % 4 for c in p} == {2}
        by = [1, .5, .5] if inside and random.random() < .6 else by
    else:
        by = [random.uniform(-.14, .14) if 0 < c < n and c != n // 2 else 0 for c in p]
    return [(c + b) / n for c, b in zip(p, by)]
points = [place((x, y, z)) for z, y, x in itertools.product(range(n + 1), repeat=3)]
points += [[random.uniform(-.2, 1.2) for _ in range(3)] for _ in range(40)]
name = list(range(len(points)))
random.shuffle(name)
tets = []
for z, y, x in itertools.product(range(n), repeat=3):
    if x >= n - 3 and (x + y) % 2 == 0 or x == 0 and (y + z) % 2:
        continue
    for axes in itertools.permutations(range(3)):
        p = [x, y, z]
        t = [node(p)]
        for a in axes:
            p[a] += 1
            t.append(node(p))
        random.shuffle(t)
        tets.append([name[v] for v in t] + [1 + (z >= n // 2), 0])
random.shuffle(tets)
sides, edges = {}, set()
for t in tets:
    for i in range(4):
        f = tuple(sorted(t[:i] + t[i + 1:4]))
        sides[f] = sides.get(f, 0) + 1
    edges |= {tuple(sorted(e)) for e in itertools.combinations(t[:4], 2)}
def some(rows, chances, markers):
    rows = [list(r) + [random.choice(markers(r))] for r in sorted(rows)
            if random.random() < chances(r)]
    random.shuffle(rows)
    return rows
faces = some(sides, lambda f: .7 if sides[f] == 1 else .008,
             lambda f: (0, 1, 1, 2) if sides[f] == 1 else (0, 5))
edges = some(edges, lambda e: .01, lambda e: (0, 0, 3))
rows = [None] * len(points)
for p, v in zip(points, name):
    rows[v] = p + [2 * p[0], p[1] * p[2], 7 * (random.random() < .01)]
print('termesh 1')
for header, block in (('.node\n%d 3 2 1', rows), ('.ele\n%d 4 2', tets),
                      ('.face\n%d 1', faces), ('.edge\n%d 1', edges)):
    print(header % len(block))
    for i, row in enumerate(block):
        print(i, *row)
print('.end')
END
}

@test "a small mesh" {
    lepp-improve points.tm >"$out/one.tm"
    for n in 1 3; do
        on_ranks "$n" lepp-improve points.tm >"$out/ranks.tm"
        cmp "$out/one.tm" "$out/ranks.tm"
    done
    lepp-improve --no-history points.tm >"$out/one.tm"
    on_ranks 2 lepp-improve --no-history -o "$out/file.tm" points.tm
    cmp "$out/one.tm" "$out/file.tm"
    on_ranks 2 lepp-improve --no-history <points.tm >"$out/ranks.tm"
    cmp "$out/one.tm" "$out/ranks.tm"
}

@test "what rank 0 does alone" {
    for options in "-a selective" "--surface-tolerance 0.01" "--max-growth 0.8" \
        "--set box=0,0,0,0.5,0.5,0.5" "-a bisection --until-size 0.5"; do
        # shellcheck disable=SC2086 # options and their arguments
        lepp-improve $options points.tm >"$out/one.tm"
        # shellcheck disable=SC2086
        on_ranks 2 lepp-improve $options points.tm >"$out/ranks.tm"
        cmp "$out/one.tm" "$out/ranks.tm"
    done
    lepp-improve --json="$out/one.json" points.tm >/dev/null
    on_ranks 2 lepp-improve --json="$out/ranks.json" points.tm >/dev/null
    for name in one ranks; do
        sed 's/"seconds": [^,]*,//' "$out/$name.json" >"$out/$name.txt"
    done
    cmp "$out/one.txt" "$out/ranks.txt"
}

# same_in_parts TETS MESH [RANKS [nodes]]: improved in parts of so many, by ranks and by
# one; nodes: those that may move are counted, too.
same_in_parts() {
    local small=$TM_BUILD/ranks/improve_small
    : >"$out/one.tm"
    "$small" "$1" "$2" "$out/one.tm" ${4:+"$4"} >"$out/one.txt"
    cat "$out/one.txt"
    for n in ${3:-1 2 3 4 7}; do
        : >"$out/ranks.tm"
        on_ranks "$n" "$small" "$1" "$2" "$out/ranks.tm" ${4:+"$4"} >"$out/ranks.txt"
        diff "$out/one.txt" "$out/ranks.txt"
        cmp "$out/one.tm" "$out/ranks.tm"
    done
}

@test "parts of a mesh with regions, rows of all kinds and edges where it touches itself" {
    troubled_cubes 10 >"$out/cubes.tm"
    same_in_parts 400 "$out/cubes.tm"
    grep -v ' 0 turned\| 0 dropped\| 0 locked\| 0 operations' "$out/one.txt"
    grep -c . "$out/ranks.tm"
}

@test "parts of a mesh with flat tetrahedra, and what is said of nodes without markers" {
    troubled_cubes 8 flat | awk '/^\.ele/ { past = 1 } NF == 7 && !past { $7 = 0 } { print }' >"$out/cubes.tm"
    same_in_parts 400 "$out/cubes.tm" "2 3" nodes
    grep -v ' 0 flat' "$out/one.txt"
}

@test "what the surface forces, in the order of one process" {
    troubled_cubes 5 | awk '/^\.ele/ { past = 1 } NF == 7 && !past { $7 = 0; $2 += 2.5 * $4 } { print }' >"$out/sheared.tm"
    same_in_parts 150 "$out/sheared.tm" "3" nodes
    grep '"sectors": \[{' "$out/one.txt"
}

@test "more ranks than parts, and a tetrahedron alone" {
    same_in_parts 100000 points.tm "3"
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' \
        .ele '1 4 0' '1 1 2 3 4' .end >"$out/one-tet.tm"
    same_in_parts 10 "$out/one-tet.tm" "2"
}

@test "errors are said once, and no file is left" {
    sed '/^\.ele/,$d' points.tm >"$out/cut.tm"
    status_of_one=0
    lepp-improve "$out/cut.tm" >/dev/null 2>"$out/one.txt" || status_of_one=$?
    [ "$status_of_one" -gt 0 ]
    run --separate-stderr on_ranks 3 lepp-improve -o "$out/none.tm" "$out/cut.tm"
    [ "$status" -eq "$status_of_one" ]
    [ "$(grep -c '^lepp-improve: ' <<<"$stderr")" -eq 1 ]
    [ ! -e "$out/none.tm" ]
}
