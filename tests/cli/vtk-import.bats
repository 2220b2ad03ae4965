# SPDX-License-Identifier: GPL-3.0-or-later
# vtk-import: what vtk-export, VTK and meshio write, in text and binary, of versions 2 to 5.1;
# damaged files.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers
load import

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# Prints a legacy file of text: legacy SECTIONS.
legacy() {
    printf '# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET UNSTRUCTURED_GRID\n%s\n' "$1"
}

corner='POINTS 4 double
0 0 0 1 0 0 0 1 0 0 0 1'
cells='CELLS 2 9
4 0 1 2 3
3 0 2 1
CELL_TYPES 2
10 5'

@test "what vtk-export writes comes back: the same nodes, elements, markers, regions, names" {
    local kind option
    for kind in tetrahedra mixed hexahedra surface points; do
        meshes $kind >$kind.tm
    done
    dual >polyhedra.tm
    for kind in tetrahedra mixed hexahedra surface points polyhedra; do
        for option in '' --no-quality; do
            # shellcheck disable=SC2086 # none or one
            vtk-export $option $kind.tm | vtk-import -q >back.tm
            same_mesh $kind.tm back.tm
        done
        vtk-export --no-names $kind.tm | vtk-import -q >back.tm
        same_mesh $kind.tm back.tm --no-names
        # and it is what vtu-import makes of the other format
        vtk-export $kind.tm | vtk-import -q --no-history >legacy.tm
        vtu-export $kind.tm | vtu-import -q --no-history | cmp - legacy.tm
    done
}

@test "VTK's files of versions 4.2 and 5.1, text and binary" {
    need_vtk
    local kind file
    meshes tetrahedra >tetrahedra.tm
    meshes mixed >mixed.tm
    meshes points >points.tm
    dual >polyhedra.tm
    for kind in tetrahedra mixed points polyhedra; do
        vtk-export -q --no-quality $kind.tm >$kind.vtk
        "$vtk_python" - $kind.vtk <<'END'
import sys, vtk
reader = vtk.vtkUnstructuredGridReader()
reader.ReadAllScalarsOn()
reader.SetFileName(sys.argv[1])
reader.Update()
for version in 42, 51:
    for form in 'ASCII', 'Binary':
        w = vtk.vtkUnstructuredGridWriter()
        w.SetInputData(reader.GetOutput())
        w.SetFileVersion(version)
        getattr(w, 'SetFileTypeTo' + form)()
        w.SetFileName('%s-%d.vtk' % (form, version))
        assert w.Write()
END
        for file in Binary-42 Binary-51; do
            vtk-import -q $file.vtk >back.tm
            same_mesh $kind.tm back.tm
        done
        for file in ASCII-42 ASCII-51; do # VTK writes eleven digits
            vtk-import -q $file.vtk >back.tm
            same_mesh $kind.tm back.tm --rounded
        done
    done
}

@test "VTK's polygons: triangles, strips, lines, points, with all kinds of data" {
    need_vtk
    "$vtk_python" - <<'END'
import vtk
points = vtk.vtkPoints()
points.SetDataTypeToDouble()
for p in (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (.1, 0, 1), (1, 0, 1):
    points.InsertNextPoint(p)
def array(kind, name, components, values):
    a = getattr(vtk, 'vtk%sArray' % kind)()
    a.SetName(name)
    a.SetNumberOfComponents(components)
    for v in values:
        a.InsertNextValue(v)
    return a
poly = vtk.vtkPolyData()
poly.SetPoints(points)
def cells(*lists):
    a = vtk.vtkCellArray()
    for l in lists:
        a.InsertNextCell(len(l))
        for i in l:
            a.InsertCellPoint(i)
    return a
poly.SetVerts(cells([5]))
poly.SetLines(cells([0, 1, 2]))
poly.SetPolys(cells([0, 1, 2, 3], [0, 1, 4]))
poly.SetStrips(cells([0, 3, 4, 5]))
poly.GetCellData().AddArray(array('Short', 'marker', 1, [7, 1, 2, 3, 4]))
data = poly.GetPointData()
data.SetScalars(array('Float', 'heat', 1, [i / 4 for i in range(6)]))
data.SetVectors(array('Double', 'speed', 3, [i / 8 for i in range(18)]))
data.SetNormals(array('Float', 'normal', 3, [0] * 18))
data.SetTCoords(array('Float', 'texture', 2, range(12)))
data.AddArray(array('Bit', 'bits', 1, [1, 0, 1, 1, 0, 1]))
data.AddArray(array('UnsignedChar', 'a name%', 1, range(250, 256)))
data.AddArray(array('IdType', 'ids', 1, range(6)))
text = vtk.vtkStringArray()
text.SetName('words')
for s in 'one', 'two words', '', 'x' * 100, 'POINTS 3', 'last':
    text.InsertNextValue(s)
data.AddArray(text)
for version in 42, 51:
    for form in 'ASCII', 'Binary':
        w = vtk.vtkPolyDataWriter()
        w.SetInputData(poly)
        w.SetFileVersion(version)
        getattr(w, 'SetFileTypeTo' + form)()
        w.SetFileName('%s-%d.vtk' % (form, version))
        assert w.Write()
END
    for file in *.vtk; do
        echo "$file"
        run -0 --separate-stderr vtk-import --no-history -o "${file%.vtk}.tm" "$file"
        [[ "$stderr" == *"attributes of nodes: "*"heat"* ]]
        [[ "$stderr" == *"data: words (strings): left out"* ]]
        [[ "$stderr" == *"a name%"* ]] && [[ "$stderr" == *"speed (3)"* ]]
        cmp "${file%.vtk}.tm" ASCII-42.tm
    done
    [ "$(rows .face ASCII-42.tm)" = "0 0 1 2 2
1 0 2 3 2
2 0 1 4 3
3 0 3 4 4
4 3 5 4 4" ]
    [ "$(rows .edge ASCII-42.tm)" = "0 0 1 1
1 1 2 1" ]
    [ "$(header .node ASCII-42.tm)" = "6 3 12 1" ]
}

@test "meshio's files, text and binary, of both versions" {
    need_meshio
    "$vtk_python" - <<'END'
import meshio, numpy as np
points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1],
                   [0, 1, 1], [.5, .5, 2]]) / 8
cells = [('hexahedron', np.arange(8).reshape(1, 8)), ('pyramid', np.array([[4, 5, 6, 7, 8]])),
         ('triangle', np.array([[4, 5, 8]])), ('quad', np.array([[0, 3, 2, 1]]))]
mesh = meshio.Mesh(points, cells, point_data={'T': np.arange(9) / 7}, cell_data={
    'material': [np.array([7]), np.array([8]), np.array([31]), np.array([32])]})
for version in '42', '51':
    for binary in True, False:
        getattr(meshio.vtk, 'write')('%s-%s.vtk' % (version, binary), mesh, fmt_version=version[0] + '.' + version[1], binary=binary)
END
    for file in *.vtk; do
        vtk-import -q "$file" >back.tm
        [ "$(rows .mix back.tm)" = "0 8 0 1 2 3 4 5 6 7 7
1 5 4 5 6 7 8 8" ]
        [ "$(rows .facet back.tm)" = "0 1 -1 3 4 5 8 31
1 0 -1 4 0 3 2 1 32" ]
        [[ "$(rows .node back.tm | tail -n 1)" == "8 0.0625 0.0625 0.25 1.142857142857142"* ]]
    done
    [ "$file" = 51-True.vtk ]
}

@test "sections by hand: in any order, metadata, tables, comments of old files" {
    legacy "$corner
METADATA
INFORMATION 1
NAME L2_NORM_RANGE LOCATION vtkDataArray
DATA 2 0 1

CELL_TYPES 2
10 5
CELLS 2 9
4 0 1 2 3 3 0 2 1
CELL_DATA 2
SCALARS region int
LOOKUP_TABLE default
7 8
COLOR_SCALARS colour 3
0 .5 1 1 1 1
LOOKUP_TABLE table 1
0 0 0 1
FIELD FieldData 2
marker 1 2 int
0 5
METADATA
COMPONENT_NAMES
x

words 1 2 string
FIELD of%20words
CELLS
POINT_DATA 4
VECTORS v float
0 0 0 1 1 1
2 2 2 nan 3 3" >hand.vtk
    run -0 --separate-stderr vtk-import -o hand.tm hand.vtk
    [ "$(rows .ele hand.tm) $(rows .face hand.tm)" = "0 0 1 2 3 7 0 0.5 1 0 0 2 1 5" ]
    [[ "$stderr" == *"attributes of elements, after the region: colour (3)"* ]]
    [[ "$stderr" == *"data: v (3) (not all finite), words (strings): left out"* ]]
    sed 's/Version 3.0/Version 1.0/; s/$/\r/' hand.vtk | vtk-import -q >crlf.tm
    same_mesh hand.tm crlf.tm
}

@test "wrong files: what is wrong, and where" {
    refuses() {
        run -3 --separate-stderr vtk-import file.vtk
        [ "$output" = "" ] && [ "${#stderr_lines[@]}" -eq 1 ] && [[ "$stderr" == "vtk-import: file.vtk:"*$1* ]] ||
            { echo "$stderr" && false; }
    }
    legacy "$corner
$cells" >good.vtk
    vtk-import good.vtk | grep -x '0 0 1 2 3'
    sed 's/UNSTRUCTURED_GRID/STRUCTURED_POINTS/' good.vtk >file.vtk
    refuses "4: holds 'STRUCTURED_POINTS' (UNSTRUCTURED_GRID or POLYDATA would be right)"
    sed 's/^ASCII/ascii-/' good.vtk >file.vtk
    refuses "3: the third line is neither ASCII nor BINARY"
    sed 's/double/quad/' good.vtk >file.vtk
    refuses "5: 'quad' is no type of numbers"
    sed 's/POINTS 4/POINTS 4000000000/' good.vtk >file.vtk
    refuses "5: there are not 12000000000 numbers in the rest of it"
    sed 's/^4 0 1 2 3/4 0 1 2 4/' good.vtk >file.vtk
    refuses " cell 0: the number of a point is 4 (there are 4)"
    sed 's/^4 0 1 2 3/9 0 1 2 3/' good.vtk >file.vtk
    refuses " cell 0: its number of nodes is out of range"
    sed 's/CELL_TYPES 2/CELL_TYPES 1/' good.vtk >file.vtk
    refuses ""
    sed 's/^10 5/41 5/' good.vtk >file.vtk
    refuses " cell 0 is of VTK's type 41"
    { cat good.vtk; echo CELL_DATA 3; } >file.vtk
    refuses ": there are data of 3 cells (there are 2)"
    { cat good.vtk; echo THINGS 3; } >file.vtk
    refuses ": 'THINGS' is no section of such a file"
    sed '/^CELL_TYPES/,$d' good.vtk >file.vtk
    refuses ": the file has no CELL_TYPES"
    sed '/^CELLS/,$d' good.vtk >file.vtk
    refuses ": the file ends behind its POINTS"
    run -3 --separate-stderr vtk-import --region stone good.vtk
    [ "$stderr" = "vtk-import: good.vtk: there is no cell data 'stone' (there are none)" ]
}

@test "damaged files are refused or read, with bounded memory" {
    need_vtk
    meshes tetrahedra 2 >tetrahedra.tm
    poly-dual -q <(sed '/^\.group/,/solid$/d' tetrahedra.tm | awk '/^\.ele/ { e = 1 } /^\.face/ { e = 0 }
        e && $1 == "48" { $3 = 0 } e && NF == 8 { NF = 5 } 1') >polyhedra.tm
    for kind in tetrahedra polyhedra; do
        # a cut behind the cells may leave a file that is whole, with less data
        vtk-export -q $kind.tm >$kind.vtk
        damage vtk-import $kind.vtk 200 CELL_DATA
        "$vtk_python" - $kind.vtk <<'END'
import sys, vtk
reader = vtk.vtkUnstructuredGridReader()
reader.ReadAllScalarsOn()
reader.SetFileName(sys.argv[1])
reader.Update()
for version in 42, 51:
    w = vtk.vtkUnstructuredGridWriter()
    w.SetInputData(reader.GetOutput())
    w.SetFileVersion(version)
    w.SetFileTypeToBinary()
    w.SetFileName('binary-%d.vtk' % version)
    assert w.Write()
END
        damage vtk-import binary-42.vtk 100 CELL_DATA
        damage vtk-import binary-51.vtk 100 CELL_DATA
    done
}
