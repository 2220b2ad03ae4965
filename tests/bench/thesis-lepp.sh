#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Tables 7.1, 7.2, 7.11, 7.12 of Balboa (2020) for RND2000: five seeds of 2000 random
# points through TetGen, swap-centroid and selective, medians beside the published row.
# With the file femur.off (or another surface) as $1 or in $TM_DATA: tables 7.9 and 7.10
# for `tetgen -pq4` of it.
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
seeds=${SEEDS:-1 2 3 4 5}

# One line of figures of a run: ratio, bad %, the ten shares of angles, CPU seconds.
figures() {
    lepp-improve --json "$work/run.json" "$@" >/dev/null 2>&1
    python3 - "$work/run.json" <<'END'
import json, sys
run = json.load(open(sys.argv[1]))
before, after = run["before"], run["after"]
angles = after["dihedral_percent"]
keys = ["<5", "<10", "<15", "<20", "<25", "<30", ">150", ">160", ">170", ">175"]
print(after["tets"] / before["tets"], after["bad_percent"],
      *[angles[k] for k in keys], run["seconds"])
END
}

# Column by column the median of the lines on standard input.
medians() {
    python3 -c 'import statistics, sys
rows = [[float(x) for x in line.split()] for line in sys.stdin]
print(" ".join("%.2f" % statistics.median(c) for c in zip(*rows)))'
}

row() {
    printf '%-19s' "$1"
    shift
    # shellcheck disable=SC2086,SC2048 # words
    printf ' %6s' $*
    echo
}

# The table of all runs on the streams given; reads the published rows, each
# "name options|ratio bad <5 … >175 seconds", from standard input.
table() {
    row "" ratio 'bad%' '<5' '<10' '<15' '<20' '<25' '<30' '>150' '>160' '>170' '>175' s
    while IFS='|' read -r name options published; do
        for stream in "$@"; do
            # shellcheck disable=SC2086,SC2048 # words
            figures $options "$stream"
        done >"$work/rows"
        row "$name" "$(medians <"$work/rows")"
        row "  thesis" "$published"
    done
}

streams=
for seed in $seeds; do
    points 2000 "$seed" >"$work/points.node"
    tetgen-mesh --no-history "$work/points.node" >"$work/$seed.tm"
    streams="$streams $work/$seed.tm"
done
echo "RND2000, medians of $(echo "$seeds" | wc -w) seeds (thesis: i7-6500U, C++)"
# shellcheck disable=SC2086
table $streams <<'END'
swap-centroid|-a swap-centroid|3.53 34.75 2.20 3.85 5.30 6.87 8.75 11.31 3.68 2.62 1.50 0.82 9.41
m = 1.00, 5 passes|-m 1 -s 5|4.23 19.04 0.37 0.87 1.47 2.19 3.30 5.17 1.27 0.77 0.35 0.16 48.37
m = 1.00|-m 1|4.23 19.04 0.37 0.87 1.47 2.19 3.30 5.17 1.27 0.77 0.35 0.16 48.37
m = 1.05|-m 1.05|2.72 22.34 0.45 0.93 1.50 2.30 3.64 5.92 1.28 0.78 0.38 0.19 34.70
m = 1.08|-m 1.08|2.35 25.77 0.53 1.06 1.70 2.63 4.16 6.79 1.43 0.86 0.44 0.23 30.51
m = 1.10|-m 1.1|2.17 27.52 0.55 1.12 1.84 2.84 4.50 7.22 1.52 0.91 0.46 0.24 30.46
m = 1.15|-m 1.15|1.86 32.09 0.65 1.33 2.16 3.36 5.29 8.47 1.73 1.05 0.52 0.28 25.18
m = 1.20|-m 1.2|1.62 35.53 0.74 1.50 2.42 3.82 5.98 9.42 1.89 1.15 0.57 0.32 22.20
END

[ -n "$surface" ] || exit 0
tetgen-mesh -q4 --no-history "$surface" >"$work/surface.tm"
echo
echo "$(basename "$surface"), tetgen -pq4: $(tets_of "$work/surface.tm") tetrahedra (thesis: another femur, 52848)"
table "$work/surface.tm" <<'END'
swap-centroid|-a swap-centroid|5.12 18.22 0.02 0.09 0.23 0.50 1.14 2.48 0.27 0.11 0.03 0.01 61.4
m = 1.00|-m 1|3.55 10.08 0.00 0.02 0.06 0.16 0.62 2.05 0.08 0.02 0.00 0.00 141
m = 1.05|-m 1.05|2.51 15.25 0.01 0.05 0.12 0.36 1.19 3.22 0.17 0.05 0.01 0.00 114
m = 1.08|-m 1.08|2.16 18.07 0.01 0.06 0.15 0.49 1.57 3.87 0.22 0.06 0.01 0.00 106
m = 1.10|-m 1.1|1.99 19.71 0.01 0.07 0.18 0.59 1.79 4.26 0.25 0.07 0.01 0.00 105
m = 1.15|-m 1.15|1.70 23.27 0.01 0.09 0.26 0.85 2.34 5.11 0.32 0.09 0.02 0.00 93.7
m = 1.20|-m 1.2|1.51 26.13 0.00 0.01 0.06 0.39 1.72 4.34 0.50 0.10 0.00 0.00 83.6
END
