#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The adaptive loop of a solver: solve, mark, refine, three times. The solution here is
# known, a front on a sphere around a corner of the unit cube; what marks tetrahedra, here
# where the front crosses them, would be an error that is estimated. Each time the marked
# ones are bisected three times, so that their edges become half as long, and what is
# around them as far as it must, so that no node hangs.
#
#   sh examples/adapt.sh [FOLDER]        FOLDER: build/adapt
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
PATH=$PATH:$root/build/bin
LC_ALL=C
export PATH LC_ALL
folder=${1:-$root/build/adapt}
mkdir -p "$folder"
cd "$folder"

# Cubes, each cut into six tetrahedra along the same diagonal.
cubes() {
    awk -v n="$1" '
    function node(x, y, z) { return x + (n + 1) * (y + (n + 1) * z) }
    function cut(x, y, z, x1, y1, z1, x2, y2, z2, odd) {
        p = node(x + x1, y + y1, z + z1); q = node(x + x2, y + y2, z + z2)
        print tets++, node(x, y, z), odd ? q : p, odd ? p : q, node(x + 1, y + 1, z + 1)
    }
    BEGIN {
        print "termesh 1\n.node\n" (n + 1) ^ 3, 3, 0, 0
        for (z = 0; z <= n; z++) for (y = 0; y <= n; y++) for (x = 0; x <= n; x++)
            print node(x, y, z), x / n, y / n, z / n
        print ".ele\n" 6 * n ^ 3, 4, 0
        for (z = 0; z < n; z++) for (y = 0; y < n; y++) for (x = 0; x < n; x++) {
            cut(x, y, z, 1, 0, 0, 1, 1, 0, 0); cut(x, y, z, 0, 1, 0, 0, 1, 1, 0)
            cut(x, y, z, 0, 0, 1, 1, 0, 1, 0); cut(x, y, z, 1, 0, 0, 1, 0, 1, 1)
            cut(x, y, z, 0, 0, 1, 0, 1, 1, 1); cut(x, y, z, 0, 1, 0, 1, 1, 0, 1)
        }
        print ".end"
    }'
}

# The numbers of the tetrahedra that have nodes on both sides of the front.
mark() {
    awk -v radius=0.7 '
    /^\./ { block = $1; head = 1; next }
    head { head = 0; next }
    block == ".node" { inside[$1] = $2 ^ 2 + $3 ^ 2 + $4 ^ 2 < radius ^ 2 }
    block == ".ele" {
        count = inside[$2] + inside[$3] + inside[$4] + inside[$5]
        if (count > 0 && count < 4) print $1
    }' "$1"
}

cubes 4 >mesh.tm
for step in 1 2 3; do
    mark mesh.tm >"marked.$step"
    lepp-improve -a bisection -s 3 --set "marked.$step" -o mesh.tm mesh.tm
    mesh-check mesh.tm >check.txt
done
tet-stats mesh.tm | tee quality.txt | head -n 5
