#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Is what 32 bits cannot number refused, in words, before a number is taken twice? Run by
# make limits: limits.sh BUILD LIMITED, where LIMITED is built with TM_IDS=16000
# (lib/base/ids.h). All filters run on meshes below, near and above the limits. Right is
# what the other build does, with no more rows in any block than there are numbers; or exit
# status 3 or 4, a message that says that there are too many, and no .end.
set -u
build=$(cd "$1" && pwd) && limited=$(cd "$2" && pwd) || exit 4
ids=16000
work=$(mktemp -d) || exit 4
trap 'rm -rf "$work"' EXIT
mkdir "$work/in"
cd "$work/in" || exit 4
PATH=$build/bin:$build/bench:$PATH
runs=0
refused=0
wrong=0

# run COMMAND… : in both builds.
run() {
    filter=$1
    shift
    runs=$((runs + 1))
    for which in build limited; do
        rm -rf "${work:?}/$which"
        mkdir "$work/$which"
        bin=$build/bin
        [ "$which" = build ] || bin=$limited/bin
        (cd "$work/$which" && "$bin/$filter" --quiet --no-history "$@" >stdout 2>stderr
            echo $? >status)
    done
    status=$(cat "$work/limited/status")
    if diff -rq "$work/build" "$work/limited" >"$work/diff"; then
        awk -v ids=$ids '/^[a-z]*\.[a-z]+$/ { block = $1; getline; if ($1 >= ids) bad = 1 }
            END { exit bad }' "$work/limited/stdout" && return
        echo "WRONG  $filter $*: more rows than numbers"
    elif { [ "$status" -eq 3 ] || [ "$status" -eq 4 ]; } &&
        grep -qE 'more .* than|more than|too many|a count of|than .* bits' "$work/limited/stderr" &&
        [ "$(wc -l <"$work/limited/stderr")" -eq 1 ] &&
        ! grep -qx '\.end' "$work/limited/stdout"; then
        refused=$((refused + 1))
        return
    else
        echo "WRONG  $filter $*: ends with $status: $(head -n 2 "$work/limited/stderr")"
        head -n 3 "$work/diff" | cut -c 1-150
    fi
    wrong=$((wrong + 1))
}

in=$work/in
printf '%s\n' OFF '8 6 0' '0 0 0' '1 0 0' '0 1 0' '1 1 0' '0 0 1' '1 0 1' '0 1 1' '1 1 1' \
    '4 0 2 3 1' '4 4 5 7 6' '4 0 1 5 4' '4 2 6 7 3' '4 0 4 6 2' '4 1 3 7 5' >cube.off
for volume in 0.01 0.001 0.0004; do
    tetgen-mesh --quiet -q1.4 -a "$volume" cube.off >tets.tm
    off-export --quiet tets.tm >skin.off
    polylla3d --quiet tets.tm >cells.tm
    run tetgen-mesh -q1.4 -a "$volume" "$in/cube.off"
    for filter in tet-stats jens-stats mesh-check mesh-view lepp-improve polylla3d poly-dual \
        abaqus-export medit-export vtk-export vtu-export visf-export off-export; do
        run "$filter" "$in/tets.tm"
    done
    run lepp-improve -a bisection -s 1 "$in/tets.tm"
    run polylla3d --star "$in/tets.tm"
    run poly-stats "$in/cells.tm"
    run mesh-check "$in/cells.tm"
    run openfoam-export out "$in/cells.tm"
    run surface-import "$in/skin.off"
    run surface-mend --weld auto "$in/skin.off"
    for format in abaqus medit vtk vtu visf m3d; do
        "$format-export" --quiet tets.tm >"tets.$format"
        run "$format-import" "$in/tets.$format"
    done
done
if command -v octree-mesh >/dev/null; then
    for level in 2 3 4; do
        octree-mesh --quiet -a "$level" cube.off >mixed.tm || continue
        run octree-mesh -a "$level" "$in/cube.off"
        run octree-mesh -a "$level" --polyhedra "$in/cube.off"
        for filter in octree-repair mesh-check jens-stats polylla3d oct-export vtk-export \
            m3d-export visf-export; do
            run "$filter" "$in/mixed.tm"
        done
        run octree-repair -t 0.5 "$in/mixed.tm"
    done
fi
echo "$runs runs, $refused refused, $wrong wrong"
[ "$wrong" -eq 0 ]
