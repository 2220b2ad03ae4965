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

need_meshio() {
    "$vtk_python" -c 'import meshio' 2>/dev/null || skip "there is no python3-meshio"
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

@test "tetrahedra: marked faces and edges are cells, with the data of the cells they bound" {
    need_vtk
    two_boxes >two.poly
    tetgen-mesh --quiet --switches A two.poly | sed '$d' >two.tm
    printf '.group\n2 0\n1 2 20 between "us" & 50%%\n2 3 7 Größe\n.end\n' >>two.tm
    vtk-export -j 3 two.tm >two.vtk
    vtk-export two.tm | cmp - two.vtk
    # cells by dimension; those of a marker are found by it, volume cells by 0
    [ "$(vtk two.vtk '[types.count(t) for t in (10, 5, 3)]')" = \
        "[$(rows .ele two.tm | wc -l), $(rows .face two.tm | awk '$5' | wc -l), $(
            rows .edge two.tm | awk '$4' | wc -l)]" ]
    [ "$(vtk two.vtk '[within("marker", m, m) for m in (0, 11, 13, 20)]')" = \
        '[([10], 2.0, 0.0), ([5], 0.0, 1.0), ([5], 0.0, 2.0), ([5], 0.0, 1.0)]' ]
    # the boxes with the faces and edges that are theirs: 1 below, 4 around
    [ "$(vtk two.vtk '[within("region", r, r)[1] for r in (3, 7)]')" = '[1.0, 1.0]' ]
    [ "$(vtk two.vtk '[{float(r) for r, m in zip(cell["region"], cell["marker"]) if m == w}
        for w in (11, 12)]')" = '[{3.0}, {7.0}]' ]
    [ "$(vtk two.vtk 'all(q in set(cell["dihedral_quality"][:types.count(10)])
        for q in cell["dihedral_quality"])')" = True ]
    [ "$(vtk two.vtk 'names')" = "['2 20 between \"us\" & 50%', '3 7 Größe']" ]
    # without them it is as it was, but for the names
    vtk-export --no-boundary --no-quality --no-names two.tm >plain.vtk
    [ "$(vtk plain.vtk 'set(types), sorted(cell), names')" = "({10}, ['region'], None)" ]
    awk '/^\.(face|edge|group)/ { skip = 1 } /^\.end/ { skip = 0 } !skip' two.tm |
        vtk-export --no-quality | cmp - plain.vtk
    "$vtk_python" -c 'import meshio' 2>/dev/null || skip "there is no python3-meshio"
    vtk-export --no-names two.tm >two.vtk
    [ "$("$vtk_python" -c 'import meshio
m = meshio.read("two.vtk")
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
    vtk-export mixed.tm >mixed.vtk
    [ "$(vtk mixed.vtk 'types, cell["marker"].tolist(), cell["region"].tolist()')" = \
        '([12, 14, 13, 10, 5, 9, 5, 5, 3, 3], [0, 0, 0, 0, 3, 5, -7, 8, 4, 6], '\
'[1.0, 1.0, 2.0, 3.0, 3.0, 1.0, 3.0, 1.0, 2.0, 0.0])' ]
    jens-stats -j mixed.tm >jens
    [ "$(vtk mixed.vtk "'\\n'.join('%.9f' % q for q in cell['jens'][:4])")" = \
        "$(awk '{ printf "%.9f\n", $2 }' jens)" ]
    [ "$(vtk mixed.vtk '[round(12 * v, 9) + 0 for v in volume.tolist()][:4]')" = \
        '[12.0, 4.0, 6.0, 1.0]' ]
    command -v octree-mesh >/dev/null || skip "octree-mesh is not built"
    surface sphere off | octree-mesh -q -u -s 4 >sphere.tm
    vtk-export sphere.tm >sphere.vtk
    [ "$(vtk sphere.vtk 'sorted(cell), bool((cell["level"] == cell["region"]).all())')" = \
        "(['jens', 'level', 'region'], True)" ]
}

@test "polyhedra: polygons, volume, the ball in the kernel; regions" {
    need_vtk
    cubes >cubes.tm
    vtk-export cubes.tm >cubes.vtk
    [ "$(vtk cubes.vtk '(types, cell["volume"].tolist()[:2],
        [round(12 * r * r, 9) for r in cell["kernel_radius"].tolist()])')" = \
        "([42, 42$(printf ', 9%.0s' {1..10})], [1.0, 1.0], [1.0$(printf ', 1.0%.0s' {1..11})])" ]
    [ "$(vtk cubes.vtk 'within("marker", 0, 0), within("marker", 2, 2)')" = \
        '(([42], 2.0, 0.0), ([9], 0.0, 4.0))' ]
    [ "$(vtk cubes.vtk '[set(cell["tetrahedra"][cell["marker"] == m].tolist())
        for m in (1, 5)]')" = '[{1.0}, {2.0}]' ]
    boxes 3 0.2 >boxes.tm
    vtk-export -j 2 boxes.tm >boxes.vtk
    poly-stats --json boxes.json boxes.tm >/dev/null
    "$vtk_python" -c 'import json, sys
volume, radius = map(float, sys.argv[1].split())
of = json.load(open("boxes.json"))
assert abs(volume / of["volume"] - 1) < 1e-12 and radius == of["kernel_radius"]["min"]' \
        "$(vtk boxes.vtk "'%.17g %.17g' % (sum(cell['volume']), min(cell['kernel_radius']))")"
    two_boxes >two.poly
    tetgen-mesh --quiet --switches A two.poly | polylla3d -q --absorb --merge-coplanar |
        vtk-export >two.vtk
    [ "$(vtk two.vtk 'within("region", 3, 3)[1], within("marker", 20, 20)')" = \
        '(1.0, ([9], 0.0, 1.0))' ]
}

@test "points and a surface with marked edges" {
    need_vtk
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' \
        .face '2 1' '1 1 3 2 -7' '2 1 2 4 8' .edge '2 1' '1 1 2 3' '2 3 4 0' .end >surface.tm
    vtk-export surface.tm >surface.vtk
    [ "$(vtk surface.vtk 'types, cell["marker"].tolist()')" = '([5, 5, 3], [-7, 8, 3])' ]
    sed '/^\.face/,/^2 1 2/d' surface.tm | vtk-export >points.vtk
    [ "$(vtk points.vtk 'types, cell["marker"].tolist()')" = \
        '([1, 1, 1, 1, 3], [0, 0, 0, 0, 3])' ]
}
