#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Meshes of octree-mesh on generated shapes and, where TM_DATA names a folder with them,
# on surfaces from there, judged by octree-judge.py, which says what the columns are; the
# speed beside tetgen -pq on the same surface; then what is aimed at. The environment:
#   TM_DATA   a folder with femur.off, knot.off, fandisk.off, anchor_dense.off, cortex.mdl
#             and cortex_surf_roi.mdl; those that are there are used
#   LEVELS    of -s; 5 6 7, of solids of few sharp polygons 5, of the wedge, whose
#             shortest side is what the level counts from, 2
#   SHAPES    which shapes and which of these files; all
#   OPTIONS   more options for octree-mesh
#   REPAIR    a threshold: what octree-repair -t makes of these meshes is judged instead,
#             and its time; the title says how many elements went in
#   FIGURES   the file for the rows as JSON
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
data=${surface:+$(dirname "$surface")}
files="femur.off knot.off fandisk.off anchor_dense.off cortex.mdl"
region=$data/cortex_surf_roi.mdl
figures=${FIGURES:-$work/figures}
: >"$figures"

# judge ARGUMENT… : Debian's python has VTK.
judge() {
    /usr/bin/python3 -B tests/bench/octree-judge.py "$@"
}

# all_shapes: the names of the generated ones, and of the files that are there.
all_shapes() {
    shapes
    for file in $files; do
        [ ! -r "$data/$file" ] || echo "$file"
    done
}

# surface_of NAME: its file.
surface_of() {
    case $1 in
    *.*) echo "$data/$1" ;;
    *)
        shapes "$1" >"$work/$1.off"
        echo "$work/$1.off"
        ;;
    esac
}

# levels_of NAME
levels_of() {
    case $1 in
    wedge) echo "${LEVELS:-2}" ;;
    star | slit | spike | step | spool) echo "${LEVELS:-5}" ;;
    *) echo "${LEVELS:-5 6 7}" ;;
    esac
}

# tetgen_rate SURFACE: TetGen's tetrahedra by CPU second; nothing where it fails.
tetgen_rate() {
    rm -f "$work"/tetgen.*
    judge --off "$1" >"$work/tetgen.off"
    seconds=$(cpu 1 timeout 300 tetgen -pqQ "$work/tetgen.off" 2>/dev/null | cut -d ' ' -f 1)
    [ -s "$work/tetgen.1.ele" ] || return 0
    awk -v s="$seconds" '{ print $1 / s; exit }' "$work/tetgen.1.ele"
}

# mesh NAME SURFACE RATE OPTION… : makes a mesh and prints its row.
mesh() {
    name=$1 file=$2 rate=$3
    shift 3
    title=$name
    for option; do
        title="$title $(basename -- "$option" .mdl)"
    done
    # shellcheck disable=SC2086 # words
    set -- octree-mesh ${OPTIONS:-} "$@" "$file"
    if [ -n "${REPAIR:-}" ]; then
        "$@" -q >"$work/made.tm" || [ $? -eq 1 ]
        title="$title ($(sed -n '/^\.mix/{n;p;q;}' "$work/made.tm" | cut -d ' ' -f 1))"
        rate=
        set -- octree-repair -t "$REPAIR" "$work/made.tm"
    fi
    echo 0 >"$work/status"
    # shellcheck disable=SC2016 # for the inner shell
    cpu 1 sh -c 'to=$1 status=$2; shift 2; "$@" >"$to" || echo $? >"$status"' sh \
        "$work/mesh.tm" "$work/status" "$@" >"$work/cpu" 2>"$work/notes" </dev/null
    status=$(cat "$work/status")
    if [ "$status" -gt 1 ]; then
        printf '%-20s failed: %s\n' "$title" "$(tail -n 1 "$work/notes")"
        echo "$title" >>"$work/failed"
        return
    fi
    read -r seconds memory <"$work/cpu"
    judge --cpu "$seconds" --memory "$memory" --status "$status" --notes "$work/notes" \
        ${rate:+--rate "$rate"} --figures "$figures" "$title" "$file" "$work/mesh.tm"
}

judge --head
: >"$work/failed"
for name in ${SHAPES:-$(all_shapes)}; do
    file=$(surface_of "$name")
    rate=$(tetgen_rate "$file")
    for level in $(levels_of "$name"); do
        mesh "$name" "$file" "$rate" -s "$level"
    done
    if [ "$name" = cortex.mdl ] && [ -r "$region" ]; then
        mesh "$name" "$file" "$rate" -s 5 -r "$region" 7
    fi
done
judge --aims "$figures"
[ ! -s "$work/failed" ] || echo "  failed: $(wc -l <"$work/failed") of them"
