# SPDX-License-Identifier: GPL-3.0-or-later
# vtu-import: what vtu-export writes, VTK and meshio write comes back; what a stream cannot
# hold is said; damaged files are refused.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers
load import

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# Prints a .vtu file of text: grid POINTS CELLS [DATA]. POINTS are "x y z, …"; CELLS
# "TYPE: nodes, …"; DATA are elements of CellData and PointData.
grid() {
    echo '<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">'
    echo '<UnstructuredGrid>'
    piece "$@"
    echo '</UnstructuredGrid></VTKFile>'
}

piece() {
    python3 - "$@" <<'END'
import sys
points = [p for p in sys.argv[1].split(',') if p.strip()]
cells = [c.split(':') for c in sys.argv[2].split(',') if c.strip()]
array = lambda name, values, more='': '<DataArray type="Float64" Name="%s" %s>%s</DataArray>' % (
    name, more, ' '.join(map(str, values)))
ends, end = [], 0
for _, nodes in cells:
    end += len(nodes.split())
    ends.append(end)
print('<Piece NumberOfPoints="%d" NumberOfCells="%d">' % (len(points), len(cells)))
print('<Points>', array('Points', points, 'NumberOfComponents="3"'), '</Points><Cells>')
print(array('connectivity', [n for _, n in cells]).replace('Float', 'Int'))
print(array('offsets', ends).replace('Float', 'Int'))
print(array('types', [t for t, _ in cells]).replace('Float', 'UInt'))
print('</Cells>', ''.join(sys.argv[3:4]), '</Piece>')
END
}

# An element of CellData or PointData: data SECTION NAME VALUES [COMPONENTS].
data() {
    echo "<$1><DataArray type=\"Float64\" Name=\"$2\" NumberOfComponents=\"${4:-1}\">$3</DataArray></$1>"
}

cube='0 0 0, 1 0 0, 1 1 0, 0 1 0, 0 0 1, 1 0 1, 1 1 1, 0 1 1'
corner='0 0 0, 1 0 0, 0 1 0, 0 0 1'

@test "what vtu-export writes comes back: the same nodes, elements, markers, regions, names" {
    local kind option
    for kind in tetrahedra mixed hexahedra surface points; do
        meshes $kind >$kind.tm
    done
    polylla3d -q --absorb tetrahedra.tm >polyhedra.tm
    for kind in tetrahedra mixed hexahedra surface points polyhedra; do
        for option in '' --no-quality; do
            # shellcheck disable=SC2086 # none or one
            vtu-export $option -o $kind.vtu $kind.tm
            vtu-import -q $kind.vtu >back.tm
            same_mesh $kind.tm back.tm
        done
        vtu-export --no-names $kind.tm | vtu-import -q >back.tm
        same_mesh $kind.tm back.tm --no-names
        [ "$kind" = surface ] || [ "$kind" = points ] ||
            { vtu-export --no-boundary $kind.tm | vtu-import -q >back.tm &&
                same_mesh $kind.tm back.tm --no-markers; }
    done
    # and what was compared can differ
    sed 's/ 11$/ 12/' tetrahedra.tm >other.tm
    run -1 same_mesh tetrahedra.tm other.tm
}

@test "what vtu-export measured is no attribute, and said with -v" {
    meshes tetrahedra | vtu-export -o tet.vtu
    run -0 --separate-stderr vtu-import -v tet.vtu
    [[ "$stderr" == *"measures of vtu-export, left out: dihedral_quality"* ]]
    run -0 --separate-stderr vtu-import --strict -o out.tm tet.vtu
    [ "$stderr" = "" ]
    [ "$(header .ele out.tm)" = "162 4 3" ]
}

@test "all forms in which VTK writes a file: text, base64, raw, packed, either order" {
    need_vtk
    local kind file
    meshes tetrahedra >tetrahedra.tm
    polylla3d -q --absorb tetrahedra.tm >polyhedra.tm
    meshes mixed 2 >mixed.tm
    for kind in tetrahedra polyhedra mixed; do
        vtu-export -q --no-quality -o $kind.vtu $kind.tm
        rm -rf forms
        mkdir forms
        vtk_forms $kind.vtu forms
        for file in forms/*.vtu; do
            echo "$kind $file"
            vtu-import -q "$file" >back.tm
            same_mesh $kind.tm back.tm
        done
        [ "$file" = forms/Binary-ZLib-64-Little.vtu ]
    done
}

@test "arrays of bits, in all forms, are attributes of 0 and 1" {
    need_vtk
    "$vtk_python" - <<'END'
import vtk
grid, points = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
for i in range(11):
    points.InsertNextPoint(i, i * i, i ** 3)
grid.SetPoints(points)
for i in range(8):
    grid.InsertNextCell(vtk.VTK_TETRA, 4, [i, i + 1, i + 2, i + 3])
def bits(data, name, components, count):
    a = vtk.vtkBitArray()
    a.SetName(name)
    a.SetNumberOfComponents(components)
    a.SetNumberOfTuples(count)
    for i in range(components * count):
        a.SetValue(i, i * i // 3 % 2)
    data.AddArray(a)
bits(grid.GetPointData(), 'one', 1, 11)
bits(grid.GetPointData(), 'three', 3, 11)
bits(grid.GetCellData(), 'cells', 1, 8)
w = vtk.vtkXMLUnstructuredGridWriter()
w.SetInputData(grid)
w.SetFileName('bits.vtu')
assert w.Write()
END
    mkdir forms
    vtk_forms bits.vtu forms
    for file in forms/*.vtu; do
        echo "$file"
        vtu-import -q --no-history -o back.tm "$file"
        awk '/^\./ { block = $1; rows = -1; next }
            { rows++ }
            rows < 1 { next }
            block == ".node" { n = rows - 1; for (c = 0; c < 4; c++) {
                i = c ? 3 * n + c - 1 : n; if ($(5 + c) != int(i * i / 3) % 2) exit 1 } }
            block == ".ele" { n = rows - 1; if ($7 != int(n * n / 3) % 2) exit 1; seen++ }
            END { if (seen != 8) exit 1 }' back.tm
    done
}

@test "meshio's files: text and binary, packed or not, with regions of Gmsh and Medit" {
    need_meshio
    "$vtk_python" - <<'END'
import meshio, numpy as np
points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1],
                   [0, 1, 1], [.5, .5, 2]]) / 3
cells = [('hexahedron', np.arange(8).reshape(1, 8)), ('pyramid', np.array([[4, 5, 6, 7, 8]])),
         ('triangle', np.array([[4, 5, 8]])), ('quad', np.array([[0, 3, 2, 1]]))]
for name in 'gmsh:physical', 'medit:ref':
    tags = {name: [np.array([7]), np.array([8]), np.array([31]), np.array([32])]}
    mesh = meshio.Mesh(points, cells, cell_data=tags, point_data={'T': np.arange(9) / 7})
    for binary in True, False:
        for compression in ('zlib', None):
            file = '%s-%s-%s.vtu' % (name[:4], binary, compression)
            meshio.vtu.write(file, mesh, binary=binary, compression=compression)
END
    for file in *.vtu; do
        run -0 --separate-stderr vtu-import -o back.tm "$file"
        [[ "$stderr" == *"' are regions (--region takes others)"* ]]
        [[ "$stderr" == *"attributes of nodes: T"* ]]
        [ "$(rows .mix back.tm)" = "0 8 0 1 2 3 4 5 6 7 7
1 5 4 5 6 7 8 8" ]
        [ "$(rows .facet back.tm)" = "0 1 -1 3 4 5 8 31
1 0 -1 4 0 3 2 1 32" ]
        # its text has 12 digits
        [[ "$file" == *False* ]] || [ "$(rows .node back.tm | tail -n 1)" = \
            "8 0.16666666666666666 0.16666666666666666 0.6666666666666666 1.1428571428571428" ]
    done
    [ "$file" = medi-True-zlib.vtu ]
    # lzma is of meshio, too
    "$vtk_python" -c 'import meshio
meshio.vtu.write("lzma.vtu", meshio.read("gmsh-True-zlib.vtu"), compression="lzma")'
    run -3 --separate-stderr vtu-import lzma.vtu
    [[ "$stderr" == "vtu-import: lzma.vtu:"*"compressed by vtkLZMADataCompressor"* ]]
}

@test "pixels, voxels, strips, polygons, lines of lines and prisms" {
    grid '0 0 0, 1 0 0, 0 1 0, 1 1 0, 0 0 1, 1 0 1, 0 1 1, 1 1 1' \
        '11: 0 1 2 3 4 5 6 7, 8: 0 1 2 3, 4: 0 1 3, 1: 5' \
        "$(data CellData marker '0 5 6 9')" >voxel.vtu
    vtu-import -q voxel.vtu >voxel.tm
    [ "$(rows .mix voxel.tm)" = "0 8 0 1 3 2 4 5 7 6" ]
    [ "$(rows .facet voxel.tm)" = "0 0 -1 4 0 2 3 1 5" ]
    [ "$(rows .edge voxel.tm)" = "0 0 1 6
1 1 3 6" ]
    [ "$(rows .node voxel.tm | cut -d ' ' -f 5 | tr '\n' ' ')" = "0 0 0 0 0 9 0 0 " ]
    grid "$cube" '6: 0 1 3 2, 7: 4 5 6 7, 9: 0 1 5 4' "$(data CellData patch '1 2 3')" >strip.vtu
    run -0 --separate-stderr vtu-import -o strip.tm strip.vtu
    [[ "$stderr" == *"3 polygons of the surface are cut into triangles"* ]]
    [ "$(rows .face strip.tm)" = "0 0 1 3 1
1 1 2 3 1
2 4 5 6 2
3 4 6 7 2
4 0 1 5 3
5 0 5 4 3" ]
    grid '0 0 0, 2 0 0, 3 2 0, 1 3 0, -1 2 0, 0 0 1, 2 0 1, 3 2 1, 1 3 1, -1 2 1' \
        '15: 0 1 2 3 4 5 6 7 8 9, 7: 0 1 2 3 4' "$(data CellData marker '0 3')" >prism.vtu
    vtu-import -q prism.vtu >prism.tm
    mesh-check -q prism.tm
    [ "$(header .facet prism.tm) $(header .cell prism.tm)" = "7 1 1 0" ]
    [ "$(rows .facet prism.tm | head -n 1)" = "0 0 -1 5 0 4 3 2 1 3" ]
}

@test "elements of second order are their corners, and their other nodes are gone" {
    grid "$corner, .5 0 0, .5 .5 0, 0 .5 0, 0 0 .5, .5 0 .5, 0 .5 .5, 9 9 9" \
        '24: 0 1 2 3 4 5 6 7 8 9, 22: 0 2 1 6 5 4, 21: 0 1 4' \
        "$(data CellData marker '0 5 6')$(data PointData T '0 1 2 3 4 5 6 7 8 9 10')" >tet10.vtu
    run -0 --separate-stderr vtu-import -o tet.tm tet10.vtu
    [[ "$stderr" == *"6 nodes of 3 elements of second or higher order, of which the corners "* ]]
    [ "$(rows .ele tet.tm) $(rows .face tet.tm) $(rows .edge tet.tm)" = \
        "0 0 1 2 3 0 0 2 1 5 0 0 1 6" ]
    [ "$(rows .node tet.tm | tail -n 2)" = "3 0 0 1 3
4 9 9 9 10" ]
    run -3 vtu-import --strict tet10.vtu
}

@test "left-handed elements are turned, those of a bad shape are not" {
    grid "$cube, 3 3 3" '10: 0 2 1 4, 14: 0 3 2 1 8, 13: 0 1 2 4 5 6, 12: 0 3 2 1 4 7 6 5' \
        >left.vtu
    run -0 --separate-stderr vtu-import -o right.tm left.vtu
    [[ "$stderr" == *" 4 elements were left-handed and are turned"* ]]
    jens-stats --json check.json right.tm
    [ "$(json check.json negative)" = 0 ]
    # one corner of eight is pushed through the cube
    grid '0 0 0, 1 0 0, 1 1 0, 0 1 0, 0 0 1, 1 0 1, -.5 -.5 -.5, 0 1 1' \
        '12: 0 1 2 3 4 5 6 7' >bad.vtu
    run -0 --separate-stderr vtu-import -o bad.tm bad.vtu
    [ "$stderr" = "" ]
    [ "$(rows .mix bad.tm)" = "0 8 0 1 2 3 4 5 6 7" ]
}

@test "regions and markers by name, and a name that is not there" {
    grid "$corner" '10: 0 1 2 3, 5: 0 2 1' \
        "$(data CellData Material '4 9')$(data CellData load '2.5 7')$(data CellData speed '1 2 3 4 5 6' 3)" \
        >named.vtu
    run -0 --separate-stderr vtu-import -o a.tm named.vtu
    [[ "$stderr" == *"cell data 'Material' are regions (--region takes others)"* ]]
    [[ "$stderr" == *"attributes of elements, after the region: load, speed (3)"* ]]
    [ "$(rows .ele a.tm) $(rows .face a.tm)" = "0 0 1 2 3 4 2.5 1 2 3 0 0 2 1 9" ]
    vtu-import -q --region load --marker load named.vtu >b.tm
    [ "$(rows .ele b.tm) $(rows .face b.tm)" = "0 0 1 2 3 2.5 4 1 2 3 0 0 2 1 7" ]
    run -3 --separate-stderr vtu-import --region stone named.vtu
    [ "$output" = "" ]
    [ "$stderr" = "vtu-import: named.vtu: there is no cell data 'stone' (there are: Material, load, speed)" ]
    run -3 --separate-stderr vtu-import --marker speed named.vtu
    [[ "$stderr" == *"'speed' are not one whole number"* ]]
    # without a region there is none that would be one by chance
    grid "$corner" '10: 0 1 2 3' "$(data CellData load 2.5)" | vtu-import -q >c.tm
    [ "$(rows .ele c.tm)" = "0 0 1 2 3 0 2.5" ]
}

@test "pieces are joined, ghosts left out, data that not all pieces have, too" {
    {
        echo '<VTKFile type="UnstructuredGrid"><UnstructuredGrid>'
        piece "$corner" '10: 0 1 2 3' \
            "$(data CellData region 1)$(data CellData x 5)$(data PointData T '0 1 2 3')"
        piece '' ''
        piece '0 1 0, 1 0 0, 0 0 0, 0 0 -1, 0 0 1, 5 5 5' '10: 0 1 2 3, 10: 0 1 4 2' \
            "$(data CellData vtkGhostType '0 1')$(data CellData region '2 9')$(data PointData T '2 1 0 4 3 6')"
        echo '</UnstructuredGrid></VTKFile>'
    } >pieces.vtu
    sed -i 's/\(NumberOfPoints="4".*\)/\1/' pieces.vtu
    run -0 --separate-stderr vtu-import -o one.tm pieces.vtu
    [[ "$stderr" == *"4 points of several pieces are the same and joined"* ]]
    [[ "$stderr" == *"data: x (not of all pieces): left out"* ]]
    [ "$(rows .node one.tm | cut -d ' ' -f 2-)" = "0 0 0 0
1 0 0 1
0 1 0 2
0 0 1 3
0 0 -1 4
5 5 5 6" ]
    # the ghosts' array is not of all pieces here, so that no cell is one
    [ "$(rows .ele one.tm | cut -d ' ' -f 2-)" = "0 1 2 3 1
2 1 0 4 2
2 1 3 0 9" ]
    sed 's|Name="x"|Name="vtkGhostType"|; s|>5<|>0<|' pieces.vtu >ghosts.vtu
    run -0 --separate-stderr vtu-import -o two.tm ghosts.vtu
    [[ "$stderr" == *"1 cells are ghosts of other pieces and left out"* ]]
    [ "$(rows .ele two.tm | cut -d ' ' -f 2-)" = "0 1 2 3 1
2 1 0 4 2" ]
}

# Prints a .pvtu file of these pieces.
list() {
    echo '<VTKFile type="PUnstructuredGrid" version="0.1"><PUnstructuredGrid GhostLevel="0">'
    echo '<PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>'
    [ $# -eq 0 ] || printf '<Piece Source="%s"/>\n' "$@"
    echo '</PUnstructuredGrid></VTKFile>'
}

@test "the files of a list of pieces are one mesh, as the pieces of a file are" {
    local first second
    first=$(data CellData region 3) second=$(data CellData region 4)
    { grid "$corner" '10: 0 1 2 3' "$first" | sed '$d' &&
        piece "$cube" '12: 0 1 2 3 4 5 6 7' "$second" && grid '' '' | sed -n '$p'; } >whole.vtu
    mkdir -p 'run & 1/deep'
    grid "$corner" '10: 0 1 2 3' "$first" >'run & 1/a_0.vtu'
    grid "$cube" '12: 0 1 2 3 4 5 6 7' "$second" | gzip >'run & 1/deep/a_1.vtu'
    grid '' '' >'run & 1/none.vtu'
    list none.vtu a_0.vtu deep/a_1.vtu >'run & 1/a.pvtu'
    vtu-import --no-history -q whole.vtu >whole.tm
    run -0 --separate-stderr vtu-import --no-history -o list.tm 'run & 1/a.pvtu'
    cmp list.tm whole.tm
    [[ "$stderr" == *"4 points of several pieces are the same and joined"* ]]
    mesh-convert 'run & 1/a.pvtu' converted.tm
    cmp <(sed '/^# /d' converted.tm) whole.tm
    # a name from the root; of standard input, from where we are
    list "$PWD/run &amp; 1/a_0.vtu" "run &amp; 1/deep/a_1.vtu" >a.pvtu
    vtu-import --no-history -q <a.pvtu | cmp - whole.tm
    # ours
    vtu-export -o ours.pvtu whole.tm
    vtu-import --no-history -q ours.pvtu | cmp - whole.tm
    mesh-convert whole.tm again.pvtu
    [ -s again_0.vtu ]
}

@test "a piece that is not there, or is none" {
    fails() {
        run "-$1" --separate-stderr vtu-import -o out.tm list.pvtu
        [[ "$stderr" == "vtu-import: "$2 ]] || { echo "$stderr" && false; }
        [ ! -e out.tm ]
    }
    grid "$corner" '10: 0 1 2 3' >a_0.vtu
    list a_0.vtu gone.vtu >list.pvtu
    fails 4 'gone.vtu: cannot open: No such file or directory'
    list a_0.vtu ./list.pvtu >list.pvtu
    fails 3 "./list.pvtu: is a list of pieces, and so no piece"
    list >list.pvtu
    fails 3 'list.pvtu: has no element Piece'
    list '' >list.pvtu
    fails 3 'list.pvtu:3: a piece has no Source'
    list a_0.vtu a_1.vtu >list.pvtu
    grid "$corner" '10: 0 1 2 9' >a_1.vtu
    fails 3 'a_1.vtu: cell 0: the number of a point is 9 (there are 4)'
    list </dev/null >a_1.vtu
    fails 3 'a_1.vtu: is a list*'
    : >a_1.vtu
    fails 3 'a_1.vtu:1: is no XML*'
}

@test "polyhedra in the layout of VTK 9.4, beside elements" {
    grid "$cube, .5 .5 2" '42: 0 1 2 3 4 5 6 7, 14: 4 5 6 7 8, 9: 0 3 2 1' \
        "$(data CellData marker '0 0 4')" >new.vtu
    sed -i 's|</Cells>|<DataArray type="Int64" Name="face_connectivity">0 1 2 3 4 5 6 7 0 1 5 4 1 2 6 5 2 3 7 6 3 0 4 7</DataArray>\
<DataArray type="Int64" Name="face_offsets">4 8 12 16 20 24</DataArray>\
<DataArray type="Int64" Name="polyhedron_to_faces">0 1 2 3 4 5</DataArray>\
<DataArray type="Int64" Name="polyhedron_offsets">6 6 6</DataArray></Cells>|' new.vtu
    vtu-import new.vtu >new.tm
    mesh-check -q --json check.json new.tm
    [ "$(json check.json volume)" = 1.3333333333333333 ]
    [ "$(header .facet new.tm) $(header .cell new.tm)" = "10 1 2 0" ]
    [ "$(rows .facet new.tm | grep -c ' 4$')" -ge 1 ]
    run -3 vtu-import <(sed 's/>6 6 6</>6 6 9</' new.vtu)
    run -3 vtu-import <(sed 's/>0 1 2 3 4 5</>0 1 2 3 4 6</' new.vtu)
    run -3 vtu-import <(sed 's/>4 8 12/>4 3 12/' new.vtu)
}

@test "what a stream has no place for is said, or refused with --strict" {
    grid "$corner, 7 7 7" '10: 0 1 2 3, 9: 0 1 2 3, 1: 4' \
        "$(data CellData heat 'nan 1 2')$(data PointData T '0 1 inf 3 4')" >rest.vtu
    run -0 --separate-stderr vtu-import -o rest.tm rest.vtu
    [[ "$stderr" == *"1 polygons that are no face of an element: left out"* ]]
    [[ "$stderr" == *"1 cells of one point: left out"* ]]
    [[ "$stderr" == *"data: T (not all finite), heat (not all finite): left out"* ]]
    [ "$(header .node rest.tm) $(header .ele rest.tm)" = "5 3 0 0 1 4 0" ]
    run -3 --separate-stderr vtu-import --strict rest.vtu
    [ "$output" = "" ]
    grid "$corner" '10: 0 1 2 3' "$(data CellData heat 1)$(data PointData words '97 0 98 0 99 0 0')" |
        sed 's/Float64\(" Name="words"\)/String\1/' >words.vtu
    run -0 --separate-stderr vtu-import -o words.tm words.vtu
    [[ "$stderr" == *"data: words (strings): left out"* ]]
    run -3 --separate-stderr vtu-import --strict words.vtu
    [ "$output" = "" ]
    run -3 --separate-stderr vtu-import --region words words.vtu
    [[ "$stderr" == *"words"* ]]
}

@test "the same bytes for any number of threads; packed by gzip, too" {
    meshes tetrahedra 12 | vtu-export -o many.vtu
    vtu-import -q --no-history -j 1 many.vtu >one.tm
    vtu-import -q --no-history -j 2 many.vtu >two.tm
    cmp one.tm two.tm
    gzip -c many.vtu | vtu-import -q --no-history >packed.tm
    cmp one.tm packed.tm
}

@test "wrong files: what is wrong, and where" {
    refuses() {
        run -3 --separate-stderr vtu-import "$2"
        [ "$output" = "" ] && [ "${#stderr_lines[@]}" -eq 1 ] && [[ "$stderr" == "vtu-import: $2:"*$1* ]] ||
            { echo "$2: $stderr" && false; }
    }
    grid "$corner" '10: 0 1 2 3' >good.vtu
    vtu-import -q good.vtu >good.tm
    sed 's/"UnstructuredGrid"/"PolyData"/' good.vtu >a.vtu
    refuses "1: is a file of VTK of type 'PolyData' (UnstructuredGrid would be right; vtk-import reads polygons of a legacy .vtk)" a.vtu
    sed 's/"UnstructuredGrid"/"PUnstructuredGrid"/' good.vtu >b.vtu
    refuses '3: a piece has no Source' b.vtu
    sed 's/byte_order/compressor="vtkLZ4DataCompressor" byte_order/' good.vtu >c.vtu
    refuses 'compressed by vtkLZ4DataCompressor (vtkZLibDataCompressor can be read)' c.vtu
    echo '<html><body/></html>' >d.vtu
    refuses "is no XML file of VTK (its first element is 'html')" d.vtu
    sed 's/0 1 2 3</0 1 2 4</' good.vtu >e.vtu
    refuses ' cell 0: the number of a point is 4 (there are 4)' e.vtu
    sed 's/NumberOfCells="1"/NumberOfCells="2"/' good.vtu >f.vtu
    refuses "there are not 2 numbers in the rest of it (a number of 'types')" f.vtu
    sed 's/NumberOfPoints="4"/NumberOfPoints="4000000000"/' good.vtu >g.vtu
    refuses '' g.vtu
    sed 's/0 0 1</0 0 nan</' good.vtu >h.vtu
    refuses ' point 3: a coordinate is no finite number' h.vtu
    sed 's/>10</>41</' good.vtu >i.vtu
    refuses " cell 0 is of VTK's type 41" i.vtu
    sed 's/>10</>12</' good.vtu >j.vtu
    refuses " cell 0, of VTK's type 12, has 4 nodes (8 would be right)" j.vtu
    sed 's/Float64/Float128/' good.vtu >k.vtu
    refuses "the type of an array is 'Float128'" k.vtu
    sed 's/<\/Points>//' good.vtu >l.vtu
    refuses 'is no XML, or is cut short: mismatched tag' l.vtu
    sed 's/NumberOfCells="1"/NumberOfCells="-1"/' good.vtu >m.vtu
    refuses 'NumberOfCells="-1" is no count' m.vtu
}

@test "entities that grow without end, and those of other files, are not opened" {
    grid "$corner" '10: 0 1 2 3' >good.vtu
    { echo '<!DOCTYPE VTKFile ['
        echo '<!ENTITY a0 "1111111111">'
        for i in $(seq 1 9); do
            echo "<!ENTITY a$i \"&a$((i - 1));&a$((i - 1));&a$((i - 1));&a$((i - 1));&a$((i - 1));&a$((i - 1));&a$((i - 1));&a$((i - 1));&a$((i - 1));&a$((i - 1));\">"
        done
        echo ']>'
        sed 's/<Points>/<Points>\&a9;/' good.vtu; } >laughs.vtu
    run -3 --separate-stderr vtu-import laughs.vtu
    [[ "$stderr" == *"amplification"* ]]
    echo '0 1 2 3' >secret
    { echo "<!DOCTYPE VTKFile [<!ENTITY other SYSTEM \"$PWD/secret\">]>"
        sed 's/>0 1 2 3</>\&other;</; s/> 0 1 2 3</>\&other;</' good.vtu; } >other.vtu
    grep -q '&other;' other.vtu
    run -3 vtu-import other.vtu
}

@test "a file of another byte order, or headers of another size, than it says" {
    meshes tetrahedra 2 | vtu-export -q -o good.vtu
    sed 's/LittleEndian/BigEndian/' good.vtu >order.vtu
    run -3 --separate-stderr vtu-import order.vtu
    [ "$output" = "" ]
    sed 's/UInt64/UInt32/' good.vtu >header.vtu
    run -3 --separate-stderr vtu-import header.vtu
    [ "$output" = "" ]
    sed 's/compressor="[A-Za-z]*"//' good.vtu >plain.vtu
    run -3 --separate-stderr vtu-import plain.vtu
    [ "$output" = "" ]
}

@test "what unpacks to more than the counts say is not unpacked" {
    python3 - <<'END'
import struct, zlib
block = zlib.compress(bytes(1 << 26), 9)
data = struct.pack('<4Q', 1, 1 << 26, 0, len(block)) + block
xml = '''<VTKFile type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">
<UnstructuredGrid><Piece NumberOfPoints="%d" NumberOfCells="0"><Points>
<DataArray type="Float64" NumberOfComponents="3" format="appended" offset="0"/></Points></Piece></UnstructuredGrid>
<AppendedData encoding="raw">_'''
for name, points in ('bomb', 10), ('claim', 10 ** 9):
    with open(name + '.vtu', 'wb') as f:
        f.write((xml % points).encode() + data + b'</AppendedData></VTKFile>')
END
    for file in bomb.vtu claim.vtu; do
        run -3 --separate-stderr bash -c "case \$TM_BUILD in */san) ;; *) ulimit -v 60000 ;; esac
            vtu-import $file"
        [[ "$stderr" == *"holds 8388608 numbers"* ]]
    done
}

@test "damaged files are refused or read, with bounded memory" {
    need_vtk
    meshes tetrahedra 2 >tetrahedra.tm
    polylla3d -q tetrahedra.tm >polyhedra.tm
    for kind in tetrahedra polyhedra; do
        vtu-export -q -o $kind.vtu $kind.tm
        damage vtu-import $kind.vtu
        rm -rf forms
        mkdir forms
        vtk_forms $kind.vtu forms
        for form in Ascii-None Binary-None Binary-ZLib Appended-None AppendedBase64-ZLib; do
            damage vtu-import forms/$form-32-Little.vtu 60
        done
    done
}
