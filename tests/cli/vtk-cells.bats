# SPDX-License-Identifier: GPL-3.0-or-later
# vtk-export and vtu-export: marked faces and edges as cells, quality, names. Both write one
# grid, so each of these is asked of both.
# shellcheck disable=SC2154 # helpers set vtk_python

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# Of KIND vtk or vtu: marked_tetrahedra KIND.
marked_tetrahedra() {
    need_vtk
    two_boxes >two.poly
    tetgen-mesh --quiet --switches A two.poly | sed '$d' >two.tm
    printf '.group\n2 0\n1 2 20 between "us" & 50%%\n2 3 7 Größe\n.end\n' >>two.tm
    "$1-export" -j 3 two.tm >"two.$1"
    "$1-export" two.tm | cmp - "two.$1"
    # cells by dimension; those of a marker are found by it, volume cells by 0
    [ "$(vtk "two.$1" '[types.count(t) for t in (10, 5, 3)]')" = \
        "[$(rows .ele two.tm | wc -l), $(rows .face two.tm | awk '$5' | wc -l), $(
            rows .edge two.tm | awk '$4' | wc -l)]" ]
    [ "$(vtk "two.$1" '[within("marker", m, m) for m in (0, 11, 13, 20)]')" = \
        '[([10], 2.0, 0.0), ([5], 0.0, 1.0), ([5], 0.0, 2.0), ([5], 0.0, 1.0)]' ]
    # the boxes with the faces and edges that are theirs: 1 below, 4 around
    [ "$(vtk "two.$1" '[within("region", r, r)[1] for r in (3, 7)]')" = '[1.0, 1.0]' ]
    [ "$(vtk "two.$1" '[{float(r) for r, m in zip(cell["region"], cell["marker"]) if m == w}
        for w in (11, 12)]')" = '[{3.0}, {7.0}]' ]
    [ "$(vtk "two.$1" 'all(q in set(cell["dihedral_quality"][:types.count(10)])
        for q in cell["dihedral_quality"])')" = True ]
    [ "$(vtk "two.$1" 'names')" = "['2 20 between \"us\" & 50%', '3 7 Größe']" ]
    # without them it is as it was, but for the names
    "$1-export" --no-boundary --no-quality --no-names two.tm >"plain.$1"
    [ "$(vtk "plain.$1" 'set(types), sorted(cell), names')" = "({10}, ['region'], None)" ]
    awk '/^\.(face|edge|group)/ { skip = 1 } /^\.end/ { skip = 0 } !skip' two.tm |
        "$1-export" --no-quality | cmp - "plain.$1"
    need_meshio
    "$1-export" --no-names two.tm >"two.$1"
    [ "$("$vtk_python" -c 'import meshio, sys
m = meshio.read(sys.argv[1])
print(sum(abs(d).sum() for b, d in zip(m.cells, m.cell_data["marker"]) if b.type == "tetra"),
    sum((d == 20).sum() for b, d in zip(m.cells, m.cell_data["marker"]) if b.type == "triangle"),
    sum(len(b.data) for b in m.cells if b.type == "line"))' "two.$1" | tail -n 1)" = \
        "0 2 $(rows .edge two.tm | awk '$4' | wc -l)" ]
}

@test ".vtk: tetrahedra: marked faces and edges are cells, with the data of the cells they bound" {
    marked_tetrahedra vtk
}

@test ".vtu: tetrahedra: marked faces and edges are cells, with the data of the cells they bound" {
    marked_tetrahedra vtu
}

# Of KIND vtk or vtu: mixed_elements KIND.
mixed_elements() {
    need_vtk
    mixed | sed '$d' >mixed.tm
    printf '%s\n' .facet '4 1' '1 1 -1 4 3 2 1 4 5' '2 4 -1 3 12 6 7 -7' '3 1 -1 3 1 2 3 8' \
        '4 1 2 4 5 6 7 8 0' .face '2 1' '1 6 7 12 3' '2 1 2 4 0' .edge '2 1' '1 10 11 4' \
        '2 1 11 6' .end >>mixed.tm
    "$1-export" mixed.tm >"mixed.$1"
    [ "$(vtk "mixed.$1" 'types, cell["marker"].tolist(), cell["region"].tolist()')" = \
        '([12, 14, 13, 10, 5, 9, 5, 5, 3, 3], [0, 0, 0, 0, 3, 5, -7, 8, 4, 6], '\
'[1.0, 1.0, 2.0, 3.0, 3.0, 1.0, 3.0, 1.0, 2.0, 0.0])' ]
    jens-stats -j mixed.tm >jens
    [ "$(vtk "mixed.$1" "'\\n'.join('%.9f' % q for q in cell['jens'][:4])")" = \
        "$(awk '{ printf "%.9f\n", $2 }' jens)" ]
    [ "$(vtk "mixed.$1" '[round(12 * v, 9) + 0 for v in volume.tolist()][:4]')" = \
        '[12.0, 4.0, 6.0, 1.0]' ]
    command -v octree-mesh >/dev/null || skip "octree-mesh is not built"
    surface sphere off | octree-mesh -q -u -s 4 >sphere.tm
    "$1-export" sphere.tm >"sphere.$1"
    [ "$(vtk "sphere.$1" 'sorted(cell), bool((cell["level"] == cell["region"]).all())')" = \
        "(['jens', 'level', 'region'], True)" ]
}

@test ".vtk: mixed elements: quadrilaterals, triangles, lines; J_ENS, and the level of octants" {
    mixed_elements vtk
}

@test ".vtu: mixed elements: quadrilaterals, triangles, lines; J_ENS, and the level of octants" {
    mixed_elements vtu
}

# Of KIND vtk or vtu: polyhedra KIND.
polyhedra() {
    need_vtk
    cubes >cubes.tm
    "$1-export" cubes.tm >"cubes.$1"
    [ "$(vtk "cubes.$1" '(types, cell["volume"].tolist()[:2],
        [round(12 * r * r, 9) for r in cell["kernel_radius"].tolist()])')" = \
        "([42, 42$(printf ', 9%.0s' {1..10})], [1.0, 1.0], [1.0$(printf ', 1.0%.0s' {1..11})])" ]
    [ "$(vtk "cubes.$1" 'within("marker", 0, 0), within("marker", 2, 2)')" = \
        '(([42], 2.0, 0.0), ([9], 0.0, 4.0))' ]
    [ "$(vtk "cubes.$1" '[set(cell["tetrahedra"][cell["marker"] == m].tolist())
        for m in (1, 5)]')" = '[{1.0}, {2.0}]' ]
    boxes 3 0.2 >boxes.tm
    "$1-export" -j 2 boxes.tm >"boxes.$1"
    poly-stats --json boxes.json boxes.tm >/dev/null
    "$vtk_python" -c 'import json, sys
volume, radius = map(float, sys.argv[1].split())
of = json.load(open("boxes.json"))
assert abs(volume / of["volume"] - 1) < 1e-12 and radius == of["kernel_radius"]["min"]' \
        "$(vtk "boxes.$1" "'%.17g %.17g' % (sum(cell['volume']), min(cell['kernel_radius']))")"
    two_boxes >two.poly
    tetgen-mesh --quiet --switches A two.poly | polylla3d -q --absorb --merge-coplanar |
        "$1-export" >"two.$1"
    [ "$(vtk "two.$1" 'within("region", 3, 3)[1], within("marker", 20, 20)')" = \
        '(1.0, ([9], 0.0, 1.0))' ]
}

@test ".vtk: polyhedra: polygons, volume, the ball in the kernel; regions" {
    polyhedra vtk
}

@test ".vtu: polyhedra: polygons, volume, the ball in the kernel; regions" {
    polyhedra vtu
}

# Of KIND vtk or vtu: points_and_surface KIND.
points_and_surface() {
    need_vtk
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' \
        .face '2 1' '1 1 3 2 -7' '2 1 2 4 8' .edge '2 1' '1 1 2 3' '2 3 4 0' .end >surface.tm
    "$1-export" surface.tm >"surface.$1"
    [ "$(vtk "surface.$1" 'types, cell["marker"].tolist()')" = '([5, 5, 3], [-7, 8, 3])' ]
    sed '/^\.face/,/^2 1 2/d' surface.tm | "$1-export" >"points.$1"
    [ "$(vtk "points.$1" 'types, cell["marker"].tolist()')" = \
        '([1, 1, 1, 1, 3], [0, 0, 0, 0, 3])' ]
}

@test ".vtk: points and a surface with marked edges" {
    points_and_surface vtk
}

@test ".vtu: points and a surface with marked edges" {
    points_and_surface vtu
}
