# SPDX-License-Identifier: GPL-3.0-or-later
# Pages of mesh-view, read by Python, and shown by a browser.
# shellcheck shell=bash
# shellcheck disable=SC2034 # for the tests

root=$(cd "$BATS_TEST_DIRNAME/../.." && pwd)

need_view() {
    command -v mesh-view >/dev/null || skip "mesh-view is not built: there is no libjs-three"
}

need_browser() {
    need_view
    command -v chromium >/dev/null || skip "there is no chromium"
}

# Runs Python from standard input, which knows Page and Stream, and Browser.
look() {
    { echo 'from page import *'; cat; } | PYTHONPATH="$root/tests/view" python3 - "$@"
}

# Prints a cube of N by N by N boxes, each cut into six tetrahedra: grid N [JITTER]. Its
# left half is region 1, the right one 2, the bottom has marker 5; all have names.
grid() {
    python3 - "$@" <<'END'
import itertools, random, sys
n = int(sys.argv[1])
jitter = float(sys.argv[2]) if len(sys.argv) > 2 else 0
m = n + 1
random.seed(n)
node = lambda p: p[0] + m * (p[1] + m * p[2])
print('termesh 1\n# made by a test\n.node\n%d 3 0 0' % m ** 3)
for z in range(m):
    for y in range(m):
        for x in range(m):
            p = (x, y, z)
            inside = jitter and 0 < min(p) and max(p) < n
            print(node(p), *(c + (random.uniform(-jitter, jitter) if inside else 0) for c in p))
tets = []
for z, y, x in itertools.product(range(n), repeat=3):
    for order in itertools.permutations(range(3)):
        p, path = [x, y, z], [(x, y, z)]
        for axis in order:
            p[axis] += 1
            path.append(tuple(p))
        odd = sum(order[i] > order[j] for i in range(3) for j in range(i + 1, 3)) % 2
        t = [node(q) for q in path]
        if odd:
            t[2], t[3] = t[3], t[2]
        tets.append((t, 1 if 2 * x < n else 2))
print('.ele\n%d 4 1' % len(tets))
for e, (t, region) in enumerate(tets):
    print(e, *t, region)
faces = []
for t, _ in tets:
    for i in range(4):
        f = t[:i] + t[i + 1:]
        if max(f) < m * m:
            faces.append(f)
print('.face\n%d 1' % len(faces))
for f, nodes in enumerate(faces):
    print(f, *nodes, 5)
print('.group\n3 0\n0 2 5 floor\n1 3 1 left\n2 3 2 right\n.end')
END
}
