#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Speed and memory of lepp-improve -a selective -m 1.1: the whole process with its text,
# beside Gmsh's default optimiser alone on the same mesh (femur.off as $1 or in $TM_DATA,
# else a generated surface), and on 20 000 and 200 000 random points. Medians of CPU
# seconds. Needs python3-gmsh for the peer.
# shellcheck source-path=SCRIPTDIR source=peers.inc
. "$(dirname "$0")/peers.inc"

tetgen-mesh -q4 "$surface" >"$work/surface.tm"
echo "$(basename "$surface"), tetgen -pq4: $(tets_of "$work/surface.tm") tetrahedra"

# Turn by turn, so that both see the same machine.
i=0
while [ "$i" -lt "$runs" ]; do
    cpu 1 lepp-improve -q -a selective -m 1.1 "$work/surface.tm" >>"$work/ours"
    if have_gmsh; then
        $python -B tests/bench/gmsh-optimize.py "$work/surface.tm" | cut -d ' ' -f 2 >>"$work/peer"
    fi
    i=$((i + 1))
done
ours=$(median_of "$work/ours")
printf 'lepp-improve, whole process    %6.3f s\n' "$ours"
if [ -s "$work/peer" ]; then
    peer=$(median_of "$work/peer")
    printf 'Gmsh, default optimiser alone  %6.3f s\n' "$peer"
    awk -v a="$ours" -v b="$peer" 'BEGIN { printf "ratio  %.3f (at most 0.1)\n", a / b }'
else
    echo 'Gmsh: needs the package python3-gmsh'
fi

echo
for n in 20000 200000; do
    points $n 1 >"$work/points.node"
    tetgen-mesh "$work/points.node" >"$work/$n.tm"
    before=$(tets_of "$work/$n.tm")
    lepp-improve -q -a selective -m 1.1 "$work/$n.tm" >"$work/out.tm"
    after=$(tets_of "$work/out.tm")
    cpu 3 lepp-improve -q -a selective -m 1.1 "$work/$n.tm" |
        awk -v n="$n" -v b="$before" -v a="$after" '{
            printf "%6d points, %7d -> %7d tetrahedra: %7.3f s, %.2f us per input " \
                "tetrahedron, %.0f bytes per output tetrahedron (at most 160)\n", \
                n, b, a, $1, 1e6 * $1 / b, 1024 * $2 / a
            print $1 / b >"/dev/stderr"
        }' 2>"$work/per-tet.$n"
done
paste "$work/per-tet.20000" "$work/per-tet.200000" |
    awk '{ printf "CPU per tetrahedron, 200 000 points to 20 000: %.2f (at most 1.5)\n", $2 / $1 }'
