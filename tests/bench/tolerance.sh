#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Surfaces that may move by a hair: tetgen-mesh -q of surfaces, then
#   lepp-improve --surface-tolerance D
# beside mmg3d -optim (the programs mmg3d, mmg3d_O3 in PATH, or MMG=PROGRAM; nothing where
# there is none), with the distance from the surface as surface-judge.py samples it, in
# parts of D, and as tet-stats --against proves it for curves and surface.
#   $1 or TM_DATA       the folder of femur.off, part.off, fandisk.off, anchor_dense.off and
#                       knot.off; without it, only generated ones
#   ONLY                the names to run, with blanks; strips:200 is the shape so fine
#   TOLERANCE_OPTIONS   what lepp-improve is given; --surface-tolerance D
#   JUDGE_SAMPLES       points of the judge; 50000. 0: it is not asked
data=${1:-${TM_DATA:-}}
[ ! -f "$data" ] || data=$(dirname "$data")
set --
unset TM_DATA
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"

mmg=${MMG:-$(command -v mmg3d || command -v mmg3d_O3 || :)}
judge_python=/usr/bin/python3
samples=${JUDGE_SAMPLES:-50000}
shapes="needles strips scan slit tiny folds knife plates tube wavy nested patches"

names() {
    for name in part femur femur4 fandisk anchor_dense knot; do
        [ ! -r "$data/${name%4}.off" ] || echo "$name"
    done
    # shellcheck disable=SC2086 # words
    printf '%s\n' $shapes points
}

# Writes $work/NAME.tm: make_mesh NAME.
make_mesh() {
    case $1 in
    points)
        points 20000 1 >"$work/points.node"
        tetgen-mesh --quiet --no-history "$work/points.node"
        ;;
    femur4) tetgen-mesh --quiet -q4 --no-history "$data/femur.off" ;;
    *)
        file=$data/$1.off
        if [ ! -r "$file" ]; then
            file=$work/$1.surface
            fine=${1#"${1%%:*}"}
            # shellcheck disable=SC2086 # a word or none
            python3 -B tests/shapes/awkward.py "${1%%:*}" ${fine#:} >"$file"
        fi
        tetgen-mesh --quiet -q --no-history "$file"
        ;;
    esac >"$work/$1.tm"
}

# The first number with a key in a JSON file: number KEY FILE.
number() {
    sed -n '/"'"$1"'": */{s/.*"'"$1"'": *\([-+.0-9e]*\).*/\1/p;q;}' "$2"
}

row_head() {
    printf '%-24s %8s %6s %8s %8s %8s %7s  %s\n' "$1" tets size 'bad %' smallest largest \
        CPU 'distance / D, judge'
}

# Prints a row: row WHO NAME FILE SECONDS D.
row() {
    tet-stats -q --json "$work/stats.json" "$3" >/dev/null
    tets=$(number tets "$work/stats.json")
    verdict=
    if [ "$2.tm" != "$(basename "$3")" ]; then
        tet-stats -q --against "$work/$2.tm" --json "$work/against.json" "$3" >/dev/null &&
            verdict=$(python3 -B - "$work/against.json" "$5" <<'END'
import json, sys
a = json.load(open(sys.argv[1]))["against"]
print(*("%s %.3f" % (what, max((a[what][way]["most"] or 0) for way in ("there", "back"))
                     / a["diagonal"] / float(sys.argv[2]))
        for what in ("surface", "curves") if what in a), end=" ")
END
            )
        [ "$samples" = 0 ] ||
            verdict="$verdict $("$judge_python" -B tests/bench/surface-judge.py \
                --samples "$samples" "$work/$2.tm" "$3" "$5" 2>&1 |
                awk '/FAIL/ && NF > 1 { sub(/  at.*/, ""); printf "%s; ", $0 } END { print $1 }')"
    fi
    printf '%-24s %8d %6s %8.2f %8.2f %8.2f %7s  %s\n' "$1" "$tets" \
        "$(awk -v n="$tets" -v from="$(tets_of "$work/$2.tm")" 'BEGIN { printf "%.2f", n / from }')" \
        "$(number bad_percent "$work/stats.json")" "$(number min_dihedral "$work/stats.json")" \
        "$(number max_dihedral "$work/stats.json")" "$4" "$verdict"
}

ours() {
    # shellcheck disable=SC2086 # words
    cpu 1 lepp-improve -q --no-history ${TOLERANCE_OPTIONS---surface-tolerance $2} \
        -o "$work/ours.tm" "$work/$1.tm" </dev/null | cut -d ' ' -f 1
}

# Medit's ASCII files are what Mmg reads and writes.
theirs() {
    python3 -B tests/bench/medit.py to "$work/$1.tm" "$work/in.mesh"
    rm -f "$work/out.mesh"
    # shellcheck disable=SC2016 # for the inner shell
    cpu 1 sh -c '"$1" -optim -v 0 "$2" "$3" >/dev/null 2>&1' sh "$mmg" "$work/in.mesh" \
        "$work/out.mesh" | cut -d ' ' -f 1
    [ ! -s "$work/out.mesh" ] ||
        python3 -B tests/bench/medit.py from "$work/out.mesh" "$work/theirs.tm"
}

for name in ${ONLY:-$(names)}; do
    tolerance=0.001
    [ "$name" != points ] || tolerance=0.02
    make_mesh "$name"
    echo
    row_head "$name, D = $tolerance"
    row input "$name" "$work/$name.tm" - "$tolerance"
    our_seconds=$(ours "$name" "$tolerance")
    row lepp-improve "$name" "$work/ours.tm" "$our_seconds" "$tolerance"
    [ -n "$mmg" ] || continue
    rm -f "$work/theirs.tm"
    their_seconds=$(theirs "$name")
    if [ ! -s "$work/theirs.tm" ]; then
        printf '%-24s made nothing\n' 'Mmg -optim'
        continue
    fi
    row 'Mmg -optim' "$name" "$work/theirs.tm" "$their_seconds" "$tolerance"
    awk -v a="$our_seconds" -v b="$their_seconds" 'BEGIN {
        printf "  CPU: %.2f of Mmg\n", (b > 0 ? a / b : 0) }'
done
