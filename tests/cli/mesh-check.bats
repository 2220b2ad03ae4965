# SPDX-License-Identifier: GPL-3.0-or-later
# mesh-check: the report, JSON, exit statuses.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

setup() {
    load helpers
    cd "$BATS_TEST_TMPDIR" || exit
    # A unit cube in six tetrahedra, counted from 0, with a row of .face and of .edge.
    cat >cube.tm <<'END'
termesh 1
# made by hand
.node
8 3 0 0
0 0 0 0
1 1 0 0
2 0 1 0
3 1 1 0
4 0 0 1
5 1 0 1
6 0 1 1
7 1 1 1
.ele
6 4 0
0 0 1 3 7
1 0 2 6 7
2 0 4 5 7
3 0 3 2 7
4 0 5 1 7
5 0 6 4 7
.face
1 1
0 0 1 3 5
.edge
1 1
0 7 0 2
.end
END
    # Counted from 1: two tetrahedra that touch in an edge, the second inverted.
    cat >touching.tm <<'END'
termesh 1
.node
6 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0 -1 0
6 0 0 -1
.ele
2 4 0
1 1 2 3 4
2 1 2 6 5
.end
END
    printf 'termesh 1\n.node\n0 3 0 0\n.ele\n0 4 0\n.end\n' >none.tm
}

@test "a good mesh: the table, and exit 0" {
    run -0 --separate-stderr mesh-check cube.tm
    [ "$stderr" = "" ]
    diff - <(echo "$output") <<'END'
nodes                                8
tetrahedra                           6
components                           1
Euler number                         1
volume                               1
boundary faces                      12
boundary area                        6
unused nodes                         0

nothing is wrong
END
    [ "$(mesh-check <cube.tm)" = "$output" ]
    [ "$(mesh-check - <cube.tm)" = "$output" ]
}

@test "a wrong mesh: what and where, in the stream's numbers, and exit 1" {
    run -1 --separate-stderr mesh-check touching.tm
    [ "$stderr" = "" ]
    diff - <(echo "$output") <<'END'
nodes                                6
tetrahedra                           2
components                           2
Euler number                         1
volume                               0
boundary faces                       8
boundary area               4.73205081
unused nodes                         0

inverted                             1
  tetrahedron 2 is inverted
non-manifold edges                   1
  edge 1 2 belongs to 4 boundary faces
END
}

@test "every kind of defect has its sentence" {
    cat >wrong.tm <<'END'
termesh 1
.node
13 3 0 0
0 0 0 0
1 1 0 0
2 0 1 0
3 0 0 1
4 1 1 1
5 2 2 2
6 9 9 9
7 8 9 9
8 9 8 9
9 9 9 8
10 0 0 1
11 1 1 0
12 20 0 0
.ele
9 4 0
0 0 1 2 3
1 1 2 3 4
2 1 2 3 5
3 6 7 8 9
4 6 7 8 10
5 6 7 8 8
6 0 1 2 11
7 12 6 9 10
8 12 6 9 5
.face
4 0
0 0 1 3
1 0 5 6
2 3 1 0
3 12 12 11
.edge
4 0
0 0 1
1 1 0
2 0 12
3 12 12
.end
END
    run -1 --separate-stderr mesh-check wrong.tm
    [ "$stderr" = "" ]
    diff - <(echo "$output" | sed -n '/^$/,$p') <<'END'

inverted                             2
  tetrahedron 3 is inverted
  tetrahedron 4 is inverted
degenerate                           2
  tetrahedron 5 names node 8 twice
  tetrahedron 6 is flat
unmatched faces                      1
  face 1 2 3 belongs to 3 tetrahedra
overlapping faces                    2
  tetrahedra 3 and 4 are on the same side of their common face
  tetrahedra 7 and 8 are on the same side of their common face
open edges                           3
  edge 1 2 belongs to 3 boundary faces
  edge 1 3 belongs to 3 boundary faces
  edge 2 3 belongs to 3 boundary faces
non-manifold edges                   5
  edge 1 2 belongs to 3 boundary faces
  edge 1 3 belongs to 3 boundary faces
  edge 2 3 belongs to 3 boundary faces
  edge 6 9 belongs to 4 boundary faces
  edge 6 10 belongs to 4 boundary faces
non-manifold vertices                1
  node 5 joins 2 fans of boundary faces
duplicate nodes                      1
  node 10 is at the place of node 3
dangling faces                       2
  row 1 of .face is no face of any tetrahedron
  row 3 of .face is no face of any tetrahedron
repeated faces                       1
  row 2 of .face repeats row 0
dangling edges                       2
  row 2 of .edge is no edge of any tetrahedron
  row 3 of .edge is no edge of any tetrahedron
repeated edges                       1
  row 1 of .edge repeats row 0
END
}

@test "of many defects of a kind the first five are shown" {
    awk '/^\.ele/ { inside = 1; print; next }
         inside && NF == 5 { print $1, $3, $2, $4, $5; next }
         { print }' cube.tm >turned.tm
    run -1 mesh-check turned.tm
    diff - <(echo "$output" | sed -n '/^$/,$p') <<'END'

inverted                             6
  tetrahedron 0 is inverted
  tetrahedron 1 is inverted
  tetrahedron 2 is inverted
  tetrahedron 3 is inverted
  tetrahedron 4 is inverted
  and 1 more
END
    [[ "${lines[4]}" =~ ^volume\ +-1$ ]]
}

@test "unused nodes and several components are no defects" {
    sed 's/^8 3 0 0/10 3 0 0/; s/^7 1 1 1/&\n8 5 5 5\n9 6 6 6/' cube.tm >unused.tm
    run -0 mesh-check unused.tm
    [[ "$output" =~ unused\ nodes\ +2 ]]
    cat >pieces.tm <<'END'
termesh 1
.node
8 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 5 0 0
6 6 0 0
7 5 1 0
8 5 0 1
.ele
2 4 0
1 1 2 3 4
2 5 6 7 8
.end
END
    run -0 mesh-check pieces.tm
    [[ "$output" =~ components\ +2 ]]
    [[ "$output" =~ Euler\ number\ +2 ]]
}

@test "--json has the documented keys, in a file or on standard output" {
    run -1 mesh-check --json out.json touching.tm
    [[ "$output" =~ inverted ]]
    run -1 mesh-check --json - touching.tm
    [ "$output" = "$(cat out.json)" ]
    python3 - out.json <<'END'
import json, sys
mesh = json.load(open(sys.argv[1]))
assert list(mesh) == [
    "nodes", "elements", "inverted", "degenerate", "unmatched_faces", "boundary_faces",
    "open_edges", "non_manifold_edges", "non_manifold_vertices", "components", "euler",
    "volume", "area", "unused_nodes", "duplicate_nodes", "overlapping_faces",
    "dangling_faces", "repeated_faces", "dangling_edges", "repeated_edges"]
assert (mesh["nodes"], mesh["elements"], mesh["inverted"]) == (6, 2, 1)
assert (mesh["non_manifold_edges"], mesh["components"], mesh["euler"]) == (1, 2, 1)
assert mesh["volume"] == 0 and abs(mesh["area"] - 3 - 3 ** 0.5) < 1e-14
END
    mesh-check --json - -o table cube.tm >out.json
    [ "$(json out.json volume)" = 1 ]
    grep -q '^nothing is wrong$' table
}

@test "-q prints nothing, and the exit status tells" {
    run -0 mesh-check -q cube.tm
    [ "$output" = "" ]
    run -1 mesh-check --quiet --json out.json touching.tm
    [ "$output" = "" ]
    [ "$(json out.json inverted)" = 1 ]
}

@test "a mesh without tetrahedra is good" {
    run -0 mesh-check --json out.json none.tm
    [[ "$output" =~ tetrahedra\ +0 ]]
    [[ "$output" =~ "nothing is wrong" ]]
    [ "$(json out.json euler)" = 0 ]
    [ "$(json out.json area)" = 0 ]
}

@test "of several kinds of elements one is examined, with a note for the others" {
    sed 's/^\.end/.mix\n0 0\n.end/' cube.tm >both.tm
    run -0 --separate-stderr mesh-check both.tm
    [ "$stderr" = "mesh-check: both.tm: .mix is not examined, only .ele" ]
    [ "$output" = "$(mesh-check cube.tm)" ]
    sed 's/^\.end/.facet\n0 0\n.cell\n0 0\n.end/' cube.tm >both.tm
    run -0 --separate-stderr mesh-check both.tm
    [ "$stderr" = "mesh-check: both.tm: .cell is not examined, only .ele" ]
    [ "$output" = "$(mesh-check cube.tm)" ]
    printf 'termesh 1\n.node\n0 3 0 0\n.mix\n0 0\n.facet\n0 0\n.cell\n0 0\n.end\n' >both.tm
    run -0 --separate-stderr mesh-check both.tm
    [ "$stderr" = "mesh-check: both.tm: .mix is not examined, only .cell" ]
    [[ "$output" =~ polyhedra\ +0 ]]
}

@test "good mixed elements: the table and the JSON, exit 0" {
    mixed >mixed.tm
    run -0 --separate-stderr mesh-check --json out.json mixed.tm
    [ "$stderr" = "" ]
    diff - <(echo "$output") <<'END'
nodes                               12
elements                             4
tetrahedra                           1
pyramids                             1
wedges                               1
hexahedra                            1
components                           1
Euler number                         1
volume                      1.91666667
boundary faces                      14
boundary area               10.1502815
unused nodes                         0

nothing is wrong
END
    python3 - out.json <<'END'
import json, sys
mesh = json.load(open(sys.argv[1]))
assert list(mesh)[20:] == ["tetrahedra", "pyramids", "wedges", "hexahedra"]
assert [mesh[k] for k in ("tetrahedra", "pyramids", "wedges", "hexahedra")] == [1] * 4
assert (mesh["elements"], mesh["boundary_faces"], mesh["euler"]) == (4, 14, 1)
END
}

@test "every kind of defect of mixed elements has its sentence" {
    # Counted from 0: two cubes, and what is wrong beside them.
    cat >wrong.tm <<'END'
termesh 1
.node
15 3 0 0
0 0 0 0
1 1 0 0
2 2 0 0
3 0 1 0
4 1 1 0
5 2 1 0
6 0 0 1
7 1 0 1
8 2 0 1
9 0 1 1
10 1 1 1
11 2 1 1
12 0.5 0.5 -1
13 1.5 0.5 2
14 1.5 0.5 2
.mix
9 0
0 8 0 1 4 3 6 7 10 9
1 8 1 2 5 4 7 8 11 10
2 5 0 3 4 1 12
3 4 7 8 11 13
4 5 1 7 10 4 14
5 5 2 8 5 11 12
6 5 2 5 11 8 2
7 5 0 1 4 3 12
8 4 0 1 12 2
.face
2 0
0 7 11 13
1 0 1 2
.edge
2 0
0 0 1
1 0 5
.facet
5 1
0 0 -1 4 0 3 4 1 5
1 0 -1 4 0 1 7 6 5
2 0 -1 4 7 6 0 1 5
3 0 -1 4 3 9 10 4 6
4 1 -1 4 3 9 10 4 6
.end
END
    run -1 --separate-stderr mesh-check wrong.tm
    [ "$stderr" = "" ]
    diff - <(echo "$output" | sed -n '/^$/,$p') <<'END'

inverted                             3
  element 4 is inverted
  element 5 is inverted
  element 7 is inverted
degenerate                           2
  element 6 names node 2 twice
  element 8 is flat
unmatched faces                      5
  face 0 1 3 belongs to 3 elements
  face 0 1 12 belongs to 3 elements
  face 1 4 7 belongs to 3 elements
  quadrilateral 2 5 8 is there in another order too
  triangle 7 8 11 is half of a quadrilateral
overlapping faces                    3
  elements 2 and 7 are on the same side of their common face
  elements 2 and 7 are on the same side of their common face
  elements 2 and 7 are on the same side of their common face
open edges                           7
  edge 0 3 belongs to 1 boundary face
  edge 0 12 belongs to 1 boundary face
  edge 1 7 belongs to 3 boundary faces
  edge 1 12 belongs to 1 boundary face
  edge 3 4 belongs to 1 boundary face
  and 2 more
non-manifold edges                   9
  edge 1 2 belongs to 4 boundary faces
  edge 1 7 belongs to 3 boundary faces
  edge 2 8 belongs to 4 boundary faces
  edge 2 12 belongs to 4 boundary faces
  edge 4 10 belongs to 3 boundary faces
  and 4 more
duplicate nodes                      1
  node 14 is at the place of node 13
dangling faces                       1
  row 0 of .facet is no face of the elements that it names
repeated faces                       2
  row 2 of .facet repeats row 1
  row 4 of .facet repeats row 3
dangling edges                       1
  row 1 of .edge is no edge of any element
END
}

@test "tetrahedra of .mix are examined as those of .ele, by each number of threads alike" {
    many >many.tm
    awk '$1 == ".ele" { print ".mix"; getline; print $1, 0; mix = 1; next }
        mix && NF == 5 { $1 = $1 " 4" }
        { print }' many.tm >mix.tm
    run -1 mesh-check -j 1 mix.tm
    diff <(echo "$output" | sed '2,6d; s/element/tetrahedron/; s/tetrahedrons/tetrahedra/') \
        <(mesh-check many.tm | sed 2d)
    cmp <(mesh-check -j 3 --json - mix.tm) <(mesh-check -j 1 --json - mix.tm)
    [ "$output" = "$(mesh-check -j 3 mix.tm)" ]
}

@test "facets of mixed elements: the reference, the face, the sense" {
    sed 's/^\.end/.facet\n2 1\n1 1 -1 4 1 4 3 2 5\n2 4 -1 3 6 7 12 -7\n.end/' \
        <(mixed) >facets.tm
    run -0 --separate-stderr mesh-check facets.tm
    [ "$stderr" = "" ]
    [ "$output" = "$(mixed | mesh-check)" ]
    sed 's/^2 4 -1/2 5 -1/' facets.tm >far.tm
    run -3 --separate-stderr mesh-check far.tm
    [ "$output" = "" ]
    [ "$stderr" = "mesh-check: far.tm: .facet: row 2: element 5 is out of range (there are 4)" ]
    sed 's/^1 1 -1 4 1 4 3 2/1 1 -1 4 1 2 3 4/' facets.tm >turned.tm
    run -1 mesh-check turned.tm
    [[ "$output" == *"row 1 of .facet is no face of the elements that it names"* ]]
}

@test "volumes and areas of mixed elements are VTK's; its wedge is ours" {
    python3 - >warped.tm <<'END'
# Hexahedra, some cut into two wedges, others into six pyramids; nodes inside moved.
import random
random.seed(11)
n = 4
m = n + 1
nodes = [[c + (random.uniform(-.2, .2) if 0 < c < n else 0) for c in (x, y, z)]
         for z in range(m) for y in range(m) for x in range(m)]
elements = []
for z in range(n):
    for y in range(n):
        for x in range(n):
            v = [x + a + m * (y + b + m * (z + c))
                 for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            if x == 1 and y == 2:
                elements += [[v[i] for i in w] for w in
                             ((0, 2, 1, 4, 6, 5), (0, 3, 2, 4, 7, 6))]
            elif (x + y + z) % 3 == 0 and x != 1:
                nodes.append([x + .5, y + .5, z + .5])
                elements += [[v[i] for i in f] + [len(nodes) - 1] for f in
                             ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2),
                              (2, 6, 7, 3), (3, 7, 4, 0))]
            else:
                elements.append(v)
print('termesh 1\n.node\n%d 3 0 0' % len(nodes))
for i, p in enumerate(nodes):
    print(i, *p)
print('.mix\n%d 0' % len(elements))
for i, e in enumerate(elements):
    print(i, len(e), *e)
print('.end')
END
    run -0 mesh-check --json out.json warped.tm
    vtu-export warped.tm >warped.vtu
    /usr/bin/python3 - out.json warped.vtu <<'END'
import json, sys
import numpy, vtk
from vtk.util.numpy_support import vtk_to_numpy
mesh = json.load(open(sys.argv[1]))
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[2])
reader.Update()
grid = reader.GetOutput()
assert [mesh[k] > 7 for k in ("pyramids", "wedges", "hexahedra")] == [True] * 3

def surface(cell, nodes):
    """Six times the volume inside of a cell's faces, as VTK turns them."""
    total = 0
    for f in range(cell.GetNumberOfFaces()):
        face = cell.GetFace(f)
        p = [nodes[face.GetPointId(i)] for i in range(face.GetNumberOfPoints())]
        fans = [p] if len(p) == 3 else [p[:3], [p[0], p[2], p[3]], p[1:], [p[0], p[1], p[3]]]
        total += sum(numpy.linalg.det(t) for t in fans) / (1 if len(p) == 3 else 2)
    return total

nodes = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
volumes = [surface(grid.GetCell(c), nodes) / 6 for c in range(grid.GetNumberOfCells())]
assert min(volumes) > 0.02
assert abs(sum(volumes) - mesh["volume"]) < 1e-9 and abs(mesh["volume"] - 64) < 1e-11
# VTK's own sizes, of tetrahedra that halve the quadrilaterals, have the same signs.
size = vtk.vtkCellSizeFilter()
size.SetInputData(grid)
size.Update()
own = vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Volume"))
assert own.min() > 0.02
assert abs(own - volumes).max() < 0.1
outside = vtk.vtkDataSetSurfaceFilter()
outside.SetInputData(grid)
mass = vtk.vtkCellSizeFilter()
mass.SetInputConnection(outside.GetOutputPort())
mass.Update()
area = vtk_to_numpy(mass.GetOutput().GetCellData().GetArray("Area")).sum()
assert abs(area - mesh["area"]) < 1e-6 and abs(mesh["area"] - 96) < 1e-11
END
}

@test "good polyhedra: the table and the JSON, exit 0" {
    boxes 3 >boxes.tm
    run -0 --separate-stderr mesh-check --json out.json boxes.tm
    [ "$stderr" = "" ]
    diff - <(echo "$output") <<'END'
nodes                               64
polyhedra                           27
components                           1
Euler number                         1
volume                              27
boundary faces                      54
boundary area                       54
unused nodes                         0

nothing is wrong
END
    python3 - out.json <<'END'
import json, sys
mesh = json.load(open(sys.argv[1]))
assert list(mesh) == [
    "nodes", "elements", "inverted", "degenerate", "unmatched_faces", "boundary_faces",
    "open_edges", "non_manifold_edges", "non_manifold_vertices", "components", "euler",
    "volume", "area", "unused_nodes", "duplicate_nodes", "overlapping_faces",
    "dangling_faces", "repeated_faces", "dangling_edges", "repeated_edges",
    "unclosed_edges", "unoriented_edges"]
assert (mesh["nodes"], mesh["elements"], mesh["euler"]) == (64, 27, 1)
END
    # No polyhedra at all are good.
    printf 'termesh 1\n.node\n0 3 0 0\n.facet\n0 0\n.cell\n0 0\n.end\n' >none.tm
    run -0 mesh-check none.tm
    [[ "$output" =~ polyhedra\ +0 ]]
}

@test "wrong polyhedra: what and where, and exit 1" {
    # Two boxes; counted from 0. Facet 1 is between them.
    boxes 2 | awk '
        /^\./ { block = $1; print; header = 1; next }
        header { header = 0; print; next }
        block == ".facet" && $1 == 0 { $5 = $6 }                  # a node twice
        block == ".facet" && $1 == 4 { n = $5; $5 = $7; $7 = n }  # turned
        block == ".facet" && $1 == 9 { $3 = 5 }                   # the wrong cell
        { print }' >wrong.tm
    run -1 --separate-stderr mesh-check wrong.tm
    [ "$stderr" = "" ]
    echo "$output"
    [[ "$output" == *"  facet 0 names node "*" twice"* ]]
    [[ "$output" == *"  facet 9 does not belong to the polyhedra that it names"* ]]
    [[ "$output" == *" of polyhedron 0 belongs to "*" of its facets"* ]]
    [[ "$output" == *" of polyhedron "*": its two facets run alike along it"* ]]
    # Inside out.
    boxes 1 | awk '
        /^\.facet/ { inside = 1 }
        /^\.cell/ { inside = 0 }
        inside && NF == 8 { n = $5; $5 = $7; $7 = n }
        { print }' >inverted.tm
    run -1 mesh-check inverted.tm
    diff - <(echo "$output" | sed -n '/^volume/p; /^$/,$p') <<'END'
volume                              -1

inverted                             1
  polyhedron 0 is inverted
END
    # Two rows for one square, of which each polyhedron has its own.
    cat >repeated.tm <<'END'
termesh 1
.node
5 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0 0 -1
.facet
8 0
1 1 -1 3 1 3 2
2 1 -1 3 1 2 4
3 1 -1 3 2 3 4
4 1 -1 3 3 1 4
5 2 -1 3 2 1 5
6 2 -1 3 3 2 5
7 2 -1 3 1 3 5
8 2 -1 3 1 2 3
.cell
2 0
1 4 1 2 3 4
2 4 5 6 7 8
.end
END
    run -1 mesh-check repeated.tm
    diff - <(echo "$output" | sed -n '/^$/,$p') <<'END'

non-manifold edges                   3
  edge 1 2 belongs to 4 boundary faces
  edge 1 3 belongs to 4 boundary faces
  edge 2 3 belongs to 4 boundary faces
repeated faces                       1
  row 8 of .facet repeats row 1
END
}

@test "polyhedra: -j 2 gives the bytes of -j 1" {
    boxes 16 0.2 | awk '
        /^\./ { block = $1 }
        block == ".facet" && NF == 7 && $1 % 50 == 0 { n = $5; $5 = $7; $7 = n }
        { print }' >many.tm
    for threads in 1 2 5; do
        run -1 mesh-check -j $threads --json $threads.json -o $threads.table many.tm
    done
    [ "$(json 1.json unoriented_edges)" -gt 5 ]
    [ "$(json 1.json unmatched_faces)" -eq 0 ]
    cmp 1.json 2.json
    cmp 1.json 5.json
    cmp 1.table 2.table
    cmp 1.table 5.table
}

@test "-j 2 gives the bytes of -j 1" {
    many 30000 >many.tm
    for threads in 1 2 5; do
        run -1 mesh-check -j $threads --json $threads.json -o $threads.table many.tm
    done
    [ "$(json 1.json inverted)" -gt 5 ]
    cmp 1.json 2.json
    cmp 1.json 5.json
    cmp 1.table 2.table
    cmp 1.table 5.table
}

@test "what the other filters make of a cube is good" {
    surface cube off | tetgen-mesh -q -a 0.01 >made.tm
    lepp-improve -q made.tm >better.tm
    for mesh in made.tm better.tm; do
        run -0 mesh-check --json out.json $mesh
        [ "$(json out.json euler)" = 1 ]
        [ "$(json out.json elements)" -gt 100 ]
        python3 - <<'END'
import json
cube = json.load(open("out.json"))
assert abs(cube["volume"] - 1) < 1e-12 and abs(cube["area"] - 6) < 1e-12
END
    done
}

# A cube of 12 triangles as a stream, changed by a sed script of OFF.
changed_cube() {
    surface cube off | sed "$1" | surface-import -q
}

@test "a good surface: the table and the JSON, exit 0" {
    surface cube stream >cube.tm
    run -0 mesh-check cube.tm
    [ "$(grep -c . <<<"$output")" -eq 11 ]
    [ "$(tail -n 1 <<<"$output")" = 'nothing is wrong' ]
    mesh-check --json - cube.tm >report
    grep -qx '{"nodes": 8, "triangles": 12, "components": 1, "nested": 0, "regions": 1, "euler": 2, "volume": \(1\|0.99999999999999[0-9]*\), "area": 6, "unused_nodes": 0, "non_manifold_edges": 0, "open_edges": 0, "duplicate_nodes": 0, "degenerate": 0, "repeated_faces": 0, "turned_faces": 0, "turned_shells": 0, "crossings": 0, "crossing_pairs": \[\], "problem": "", "good": true}' report
    surface sphere off | surface-import | mesh-check -j 2 >two
    surface sphere off | surface-import | mesh-check | cmp - two
    run -2 mesh-check --against cube.tm cube.tm
}

# shellcheck disable=SC2016 # the $ is sed's
@test "what is wrong with a surface: each kind, with its place" {
    wrong() { # wrong SED JSON-MEMBER LINE
        changed_cube "$1" >wrong.tm
        mesh-check --json report -o text wrong.tm && return 1
        grep -q "$2" report
        grep -q "$3" text
    }
    wrong '2s/12/11/; $d' '"open_edges": 3, ' '^    nodes [0-9]* and [0-9]*, from (.*) to (.*)$'
    wrong '2s/12/13/; $p' '"repeated_faces": 1, ' '^repeated triangles: 1, the first is 13, at (.*)$'
    wrong '$s/3 \(.\) \(.\) \(.\)/3 \2 \1 \3/' '"turned_faces": 1, "turned_shells": 0, ' \
        '^triangles turned against most of their shell: 1, the first is 12, at ('
    wrong 's/^3 \(.\) \(.\) \(.\)$/3 \2 \1 \3/' '"turned_faces": 0, "turned_shells": 1, ' \
        '^outermost shells that look inward: 1, the first is 1, at ('
    wrong '2s/8 12/9 12/; 3s/.*/&\n&/; s/^3 \(.\) \(.\) \(.\)$/3 \1 \2 \3/' '"duplicate_nodes": 1, ' \
        '^nodes in the place of an earlier one: 1$'
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 2 0 0' .face '2 0' \
        '1 1 2 3' '2 1 2 4' .end >flat.tm
    run -1 mesh-check flat.tm
    [[ $output == *'degenerate triangles: 1, the first is 2, at (0, 0, 0)'* ]]
}

@test "crossings: each pair, with a place; nesting" {
    cat >three.py <<'END'
import sys
print('OFF\n12 12 0')
for x, s in ((0, 9), (0.5, 1), (float(sys.argv[1]), 1)):
    for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)):
        print(p[0] * s + x, p[1] * s + x, p[2] * s + x)
for b in (0, 4, 8):
    for f in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)):
        print(3, *(b + v for v in f))
END
    python3 three.py 1.5 | surface-import | mesh-check >apart
    grep -q '^shells within others *2$' apart
    python3 three.py 0.6 | surface-import >crossed.tm
    run -1 mesh-check --json report crossed.tm
    pairs=$(sed -n 's/^crossings: //p' <<<"$output")
    [ "$pairs" -ge 3 ]
    [ "$(grep -c '^    triangles [0-9]* and [0-9]* meet near (.*)$' <<<"$output")" -eq "$((pairs < 5 ? pairs : 5))" ]
    python3 -c '
import json, sys
found = json.load(open("report"))
pairs = found["crossing_pairs"]
assert len(pairs) == found["crossings"] == int(sys.argv[1])
assert pairs == sorted(pairs) and all(len(p) == 5 and 5 <= p[0] < p[1] <= 12 for p in pairs)
assert "cross" in found["problem"]' "$pairs"
}

@test "usage errors: exit 2" {
    run -2 mesh-check --no-such-option cube.tm
    run -2 mesh-check cube.tm cube.tm
    run -2 mesh-check -j 0 cube.tm
    run -2 mesh-check --json
}

@test "bad input: exit 3 with file and line, and nothing on standard output" {
    head -n 14 cube.tm >cut.tm
    run -3 --separate-stderr mesh-check cut.tm
    [ "$output" = "" ]
    [[ "$stderr" =~ ^mesh-check:\ cut\.tm:[0-9]+: ]]
    run -3 --separate-stderr mesh-check <cut.tm
    [[ "$stderr" =~ ^mesh-check:\ \<stdin\>:[0-9]+: ]]
    sed 's/^5 0 6 4 7/5 0 6 4 8/' cube.tm >range.tm
    run -3 --separate-stderr mesh-check range.tm
    [[ "$stderr" =~ ^mesh-check:\ range\.tm:20:\ \.ele:\  ]]
}

@test "what cannot be read or written: exit 4" {
    run -4 mesh-check no-such-file.tm
    run -4 mesh-check -o /no-such-folder/out cube.tm
    run -4 mesh-check --json /no-such-folder/out.json cube.tm
    if [ -e /dev/full ]; then
        run -4 sh -c 'mesh-check cube.tm >/dev/full'
        run -4 sh -c 'mesh-check touching.tm >/dev/full'
        run -4 sh -c 'mesh-check --json - cube.tm >/dev/full'
        run -4 mesh-check --json /dev/full cube.tm
    fi
    run -4 sh -c 'mesh-check cube.tm >&-'
}

@test "a reader that stops early is no error" {
    mkfifo pipe
    run --separate-stderr bash -c 'true <pipe & exec 3>pipe; wait
        mesh-check cube.tm >&3'
    [ "$stderr" = "" ]
    [ "$status" -eq 141 ] # ended by SIGPIPE, as a shell reports it
}

@test "-o leaves the report whole or not at all" {
    echo old >report
    run -1 mesh-check -o report touching.tm
    [ "$output" = "" ]
    [ "$(head -n 1 report)" = "$(mesh-check cube.tm | sed -n '1s/8$/6/p')" ]
    cp report before
    run -3 mesh-check -o report /dev/null
    cmp report before
}

@test "volume and area of a surface are no whole numbers" {
    surface box off | awk 'NR > 2 && NF == 3 { $1 /= 2; $2 /= 4; $3 /= 8 } 1' >box.off
    surface-import -o box.tm box.off
    run -0 mesh-check box.tm
    [[ "$output" =~ volume\ +0\.015625 ]]
    [[ "$output" =~ area\ +0\.4375 ]]
    # the table's numbers end below each other
    [ "$(sed '/^$/,$d' <<<"$output" | awk '{ print length }' | sort -u | wc -l)" -eq 1 ]
}
