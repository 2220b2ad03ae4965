#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Whether octree-mesh takes time and memory in proportion to the elements: one surface,
# level by level. The environment:
#   LEVELS    of -s; 5 6 7 8 9
#   SHAPE     a name that shapes knows, or a file; torus
#   RUNS      so many runs, of which the median counts; 5. From two seconds on one counts
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
shape=${SHAPE:-torus}
case $shape in
*.*) file=$shape ;;
*)
    file=$work/$shape.off
    shapes "$shape" >"$file"
    ;;
esac

printf '%-10s %10s %9s %12s %14s\n' "$(basename "$shape")" elements "CPU s" "us/element" \
    "bytes/element"
: >"$work/rows"
for level in ${LEVELS:-5 6 7 8 9}; do
    octree-mesh -q -s "$level" -o "$work/mesh.tm" "$file" || [ $? -eq 1 ]
    elements=$(sed -n '/^\.mix/{n;p;q;}' "$work/mesh.tm" | cut -d ' ' -f 1)
    rm "$work/mesh.tm"
    : >"$work/runs"
    for _ in $(seq "$runs"); do
        # shellcheck disable=SC2016 # for the inner shell
        cpu 1 sh -c '"$@" || [ $? -eq 1 ]' sh octree-mesh -q -s "$level" "$file" \
            2>/dev/null >>"$work/runs"
        ! awk '$1 > 2 { exit 1 }' "$work/runs" || continue
        break
    done
    awk -v s="$(median_of "$work/runs")" -v n="$elements" -v level="$level" '
        $2 > kb { kb = $2 }
        END { print level, n, s, 1e6 * s / n, 1024 * kb / n }' "$work/runs" >"$work/row"
    cat "$work/row" >>"$work/rows"
    awk '{ printf "-s %-7s %10d %9.3f %12.3f %14.1f\n", $1, $2, $3, $4, $5 }' "$work/row"
done
# From the first level with enough elements that starting the program does not count.
awk -v from=50000 '
    $2 >= from { if (!first) first = $4; last = $4; bytes = $5 }
    END {
        if (first) printf "  aim: %-42s %9.3f, at most %9.3f: %s\n",
            "CPU per element, last to first", last / first, 1.25,
            last / first <= 1.25 ? "yes" : "NO"
        if (first) printf "  aim: %-42s %9.1f, at most %9.1f: %s\n",
            "bytes per element, last", bytes, 300, bytes <= 300 ? "yes" : "NO"
    }' "$work/rows"
