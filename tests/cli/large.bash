# SPDX-License-Identifier: GPL-3.0-or-later
# Meshes that are read, walked and written in several chunks, for all filters; with
# helpers.bash and filters.bash.
# shellcheck shell=bash

# A gear as surface, tetrahedra, octree elements and polyhedra, and in all formats.
make_large_inputs() {
    PATH=$PATH:$TM_BUILD/bench
    shapes gear 1 >gear.off
    surface-import -q gear.off >surface.tm
    tetgen-mesh -q1.4 -a 0.0002 -q surface.tm >tets.tm
    octree-mesh -q -s 5 surface.tm >elements.tm
    polylla3d -q tets.tm >cells.tm
    abaqus-export -q tets.tm >tets.inp
    medit-export -q tets.tm >tets.mesh
    vtu-export -q elements.tm >elements.vtu
    vtk-export -q elements.tm >elements.vtk
    m3d-export -q elements.tm >elements.m3d
    oct-export -q elements.tm >elements.oct
    visf-export -q cells.tm >cells.visf
    tetgen-export -q tets tets.tm
    openfoam-export -q cells cells.tm
    is_left_out gmsh-export || gmsh-export -q tets.msh tets.tm
    { echo '[Vertices, ARRAY1<POINT3D>]'; awk 'NR == 2 { n = $1; print n }
        NR > 2 && NR <= n + 2' gear.off; echo '[Triangles, ARRAY1<STRING>]'
        awk 'NR == 2 { n = $1; print $2 } NR > n + 2 { print $2, $3, $4, 0, 0, 0 }' gear.off
    } >gear.mdl
}

# What a filter reads of them.
large_input() {
    case $1 in
    tetgen-mesh | octree-mesh | surface-import | surface-mend) echo gear.off ;;
    off-export | stl-export | ply-export | obj-export) echo tets.tm ;;
    octree-repair | oct-export | m3d-export | jens-stats | vtk-export | vtu-export)
        echo elements.tm ;;
    poly-stats | visf-export | openfoam-export | mesh-view) echo cells.tm ;;
    abaqus-import) echo tets.inp ;;
    medit-import) echo tets.mesh ;;
    vtu-import) echo elements.vtu ;;
    vtk-import) echo elements.vtk ;;
    m3d-import) echo elements.m3d ;;
    oct-import) echo elements.oct ;;
    visf-import) echo cells.visf ;;
    mdl-import) echo gear.mdl ;;
    gmsh-import) echo tets.msh ;;
    openfoam-import) echo cells ;;
    tetgen-import) echo tets.node ;;
    *) echo tets.tm ;;
    esac
}

# What makes it work hard.
more_options() {
    case $1 in
    octree-repair) echo -t 0.35 ;;
    surface-mend) echo --weld auto ;;
    esac
}
