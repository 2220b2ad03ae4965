#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# vtu-import on a million tetrahedra, of a file that is raw and compressed, beside mesh-check
# of the same mesh as a stream: medians of CPU seconds, and the most memory.
#   CELLS   cubes of six tetrahedra along each edge; 55
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
io make "${CELLS:-55}" >"$work/grid.tm"
vtu-export -q -o "$work/grid.vtu" "$work/grid.tm"
vtu-export -q --no-boundary --no-quality -o "$work/plain.vtu" "$work/grid.tm"
printf '%s tetrahedra, %s bytes as .vtu\n' "$(tets_of "$work/grid.tm")" \
    "$(wc -c <"$work/grid.vtu")"

# The median of CPU seconds, and kB.
check=$(cpu "$runs" mesh-check -q -j 1 "$work/grid.tm")
for file in grid plain; do
    import=$(cpu "$runs" vtu-import -q -j 1 "$work/$file.vtu")
    echo "$check $import" | awk -v file="$file.vtu" '{
        printf "%-10s mesh-check %.3f s, vtu-import %.3f s, %d MB: %.2f times (at most 2)\n",
            file, $1, $3, $4 / 1024, $3 / $1
    }'
done
