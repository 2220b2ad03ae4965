#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# From a surface to improved tetrahedra, the triangles of the surface kept: Gmsh with its
# HXT and with its Delaunay algorithm, each with its own optimiser, beside
#   tetgen-mesh -Y -q SURFACE | lepp-improve -a improve --max-growth X
# where X allows as many tetrahedra as Gmsh has. CPU seconds of all processes together,
# reading and writing included; ratios are to what tetgen-mesh makes. $1, TM_DATA and the
# rest: peers.inc.
# shellcheck source-path=SCRIPTDIR source=peers.inc
. "$(dirname "$0")/peers.inc"

# Prints a surface of triangles, in OFF without comments, as a mesh file for Gmsh, whose
# own reading of STL would round the nodes to single precision: off_to_msh FILE.
off_to_msh() {
    awk '/OFF/ || !NF { next }
    !sized { nodes = $1; faces = $2; sized = 1
        print "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" nodes; next }
    row++ < nodes { print row, $1, $2, $3; next }
    row == nodes + 1 { print "$EndNodes\n$Elements\n" faces }
    { print row - nodes, 2, 2, 0, 1, $2 + 1, $3 + 1, $4 + 1 }
    END { print "$EndElements" }' "$1"
}

# gmsh_mesh SURFACE ALGORITHM, where $work/SURFACE.geo says what to fill.
gmsh_mesh() {
    rm -f "$work/gmsh.msh"
    cpu 1 gmsh -3 -algo "$2" -nt 1 -v 0 -bin -o "$work/gmsh.msh" "$work/$1.geo" |
        sed 's/^/- /; s/ [0-9]*$//'
    $python -B tests/bench/gmsh-read.py "$work/gmsh.msh" "$out"
}

tetgen_only() {
    cpu 1 tetgen-mesh -Y -q "$1" | sed 's/^/- /; s/ [0-9]*$//'
    tetgen-mesh -Y -q "$1" >"$out"
}

# tetgen_improve FILE [OPTION…]: the pipe. The exit status is that of its last program.
tetgen_improve() {
    file=$1
    shift
    echo 0 >"$work/status"
    # shellcheck disable=SC2016,SC2086 # for the inner shell; words
    cpu 1 sh -c 'file=$1; shift
        tetgen-mesh -Y -q "$file" | lepp-improve -q "$@" || echo $? >"$0"' "$work/status" \
        "$file" $improve_options -o "$out" "$@" >"$work/cpu"
    echo - "$(cut -d ' ' -f 1 "$work/cpu")" "$(cat "$work/status")"
}

# The growth that makes no more than so many tetrahedra: growth_to MESH TETRAHEDRA.
growth_to() {
    awk -v n="$2" -v from="$(tets_of "$work/$1.tm")" 'BEGIN {
        printf "%.3f\n", int(1000 * n / from) / 1000
    }'
}

beside() {
    tets=$(figure "$1" "$2" tets)
    [ -n "$tets" ] || return 0
    limit=$(growth_to "$1" "$tets")
    # shellcheck disable=SC2046 # words
    row "$1" ours "as large as $2: $limit" "${growth_option:+$limit}" \
        tetgen_improve "$(surface_file "$1")" $(growth "$limit")
}

: >"$figures"
for name in $(surfaces); do
    file=$(surface_file "$name")
    tetgen-mesh -Y -q --no-history "$file" >"$work/$name.tm"
    printf '\n%s, %d triangles\n' "$(basename "$file")" \
        "$(awk '/OFF/ { next } NF { print $2; exit }' "$file")"
    head_row
    row "$name" peer 'tetgen-mesh -Y -q' '' tetgen_only "$file"
    if command -v gmsh >/dev/null && have_gmsh; then
        off_to_msh "$file" >"$work/$name.surface.msh"
        printf 'Merge "%s";\nSurface Loop(1) = {1};\nVolume(1) = {1};\n' \
            "$work/$name.surface.msh" >"$work/$name.geo"
        row "$name" peer 'Gmsh HXT' '' gmsh_mesh "$name" hxt
        row "$name" peer 'Gmsh Delaunay' '' gmsh_mesh "$name" del3d
        beside "$name" 'Gmsh HXT'
        beside "$name" 'Gmsh Delaunay'
    else
        echo 'Gmsh: needs the packages gmsh and python3-gmsh'
    fi
    ours=$(awk -F '\t' -v mesh="$name" '$1 == mesh && $3 ~ /HXT:/ { print $3 }' "$figures")
    target 'tetrahedra (HXT)' "$(figure "$name" "$ours" tets)" \
        "$(figure "$name" 'Gmsh HXT' tets)"
    target 'bad % (1/2 of HXT)' "$(figure "$name" "$ours" bad)" \
        "$(product "$(figure "$name" 'Gmsh HXT' bad)" 0.5)"
    target 'CPU s in all (HXT)' "$(figure "$name" "$ours" whole)" \
        "$(figure "$name" 'Gmsh HXT' whole)"
done
