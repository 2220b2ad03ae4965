# SPDX-License-Identifier: GPL-3.0-or-later
# Surfaces in and out: surface-import, stl-export, ply-export, obj-export, and what
# off-export has with them.
# shellcheck disable=SC1003,SC2154 # a backslash is meant; run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# A unit cube of squares with markers and names; node 5 is in no face.
named_cube() {
    printf '%s\n' 'termesh 1' .node '9 3 0 0' '0 0 0 0' '1 0.1 0 0' '2 0.1 0.1 0' \
        '3 0 0.1 0' '4 0 0 1e-20' '5 9 9 9' '6 0.1 0 1' '7 0.1 0.1 1' '8 0 0.1 1' \
        .face '12 1' '0 0 3 2 7' '1 0 2 1 7' '2 4 6 7 -2' '3 4 7 8 -2' '4 0 1 6 0' \
        '5 0 6 4 0' '6 1 2 7 0' '7 1 7 6 0' '8 2 3 8 9' '9 2 8 7 9' '10 3 0 4 9' \
        '11 3 4 8 9' .group '3 0' '0 2 7 inlet port' '1 2 -2 Auslaß' '2 3 1 steel' .end
}

# The faces of a stream by coordinates, with the name of their marker, sorted; each from
# its smallest corner on.
faces() {
    awk '/^\.[a-z]+$/ { block = $1; getline; next }
        block == ".node" { at[$1] = $2 " " $3 " " $4 }
        block == ".group" && $2 == 2 { name = $0; sub(/^[^ ]+ [^ ]+ [^ ]+ /, "", name)
            named[$3] = name }
        block == ".face" { n++; for (i = 0; i < 3; i++) c[n, i] = at[$(2 + i)]; marker[n] = $5 }
        END {
            for (f = 1; f <= n; f++) {
                first = 0
                for (i = 1; i < 3; i++) if (c[f, i] < c[f, first]) first = i
                print c[f, first] ", " c[f, (first + 1) % 3] ", " c[f, (first + 2) % 3] \
                    ": " named[marker[f]]
            }
        }' "$1" | sort
}

# The area of each group as meshio or VTK read a file: not our reader.
vtk_area() {
    python3 - "$1" <<'END'
import sys, vtk
reader = {'stl': vtk.vtkSTLReader, 'ply': vtk.vtkPLYReader, 'obj': vtk.vtkOBJReader}[
    sys.argv[1][-3:]]()
reader.SetFileName(sys.argv[1])
triangles = vtk.vtkTriangleFilter()
triangles.SetInputConnection(reader.GetOutputPort())
mass = vtk.vtkMassProperties()
mass.SetInputConnection(triangles.GetOutputPort())
mass.Update()
print('%.6g %.6g' % (mass.GetSurfaceArea(), mass.GetVolume()))
END
}

@test "a surface to each format and back: nodes to the bit, faces, markers, names" {
    named_cube >cube.tm
    faces cube.tm >expected
    grep -c 'inlet port' expected | grep -x 2
    for format in 'stl' 'ply' 'ply --binary' 'obj'; do
        # shellcheck disable=SC2086 # words
        set -- $format
        run -0 --separate-stderr "$1-export" "${@:2}" -o "cube.$1" cube.tm
        [ "$stderr" = "" ]
        run -0 --separate-stderr surface-import --strict -o again.tm "cube.$1"
        [ "$stderr" = "" ]
        faces again.tm | sed 's/: marker_9$/: /' | diff - expected
    done
    # numbers of markers stay where the format has them
    ply-export --binary cube.tm | surface-import | sed -n '/^.group/,$p' |
        grep -x '[0-9]* 2 -2 Auslaß'
    ply-export cube.tm | surface-import | awk '/^\.face/ { f = 1; getline; next }
        /^\.group/ { f = 0 } f { n[$5]++ } END { print n[7], n[-2], n[0], n[9] }' | grep -x '2 2 4 4'
    # the second time nothing changes
    stl-export cube.tm >one.stl
    surface-import one.stl | stl-export >two.stl
    surface-import two.stl | stl-export | cmp - two.stl
    obj-export cube.tm >one.obj
    surface-import one.obj | obj-export >two.obj
    surface-import two.obj | obj-export | cmp - two.obj
}

@test "binary STL: 32-bit floats, no names, and both are said" {
    named_cube >cube.tm
    run -0 --separate-stderr stl-export --binary -o cube.stl cube.tm
    [ "${#stderr_lines[@]}" -eq 1 ]
    [[ "$stderr" == 'stl-export: cube.tm: '*'markers of faces (.face)'*'names of faces (.group): left out' ]]
    [ "$(wc -c <cube.stl)" -eq $((84 + 12 * 50)) ]
    run -3 --separate-stderr stl-export --strict --binary -o no.stl cube.tm
    [ ! -e no.stl ]
    # nodes that floats cannot tell apart
    sed 's/^6 0.1 0 1/6 0.1 0.10000000001 1/' cube.tm >thin.tm
    run -0 --separate-stderr stl-export --binary -o thin.stl thin.tm
    [[ "$stderr" == *'of 12 triangles have two corners that are one as 32-bit floats'* ]]
    sed 's/^6 0.1 0 1/6 1e39 0 1/' cube.tm >large.tm
    run -3 --separate-stderr stl-export --binary -o large.stl large.tm
    [ "$stderr" = 'stl-export: large.tm: node 6: 1e+39 is too large for the 32-bit floats of '\
'binary STL (text would be right)' ]
    run -0 stl-export -o large.stl large.tm
}

@test "what VTK reads: the same area and volume" {
    python3 -c 'import vtk' || skip "there is no VTK for Python"
    surface sphere off >sphere.off
    surface-import sphere.off >sphere.tm
    for format in 'stl' 'stl --binary' 'ply' 'ply --binary' 'obj'; do
        # shellcheck disable=SC2086 # words
        set -- $format
        "$1-export" "${@:2}" -o "sphere.$1" sphere.tm
        vtk_area "sphere.$1"
    done >areas
    [ "$(sort -u areas | wc -l)" -eq 1 ]
    cubes | ply-export --binary -o cubes.ply
    [ "$(vtk_area cubes.ply)" = '10 2' ]
    cubes | obj-export -o cubes.obj
    [ "$(vtk_area cubes.obj)" = '10 2' ]
}

@test "the boundary of cells, all faces, and each region closed" {
    cubes >cubes.tm # two unit cubes, side by side, of the regions 1 and 2
    sed -n '/^.cell/,$p' cubes.tm
    for format in stl ply obj; do
        "$format-export" cubes.tm | surface-import >boundary.tm
        [ "$(header .face boundary.tm | cut -d ' ' -f 1)" -eq 20 ]
        "$format-export" --all cubes.tm | surface-import >all.tm
        [ "$(header .face all.tm | cut -d ' ' -f 1)" -eq 22 ]
    done
    # two tetrahedra of two regions, one of which has a name
    printf '%s\n' 'termesh 1' .node '5 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' \
        '5 0 0 -1' .ele '2 4 1' '1 1 2 3 4 3' '2 1 3 2 5 8' .group '1 0' '1 3 8 steel' .end \
        >two.tm
    run -0 --separate-stderr stl-export --regions -o two.stl two.tm
    [ "$stderr" = "" ]
    [ "$(grep -c '^facet' two.stl)" -eq 8 ]
    grep -x 'solid region_3' two.stl
    grep -x 'solid steel' two.stl
    sed -n '/^solid steel/,/^endsolid/p' two.stl >steel.stl
    surface-import steel.stl | tetgen-mesh --quiet | tet-stats --json - -o list |
        grep -q '"volume": 0.1666666666666666[0-9]'
    obj-export --regions two.tm | grep -x 'g steel'
    ply-export --regions two.tm | grep -x 'comment region 8 steel'
    off-export --regions two.tm | sed -n 2p | grep -x '5 8 0'
    run -3 --separate-stderr stl-export --regions -o no.stl <(named_cube)
    [[ "$stderr" == *'has no cells (.cell, .mix or .ele), and so no regions' ]]
    run -2 stl-export --regions --all two.tm
}

@test "a part of the stream: the surface that an octree's mesh keeps" {
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "octree-mesh is not built"
    named_cube >cube.tm
    obj-export cube.tm >cube.obj
    octree-mesh --quiet -s 2 cube.obj >both.tm
    obj-export --part surface both.tm >part.obj
    faces <(surface-import part.obj) | sed "s/marker_[19]\$//" | diff - <(faces cube.tm)
    run -3 --separate-stderr obj-export --part none both.tm
    [ "$stderr" = 'obj-export: both.tm: there is no block none.face' ]
    run -2 stl-export --part surface --regions both.tm
}

@test "names that are taken, and those that a format could take for something else" {
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' \
        .face '4 1' '1 1 3 2 1' '2 1 2 4 2' '3 2 3 4 3' '4 1 4 3 4' .group '3 0' \
        '1 2 1 marker_2' '2 2 3 # no comment' '3 2 4 ends in \' .end >names.tm
    stl-export names.tm | surface-import | grep -c '^[1-4] 2 [1-4] \(marker_2\|marker_2_\|# no comment\|ends in \\\)$' |
        grep -x 4
    obj-export names.tm | surface-import | grep -c '^[1-4] 2 [1-4] \(marker_2\|marker_2_\|# no comment\|ends in \\_\)$' |
        grep -x 4
    ply-export names.tm | surface-import | grep -c '^[1-3] 2 [1-4] \(marker_2\|# no comment\|ends in \\\)$' |
        grep -x 3
}

@test "PLY: markers of our own and of others, and comments that are none" {
    ply() {
        printf '%s\n' ply 'format ascii 1.0' "${@}" 'element vertex 3' 'property float x' \
            'property float y' 'property float z' 'element face 2' "property $type marker" \
            'property list uchar int vertex_indices' end_header '0 0 0' '1 0 0' '0 1 0' \
            "$marker 3 0 1 2" '5 3 2 1 0'
    }
    type=int marker=-7
    ply 'comment marker 5 five' 'comment marker 5 again' 'comment marker 6 five' 'comment marker x' \
        'comment marker' 'comment' >one.ply
    surface-import one.ply | sed -n '/^.face/,$p' >rows
    printf '%s\n' .face '2 1' '1 1 2 3 -7' '2 3 2 1 5' .group '1 0' '1 2 5 five' .end | diff rows -
    type=float ply >real.ply
    run -3 --separate-stderr surface-import real.ply
    [[ "$stderr" == 'surface-import: real.ply:'*': markers are real numbers'* ]]
    type=uint marker=4000000000 ply >large.ply
    run -3 --separate-stderr surface-import large.ply
    [[ "$stderr" == *'the marker is 4000000000 (a number of 32 bits)' ]]
}

@test "surface-import: polygons are cut by ears, and nothing else is changed" {
    # an L whose fan from the first corner would fold over
    printf '%s\n' OFF '6 1 0' '0 1 0' '0 0 0' '2 0 0' '2 2 0' '1 2 0' '1 1 0' \
        '6 0 1 2 3 4 5' >l.off
    surface-import l.off >l.tm
    awk '/^\.[a-z]+$/ { block = $1; getline; next }
        block == ".node" { x[$1] = $2; y[$1] = $3 }
        block == ".face" {
            area = (x[$3] - x[$2]) * (y[$4] - y[$2]) - (y[$3] - y[$2]) * (x[$4] - x[$2])
            if (area <= 0) exit 1
            sum += area / 2; n++
        }
        END { print n, sum }' l.tm | grep -x '4 3'
    printf '%s\n' OFF '4 2 0' '0 0 0' '1 0 0' '1 0 0' '0 1 0' '3 0 1 3' '3 0 0 1' >flat.off
    run -0 --separate-stderr surface-import -o flat.tm flat.off
    [ "$stderr" = 'surface-import: flat.off: 1 triangles that have a node twice are dropped' ]
    grep -A 1 -x .node flat.tm | grep -x '4 3 0 0'
    printf '%s\n' '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 1 1 0' '1 0' '2 0' '3 1 2 3' '3 2 4 3' 0 0 \
        >two.poly
    run -3 --separate-stderr surface-import two.poly
    [ "$stderr" = 'surface-import: two.poly: facet 1 has several polygons, or a hole (tetgen-mesh takes them)' ]
    run -3 --separate-stderr surface-import <(cubes)
    [[ "$stderr" == *'holds polyhedra (.cell), but surface-import takes'* ]]
}

@test "what of a stream is no part of its surface is said by all that read surfaces" {
    named_cube | sed "/^2 3 1 steel/d; s/^3 0$/2 0/; /^\.end/d" >named.tm
    printf '%s\n' .edge '1 1' '0 0 1 0' >>named.tm
    cp named.tm plain.tm
    echo .end >>plain.tm
    sed -i 's/^0 0 1 0$/0 0 1 9/' named.tm
    printf '%s\n' .notes 'by hand' other.node '1 3 0 0' '0 5 5 5' other.notes x .end >>named.tm
    # The same as the part of a mesh, with an edge of its own.
    { sed 's/^\.\(node\|face\|group\|edge\)$/surface&/; /^\.end/d' named.tm; \
        printf '%s\n' .node '0 3 0 0' .ele '0 4 0' .end; } >part.tm
    for filter in surface-import surface-mend tetgen-mesh octree-mesh; do
        command -v "$filter" >/dev/null && { [ "$filter" != tetgen-mesh ] || command -v tetgen; } || continue
        run -0 --separate-stderr "$filter" -o mesh.tm plain.tm
        [[ "$stderr" != *'left out'* ]]
        for blocks in named.tm=.edge,.notes,other.node,other.notes \
            part.tm=surface.edge,.notes,other.node,other.notes; do
            input=${blocks%=*}
            run -0 --separate-stderr "$filter" -o mesh.tm "$input"
            for block in $(tr , ' ' <<<"${blocks#*=}"); do
                grep -q "^$filter: $input: .*$block)*: left out$" <<<"$stderr" ||
                    grep -x "$block" mesh.tm
            done
            run -3 "$filter" --strict -o strict.tm "$input"
            [ ! -e strict.tm ]
        done
    done
}

@test "mesh-convert: by suffixes, whichever way, and the status of what failed" {
    named_cube >cube.tm
    mesh-convert cube.tm cube.stl
    cmp cube.stl <(stl-export cube.tm)
    gzip -k cube.stl
    mesh-convert cube.stl.gz CUBE.OBJ
    cmp CUBE.OBJ <(surface-import cube.stl | obj-export)
    mesh-convert CUBE.OBJ again.tm
    cmp <(tail -n +3 again.tm) <(surface-import CUBE.OBJ | tail -n +3)
    cubes >cubes.tm
    mkdir case
    mesh-convert cubes.tm case/polyMesh
    [ -s case/polyMesh/owner ]
    mesh-convert cubes.tm cubes.vtu
    vtu-export cubes.tm | cmp - cubes.vtu
    mixed >mixed.tm
    mesh-convert mixed.tm mixed.inp
    mesh-convert mixed.inp mixed.meshb
    mesh-convert mixed.meshb mixed.mesh
    abaqus-import mixed.inp | medit-export | cmp - mixed.mesh
    abaqus-import mixed.inp | medit-export --binary | cmp - mixed.meshb
    run -4 mesh-convert none.stl cube.obj
    [[ "$output" == *'surface-import: none.stl: cannot open: '* ]]
    run -4 mesh-convert cube.stl none/cube.obj
    [[ "$output" == *'obj-export: none/cube.obj: cannot write: '* ]]
    head -n 20 cube.stl >cut.stl
    run -3 mesh-convert cut.stl cube.ply
    [ ! -e cube.ply ]
    run -3 mesh-convert cube.tm cube.oct
    run -2 mesh-convert cube.tm cube.xyz
    [ "$output" = 'mesh-convert: cube.xyz: no exporter is known for this suffix (mesh-convert --help lists them)' ]
    run -2 mesh-convert cube cube.stl
    run -2 mesh-convert cube.tm other.tm
    run -2 mesh-convert cube.tm
    run -2 mesh-convert --fast cube.tm cube.stl
    run -0 mesh-convert --help
    [[ "${lines[0]}" == 'usage: mesh-convert '* ]]
    run -0 mesh-convert --version
    [[ "$output" =~ ^mesh-convert\ \(termesh\)\ [0-9.]+$ ]]
    # what --help lists is known
    for suffix in $(mesh-convert --help | sed -n '/^in: /,/^out: /p' | grep -o '\.[a-z0-9]*' | sort -u); do
        run mesh-convert "none$suffix" "none/none.tm"
        [[ "$output" != *'no importer is known'* ]]
    done
}

@test "mesh-convert: TetGen's files are read together, whichever of them is named" {
    printf '%s\n' 'termesh 1' .node '4 3 0 1' '1 0 0 0 0' '2 1 0 0 5' '3 0 1 0 5' '4 0 0 1 5' \
        .ele '1 4 1' '1 1 2 3 4 7' .face '1 1' '1 1 3 2 11' .edge '1 1' '1 1 2 3' \
        .group '2 0' '1 2 11 bottom' '2 3 7 steel' .end >corner.tm
    mesh-convert corner.tm corner.node
    mesh-convert corner.tm packed.ele
    gzip packed.*
    for file in corner.node corner.ele packed.node.gz packed.ele.gz; do
        mesh-convert "$file" again.tm
        diff corner.tm <(sed '/^#/d' again.tm)
        mesh-convert "$file" again.vtu
        vtu-export corner.tm | cmp - again.vtu
    done
}

@test "mesh-convert: names that begin with -, a folder's slash, what is packed" {
    named_cube >cube.tm
    cp cube.tm ./-o.tm
    mesh-convert -- -o.tm -q.stl
    stl-export cube.tm | cmp - ./-q.stl
    mesh-convert -- -q.stl again.tm
    surface-import -o expected.tm ./-q.stl
    cmp again.tm expected.tm
    cubes >cubes.tm
    mesh-convert cubes.tm polyMesh/
    mesh-convert polyMesh/ again.tm
    openfoam-import polyMesh | cmp - again.tm
    gzip -c cube.tm >CUBE.TM.GZ
    mesh-convert CUBE.TM.GZ cube.off
    off-export cube.tm | cmp - cube.off
    # what is written is never packed
    run -2 mesh-convert cube.tm cube.stl.gz
    [ ! -e cube.stl.gz ]
}

@test "a solid without a triangle has a name: what is written is read" {
    printf 'solid a name\nendsolid\n' >nothing.stl
    surface-import --no-history nothing.stl >nothing.tm
    grep -q 'a name$' nothing.tm
    surface-import --no-history nothing.tm | cmp - nothing.tm
    # The first number of all is that of the name's row.
    printf '%s\n' 'termesh 1' .node '0 3 0 0' .ele '0 4 0' .group '1 0' '0 2 1 part' .end >zero.tm
    lepp-improve -q --no-history zero.tm | cmp - zero.tm
    printf '%s\n' 'termesh 1' .group '1 0' '1 2 1 part' .node '0 3 0 0' .ele '0 4 0' .end >early.tm
    run -3 mesh-check early.tm
    [[ "$output" == *"comes before the nodes"* ]]
}
