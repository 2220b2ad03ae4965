#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# jens-stats beside mesh-check on the same stream: medians of CPU seconds and their ratio,
# on tetrahedra and, made by octree-mesh of the surface that is given (or of a sphere), on
# mixed elements; and what certificates cost.
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
cells=${CELLS:-60}
level=${LEVEL:-7}

# The median CPU seconds of a command that reads a stream: seconds STREAM COMMAND…
# That a mesh is not good is an answer, no failure.
seconds() {
    stream=$1
    shift
    cpu "$runs" sh -c '"$@" >/dev/null 2>&1 || [ $? -eq 1 ]' sh "$@" <"$stream" |
        cut -d ' ' -f 1
}

# One line for each command, beside mesh-check: compare STREAM WHAT
compare() {
    check=$(seconds "$1" mesh-check)
    plain=$(seconds "$1" jens-stats)
    json=$(seconds "$1" jens-stats --json /dev/null)
    certify=$(seconds "$1" jens-stats --certify)
    list=$(seconds "$1" jens-stats -j)
    jens-stats "$1" | sed -n "s/^total: /$2: elements /p"
    awk -v c="$check" -v p="$plain" -v j="$json" -v f="$certify" -v l="$list" 'BEGIN {
        printf "mesh-check             %7.3f s\n", c
        printf "jens-stats             %7.3f s   %.2f of it (at most 1.5)\n", p, p / c
        printf "jens-stats --json      %7.3f s   %.2f\n", j, j / c
        printf "jens-stats --certify   %7.3f s   %.2f\n", f, f / c
        printf "jens-stats -j          %7.3f s   %.2f\n", l, l / c
    }'
}

io make "$cells" >"$work/grid.tm"
compare "$work/grid.tm" tetrahedra
rm "$work/grid.tm"

if [ -z "$surface" ]; then
    surface=$work/ball.off
    python3 - >"$surface" <<'END'
import math
around, rings = 60, 30
points = [(0, 0, 1)]
for r in range(1, rings):
    u = math.pi * r / rings
    points += [(math.sin(u) * math.cos(2 * math.pi * a / around),
                math.sin(u) * math.sin(2 * math.pi * a / around), math.cos(u))
               for a in range(around)]
points.append((0, 0, -1))
last = len(points) - 1
at = lambda r, a: 0 if r == 0 else last if r == rings else 1 + (r - 1) * around + a % around
faces = [f for r in range(rings) for a in range(around)
         for f in ((at(r, a), at(r + 1, a), at(r + 1, a + 1)),
                   (at(r, a), at(r + 1, a + 1), at(r, a + 1))) if len(set(f)) == 3]
print('OFF\n%d %d 0' % (len(points), len(faces)))
for p in points:
    print(*p)
for f in faces:
    print(3, *f)
END
fi
octree-mesh -q -s "$level" -o "$work/octree.tm" "$surface"
compare "$work/octree.tm" "mixed elements"
