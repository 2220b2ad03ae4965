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
    "$vtk_python" -c 'import meshio' 2>/dev/null || skip "there is no python3-meshio"
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

@test "tetrahedra: marked faces and edges are cells, with the data of the cells they bound" {
    need_vtk
    two_boxes >two.poly
    tetgen-mesh --quiet --switches A two.poly | sed '$d' >two.tm
    printf '.group\n2 0\n1 2 20 between "us" & 50%%\n2 3 7 Größe\n.end\n' >>two.tm
    vtu-export -j 3 two.tm >two.vtu
    vtu-export two.tm | cmp - two.vtu
    # cells by dimension; those of a marker are found by it, volume cells by 0
    [ "$(vtk two.vtu '[types.count(t) for t in (10, 5, 3)]')" = \
        "[$(rows .ele two.tm | wc -l), $(rows .face two.tm | awk '$5' | wc -l), $(
            rows .edge two.tm | awk '$4' | wc -l)]" ]
    [ "$(vtk two.vtu '[within("marker", m, m) for m in (0, 11, 13, 20)]')" = \
        '[([10], 2.0, 0.0), ([5], 0.0, 1.0), ([5], 0.0, 2.0), ([5], 0.0, 1.0)]' ]
    # the boxes with the faces and edges that are theirs: 1 below, 4 around
    [ "$(vtk two.vtu '[within("region", r, r)[1] for r in (3, 7)]')" = '[1.0, 1.0]' ]
    [ "$(vtk two.vtu '[{float(r) for r, m in zip(cell["region"], cell["marker"]) if m == w}
        for w in (11, 12)]')" = '[{3.0}, {7.0}]' ]
    [ "$(vtk two.vtu 'all(q in set(cell["dihedral_quality"][:types.count(10)])
        for q in cell["dihedral_quality"])')" = True ]
    [ "$(vtk two.vtu 'names')" = "['2 20 between \"us\" & 50%', '3 7 Größe']" ]
    # without them it is as it was, but for the names
    vtu-export --no-boundary --no-quality --no-names two.tm >plain.vtu
    [ "$(vtk plain.vtu 'set(types), sorted(cell), names')" = "({10}, ['region'], None)" ]
    awk '/^\.(face|edge|group)/ { skip = 1 } /^\.end/ { skip = 0 } !skip' two.tm |
        vtu-export --no-quality | cmp - plain.vtu
    "$vtk_python" -c 'import meshio' 2>/dev/null || skip "there is no python3-meshio"
    vtu-export --no-names two.tm >two.vtu
    [ "$("$vtk_python" -c 'import meshio
m = meshio.read("two.vtu")
print(sum(abs(d).sum() for b, d in zip(m.cells, m.cell_data["marker"]) if b.type == "tetra"),
    sum((d == 20).sum() for b, d in zip(m.cells, m.cell_data["marker"]) if b.type == "triangle"),
    sum(len(b.data) for b in m.cells if b.type == "line"))' | tail -n 1)" = \
        "0 2 $(rows .edge two.tm | awk '$4' | wc -l)" ]
}

@test "mixed elements: quadrilaterals, triangles, lines; J_ENS, and the level of octants" {
    need_vtk
    mixed | sed '$d' >mixed.tm
    printf '%s\n' .facet '4 1' '1 1 -1 4 3 2 1 4 5' '2 4 -1 3 12 6 7 -7' '3 1 -1 3 1 2 3 8' \
        '4 1 2 4 5 6 7 8 0' .face '2 1' '1 6 7 12 3' '2 1 2 4 0' .edge '2 1' '1 10 11 4' \
        '2 1 11 6' .end >>mixed.tm
    vtu-export mixed.tm >mixed.vtu
    [ "$(vtk mixed.vtu 'types, cell["marker"].tolist(), cell["region"].tolist()')" = \
        '([12, 14, 13, 10, 5, 9, 5, 5, 3, 3], [0, 0, 0, 0, 3, 5, -7, 8, 4, 6], '\
'[1.0, 1.0, 2.0, 3.0, 3.0, 1.0, 3.0, 1.0, 2.0, 0.0])' ]
    jens-stats -j mixed.tm >jens
    [ "$(vtk mixed.vtu "'\\n'.join('%.9f' % q for q in cell['jens'][:4])")" = \
        "$(awk '{ printf "%.9f\n", $2 }' jens)" ]
    [ "$(vtk mixed.vtu '[round(12 * v, 9) + 0 for v in volume.tolist()][:4]')" = \
        '[12.0, 4.0, 6.0, 1.0]' ]
    command -v octree-mesh >/dev/null || skip "octree-mesh is not built"
    surface sphere off | octree-mesh -q -u -s 4 >sphere.tm
    vtu-export sphere.tm >sphere.vtu
    [ "$(vtk sphere.vtu 'sorted(cell), bool((cell["level"] == cell["region"]).all())')" = \
        "(['jens', 'level', 'region'], True)" ]
}

@test "polyhedra: polygons, volume, the ball in the kernel; regions" {
    need_vtk
    cubes >cubes.tm
    vtu-export cubes.tm >cubes.vtu
    [ "$(vtk cubes.vtu '(types, cell["volume"].tolist()[:2],
        [round(12 * r * r, 9) for r in cell["kernel_radius"].tolist()])')" = \
        "([42, 42$(printf ', 9%.0s' {1..10})], [1.0, 1.0], [1.0$(printf ', 1.0%.0s' {1..11})])" ]
    [ "$(vtk cubes.vtu 'within("marker", 0, 0), within("marker", 2, 2)')" = \
        '(([42], 2.0, 0.0), ([9], 0.0, 4.0))' ]
    [ "$(vtk cubes.vtu '[set(cell["tetrahedra"][cell["marker"] == m].tolist())
        for m in (1, 5)]')" = '[{1.0}, {2.0}]' ]
    boxes 3 0.2 >boxes.tm
    vtu-export -j 2 boxes.tm >boxes.vtu
    poly-stats --json boxes.json boxes.tm >/dev/null
    "$vtk_python" -c 'import json, sys
volume, radius = map(float, sys.argv[1].split())
of = json.load(open("boxes.json"))
assert abs(volume / of["volume"] - 1) < 1e-12 and radius == of["kernel_radius"]["min"]' \
        "$(vtk boxes.vtu "'%.17g %.17g' % (sum(cell['volume']), min(cell['kernel_radius']))")"
    two_boxes >two.poly
    tetgen-mesh --quiet --switches A two.poly | polylla3d -q --absorb --merge-coplanar |
        vtu-export >two.vtu
    [ "$(vtk two.vtu 'within("region", 3, 3)[1], within("marker", 20, 20)')" = \
        '(1.0, ([9], 0.0, 1.0))' ]
}

@test "points and a surface with marked edges" {
    need_vtk
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' \
        .face '2 1' '1 1 3 2 -7' '2 1 2 4 8' .edge '2 1' '1 1 2 3' '2 3 4 0' .end >surface.tm
    vtu-export surface.tm >surface.vtu
    [ "$(vtk surface.vtu 'types, cell["marker"].tolist()')" = '([5, 5, 3], [-7, 8, 3])' ]
    sed '/^\.face/,/^2 1 2/d' surface.tm | vtu-export >points.vtu
    [ "$(vtk points.vtu 'types, cell["marker"].tolist()')" = \
        '([1, 1, 1, 1, 3], [0, 0, 0, 0, 3])' ]
}
