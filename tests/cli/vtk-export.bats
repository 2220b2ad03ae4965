# SPDX-License-Identifier: GPL-3.0-or-later
# vtk-export: what it writes, VTK's own reader reads, and meshio, with the cells, volumes
# and data that the stream has.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# meshio FILE.vtk EXPRESSION: prints it, of m, the mesh as meshio reads it.
meshio() {
    "$vtk_python" -c 'import meshio, sys
m = meshio.read(sys.argv[1])
print(eval(sys.argv[2]))' "$@" | tail -n 1
}

@test "polyhedra: VTK counts the same cells and points and measures the same volumes" {
    need_vtk
    sheared_boxes 4 >boxes.tm
    vtk-export --no-boundary --no-quality -j 3 -o boxes.vtk boxes.tm
    vtk-export --no-boundary --no-quality boxes.tm | cmp - boxes.vtk
    [ "$(vtk boxes.vtk 'g.GetNumberOfPoints(), g.GetNumberOfCells(), set(types)')" = \
        '(125, 64, {42})' ]
    [ "$(vtk boxes.vtk 'abs(volume.sum() - 64) < 1e-9 and volume.min() > 0')" = True ]
    [ "$(vtk boxes.vtk 'sorted(point), sorted(cell)')" = \
        "(['attribute_1', 'marker'], ['tetrahedra'])" ]
    [ "$(vtk boxes.vtk "[float(v) for v in cell['tetrahedra'][:3]], \
        [int(v) for v in point['marker'][4:7]]")" = '([0.5, 1.5, 0.5], [0, 1, 1])' ]
}

@test "polyhedra: the faces of each are outward" {
    need_vtk
    cubes 0 >cubes.tm
    vtk-export cubes.tm >cubes.vtk
    # Each face's fan from the origin of the cube encloses it with a positive sign.
    run -0 vtk cubes.vtk '[sum(vtk.vtkMath.Determinant3x3(
        *[f.GetPoints().GetPoint(i) for i in (0, j, j + 1)])
        for f in map(g.GetCell(c).GetFace, range(6)) for j in (1, 2)) / 6
        for c in (0, 1) if g.GetCell(c).GetNumberOfFaces() == 6]'
    [ "$output" = '[1.0, 1.0]' ]
}

@test "tetrahedra: volumes, regions, node data; meshio reads them, too" {
    need_vtk
    surface sphere smesh >s.smesh
    { sed '$d' s.smesh; printf '1\n1 0 0 0 5 -1\n'; } >r.smesh
    tetgen-mesh --switches A -q1.4 r.smesh >sphere.tm
    vtk-export --no-boundary --no-quality sphere.tm >sphere.vtk
    [ "$(vtk sphere.vtk 'sorted(cell)')" = "['region']" ]
    vtk sphere.vtk "'\\n'.join('%.17g' % v for v in volume)" | paste - <(volumes sphere.tm) |
        awk '($1 - $2) ^ 2 > 1e-18 { exit 1 } END { exit NR < 1000 }'
    [ "$(vtk sphere.vtk "{float(r) for r in cell['region']}, set(types)")" = '({5.0}, {10})' ]
    # the points bit by bit
    vtk sphere.vtk "'\\n'.join(' '.join('%.17g' % c for c in g.GetPoint(i))
        for i in range(g.GetNumberOfPoints()))" >points
    rows .node sphere.tm | awk '{ printf "%.17g %.17g %.17g\n", $2, $3, $4 }' | cmp - points
    need_meshio
    [ "$(meshio sphere.vtk "len(m.points), len(m.cells_dict['tetra'])")" = \
        "($(rows .node sphere.tm | wc -l), $(rows .ele sphere.tm | wc -l))" ]
}

@test "mixed elements: each with its volume, and the nodes that meshio reads" {
    need_vtk
    mixed >mixed.tm
    vtk-export mixed.tm >mixed.vtk
    [ "$(vtk mixed.vtk '[round(12 * v, 9) + 0 for v in volume.tolist()], types')" = \
        '([12.0, 4.0, 6.0, 1.0], [12, 14, 13, 10])' ]
    [ "$(vtk mixed.vtk "[float(r) for r in cell['region']]")" = '[1.0, 1.0, 2.0, 3.0]' ]
    need_meshio
    # (meshio turns wedges to its own order)
    [ "$(meshio mixed.vtk '[c.data.tolist() for c in m.cells]')" = \
        '[[[0, 1, 2, 3, 4, 5, 6, 7]], [[4, 5, 6, 7, 8]], [[1, 9, 2, 5, 10, 6]], [[5, 6, 8, 11]]]' ]
}

@test "a surface and points" {
    need_vtk
    printf '%s\n' 'termesh 1' .node '3 3 1 1' '1 0 0 0 0.5 7' '2 1 0 0 1.5 -8' '3 0 1 0 2 9' \
        .face '1 1' '1 1 2 3 -4' .end >triangle.tm
    vtk-export triangle.tm >triangle.vtk
    [ "$(vtk triangle.vtk "types, [int(v) for v in cell['marker']], \
        [int(v) for v in point['marker']], [float(v) for v in point['attribute_1']]")" = \
        '([5], [-4], [7, -8, 9], [0.5, 1.5, 2.0])' ]
    sed '/^.face/,/-4$/d' triangle.tm >points.tm
    vtk-export points.tm >points.vtk
    [ "$(vtk points.vtk "types, [int(v) for v in point['marker']]")" = \
        '([1, 1, 1], [7, -8, 9])' ]
}

@test "no nodes, contradicting polyhedra: exit 3" {
    printf 'termesh 1\n.node\n0 3 0 0\n.end\n' >none.tm
    run -3 --separate-stderr vtk-export -o out.vtk none.tm
    [ "$stderr" = 'vtk-export: none.tm: has no nodes (.node)' ]
    cubes | sed 's/^2 1 -1 4/2 2 -1 4/' >cubes.tm
    run -3 --separate-stderr vtk-export -o out.vtk cubes.tm
    [[ "$stderr" == 'vtk-export: cubes.tm: .cell: row 1: facet 2 is not between '* ]]
    [ ! -e out.vtk ]
}
