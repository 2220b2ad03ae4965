#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The stream's reader and writer on a million nodes and six million tetrahedra, beside
# wc -l, getline + strtod/strtol and printf %.17g/%d: medians of CPU seconds.
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
cells=${CELLS:-102}
io make "$cells" >"$work/grid.tm"
ls -l "$work/grid.tm" | awk '{ printf "stream of %d bytes, ", $5 }'
sed -n '3p' "$work/grid.tm" | awk '{ printf "%d nodes\n", $1 }'

# The median CPU seconds of a command that reads the stream.
median() {
    cpu "$runs" "$@" <"$work/grid.tm" | cut -d ' ' -f 1
}
wc=$(median wc -l)
read=$(median io read)
getline=$(median io getline)
both=$(median io both)
printf=$(median io printf)
awk -v w="$wc" -v r="$read" -v g="$getline" -v b="$both" -v p="$printf" 'BEGIN {
    printf "wc -l                    %7.3f s\n", w
    printf "read, all checks         %7.3f s   %.1f x wc -l (at most 7)\n", r, r / w
    printf "getline, strtod, strtol  %7.3f s   %.1f x ours (at least 4)\n", g, g / r
    printf "write                    %7.3f s\n", b - r
    printf "printf %%.17g, %%d         %7.3f s   %.1f x ours (at least 5)\n", p - r, \
        (p - r) / (b - r)
}'
