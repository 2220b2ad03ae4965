#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The six cases of Donoso (Universidad Técnica Federico Santa María, 2022) in kind: octants
# to improve in each iteration by refining alone and by octree-repair's full method, for
# the thesis' threshold 0 and for 0.2; elements, worst and average J_ENS, CPU. The cortex
# with its region, and a mesh that the thesis' mesher made, come from the folder TM_DATA,
# where that is given; thin and folded shapes are generated. The thesis has, for the cortex, 21, 7, 2, 1, 0 octants.
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
data=${TM_DATA:-}
limit=${ITERATIONS:-8}

number() {
    tr '{,}' '[\n*]' <"$work/report.json" | sed -n "s/.*\"$1\": *//p" | tail -n 1
}

# repair NAME METHOD THRESHOLD: a row about the mesh.
repair() {
    cpu 1 sh -c 'octree-repair "$@" || [ $? -eq 1 ]' sh --method "$2" -t "$3" -i "$limit" \
        -v --json "$work/report.json" -o "$work/mended.tm" "$work/mesh.tm" \
        >"$work/cpu" 2>"$work/notes" || { echo "$1 $2 failed" && return; }
    octants=$(sed -n 's/.*ctants to improve in iteration [0-9]*: //p; s/^No more .*/0/p' \
        "$work/notes" | tr '\n' ' ')
    printf '%-14s %-6s %4s %9d %7d %6d %8.4f %8.4f %7.2f  %s\n' "$1" "$2" "$3" \
        "$(number elements)" "$(number bad)" "$(number held)" "$(number worst)" \
        "$(number average)" "$(cut -d ' ' -f 1 "$work/cpu")" "$octants"
}

# repair_all NAME: the mesh in all ways.
repair_all() {
    for threshold in 0 0.2; do
        for method in refine full; do
            repair "$1" "$method" "$threshold"
        done
    done
}

# mesh NAME OPTION… : makes a mesh and repairs it.
mesh() {
    name=$1
    shift
    octree-mesh -q -o "$work/mesh.tm" "$@" || [ $? -eq 1 ]
    repair_all "$name"
}

printf '%-14s %-6s %4s %9s %7s %6s %8s %8s %7s  %s\n' mesh method T elements bad held \
    worst average CPU octants
if [ -n "$data" ] && [ -r "$data/cortex.mdl" ]; then
    mesh cortex -s 5 -r "$data/cortex_surf_roi.mdl" 7 "$data/cortex.mdl"
fi
# What the thesis' mesher wrote itself: ids, and no octants outside.
if [ -n "$data" ] && [ -r "$data/palate_0.oct.xz" ]; then
    xz -dc "$data/palate_0.m3d.xz" >"$work/palate.m3d"
    xz -dc "$data/palate_0.oct.xz" |
        oct-import -m "$work/palate.m3d" -s "$data/palate.mdl" -o "$work/mesh.tm"
    repair_all palate_0
fi
for shape in ${SHAPES:-plate sheets hand gear spikes}; do
    shapes "$shape" >"$work/$shape.off"
    mesh "$shape" -s "${LEVEL:-5}" "$work/$shape.off"
done
