# SPDX-License-Identifier: GPL-3.0-or-later
# polylla3d with every set of options on every kind of mesh: 28 meshes, 18 sets. What it makes
# is what mesh-check finds nothing wrong with, but for what it finds in the tetrahedra, and no
# region has lost or gained volume.

bats_require_minimum_version 1.5.0

setup_file() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    cat >meshes.py <<'END'
"""Writes the meshes as NAME.tm, and NAME.node of points that are to be joined."""
import itertools, random
rng = random.Random(7)
def points(name, xyz):
    with open(name + '.node', 'w') as f:
        print(len(xyz), 3, file=f)
        for i, p in enumerate(xyz, 1):
            print(i, *map(repr, p), file=f)
def mesh(name, xyz, tets, region=None, faces=()):
    with open(name + '.tm', 'w') as f:
        print('termesh 1\n.node\n%d 3 0 0' % len(xyz), file=f)
        for i, p in enumerate(xyz, 1):
            print(i, *map(repr, p), file=f)
        print('.ele\n%d 4 %d' % (len(tets), region is not None), file=f)
        for t, tet in enumerate(tets):
            print(t + 1, *(n + 1 for n in tet), *([region(xyz, tet)] if region else []), file=f)
        if faces:
            print('.face\n%d 1' % len(faces), file=f)
            for i, face in enumerate(faces, 1):
                print(i, *(n + 1 for n in face), 9, file=f)
        print('.end', file=f)
# Cubes of six tetrahedra each (Kuhn), where `keep` has them.
def cubes(n, keep=lambda *c: True, scale=(1, 1, 1)):
    number, tets = {}, []
    for c in itertools.product(range(n), repeat=3):
        if not keep(*c):
            continue
        for order in itertools.permutations(range(3)):
            at, path = list(c), []
            for k in (None,) + order:
                if k is not None:
                    at[k] += 1
                path.append(number.setdefault(tuple(at), len(number)))
            sign = sum(order[i] > order[j] for i in range(3) for j in range(i + 1, 3)) % 2
            tets.append(path if sign == 0 else [path[1], path[0]] + path[2:])
    return [tuple(float(x * s) for x, s in zip(p, scale)) for p in number], tets
def middle(xyz, tet, k):
    return sum(xyz[n][k] for n in tet) / 4
cloud = lambda n: [tuple(rng.random() for _ in range(3)) for _ in range(n)]
for n in (5, 20, 60, 200):
    points('random%d' % n, cloud(n))
points('clusters', [tuple(rng.gauss(c, 0.2) for _ in range(3)) for c in (0, 1, 2) for _ in range(40)])
points('flat', [(x, y, 1e-3 * z) for x, y, z in cloud(90)])
points('flatter', [(x, 1e-5 * y, z) for x, y, z in cloud(90)])
points('needle', [(1e4 * x, y, z) for x, y, z in cloud(90)])
points('tiny', [tuple(1e-30 * x for x in p) for p in cloud(90)])
points('huge', [tuple(1e30 * x for x in p) for p in cloud(90)])
points('lattice', [tuple(map(float, p)) for p in itertools.product(range(5), repeat=3)])
points('ball', [tuple(x / sum(y * y for y in p) ** .5 for x in p) for p in
                ([rng.gauss(0, 1) for _ in range(3)] for _ in range(80))])
for n in (1, 2, 4):
    mesh('cubes%d' % n, *cubes(n))
mesh('plate', *cubes(4, lambda i, j, k: k == 0, (1, 1, 1 / 64)))
mesh('rod', *cubes(6, lambda i, j, k: j == k == 0, (8, 1, 1)))
mesh('halves', *cubes(4), region=lambda x, t: int(middle(x, t, 0) > 2))
mesh('slabs', *cubes(4), region=lambda x, t: int(middle(x, t, 2)))
mesh('board', *cubes(3), region=lambda x, t: sum(int(middle(x, t, k)) for k in range(3)) % 2)
mesh('crumbs', *cubes(3), region=lambda x, t: rng.randrange(4))
mesh('edge', *cubes(2, lambda i, j, k: i == j))
mesh('corner', *cubes(2, lambda i, j, k: i == j == k))
mesh('apart', *cubes(3, lambda i, j, k: i != 1))
mesh('ring', *cubes(4, lambda i, j, k: not (i in (1, 2) and j in (1, 2))))
mesh('cavity', *cubes(3, lambda i, j, k: (i, j, k) != (1, 1, 1)))
xyz, tets = cubes(3)
inner = {}
for tet in tets:
    for face in itertools.combinations(sorted(tet), 3):
        inner[face] = inner.get(face, 0) + 1
mesh('marked', xyz, tets, faces=[f for f, n in sorted(inner.items()) if n == 2][::5])
mesh('two', [(0., 0., 0.), (1., 0., 0.), (0., 1., 0.), (.3, .3, .5), (.3, .3, -.5)],
     [(0, 1, 2, 3), (0, 2, 1, 4)])
END
    python3 meshes.py
    for points in *.node; do
        tetgen-mesh --quiet "$points" >"${points%.node}.tm"
    done
    cat >sets.py <<'END'
import collections, json, math, subprocess, sys
SETS = ['', '--star', '--star=0.05', '--star=centroid', '--absorb', '--star --absorb',
        '--star=centroid --absorb --merge-coplanar', '--mode edge --no-swallow',
        '--mode face --star', '--mode terminal-face --absorb', '--mode cavity --star=0',
        '--cells 5 --star --absorb', '--cells 9 --star=centroid', '--max-tets 5 --no-swallow',
        '--star --merge-coplanar --ignore-markers', '--star --levels 2', '--label | --partition --star',
        '--mode edge | --star --cells 6']
def blocks(text):
    found, lines = {}, iter(text.split('\n'))
    for line in lines:
        if line[:1] == '.' and line != '.end' or line[:5] == 'level':
            found[line] = [next(lines).split() for _ in range(int(next(lines).split()[0]))]
    return found
def volume(origin, a, b, c):
    u, v, w = ([q - p for p, q in zip(origin, x)] for x in (a, b, c))
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
            + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6
def places(found):
    return {row[0]: [float(x) for x in row[1:4]] for row in found['.node']}
def of_tets(found):
    xyz, sums = places(found), collections.defaultdict(list)
    for row in found['.ele']:
        sums[tuple(row[5:])].append(abs(volume(*(xyz[n] for n in row[1:5]))))
    return {region: math.fsum(parts) for region, parts in sums.items()}
def of_cells(found):
    xyz, sums = places(found), collections.defaultdict(list)
    origin = {row[0]: None for row in found['.cell']}
    region = {row[0]: tuple(row[3 + int(row[1]):]) for row in found['.cell']}
    for row in found['.facet']:
        loop = [xyz[n] for n in row[4:4 + int(row[3])]]
        for side, sign in ((row[1], 1), (row[2], -1)):
            if side == '-1':
                continue
            start = origin[side] = origin[side] or loop[0]
            sums[region[side]] += [sign * volume(start, loop[0], loop[i], loop[i + 1])
                                   for i in range(1, len(loop) - 1)]
    return {name: math.fsum(parts) for name, parts in sums.items()}
def check(text):
    return subprocess.run(['mesh-check', '-q', '--json', '-'], input=text, text=True,
                          capture_output=True)
def wrong(report):
    return [report.get(key, 0) for key in ('inverted', 'unmatched_faces', 'repeated_faces',
                                           'unclosed_edges', 'unoriented_edges')]
done = 0
for path in sys.argv[1:]:
    text = open(path).read()
    before, was = of_tets(blocks(text)), check(text)
    for options in SETS:
        made = text
        for words in options.split('|'):
            run = subprocess.run(['polylla3d', '-q', *words.split()], input=made, text=True,
                                 capture_output=True)
            made = run.stdout
            assert run.returncode in (0, 1), (path, options, run)
        found, now = blocks(made), check(made)
        if options.endswith('--levels 2') and 'level1.cell' in found: # the parent is the last
            for row in found['.cell']:
                del row[-1 if any(before) else -2:] # after a region 0 where there was none
        assert now.returncode <= was.returncode, (path, options, now.stdout)
        assert not any(wrong(json.loads(now.stdout))), (path, options, now.stdout)
        after = of_cells(found)
        assert set(after) == set(before), (path, options, after, before)
        for region, whole in before.items():
            assert abs(after[region] / whole - 1) < 1e-12, (path, options, after, before)
        done += 1
print(done)
END
}

@test "28 meshes and 18 sets of options: all is valid, and each region has its volume" {
    cd "$BATS_FILE_TMPDIR" || exit
    run -0 --separate-stderr python3 sets.py ./*.tm
    [ "$output" -eq $((28 * 18)) ]
}
