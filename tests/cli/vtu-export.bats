# SPDX-License-Identifier: GPL-3.0-or-later
# vtu-export: what it writes, VTK's own reader reads, with the cells, volumes and data
# that the stream has.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

@test "polyhedra: VTK counts the same cells and points and measures the same volumes" {
    need_vtk
    sheared_boxes 4 >boxes.tm
    vtu-export --no-boundary --no-quality -o boxes.vtu boxes.tm
    [ "$(vtk boxes.vtu 'g.GetNumberOfPoints(), g.GetNumberOfCells(), set(types)')" = \
        '(125, 64, {42})' ]
    [ "$(vtk boxes.vtu 'abs(volume.sum() - 64) < 1e-9 and volume.min() > 0')" = True ]
    [ "$(vtk boxes.vtu 'sorted(point), sorted(cell)')" = \
        "(['attribute_1', 'marker'], ['tetrahedra'])" ]
    [ "$(vtk boxes.vtu "list(cell['tetrahedra'][:3]), list(point['marker'][4:7])")" = \
        '([0.5, 1.5, 0.5], [0, 1, 1])' ]
    # and of each cell
    cubes >cubes.tm
    vtu-export --no-boundary cubes.tm >cubes.vtu
    [ "$(vtk cubes.vtu 'max(abs(volume - 1)) < 1e-9, volume.size')" = '(True, 2)' ]
}

@test "what polylla3d makes has the same volume for VTK, by the surface of each cell" {
    need_vtk
    command -v tetgen >/dev/null || skip "there is no tetgen"
    local options
    # vtkCellSizeFilter itself fills hollows of polyhedra that are not convex.
    cat >surfaces.py <<'END'
import json, sys, vtk
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
g = reader.GetOutput()
volumes = []
for c in range(g.GetNumberOfCells()):
    surface = vtk.vtkPolyData()
    surface.DeepCopy(g.GetCell(c).GetPolyData())
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputData(surface)
    mass = vtk.vtkMassProperties()
    mass.SetInputConnection(triangles.GetOutputPort())
    mass.Update()
    volumes.append(mass.GetVolume())
check = json.load(open(sys.argv[2]))
assert len(volumes) == check["elements"] and min(volumes) > 0
assert abs(sum(volumes) / check["volume"] - 1) < 1e-9, (sum(volumes), check["volume"])
END
    surface sphere off | tetgen-mesh -q >sphere.tm
    for options in --star '--absorb --merge-coplanar' '--mode edge'; do
        # shellcheck disable=SC2086 # words
        polylla3d -q $options sphere.tm >poly.tm
        mesh-check -q --json check.json poly.tm
        vtu-export --no-boundary -o poly.vtu poly.tm
        "$vtk_python" surfaces.py poly.vtu check.json
    done
}

@test "polyhedra: the faces of each are outward" {
    need_vtk
    cubes 0 >cubes.tm
    vtu-export cubes.tm >cubes.vtu
    # Each face's fan from the origin of the cube encloses it with a positive sign.
    run -0 vtk cubes.vtu '[sum(vtk.vtkMath.Determinant3x3(
        *[f.GetPoints().GetPoint(i) for i in (0, j, j + 1)])
        for f in map(g.GetCell(c).GetFace, range(6)) for j in (1, 2)) / 6
        for c in (0, 1) if g.GetCell(c).GetNumberOfFaces() == 6]'
    [ "$output" = '[1.0, 1.0]' ]
}

@test "tetrahedra: volumes, quality, regions; meshio reads them, too" {
    need_vtk
    surface sphere smesh >s.smesh
    { sed '$d' s.smesh; printf '1\n1 0 0 0 5 -1\n'; } >r.smesh
    tetgen-mesh --switches A -q1.4 r.smesh >sphere.tm
    vtu-export --no-boundary -j 3 sphere.tm >sphere.vtu
    vtu-export --no-boundary sphere.tm | cmp - sphere.vtu
    [ "$(vtk sphere.vtu 'sorted(cell)')" = "['dihedral_quality', 'region']" ]
    volumes sphere.tm | awk '{ sum += $1 } END { printf "%.17g\n", sum }' >sum
    counts=$(header .node sphere.tm | cut -d ' ' -f 1),$(header .ele sphere.tm |
        cut -d ' ' -f 1)
    [ "$(vtk sphere.vtu "'%d,%d' % (g.GetNumberOfPoints(), g.GetNumberOfCells())")" = \
        "$counts" ]
    [ "$(vtk sphere.vtu "abs(volume.sum() - $(cat sum)) < 1e-9, set(types)")" = \
        '(True, {10})' ]
    vtk sphere.vtu "'\\n'.join('%.17g' % v for v in volume)" | paste - <(volumes sphere.tm) |
        awk '($1 - $2) ^ 2 > 1e-18 { exit 1 } END { exit NR < 1000 }'
    [ "$(vtk sphere.vtu "set(cell['region'])")" = '{5.0}' ]
    tet-stats --list sphere.tm |
        awk '{ q = $2 < 180 - $3 ? $2 : 180 - $3; printf "%.4f\n", q }' >expected
    vtk sphere.vtu "'\\n'.join('%.4f' % q for q in cell['dihedral_quality'])" >quality
    paste expected quality |
        awk '$1 - $2 > 2e-4 || $2 - $1 > 2e-4 { print; wrong = 1 } END { exit wrong }'
    need_meshio
    [ "$("$vtk_python" -c 'import meshio
m = meshio.read("sphere.vtu")
print(len(m.points), len(m.cells_dict["tetra"]), sep=",")' | tail -n 1)" = "$counts" ]
}

@test "tetrahedra: those that are left-handed are turned, with a note" {
    need_vtk
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '0 0 0 0' '1 1 0 0' '2 0 1 0' '3 0 0 1' \
        .ele '1 4 2' '0 0 2 1 3 8 9' .end >left.tm
    run -0 --separate-stderr vtu-export -o left.vtu left.tm
    [ "$stderr" = 'vtu-export: left.tm: 1 of 1 tetrahedra were left-handed and are turned' ]
    [ "$(vtk left.vtu '6 * volume[0]')" = 1.0 ]
    [ "$(vtk left.vtu "cell['region'][0], cell['attribute_2'][0]")" = '(8.0, 9.0)' ]
    run -0 --separate-stderr vtu-export -q -o left.vtu left.tm
    [ -z "$stderr" ]
}

@test "mixed elements, a surface, points" {
    need_vtk
    mixed | vtu-export >mixed.vtu
    [ "$(vtk mixed.vtu 'types, [round(v * 12, 9) for v in volume]')" = \
        '([12, 14, 13, 10], [12.0, 4.0, 6.0, 1.0])' ]
    [ "$(vtk mixed.vtu "list(cell['region'])")" = '[1.0, 1.0, 2.0, 3.0]' ]
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' \
        .face '2 1' '1 1 3 2 -7' '2 1 2 4 8' .end >surface.tm
    vtu-export surface.tm >surface.vtu
    [ "$(vtk surface.vtu "types, list(cell['marker']), g.GetNumberOfPoints()")" = \
        '([5, 5], [-7, 8], 4)' ]
    sed '/^\.face/,/^2 1 2/d' surface.tm | vtu-export >points.vtu
    [ "$(vtk points.vtu 'types, g.GetPoint(3)')" = '([1, 1, 1, 1], (0.0, 0.0, 1.0))' ]
}

@test "a stream without nodes, or cut short, or with wrong polyhedra: exit 3" {
    printf 'termesh 1\n.end\n' >none.tm
    run -3 --separate-stderr vtu-export none.tm
    [[ "$stderr" == 'vtu-export: none.tm: holds nothing, but vtu-export takes points '* ]]
    cubes >cubes.tm
    sed '$d' cubes.tm >short.tm
    run -3 --separate-stderr vtu-export -o out.vtu short.tm
    [ ! -e out.vtu ]
    sed 's/^1 6 1 2 3 4 5 6 1$/1 6 1 2 3 4 5 7 1/' cubes.tm >wrong.tm
    run -3 --separate-stderr vtu-export wrong.tm
    [ "$stderr" = 'vtu-export: wrong.tm: .cell: row 1: facet 7 is not between this cell '\
'and another one' ]
    sed 's/^1 6 1 2 3 4 5 6 1$/1 6 1 2 3 4 6 6 1/' cubes.tm >wrong.tm
    run -3 --separate-stderr vtu-export wrong.tm
    [ "$stderr" = 'vtu-export: wrong.tm: .cell: row 1: facet 6 is there twice' ]
    sed 's/^1 6 1 2 3 4 5 6 1$/1 5 1 2 3 4 6 1/' cubes.tm >wrong.tm
    run -3 --separate-stderr vtu-export wrong.tm
    [ "$stderr" = 'vtu-export: wrong.tm: .facet: row 5: cell 1 does not have this facet' ]
    sed 's/^6 1 2 4/6 1 1 4/' cubes.tm >wrong.tm
    run -3 --separate-stderr vtu-export wrong.tm
}

@test "meshio reads cell data as one number for each cell" {
    need_meshio
    surface cube off | tetgen-mesh -q >cube.tm
    vtu-export --no-boundary cube.tm >cube.vtu
    [ "$("$vtk_python" -c 'import meshio, sys
m = meshio.read(sys.argv[1])
print({len(d.shape) for data in m.cell_data.values() for d in data})' cube.vtu | tail -n 1)" = '{1}' ]
}
