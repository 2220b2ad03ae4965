# SPDX-License-Identifier: GPL-3.0-or-later
# openfoam-import: what openfoam-export, blockMesh and foamFormatConvert write, in text and
# binary, packed or not; damaged files.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers
load import

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    export WM_PROJECT_DIR="${WM_PROJECT_DIR:-/usr/share/openfoam}"
    export FOAM_ETC="${FOAM_ETC:-$WM_PROJECT_DIR/etc}"
}

need_openfoam() {
    command -v "$1" >/dev/null && [ -r "$FOAM_ETC/controlDict" ] || skip "there is no OpenFOAM"
}

# foam NAME TEXT: a dictionary.
foam() {
    printf 'FoamFile { version 2.0; format ascii; class dictionary; object %s; }\n%s\n' \
        "$(basename "$1")" "$2" >"$1"
}

# foam_case FOLDER [FORMAT [COMPRESSION]]: all of a case but its mesh.
foam_case() {
    rm -rf "$1"
    mkdir -p "$1/system" "$1/constant"
    foam "$1/system/controlDict" "application icoFoam; startFrom startTime; startTime 0;
stopAt endTime; endTime 1; deltaT 1; writeControl timeStep; writeInterval 1;
writePrecision 17; writeFormat ${2:-ascii}; writeCompression ${3:-off};"
    foam "$1/system/fvSchemes" 'ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {}
interpolationSchemes {} snGradSchemes {}'
    foam "$1/system/fvSolution" ''
}

# Two blocks of 4 by 4 and 2 by 4 hexahedra.
block_mesh_dict='scale 0.1;
vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 0.1) (1 0 0.1) (1 1 0.1) (0 1 0.1)
    (2 0 0) (2 1 0) (2 0 0.1) (2 1 0.1));
blocks (hex (0 1 2 3 4 5 6 7) fluid (4 4 1) simpleGrading (1 1 1)
    hex (1 8 9 2 5 10 11 6) solid (2 4 1) simpleGrading (2 1 1));
edges ();
boundary (movingWall { type wall; faces ((3 7 6 2)); }
    fixedWalls { type wall; faces ((0 4 7 3) (1 5 4 0)); }
    frontAndBack { type empty; faces ((0 3 2 1) (4 5 6 7)); });
mergePatchPairs ();'

# Prints a stream of polyhedra with regions and markers, of boxes: cells N.
cells() {
    meshes hexahedra "$1" >cells.hexahedra
    openfoam-export -q cells.folder cells.hexahedra
    openfoam-import -q cells.folder
}

@test "what openfoam-export writes comes back: nodes, cells, patches, zones, names" {
    local kind
    for kind in tetrahedra mixed hexahedra; do
        meshes $kind >$kind.tm
    done
    dual >dual.tm
    for kind in tetrahedra mixed hexahedra dual; do
        rm -rf case again
        mkdir -p case/constant
        openfoam-export -q case/constant/polyMesh $kind.tm
        openfoam-import case >$kind.back
        openfoam-export -q again $kind.back
        diff -r case/constant/polyMesh again
        # the mesh, as another filter sees it
        mesh-check -q --json a.json $kind.tm || true
        mesh-check -q --json b.json $kind.back || true
        [ "$(json a.json nodes)" = "$(json b.json nodes)" ]
        [ "$(json a.json elements)" = "$(json b.json elements)" ]
        [ "$(json b.json unclosed_edges)$(json b.json unoriented_edges)" = 00 ]
        [ "$(rows .node $kind.back | cut -d ' ' -f 2-4)" = \
            "$(rows .node $kind.tm | cut -d ' ' -f 2-4 | sed 's/e-0/e-/g')" ]
    done
    run -0 rows .group tetrahedra.back
    [ "$output" = "0 2 1 inlet_100%
1 2 2 _wall_
2 3 1 solid" ]
    # what has no name keeps its number
    [ "$(rows .facet tetrahedra.back | awk '{ print $NF }' | sort -n | uniq | tr '\n' ' ')" = \
        "-4 0 1 2 12 " ]
    [ "$(rows .cell tetrahedra.back | awk '{ print $NF }' | sort -n | uniq | tr '\n' ' ')" = "-3 1 " ]
}

@test "--elements: tetrahedra, or mixed elements, with the markers of the boundary" {
    local kind
    for kind in tetrahedra hexahedra mixed; do
        meshes $kind 3 >$kind.tm
        rm -rf mesh
        openfoam-export -q mesh $kind.tm
        openfoam-import --elements mesh >$kind.back
        # the elements, each of the same nodes as before, whichever comes first, and as large
        block=.mix
        [ $kind != tetrahedra ] || block=.ele
        diff <(rows $block $kind.back | sorted_nodes $block) \
            <(rows $block $kind.tm | sorted_nodes $block)
        jens-stats -q --json a.json $kind.tm >a.txt
        jens-stats -q --json b.json $kind.back >b.txt
        [ "$(json b.json negative)" = "$(json a.json negative)" ]
        rm -rf again
        openfoam-export -q again $kind.back
        for file in points owner neighbour boundary cellZones faceZones; do
            cmp mesh/$file again/$file
        done
    done
    dual >dual.tm
    rm -rf mesh
    openfoam-export -q mesh dual.tm
    run -0 --separate-stderr openfoam-import --elements -o out.tm mesh
    [[ "$stderr" == *"cells are no tetrahedra, pyramids, wedges or hexahedra: all stay polyhedra" ]]
    [ "$(header .cell out.tm)" = "$(header .cell dual.tm)" ]
}

# Elements as their nodes in order, and their region.
sorted_nodes() {
    python3 -c '
import sys
for line in sys.stdin:
    r = line.split()
    first, k = (1, 4) if sys.argv[1] == ".ele" else (2, int(r[1]))
    print(sorted(map(int, r[first:first + k])))' "$1"
}

@test "blockMesh's meshes: text and binary, packed and not, are the same stream" {
    need_openfoam blockMesh
    local format compression
    for format in ascii binary; do
        for compression in off on; do
            foam_case case $format $compression
            foam case/system/blockMeshDict "$block_mesh_dict"
            timeout 100 blockMesh -case case >log 2>&1
            run -0 --separate-stderr openfoam-import --no-history -o $format-$compression.tm case
            [ "$stderr" = \
                "openfoam-import: case: the types of 4 patches (wall, empty): left out" ]
            cmp ascii-off.tm $format-$compression.tm
        done
    done
    [ "$(rows .group ascii-off.tm)" = "0 2 1 movingWall
1 2 2 fixedWalls
2 2 3 frontAndBack
3 2 4 defaultFaces
4 3 1 fluid
5 3 2 solid" ]
    [ "$(header .cell ascii-off.tm)" = "24 2" ]
    [ "$(rows .cell ascii-off.tm | awk '{ print $NF }' | sort | uniq -c | tr -s ' ' | tr '\n' ';')" = \
        " 16 1; 8 2;" ]
    poly-stats -q --for fv --json stats.json ascii-off.tm
    python3 -c 'import json; s = json.load(open("stats.json"))
assert s["polyhedra"] == 24 and abs(s["volume"] / 2e-4 - 1) < 1e-12, s["volume"]'
    openfoam-import -q --no-history --elements case/constant/polyMesh >elements.tm
    [ "$(header .mix elements.tm)" = "24 1" ]
}

@test "what foamFormatConvert makes of a mesh with zones, and checkMesh of what comes back" {
    need_openfoam foamFormatConvert
    need_openfoam checkMesh
    meshes hexahedra >mesh.tm
    foam_case case
    openfoam-export -q case/constant/polyMesh mesh.tm
    openfoam-import -q --no-history case >text.tm
    for compression in off on; do
        foam_case converted binary $compression
        cp -R case/constant/polyMesh converted/constant
        timeout 100 foamFormatConvert -constant -case converted >log 2>&1
        grep -aq 'format *binary' <(cat converted/constant/polyMesh/points* | gzip -cdf)
        openfoam-import -q --no-history converted >binary.tm
        cmp text.tm binary.tm
    done
    foam_case back
    openfoam-export -q back/constant/polyMesh binary.tm
    timeout 100 checkMesh -case back -noZero >check.txt 2>&1 || true
    grep -Eq 'points: +64$' check.txt
    grep -Eq 'cells: +27$' check.txt
    grep -Eq 'faces: +108$' check.txt
    grep -Eq 'boundary patches: +4$' check.txt
    grep -q 'Mesh OK' check.txt
}

@test "foamToVTK's files of polyhedra are the same cells for vtu-import and vtk-import" {
    need_openfoam foamToVTK
    dual >dual.tm
    mesh-check -q --json right.json dual.tm
    foam_case case
    openfoam-export -q case/constant/polyMesh dual.tm
    timeout 100 foamToVTK -case case -constant -poly -name xml >log 2>&1
    timeout 100 foamToVTK -case case -constant -poly -name legacy -legacy >log 2>&1
    vtu-import -q case/xml/case_0/internal.vtu >xml.tm
    vtk-import -q case/legacy/case_0.vtk >legacy.tm
    for mesh in xml legacy; do
        mesh-check -q --json $mesh.json $mesh.tm
        for key in nodes elements boundary_faces; do
            [ "$(json $mesh.json $key)" = "$(json right.json $key)" ]
        done
        # points are 32-bit floats there
        python3 -c 'import json, sys
a, b = (json.load(open(f))["volume"] for f in sys.argv[1:])
assert abs(a / b - 1) < 1e-6, (a, b)' $mesh.json right.json
    done
}

# The files of a tetrahedron, by hand.
write_tetrahedron() {
    mkdir -p mesh
    head='FoamFile { version 2.0; format ascii; arch "LSB;label=32;scalar=64"; class C; meta { x 1; } }'
    printf '/* a comment\n */ %s // more\n4((0 0 0)(1 0 0) (0 1 0)\n(0 0 1))\n' "$head" >mesh/points
    printf '%s\n4\n(\n3(0 2 1)\n3(0 1 3)\n3(1 2 3)\n3(2 0 3)\n)\n' "$head" >mesh/faces
    printf '%s\n4{0}\n' "$head" >mesh/owner
    printf '%s\n0()\n' "$head" >mesh/neighbour
    printf '%s\n2(a { type patch; note "}"; inGroups 1(x); nFaces 1; startFace 0; }
"b.*" { type patch; nFaces 3; startFace 1; })\n' "$head" >mesh/boundary
}

@test "comments, heads, lists of one value, dictionaries, names in quotes" {
    write_tetrahedron
    run -0 --separate-stderr openfoam-import --no-history mesh
    [ "$stderr" = "" ]
    [ "$output" = "termesh 1
.node
4 3 0 0
0 0 0 0
1 1 0 0
2 0 1 0
3 0 0 1
.facet
4 1
0 0 -1 3 0 2 1 1
1 0 -1 3 0 1 3 2
2 0 -1 3 1 2 3 2
3 0 -1 3 2 0 3 2
.cell
1 0
0 4 0 1 2 3
.group
2 0
0 2 1 a
1 2 2 b.*
.end" ]
    # the same with faces as one list, and old files of neighbours
    printf 'FoamFile { class faceCompactList; }\n5(0 3 6 9 12)\n12(0 2 1 0 1 3 1 2 3 2 0 3)\n' >mesh/faces
    printf '4(-1 -1 -1 -1)\n' >mesh/neighbour
    [ "$(openfoam-import --no-history mesh)" = "$output" ]
}

@test "binary lists with labels of 64 bits, scalars of 32, and the other byte order" {
    write_tetrahedron
    openfoam-import --no-history mesh >text.tm
    for arch in 'LSB;label=64;scalar=32' 'MSB;label=64;scalar=64' 'MSB;label=32;scalar=32'; do
        python3 - "$arch" <<'END'
import struct, sys
arch = sys.argv[1]
order = '<' if 'LSB' in arch else '>'
label = order + ('q' if 'label=64' in arch else 'i')
scalar = order + ('d' if 'scalar=64' in arch else 'f')
def write(name, kind, *lists):
    with open('mesh/' + name, 'wb') as f:
        f.write(b'FoamFile { format binary; class %s; arch "%s"; }\n' % (kind.encode(), arch.encode()))
        for form, per, values in lists:
            f.write(b'%d\n' % (len(values) // per))
            if values:
                f.write(b'(' + b''.join(struct.pack(form, v) for v in values) + b')')
            f.write(b'\n')
write('points', 'vectorField', (scalar, 3, [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]))
write('faces', 'faceCompactList', (label, 1, [0, 3, 6, 9, 12]),
      (label, 1, [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]))
write('owner', 'labelList', (label, 1, [0] * 4))
write('neighbour', 'labelList', (label, 1, []))
END
        openfoam-import --no-history mesh | cmp - text.tm
    done
}

@test "zones: cells of two, faces of a patch, turned faces are said" {
    cells 2 >cells.tm
    rm -rf mesh
    openfoam-export -q mesh cells.tm
    cat >mesh/cellZones <<'END'
2
(
rotor { type cellZone; cellLabels List<label> 3(0 1 2); }
region_9 { type cellZone; cellLabels 2(2 3); }
)
END
    cat >mesh/faceZones <<'END'
1(cut { type faceZone; faceLabels List<label> 3(0 1 20); flipMap List<bool> 3(0 1 0); })
END
    run -0 --separate-stderr openfoam-import -o zones.tm mesh
    [[ "$stderr" == *"1 cells of zones that are in another one before: left out"* ]]
    [[ "$stderr" == *"1 faces of zones that have a patch or a zone before: left out"* ]]
    [[ "$stderr" == *"the turns of 1 faces of zones (flipMap): left out"* ]]
    [ "$(rows .cell zones.tm | awk '{ print $NF }' | tr '\n' ' ')" = "1 1 1 9 0 0 0 0 " ]
    rows .group zones.tm | grep -E '^[0-9]+ 3 1 rotor$'
    rows .group zones.tm | grep -E '^[0-9]+ 2 [0-9]+ cut$'
    run -3 --separate-stderr openfoam-import --strict mesh
    [ "$output" = "" ]
}

@test "zones of points are said to be left out, or refused with --strict" {
    cells 2 >cells.tm
    rm -rf mesh
    openfoam-export -q mesh cells.tm
    for none in '0()' 0 ''; do
        [ -n "$none" ] || none='0 ( )'
        printf 'FoamFile { version 2.0; class regIOobject; }\n%s\n' "$none" >mesh/pointZones
        openfoam-import --strict -o out.tm mesh
    done
    printf '2 ( a { type pointZone; pointLabels List<label> 1(0); }\nb { type pointZone; pointLabels 0(); } )' |
        gzip >mesh/pointZones.gz
    rm mesh/pointZones
    run -0 --separate-stderr openfoam-import -o out.tm mesh
    [[ "$stderr" == *"2 zones of points (pointZones): left out"* ]]
    run -3 --separate-stderr openfoam-import --strict mesh
    [ "$output" = "" ]
    echo zones | gzip >mesh/pointZones.gz
    run -3 --separate-stderr openfoam-import mesh
    [[ "$stderr" == "openfoam-import: mesh/pointZones.gz"* ]]
}

@test "wrong folders and files: which, where, what" {
    refuses() {
        run -3 --separate-stderr openfoam-import mesh
        [ "$output" = "" ] && [ "${#stderr_lines[@]}" -eq 1 ] && [[ "$stderr" == "openfoam-import: mesh$1"* ]] ||
            { echo "$stderr" && false; }
        write_tetrahedron
    }
    run -2 openfoam-import
    write_tetrahedron
    run -3 --separate-stderr openfoam-import mesh/points
    [[ "$stderr" == "openfoam-import: mesh/points: is no folder"* ]]
    rm mesh/owner
    refuses ": the file owner is missing"
    sed -i 's/(0 0 1)/(0 0 x)/' mesh/points
    refuses "/points:4: 'x' stands where coordinates should be"
    sed -i 's/(0 0 1))/(0 0 1)/' mesh/points
    refuses "/points:5: the file ends where ')' should be"
    sed -i 's/^4((/9((/' mesh/points
    refuses "/points:"
    sed -i 's/3(2 0 3)/3(2 0 4)/' mesh/faces
    refuses "/faces: face 3: point 4 is out of range (there are 4)"
    sed -i 's/3(2 0 3)/2(2 0)/' mesh/faces
    refuses "/faces: face 3 has 2 points (3 or more)"
    sed -i 's/4{0}/4{7}/' mesh/owner
    refuses "/owner: face 0: cell 7 is out of range (0 to 3)"
    sed -i 's/4{0}/4000000000{0}/' mesh/owner
    refuses "/owner:2: the size of a list is 4000000000 (0 to 4 would be right)"
    sed -i 's/4{0}/3(0 0 0)/' mesh/owner
    refuses "/owner: there are owners of 3 faces (of 4)"
    sed -i 's/4{0}/4(0 0 0 1)/' mesh/owner
    refuses "/owner: cell 0 has 3 faces (4 or more)"
    sed -i 's/0()/1(0)/' mesh/neighbour
    refuses "/neighbour: face 0 has not two cells"
    sed -i 's/startFace 1/startFace 2/' mesh/boundary
    refuses "/boundary: patch 'b.*' begins at face 2 (1 would be right)"
    sed -i 's/nFaces 3/nFaces 2/' mesh/boundary
    refuses "/boundary: the patches end at face 3 (4 would be right)"
    sed -i 's/type patch; note/#include "x"/' mesh/boundary
    refuses "/boundary:2: directives (#include and others) are not read"
    sed -i 's/note "}"/note "}/' mesh/boundary
    refuses "/boundary:"
    printf '1(z { type cellZone; cellLabels List<label> 1(5); })' >mesh/cellZones
    refuses "/cellZones:1: zone 'z': label 5 is out of range (below 1)"
}

# damage_folder: cuts each file of mesh/ at some places, and changes bytes of it.
damage_folder() {
    python3 - <<'END'
import os, random, resource, subprocess, sys
size = sum(os.path.getsize('mesh/' + f) for f in os.listdir('mesh'))
limit = None if '/san' in os.environ.get('TM_BUILD', '') else 20 * size + (64 << 20)
random.seed(size)
def bound():
    if limit:
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
def run(allowed, what):
    p = subprocess.run(['openfoam-import', '-q', '--no-history', 'mesh'], stdout=subprocess.PIPE,
                       stderr=subprocess.PIPE, timeout=20, preexec_fn=bound)
    if p.returncode not in allowed or p.returncode == 3 and (
            p.stdout or not p.stderr.startswith(b'openfoam-import: mesh') or
            p.stderr.count(b'\n') != 1):
        sys.exit('%s: exit %d, %r' % (what, p.returncode, p.stderr))
for name in sorted(os.listdir('mesh')):
    path = 'mesh/' + name
    data = open(path, 'rb').read()
    end = data.rindex(b')') # comments may follow
    for at in random.sample(range(end), min(30, end)):
        open(path, 'wb').write(data[:at])
        run([3], '%s cut at %d' % (name, at))
    for i in range(60):
        changed = bytearray(data)
        for _ in range(random.randint(1, 3)):
            at = random.randrange(len(data))
            changed[at] = random.choice(b'0123456789-(){};" \xff') if random.random() < .7 \
                else random.randrange(256)
        open(path, 'wb').write(changed)
        run([0, 3], '%s changed, %d' % (name, i))
    open(path, 'wb').write(data)
END
}

@test "damaged files are refused or read, with bounded memory" {
    meshes hexahedra 2 >cells.tm
    openfoam-export -q mesh cells.tm
    damage_folder
    if command -v foamFormatConvert >/dev/null && [ -r "$FOAM_ETC/controlDict" ]; then
        foam_case case binary
        cp -R mesh case/constant/polyMesh
        timeout 100 foamFormatConvert -constant -case case >log 2>&1
        rm -rf mesh
        mv case/constant/polyMesh mesh
        damage_folder
    fi
}
