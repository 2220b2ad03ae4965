#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# surface-mend on a clean surface of a million triangles, beside reading and writing it
# (surface-import of the stream): medians of CPU seconds, and the most memory.
#   FINE   how fine the sphere is; 290
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
shapes sphere "${FINE:-290}" | surface-import -q -o "$work/sphere.tm"
read=$(cpu "$runs" surface-import -q -j 1 "$work/sphere.tm")
mend=$(cpu "$runs" surface-mend -q -j 1 "$work/sphere.tm")
echo "$read $mend" | awk '{
    printf "surface-import %.3f s, surface-mend %.3f s, %d MB: %.2f times (at most 2)\n",
        $1, $3, $4 / 1024, $3 / $1
}'
