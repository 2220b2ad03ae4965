#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# How much of what lepp-improve -a improve makes depends on the order of nodes and
# tetrahedra: each mesh as it is and in other orders, and how far apart the results are.
# $1, TM_DATA and the rest: peers.inc; and
#   MESHES    of rnd2000 rnd20000 femur knot house2; all
#   SEEDS     of the orders; 1 2 3 4 5
#   GROWTHS   bounds of the size, in times the input
# shellcheck source-path=SCRIPTDIR source=peers.inc
. "$(dirname "$0")/peers.inc"
seeds=${SEEDS:-1 2 3 4 5}
growths=${GROWTHS:-1 3}
runs=1

# The least and the greatest value of a column of the figures: spread WHAT COLUMN.
spread() {
    cut -f "$2" "$figures" | sort -n | awk -v what="$1" '{ v[NR] = $1 }
        END { printf "  %s: %s to %s, %.1f %% apart\n", what, v[1], v[NR],
            v[1] ? 100 * (v[NR] / v[1] - 1) : 0 }'
}

all=$(meshes | tr '\n' ' ')
for mesh in ${MESHES:-$all}; do
    make_mesh "$mesh"
    orders=$mesh
    for seed in $seeds; do
        orders="$orders $mesh.$seed"
        $python -B tests/bench/shuffle.py "$seed" "$work/$mesh.tm" "$work/$mesh.$seed.tm"
    done
    for growth in $growths; do
        : >"$figures"
        head_row
        for order in $orders; do
            # shellcheck disable=SC2046 # words
            row "$order" ours "$order, at most $growth" "${growth_option:+$growth}" \
                improve "$work/$order.tm" $(growth "$growth")
        done
        spread 'bad %' 6
        spread tetrahedra 4
    done
done
