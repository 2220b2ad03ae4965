#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The tables of Balboa (2020) about swap-centroid and selective, ours beside his: size and
# quality by the factor m (chapter 7), with sweeps between the passes (7.4), by the volume
# (8), and what the terminal stars are like (9). Of his meshes there are RND2000, five
# seeds of 2000 random points, of which medians count, and one like Femur, `tetgen -pq4`
# of the surface femur.off ($1, or in the folder $TM_DATA). Nobody has his Retinal, P and
# N090: in their place are other surfaces of that folder, or without it a generated one.
# Surfaces run $RUNS times (3), and the medians of the seconds count. One minute.
RUNS=${RUNS:-3}
# shellcheck source-path=SCRIPTDIR source=peers.inc
. "$(dirname "$0")/peers.inc"
seeds=${SEEDS:-1 2 3 4 5}
stand_ins='knot fandisk anchor_dense'

# What is run, each "name|options". Chapter 8 measures the meshes of chapter 7 and does
# not compare stars by the volume, so nothing has -Q volume. The runs were until nothing
# is left to do (7.2.2), but some figures of chapter 9 are rather those of one pass.
ways() {
    cat <<'END'
centroid|-a centroid
swap-centroid|-a swap-centroid
swap-centroid, fixed|-a swap-centroid --path fixed
m=1.00|-a selective -m 1
m=1.05|-a selective -m 1.05
m=1.08|-a selective -m 1.08
m=1.10|-a selective -m 1.1
m=1.15|-a selective -m 1.15
m=1.20|-a selective -m 1.2
m=1.00, 5 passes|-a selective -m 1 -s 5
m=1.10, one pass|-a selective -m 1.1 -s original
m=1.10, small stars|-a selective -m 1.1 --max-star 6
m=1.10, smooth|-a selective -m 1.1 --with smooth
m=1.10, face-swap|-a selective -m 1.1 --with face-swap
m=1.10, both|-a selective -m 1.1 --with both
END
}

# Writes the reports of all ways on a stream: run_all MESH NUMBER STREAM.
run_all() {
    reports=$work/reports/$1/$2
    mkdir -p "$reports"
    ways | while IFS='|' read -r name options; do
        # shellcheck disable=SC2086 # words
        lepp-improve -q $options --json "$reports/$name.json" "$3" >/dev/null
    done
}

run_points() {
    for seed in $seeds; do
        points 2000 "$seed" >"$work/points.node"
        tetgen-mesh --no-history -o "$work/points.tm" "$work/points.node"
        run_all rnd2000 "$seed" "$work/points.tm"
    done
}

run_surface() {
    make_mesh "$1" >/dev/null
    for number in $(seq "$runs"); do
        run_all "$1" "$number" "$work/$1.tm"
    done
}

first=$(basename "$surface" .off)
names=$first
for name in $stand_ins; do
    [ ! -r "$data/$name.off" ] || [ "$name" = "$first" ] || names="$names $name"
done
run_points
for name in $names; do
    run_surface "$name"
done
# shellcheck disable=SC2086 # words
$python -B tests/bench/thesis-lepp.py "$work/reports" rnd2000 $names
