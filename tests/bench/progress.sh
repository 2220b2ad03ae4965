#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What progress costs: instructions of filters whose standard error is a terminal, of all
# their threads, beside the same with -q. Needs valgrind and script(1).
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
export TERM=xterm

for program in valgrind script; do
    command -v "$program" >/dev/null || {
        echo "There is no $program." >&2
        exit 0
    }
done

points "${POINTS:-20000}" 1 >"$work/points.node"
tetgen-mesh --no-history "$work/points.node" >"$work/mesh.tm"
lepp-improve -q -a selective --no-history "$work/mesh.tm" >"$work/better.tm"

# Prints how many instructions a command takes on a terminal.
instructions() {
    script -qec "valgrind --tool=callgrind --callgrind-out-file=/dev/null \
        --log-file=$work/log $* >/dev/null" "$work/typescript" </dev/null >/dev/null
    sed -n 's/.*Collected : *//p' "$work/log"
}

# compare COMMAND…
compare() {
    quiet=$(instructions "$@" --quiet)
    told=$(instructions "$@")
    lines=$(tr -cd '\r' <"$work/typescript" | wc -c)
    awk -v q="$quiet" -v t="$told" -v lines="$lines" -v what="$*" 'BEGIN {
        gsub(/[^ ]*\//, "", what)
        printf "%-44s %13.0f, drawn %5d times: %+.3f %% (at most 0.5)\n", what, q, lines,
            100 * (t - q) / q
    }'
}

compare lepp-improve -a selective -m 1.1 "$work/mesh.tm"
compare lepp-improve "$work/better.tm"
compare polylla3d --absorb "$work/mesh.tm"
compare tet-stats "$work/mesh.tm"
compare off-export "$work/mesh.tm"
