#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What threads gain: seconds by the clock of whole processes with -j 1 and with -j THREADS
# (2), in turn, and that both give the same bytes. Needs free cores: medians of RUNS (3).
# POINTS (200000) random points make the tetrahedra, CELLS (102) those that are only read;
# LEVEL (6) is that of the octree in a cube, KNOT (8) that in knot.off, where TM_DATA has
# it.
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
threads=${THREADS:-2}
runs=${RUNS:-3}
points "${POINTS:-200000}" 1 >"$work/points.node"
tetgen-mesh -q --no-history "$work/points.node" >"$work/tets.tm" 2>/dev/null ||
    tetgen-mesh --no-history "$work/points.node" >"$work/tets.tm"
unit_cube >"$work/cube.off"
octree-mesh -q --no-history -a "${LEVEL:-6}" -o "$work/octree.tm" "$work/cube.off"
io make "${CELLS:-102}" >"$work/grid.tm"
echo "$(tets_of "$work/tets.tm") tetrahedra, $(nproc) cores"
echo "work                      -j 1 (s)  -j $threads (s)    gain"

# Seconds by the clock of a command that reads $input.
seconds() {
    begin=$(date +%s.%N)
    "$@" <"$work/$input" >"$work/out" 2>/dev/null || true
    echo "$begin $(date +%s.%N)" | awk '{ print $2 - $1 }'
}

# compare NAME INPUT COMMAND… : the number of threads is given behind it.
compare() {
    name=$1
    input=$2
    shift 2
    : >"$work/one"
    : >"$work/several"
    run=0
    while [ "$run" -lt "$runs" ]; do
        seconds "$@" 1 >>"$work/one"
        mv "$work/out" "$work/first"
        seconds "$@" "$threads" >>"$work/several"
        cmp "$work/first" "$work/out"
        run=$((run + 1))
    done
    echo "$name|$(median_of "$work/one")|$(median_of "$work/several")" | awk -F '|' '{
        printf "%-24s %9.3f %9.3f %7.2f\n", $1, $2, $3, $2 / $3 }'
}

compare "reading" grid.tm io read
compare "mesh-check" grid.tm mesh-check -j
compare "tet-stats" grid.tm tet-stats -j
compare "jens-stats" octree.tm jens-stats --threads
compare "lepp-improve" tets.tm lepp-improve --no-history -j
compare "polylla3d --star" tets.tm polylla3d --no-history --star -j
compare "octree-repair" octree.tm octree-repair --no-history -t 0.2 -j
compare "octree-mesh" cube.off octree-mesh --no-history -a "${LEVEL:-6}" -j

knot=${TM_DATA:-}/knot.off
[ -f "$knot" ] || exit 0
ln -s "$knot" "$work/knot.off"
compare "octree-mesh, knot" knot.off octree-mesh -q --no-history -s "${KNOT:-8}" -j
octree-mesh -q --no-history -s "${KNOT:-8}" -o "$work/knot.tm" "$knot"
compare "octree-repair, knot" knot.tm octree-repair -q --no-history -t 0.2 -j
compare "jens-stats, knot" knot.tm jens-stats --threads
