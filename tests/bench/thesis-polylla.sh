#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Table 1 of Cerda, Generador de mallas de poliedros en tres dimensiones (Universidad de
# Chile, 2022): polyhedra of random points, ours by the same algorithm (--mode edge
# --no-repair) beside the published ones, and what polylla3d makes otherwise. The points
# are not the same ones. What the thesis calls not simple are those for which Euler's
# formula does not hold, a lower bound, as it says; so its column is Euler's here. Its row
# of 2000 points has tetrahedra and polyhedra the wrong way round, and in the first three
# rows tetrahedra by polyhedra are not the quotient that is printed. Half a minute.
# shellcheck source-path=SCRIPTDIR source=peers.inc
. "$(dirname "$0")/peers.inc"
sizes=${POINTS:-100 1000 2000 3000 4000 5000 6000 7000 8000 9000 10000}

# Points, tetrahedra, polyhedra, not simple, tetrahedra and faces for each polyhedron.
published() {
    cat <<'END'
100 506 313 1 1.56 5.11
1000 6312 3740 29 1.63 5.26
2000 12967 7549 73 1.66 5.32
3000 19624 11398 112 1.72 5.32
4000 26333 15277 152 1.72 5.32
5000 33057 19165 156 1.72 5.32
6000 39640 22979 214 1.73 5.32
7000 46326 26735 239 1.73 5.32
8000 52968 30549 268 1.73 5.32
9000 59704 34433 298 1.73 5.32
10000 66380 38361 329 1.73 5.32
END
}

line() {
    printf '%-26s %8s %9s %9s %9s %10s %7s\n' "$@"
}

# What polylla3d makes of a mesh: polyhedra NAME OPTION…. Where some are no
# stars the exit status is 1.
polyhedra() {
    name=$1
    shift
    { polylla3d -q "$@" "$work/points.tm" || [ $? -eq 1 ]; } >"$work/polyhedra.tm"
    $python -B tests/bench/polyhedra.py "$work/polyhedra.tm" >"$work/counts.$name"
    # shellcheck disable=SC2046 # words
    line "  ${*:-default}" "$tets" $(cat "$work/counts.$name")
}

# count NAME COLUMN: of the last row with that name.
count() {
    cut -d ' ' -f "$2" "$work/counts.$1"
}

line "" tets polyhedra 'tets each' 'faces each' 'not simple' Euler
for n in $sizes; do
    points "$n" 1 >"$work/points.node"
    tetgen-mesh --no-history -o "$work/points.tm" "$work/points.node"
    tets=$(tets_of "$work/points.tm")
    echo "$n points"
    published | awk -v n="$n" '$1 == n { print $3, $5, $6, "-", $4 }' \
        >"$work/counts.published"
    # shellcheck disable=SC2046 # words
    [ ! -s "$work/counts.published" ] || line '  published' \
        "$(published | awk -v n="$n" '$1 == n { print $2 }')" \
        $(cat "$work/counts.published")
    polyhedra edge --mode edge --no-repair
    polyhedra repaired --mode edge
    polyhedra default
    polyhedra star --star
    polyhedra absorb --star --absorb
    for name in repaired default star absorb; do
        count $name 4
    done >>"$work/broken"
done

# Larger by so many times: the points are others, so the last digit may differ.
apart() {
    [ -z "$2" ] || awk -v a="$1" -v b="$2" 'BEGIN { print (a > b ? a / b : b / a) }'
}
echo "$n points"
target 'tetrahedra each, edge, and published' "$(apart "$(count edge 2)" \
    "$(count published 2)")" 1.01
target 'faces each, edge, and published' "$(apart "$(count edge 3)" \
    "$(count published 3)")" 1.01
target '15 / tetrahedra each, --star --absorb' "$(awk -v t="$(count absorb 2)" \
    'BEGIN { print 15 / t }')" 1
echo 'all sizes'
target 'not simple after repair' "$(awk '{ n += $1 } END { print n }' "$work/broken")" 0
