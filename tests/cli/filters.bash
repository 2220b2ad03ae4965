# SPDX-License-Identifier: GPL-3.0-or-later
# All filters, a good input for each, and a test run with each.
# shellcheck shell=bash
# shellcheck disable=SC2016,SC2154 # names of sections; run sets stderr

# Whether a filter is not built: there is no p4est, no three.js, or no libgmsh.
is_left_out() {
    { needs_p4est "$1" || needs_gmsh "$1" || [ "$1" = mesh-view ]; } &&
        ! [ -x "$TM_BUILD/bin/$1" ]
}

# Only these may.
needs_p4est() {
    [ "$1" = octree-mesh ] || [ "$1" = octree-repair ]
}

needs_gmsh() {
    [ "$1" = gmsh-import ] || [ "$1" = gmsh-export ]
}

setup_file() {
    root=$(cd "$BATS_TEST_DIRNAME/../.." && pwd)
    filters=$(for file in "$root"/cmd/*.c "$root"/cmd/import/*.c "$root"/cmd/export/*.c; do
        filter=$(basename "$file" .c)
        is_left_out "$filter" || echo "$filter"
    done)
    export root filters
}

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    cat >corner.tm <<'END'
termesh 1
.node
4 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
.ele
1 4 0
1 1 2 3 4
.face
4 0
1 1 3 2
2 1 2 4
3 2 3 4
4 1 4 3
.end
END
    cat >cell.tm <<'END'
termesh 1
.node
4 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
.facet
4 0
1 1 -1 3 1 3 2
2 1 -1 3 1 2 4
3 1 -1 3 2 3 4
4 1 -1 3 1 4 3
.cell
1 1
1 4 1 2 3 4 1
.end
END
    sed -n '/^.node/,/^.ele/p' corner.tm | sed '1d; $d' >corner.node
    sed 's/^\.node/surface.node/; s/^\.face/surface.face/; /^\.ele/,/^1 1 2/d' \
        corner.tm >surface.tm
    printf '%s\n' '2 0' 4 '0 0 0' '1 0 0' '0 1 0' '0 0 1' >corner.visf
    printf '%s\n' '[Vertices, ARRAY1<POINT3D>]' 3 '0 0 0' '1 0 0' '0 1 0' \
        '[Triangles, ARRAY1<STRING>]' 1 '0 1 2 0 0 0' >corner.mdl
    printf '%s\n' MIXED '4 1' '0 0 0' '1 0 0' '0 1 0' '0 0 1' 'T 0 1 2 3' >corner.mvm
    printf '%s\n' '8 0 1' '0 0 0' '0 0 1' '1 0 1' '1 0 0' '0 1 0' '0 1 1' '1 1 1' '1 1 0' \
        '8 0 1 2 3 4 5 6 7 0' 0 'Geometric Transform' '0 0 0' '0 0 0' \
        1 >cube.oct
    printf '%s\n' '$MeshFormat' '2.2 0 8' '$EndMeshFormat' '$Nodes' 4 '1 0 0 0' '2 1 0 0' \
        '3 0 1 0' '4 0 0 1' '$EndNodes' '$Elements' 1 '1 4 2 7 1 1 2 3 4' '$EndElements' \
        >corner.msh
    printf '%s\n' '# vtk DataFile Version 2.0' point ASCII 'DATASET POLYDATA' 'POINTS 1 float' \
        '1 2 3' 'VERTICES 1 2' '1 0' >point.vtk
    printf '%s\n' '*NODE' '1, 0, 0, 0' '2, 1, 0, 0' '3, 0, 1, 0' '4, 0, 0, 1' \
        '*ELEMENT, TYPE=C3D4' '1, 1, 2, 3, 4' >corner.inp
    printf '%s\n' 'MeshVersionFormatted 2' 'Dimension 3' Vertices 4 '0 0 0 0' '1 0 0 0' \
        '0 1 0 0' '0 0 1 0' Tetrahedra 1 '1 2 3 4 5' End >corner.mesh
    mkdir polyMesh
    echo '4((0 0 0) (1 0 0) (0 1 0) (0 0 1))' >polyMesh/points
    echo '4(3(0 2 1) 3(0 1 3) 3(1 2 3) 3(2 0 3))' >polyMesh/faces
    echo '4{0}' >polyMesh/owner
    echo '0()' >polyMesh/neighbour
    echo '1(wall {type wall; nFaces 4; startFace 0;})' >polyMesh/boundary
    printf '%s\n' '<VTKFile type="UnstructuredGrid"><UnstructuredGrid>' \
        '<Piece NumberOfPoints="1" NumberOfCells="0"><Points>' \
        '<DataArray type="Float32" NumberOfComponents="3">1 2 3</DataArray></Points></Piece>' \
        '</UnstructuredGrid></VTKFile>' >point.vtu
    { sed '$d' corner.tm; printf '%s\n' .mix '1 0' '1 4 1 2 3 4' .octant '1 0' \
        '1 0 0 0 0 1 2' .root '1 0' '1 0 0 0 1 0' surface.node '3 3 0 0' '1 0 0 0' \
        '2 1 0 0' '3 0 1 0' surface.face '1 0' '1 1 2 3' .end; } >octant.tm
    { sed '/^surface.node/,$d' octant.tm; echo .end; } >element.tm
}

# The operands with which a filter reads the file $2; for tetgen-import, a .node file.
operands() {
    case $1 in
    tetgen-export | openfoam-export) echo "out $2" ;;
    gmsh-export) echo "out.msh $2" ;;
    *) echo "$2" ;;
    esac
}

# Whether a filter's output is files that an operand names.
writes_files() {
    [ "$1" = tetgen-export ] || [ "$1" = openfoam-export ] || [ "$1" = gmsh-export ]
}

# A good input for a filter.
input() {
    case $1 in
    poly-stats) echo cell.tm ;;
    tetgen-import) echo corner.node ;;
    tetgen-mesh | octree-mesh | surface-import | surface-mend) echo surface.tm ;;
    visf-import) echo corner.visf ;;
    vtu-import) echo point.vtu ;;
    vtk-import) echo point.vtk ;;
    abaqus-import) echo corner.inp ;;
    medit-import) echo corner.mesh ;;
    openfoam-import) echo polyMesh ;;
    mdl-import) echo corner.mdl ;;
    m3d-import) echo corner.mvm ;;
    oct-import) echo cube.oct ;;
    gmsh-import) echo corner.msh ;;
    oct-export) echo octant.tm ;;
    octree-repair) echo element.tm ;;
    *) echo corner.tm ;;
    esac
}

# Runs the function $1 with each filter. (bats shows which one where it fails.)
for_each_filter() {
    for filter in $filters; do
        echo "$filter"
        "$1" "$filter"
    done
}

teardown() {
    echo "status '${status:-}', output '${output:-}', standard error '${stderr:-}'"
}
