#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What solvers gain from polyhedra, ours beside those of others, by three methods:
#
#   virtual elements and discontinuous Galerkin, both of lowest order, on the unit cube
#   with a smooth solution (tests/solve/poisson.c): the errors for as many cells, and the
#   unknowns for the same error
#   finite volumes: OpenFOAM's checkMesh and laplacianFoam, on surfaces (openfoam.inc)
#
# Others: METIS (gpmetis) and k-means of the same tetrahedra (agglomerate.py, which needs
# numpy), relaxed Voronoi cells (voronoi.cc, which needs voro++), OpenFOAM's polyDualMesh.
# Programs and options that are not there are left out, with a note. A quarter of an hour.
# The environment:
#   TM_DATA   a folder with knot.off, femur.off, fandisk.off and anchor_dense.off; those
#             that are there are used, besides a generated gear; others are left out,
#             with a note
#   PARTS     which of: errors unknowns volumes; all
#   MODELS    which of these surfaces; all
#   LEVELS    of octants, at surfaces alone (-s) and everywhere (-a); 4 5
#   VOLUMES   of the cube's tetrahedra, at most, for the errors; 0.00026 0.000033, which
#             make about 400 and 3 000 polyhedra
# shellcheck source-path=SCRIPTDIR source=peers.inc
. "$(dirname "$0")/peers.inc"
# shellcheck source-path=SCRIPTDIR source=openfoam.inc
. "$(dirname "$0")/openfoam.inc"
make -s build/solve/poisson
PATH=$PWD/build/solve:$PATH
for python in python3 /usr/bin/python3; do
    ! $python -c 'import numpy' 2>/dev/null || break
done
h1=$work/h1
: >"$h1"

note() {
    echo "  left out: $*"
}

# has FILTER WORD: whether its --help has the word.
has() {
    command -v "$1" >/dev/null && "$1" --help | grep -q -e "$2"
}

# Exit status 1 says that some are no stars.
polyhedra() {
    polylla3d -q "$@" || [ $? -eq 1 ]
}

# octants OPTION… SURFACE: the polyhedra of octree-mesh.
octants() {
    if has octree-mesh --polyhedra; then
        octree-mesh -q --polyhedra "$@"
    else
        octree-mesh -q "$@" >"$work/octants.tm" && polyhedra "$work/octants.tm"
    fi
}

have_voronoi() {
    printf '#if !__has_include(<voro++/voro++.hh>)\n#error\n#endif\n' |
        c++ -E -x c++ - >/dev/null 2>&1 || return
    source=tests/bench/voronoi.cc
    [ -n "$(find build/bench/voronoi -newer $source 2>/dev/null)" ] ||
        c++ -std=c++17 -O2 -o build/bench/voronoi $source -lvoro++
}

# grid N: the unit cube as N^3 cubes.
grid() {
    awk -v n="$1" '
        function node(i, j, k) { return i + (n + 1) * (j + (n + 1) * k) }
        function cell(i, j, k) { return i + n * (j + n * k) }
        # The facet across an axis at a corner, from the cell before it to that behind it.
        function facet(axis, i, j, k,   p, c1, c2, nodes, turn) {
            p = axis == 0 ? i : axis == 1 ? j : k
            c1 = p == 0 ? -1 : cell(i - (axis == 0), j - (axis == 1), k - (axis == 2))
            c2 = p == n ? -1 : cell(i, j, k)
            if (axis == 0)
                nodes = node(i, j, k) " " node(i, j + 1, k) " " node(i, j + 1, k + 1) " " node(i, j, k + 1)
            else if (axis == 1)
                nodes = node(i, j, k) " " node(i, j, k + 1) " " node(i + 1, j, k + 1) " " node(i + 1, j, k)
            else
                nodes = node(i, j, k) " " node(i + 1, j, k) " " node(i + 1, j + 1, k) " " node(i, j + 1, k)
            if (c1 < 0) {
                split(nodes, turn, " ")
                nodes = turn[4] " " turn[3] " " turn[2] " " turn[1]
                c1 = c2
                c2 = -1
            }
            row[facets] = facets " " c1 " " c2 " 4 " nodes
            of[c1] = of[c1] " " facets
            if (c2 >= 0) of[c2] = of[c2] " " facets
            facets++
        }
        BEGIN {
            facets = 0
            print "termesh 1\n.node\n" (n + 1) ^ 3, "3 0 0"
            for (k = 0; k <= n; k++) for (j = 0; j <= n; j++) for (i = 0; i <= n; i++)
                printf "%d %.17g %.17g %.17g\n", node(i, j, k), i / n, j / n, k / n
            for (k = 0; k <= n; k++) for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) {
                if (j < n && k < n) facet(0, i, j, k)
                if (i < n && k < n) facet(1, i, j, k)
                if (i < n && j < n) facet(2, i, j, k)
            }
            print ".facet\n" facets, 0
            for (f = 0; f < facets; f++) print row[f]
            print ".cell\n" n ^ 3, 0
            for (c = 0; c < n ^ 3; c++) print c, 6 of[c]
            print ".end"
        }'
}

cells_of() {
    sed -n '/^\.cell/{n;p;q;}' "$1" | cut -d ' ' -f 1
}

# solved MESH OPTION…: unknowns, L2 and H1 error.
solved() {
    mesh=$1
    shift
    poisson --wave "$@" "$mesh" | tr -d , | awk '{ print $1, $9, $12 }'
}

# h1_of NAME METHOD: of the row with that name.
h1_of() {
    awk -F '\t' -v name="$1" -v method="$2" '$1 == name && $2 == method { print $3 }' "$h1"
}

cube_line() {
    printf '%-26s %7s %7s %6s %6s %6s %6s %6s %9s %8s %7s %9s %8s\n' "$@"
}

# shape MESH: nodes, facets of a cell, the largest diameter, the spread of volumes, Sorgente's
# indicator.
shape() {
    poly-stats -q --json - "$1" | $python -c '
import json, sys
s = json.load(sys.stdin)
v = s["finite_volume"]
print(s["nodes"], "%.1f" % s["faces_per_polyhedron"], "%.2f" % s["max_diameter"],
      "%.1f" % v["volume_spread"], "%.3f" % s["vem_indicator"])'
}

# cube_row NAME MESH: shape, and the errors by both methods.
cube_row() {
    solved "$2" >"$work/vem"
    solved "$2" --dg >"$work/dg"
    # shellcheck disable=SC2046 # words
    cube_line "$1" "$(cells_of "$2")" $(shape "$2") $(cat "$work/vem" "$work/dg")
    for method in vem dg; do
        printf '%s\t%s\t%s\n' "$1" $method "$(cut -d ' ' -f 3 "$work/$method")" >>"$h1"
    done
}

# made NAME COMMAND…: a row of what the command writes.
made() {
    name=$1
    shift
    if "$@" >"$work/made.tm"; then
        cube_row "$name" "$work/made.tm"
    else
        note "$name, which failed"
    fi
}

# The errors for as many cells as --star --absorb makes of tetrahedra.
errors() {
    : >"$h1"
    tetgen-mesh -q -a "$1" --no-history -o "$work/tets.tm" "$work/cube.off"
    polyhedra --star --absorb "$work/tets.tm" >"$work/absorbed.tm"
    n=$(cells_of "$work/absorbed.tm")
    printf '\n%d tetrahedra, about %d cells\n' "$(tets_of "$work/tets.tm")" "$n"
    cube_line '' cells nodes faces diam. spread rho VEM L2 H1 DG L2 H1
    made tetrahedra polyhedra --max-tets 1 "$work/tets.tm"
    made --star polyhedra --star "$work/tets.tm"
    cube_row '--star --absorb' "$work/absorbed.tm"
    made "--cells --star" polyhedra --cells "$n" --star "$work/tets.tm"
    made "--cells --star --absorb" polyhedra --cells "$n" --star --absorb "$work/tets.tm"
    if has polylla3d 'star\[='; then
        made "--cells --star=centroid" polyhedra --cells "$n" --star=centroid "$work/tets.tm"
    else
        note '--star=centroid'
    fi
    if $python -c 'import numpy' 2>/dev/null; then
        made 'k-means' $python -B tests/bench/agglomerate.py --kmeans "$n" "$work/tets.tm"
    else
        note 'k-means, which needs numpy'
    fi
    if command -v gpmetis >/dev/null; then
        made METIS $python -B tests/bench/agglomerate.py --metis "$n" "$work/tets.tm"
        if has polylla3d --partition; then
            $python -B tests/bench/agglomerate.py --metis "$n" --label "$work/tets.tm" \
                >"$work/labelled.tm"
            made '  --partition --star' polyhedra --partition --star "$work/labelled.tm"
        fi
    else
        note 'METIS: gpmetis of the package metis'
    fi
    if have_voronoi; then
        made 'Voronoi, relaxed' build/bench/voronoi "$n"
    else
        note 'Voronoi cells: the package voro++-dev'
    fi
    if command -v poly-dual >/dev/null; then
        made 'poly-dual of tetrahedra' poly-dual -q "$work/tets.tm"
    else
        note poly-dual
    fi
    made cubes grid "$(awk -v n="$n" 'BEGIN { print int(exp(log(n) / 3) + 0.5) }')"
    for method in vem dg; do
        ours=$(product "$(h1_of '--cells --star' $method)" 1000)
        target "1000 H1, $method, of --cells, to --absorb" "$ours" \
            "$(product "$(h1_of '--star --absorb' $method)" 850)"
        target '  to k-means' "$ours" "$(product "$(h1_of k-means $method)" 850)"
        target '  to METIS' "$ours" "$(product "$(h1_of METIS $method)" 1000)"
    done
}

# reached MESH: whether the error is at most the limit; adds unknowns and error to $work/way.
reached() {
    solved "$1" --dg >"$work/dg"
    awk '{ print $3, $1 }' "$work/dg" >>"$work/way"
    awk -v goal="$goal" '{ exit !($3 <= goal) }' "$work/dg"
}

# Of polylla3d's cells of the fine tetrahedra the fewest, by bisection.
fewest_cells() {
    low=100 high=6000
    while [ $((high - low)) -gt $((low / 50)) ]; do
        n=$(((low + high) / 2))
        polyhedra --cells "$n" --star "$work/fine.tm" >"$work/made.tm"
        if reached "$work/made.tm"; then
            high=$n
        else
            low=$n
        fi
    done
}

# From coarse to fine octants.
fewest_octants() {
    for size in 0.14 0.125 0.11 0.1 0.09 0.083 0.077 0.071 0.0625 0.05; do
        octants --size "$size" --inner-size "$size" "$work/cube.off" >"$work/made.tm" ||
            continue
        ! reached "$work/made.tm" || break
    done
}

fewest_cubes() {
    for n in 8 9 10 11 12 13 14 15 16; do
        grid $n >"$work/made.tm"
        ! reached "$work/made.tm" || break
    done
}

# Duals of finer and finer tetrahedra.
fewest_dual() {
    for volume in 0.0004 0.00032 0.00026 0.0002 0.00016 0.00013 0.0001 0.00008 0.00006; do
        tetgen-mesh -q -a $volume --no-history "$work/cube.off" | poly-dual -q \
            >"$work/made.tm" || continue
        ! reached "$work/made.tm" || break
    done
}

# fewest NAME WAY: prints the least unknowns on the way that reach the limit.
fewest() {
    : >"$work/way"
    "$2"
    least=$(awk -v goal="$goal" '$1 <= goal && (!n || $2 < n) { n = $2 } END { print n }' \
        "$work/way")
    printf '  %-26s %8s  %6s of the tetrahedra'"'"'s\n' "$1" "${least:-none}" \
        "$(awk -v a="${least:-0}" -v b="$all" 'BEGIN { if (a) printf "%.3f", a / b }')"
}

# The unknowns of discontinuous Galerkin for the error of tetrahedra.
unknowns() {
    tetgen-mesh -q -a 0.00026 --no-history -o "$work/tets.tm" "$work/cube.off"
    tetgen-mesh -q -a 0.000033 --no-history -o "$work/fine.tm" "$work/cube.off"
    polyhedra --max-tets 1 "$work/tets.tm" >"$work/made.tm"
    solved "$work/made.tm" --dg >"$work/dg"
    read -r all _ goal <"$work/dg"
    printf '\nUnknowns of discontinuous Galerkin for an H1 error of %s\n' "$goal"
    printf '  %-26s %8s\n' tetrahedra "$all"
    fewest 'polylla3d --cells --star' fewest_cells
    target 'of the tetrahedra'"'"'s unknowns' "${least:-$all}" "$(product "$all" 0.5)"
    fewest "octants$(has octree-mesh --polyhedra || echo ', joined')" fewest_octants
    target 'of the tetrahedra'"'"'s unknowns' "${least:-$all}" "$(product "$all" 0.25)"
    if command -v poly-dual >/dev/null; then
        fewest poly-dual fewest_dual
    else
        note poly-dual
    fi
    fewest cubes fewest_cubes
}

foam_line() {
    printf '%s\n' "$1" | awk -F '\t' '{
        printf "  %-26s %7s %-10s %8s %8s %6s %8s %9s %9s\n", $1, $2, $3, $4, $5, $6, $7, $8, $9
    }'
}

# The last row, and which checks failed.
foam_print() {
    foam_line "$(cat "$work/row")"
    foam_failed "$work/case"
    sed "s/^/$model	/" "$work/row" >>"$work/rows"
}

# judged NAME COMMAND…: a row of the polyhedra or tetrahedra that the command writes.
judged() {
    name=$1
    shift
    if "$@" >"$work/made.tm" && foam_case "$work/case" &&
        openfoam-export -q "$work/case/constant/polyMesh" "$work/made.tm"; then
        foam_row "$name" "$work/case" >"$work/row"
        foam_print
    else
        note "$name, which failed"
    fi
}

# OpenFOAM's own dual of the tetrahedra.
judge_foam_dual() {
    if ! command -v polyDualMesh >/dev/null; then
        note polyDualMesh
        return
    fi
    foam_case "$work/case"
    openfoam-export -q "$work/case/constant/polyMesh" "$work/tets.tm"
    if (cd "$work/case" && polyDualMesh 40 -overwrite >dual 2>&1); then
        foam_row polyDualMesh "$work/case" >"$work/row"
        foam_print
    else
        note 'polyDualMesh, which failed'
    fi
}

# foam_figure MODEL NAME COLUMN: 2 cells, 3 verdict, 4 wrong pyramids, 5 angle, 8 and 9 errors.
foam_figure() {
    awk -F '\t' -v model="$1" -v name="$2" -v column="$3" \
        '$1 == model && $2 == name { print $(column + 1) }' "$work/rows"
}

# In thousandths, for target; diverged is 9.
error_figure() {
    product "$(foam_figure "$@" | sed 's/diverged/9/')" 1000
}

# aims NAME: of what is to be used as it is.
aims() {
    [ -n "$(foam_figure "$model" "$1" 2)" ] || return 0
    target "$1: checks that failed" \
        "$(foam_figure "$model" "$1" 3 | sed 's/OK/0/; s/no verdict/9/; s/ failed//')" 0
    target '  wrong pyramids' "$(foam_figure "$model" "$1" 4)" 0
    target '  largest non-orthogonality' "$(foam_figure "$model" "$1" 5)" 70
    target '  cells' "$(foam_figure "$model" "$1" 2)" \
        "$(product "$(foam_figure "$model" tetrahedra 2)" 0.3334)"
    target '  1000 error, linear' "$(error_figure "$model" "$1" 8)" \
        "$(error_figure "$model" tetrahedra 8)"
    target '  1000 error, smooth' "$(error_figure "$model" "$1" 9)" \
        "$(error_figure "$model" tetrahedra 9)"
}

# volumes MODEL SURFACE
volumes() {
    model=$1
    printf '\n%s\n' "$model"
    tetgen-mesh -q --no-history -o "$work/tets.tm" "$2"
    judged tetrahedra cat "$work/tets.tm"
    judged 'polylla3d --star' polyhedra --star "$work/tets.tm"
    if has polylla3d 'star\[='; then
        judged '--star=centroid' polyhedra --star=centroid "$work/tets.tm"
        target '--star=centroid: wrong pyramids' "$(foam_figure "$model" --star=centroid 4)" 0
        target '  1000 error, smooth' "$(error_figure "$model" --star=centroid 9)" 1000
    else
        note '--star=centroid'
    fi
    if command -v poly-dual >/dev/null; then
        judged poly-dual poly-dual -q "$work/tets.tm"
        judged 'poly-dual --convex' poly-dual -q --feature-angle 30 --convex "$work/tets.tm"
        aims 'poly-dual --convex'
    else
        note poly-dual
    fi
    judge_foam_dual
    for level in ${LEVELS:-4 5}; do
        for where in -s -a; do
            judged "octants $where $level" octants $where "$level" "$2"
            aims "octants $where $level"
        done
    done
}

unit_cube >"$work/cube.off"
for part in ${PARTS:-errors unknowns volumes}; do
    case $part in
    errors)
        for volume in ${VOLUMES:-0.00026 0.000033}; do
            errors "$volume"
        done
        ;;
    unknowns) unknowns ;;
    volumes)
        if ! have_openfoam; then
            note 'finite volumes: the package openfoam'
            continue
        fi
        : >"$work/rows"
        printf '\n'
        foam_line "OpenFOAM	cells	checkMesh	pyramids	max	mean	skew	linear	smooth"
        shapes gear >"$work/gear.off"
        for name in ${MODELS:-gear knot femur fandisk anchor_dense}; do
            case $name in
            gear) volumes gear "$work/gear.off" ;;
            *)
                if [ -r "$data/$name.off" ]; then
                    volumes "$name" "$data/$name.off"
                else
                    note "$name: no $name.off in TM_DATA (${TM_DATA:-which is not set})"
                fi
                ;;
            esac
        done
        ;;
    esac
done
