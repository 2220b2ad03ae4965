#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Filters on ranks of a launcher (mpirun). First, strong: on 1 rank and on 2 of one thread
# each, by the clock, the memory of the larger rank, and whether the bytes are the same.
# Then, weak: as much for each rank on more and more of them, which share the machine's
# cores, so that it is not the clock that says how it scales but what is counted: what each
# rank sends, in how many messages, and the work of the busiest rank against the mean. The
# environment:
#   TM_DATA   a folder with knot.off, else a generated one is meshed
#   LEVEL     of octree-mesh -s, strong; 9
#   POINTS    of which tetrahedra are made for lepp-improve, strong; 200000
#   RANKS     weak; 2 4 8 16 32 64: an octree has four times as many elements a level
#             deeper, so that of 2, 8 and 32 ranks each has twice as many as of 4, 16, 64
#   WEAK      of octree-mesh -s on up to 3 ranks, weak; 5
#   PARTS     which: strong weak
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
data=${surface:+$(dirname "$surface")}
knot=$data/knot.off
[ -r "$knot" ] || { knot=$work/knot.off && shapes torus >"$knot"; }
level=${LEVEL:-9}

# on N COMMAND… : on N ranks of one thread.
on() {
    ranks=$1
    shift
    mpirun --allow-run-as-root --oversubscribe -n "$ranks" "$@" -j 1
}

# wall FILE: the seconds that GNU time wrote last.
wall() {
    tail -n 1 "$1"
}

# memory_of LOG: MB at most of one rank, of -v.
memory_of() {
    sed -n 's/.*MB of memory, \([0-9.]*\) MB at most$/\1/p; t
        s/.* \([0-9.]*\) MB at most$/\1/p' "$1" | sort -g | tail -n 1
}

# strong NAME COMMAND… : a row.
strong() {
    name=$1
    shift
    for n in 1 2; do
        /usr/bin/time -f %e -o "$work/time.$n" mpirun --allow-run-as-root --oversubscribe \
            -n $n "$@" -j 1 -v --no-history -o "$work/out.$n" 2>"$work/log.$n"
    done
    cmp -s "$work/out.1" "$work/out.2" && same=yes || same=NO
    awk -v name="$name" -v a="$(wall "$work/time.1")" -v b="$(wall "$work/time.2")" \
        -v m="$(memory_of "$work/log.1")" -v k="$(memory_of "$work/log.2")" -v same="$same" 'BEGIN {
        printf "%-24s %8.1f %8.1f %6.2f %9.0f %9.0f %6.2f  %s\n", name, a, b, b / a, m, k, k / m, same
    }'
    rm -f "$work"/out.*
}

# weak NAME RANKS COMMAND… : a row; the numbers of the line of -v, in their order: ranks, MB
# sent by each, most; messages, most; s of CPU, most; MB of memory, most. Then octants of
# others that each has.
weak() {
    name=$1 ranks=$2
    shift 2
    on "$ranks" "$@" -v -o "$work/out" 2>"$work/log"
    sed -n 's/^[^:]*: \([0-9]* ranks: .* MB sent by each.*\)/\1/p' "$work/log" |
        grep -oE '[0-9]+(\.[0-9]+)?' | tr '\n' ' ' |
        awk -v name="$name" -v ranks="$ranks" '
        { printf "%-24s %5d %9.2f %9.2f %9d %9d %9.2f %9.2f %9.1f", name, ranks, $2, $3, $4, $5, $6, $7 / ($6 > 0 ? $6 : 1), $9 }'
    sed -n 's/.*of others each rank has \([0-9]*\) octants.*/ \1/p' "$work/log" | tr -d '\n'
    echo
    rm -f "$work/out"
}

case ${PARTS:-strong weak} in
*strong*)
    points "${POINTS:-200000}" 1 | tetgen-mesh -o "$work/tets.tm"
    echo "by the clock, on 1 and 2 ranks of one thread, and MB of the larger rank"
    echo "                              1 s      2 s  ratio      1 MB      2 MB  ratio  same bytes"
    strong "octree-mesh -s $level" octree-mesh -s "$level" "$knot"
    strong "lepp-improve" lepp-improve "$work/tets.tm"
    strong "polylla3d --star" polylla3d --star "$work/tets.tm"
    strong "mesh-check" mesh-check "$work/tets.tm"
    strong "tet-stats" tet-stats "$work/tets.tm"
    polylla3d -q -o "$work/cells.tm" "$work/tets.tm"
    strong "poly-stats" poly-stats "$work/cells.tm"
    octree-mesh -q -s $((level - 1)) -o "$work/mixed.tm" "$knot"
    strong "octree-repair -t 0.2" octree-repair -t 0.2 "$work/mixed.tm"
    ;;
esac
case ${PARTS:-strong weak} in
*weak*)
    echo
    echo "as much for each rank: MB sent by each and at most, messages, s of CPU, busiest / mean, MB"
    echo "                         ranks       MB   most MB  messages      most         s   busiest        MB  ghosts"
    step=${WEAK:-5} more=1
    for n in ${RANKS:-2 4 8 16 32 64}; do
        while [ $((more * 4)) -le "$n" ]; do
            more=$((more * 4)) step=$((step + 1))
        done
        weak "octree-mesh -s $step" "$n" octree-mesh -s "$step" "$knot"
    done
    for n in ${RANKS:-2 4 8 16 32 64}; do
        points $((3000 * n)) 1 | tetgen-mesh -o "$work/tets.tm"
        weak "tet-stats" "$n" tet-stats "$work/tets.tm"
        weak "mesh-check" "$n" mesh-check "$work/tets.tm"
        weak "polylla3d --star" "$n" polylla3d --star "$work/tets.tm"
    done
    ;;
esac
