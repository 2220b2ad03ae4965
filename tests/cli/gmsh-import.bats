# SPDX-License-Identifier: GPL-3.0-or-later
# gmsh-import: files of Gmsh, of all versions, of meshio, made by hand, and damaged ones.
# shellcheck disable=SC2154 # run sets stderr
# shellcheck disable=SC2016 # sections begin with a dollar sign

bats_require_minimum_version 1.5.0
load helpers
load gmsh

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    [ -x "$TM_BUILD/bin/gmsh-import" ] || skip "there is no libgmsh"
}

@test "what Gmsh writes, of all versions of .msh, text, binary, packed, with CR LF" {
    need_gmsh
    two_geo
    by_gmsh two.msh
    gmsh-import two.msh >two.tm
    run -0 mesh-check --json report.json two.tm
    [ "$(json report.json volume)" = 2.0 ] || [ "$(json report.json volume)" = 2 ]
    names two.tm | diff - <(printf '%s\n' '0 2 corner' '1 3 rim' '2 5 wall' '2 6 between' \
        '3 10 left half' '3 20 right' | sort)
    for version in msh1 msh2 msh40 msh4; do
        by_gmsh a.msh -format "$version"
        run -0 --separate-stderr gmsh-import -o a.tm a.msh
        [ "$stderr" = "" ]
        same_mesh a.tm two.tm
        [ "$version" = msh1 ] || diff <(blocks a.tm) <(blocks two.tm)
        sed 's/$/\r/' a.msh >crlf.msh
        gmsh-import crlf.msh >crlf.tm
        diff <(blocks crlf.tm) <(blocks a.tm)
        gzip -c a.msh | gmsh-import | diff <(blocks -) <(blocks a.tm)
        gmsh-import <a.msh | diff <(blocks -) <(blocks a.tm)
        printf '\357\273\277' | cat - a.msh >mark.msh
        gmsh-import mark.msh | diff <(blocks -) <(blocks a.tm)
        case $version in msh2 | msh4) ;; *) continue ;; esac
        by_gmsh b.msh -format "$version" -bin
        gmsh-import b.msh >b.tm
        same_mesh b.tm two.tm 1e-12
        names b.tm | diff - <(names two.tm)
    done
}

@test "partitions, with their ghosts and the elements between them" {
    need_gmsh
    two_geo
    by_gmsh two.msh
    gmsh-import two.msh >two.tm
    for version in msh2 msh4; do
        by_gmsh parts.msh -format "$version" -part 3 -part_ghosts
        grep -q 'PartitionedEntities\|^[0-9]* 4 [4-9]' parts.msh
        run -0 --separate-stderr gmsh-import -o parts.tm parts.msh
        same_mesh parts.tm two.tm
    done
}

# Sections as of another program, in the way of all readers.
others() {
    printf '%s\n' '$Comments' 'by hand, $Nodes are below' '$EndComments' '$Mine' '1 2 3' \
        'Elements 7' '$EndMine'
}

# A pyramid of four tetrahedra that share the node 70, in two volumes; one triangle, one
# line; a node 99 that nothing has.
nodes_by_hand='50 0 0 0
10 1 0 0
30 1 1 0
20 0 1 0
70 0.5 0.5 1
40 0.5 0.5 0'

by_hand() {
    case $1 in
    1)
        printf '$NOD\n6\n%s\n$ENDNOD\n$ELM\n6\n' "$nodes_by_hand"
        printf '%s\n' '105 1 3 1 2 50 10' '101 4 7 2 4 50 10 40 70' '102 4 7 2 4 10 30 40 70' \
            '103 4 8 3 4 30 20 40 70' '104 4 8 3 4 20 50 40 70' '90 2 5 1 3 50 70 10' '$ENDELM'
        ;;
    2)
        printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n'
        others
        printf '$PhysicalNames\n3\n3 7 "steel"\n2 5 "wall"\n3 8 "air gap"\n$EndPhysicalNames\n'
        printf '$Nodes\n6\n%s\n$EndNodes\n$Elements\n6\n' "$nodes_by_hand"
        printf '%s\n' '105 1 2 3 1 50 10' '101 4 4 7 2 1 1 50 10 40 70' \
            '102 4 4 7 2 1 2 10 30 40 70' '103 4 2 8 3 30 20 40 70' '104 4 2 8 3 20 50 40 70' \
            '90 2 2 5 1 50 70 10' '$EndElements' '$Periodic' 1 '0 1 2' 1 '10 20' '$EndPeriodic' \
            '$NodeData' 1 '"u"' 1 0.0 3 0 1 1 '10 1.5' '$EndNodeData'
        ;;
    4.0)
        printf '$MeshFormat\n4.0 0 8\n$EndMeshFormat\n'
        others
        printf '$PhysicalNames\n3\n3 7 "steel"\n2 5 "wall"\n3 8 "air gap"\n$EndPhysicalNames\n'
        printf '$Entities\n0 1 1 2\n1 0 0 0 1 0 0 1 3 0\n1 0 0 0 1 1 1 1 5 0\n'
        printf '2 0 0 0 1 1 1 1 7 0\n3 0 0 0 1 1 1 1 8 0\n$EndEntities\n'
        printf '$Nodes\n1 6\n2 3 0 6\n%s\n$EndNodes\n$Elements\n4 6\n' "$nodes_by_hand"
        printf '%s\n' '1 1 1 1' '105 50 10' '3 3 4 2' '103 30 20 40 70' '104 20 50 40 70' \
            '2 3 4 2' '101 50 10 40 70' '102 10 30 40 70' '1 2 2 1' '90 50 70 10' '$EndElements'
        others
        ;;
    4.1)
        printf '$MeshFormat\n4.1 0 8\n$EndMeshFormat\n'
        others
        printf '$PhysicalNames\n3\n3 7 "steel"\n2 5 "wall"\n3 8 "air gap"\n$EndPhysicalNames\n'
        printf '$Entities\n0 1 1 2\n1 0 0 0 1 0 0 1 3 0\n1 0 0 0 1 1 1 1 5 0\n'
        printf '2 0 0 0 1 1 1 1 7 0\n3 0 0 0 1 1 1 1 8 0\n$EndEntities\n'
        printf '$Nodes\n1 6 10 70\n3 2 0 6\n'
        cut -d ' ' -f 1 <<<"$nodes_by_hand"
        cut -d ' ' -f 2- <<<"$nodes_by_hand"
        printf '$EndNodes\n$Elements\n4 6 90 105\n'
        printf '%s\n' '1 1 1 1' '105 50 10' '3 3 4 2' '103 30 20 40 70' '104 20 50 40 70' \
            '3 2 4 2' '101 50 10 40 70' '102 10 30 40 70' '2 1 2 1' '90 50 70 10' '$EndElements' \
            '$Periodic' 1 '1 1 1' '0' 1 '10 20' '$EndPeriodic'
        others
        ;;
    esac
}

@test "files by hand of each version: gaps, no order, comments, sections of others, CR LF" {
    cat >right.tm <<'END'
termesh 1
.node
6 3 0 0
1 1 0 0
2 0 1 0
3 1 1 0
4 0.5 0.5 0
5 0 0 0
6 0.5 0.5 1
.ele
4 4 1
1 5 1 4 6 7
2 1 3 4 6 7
3 3 2 4 6 8
4 2 5 4 6 8
.face
1 1
1 5 6 1 5
.edge
1 1
1 5 1 3
.group
3 0
1 2 5 wall
2 3 7 steel
3 3 8 air gap
.end
END
    for version in 1 2 4.0 4.1; do
        by_hand "$version" >hand.msh
        run -0 --separate-stderr gmsh-import --no-history -o hand.tm hand.msh
        [ "$stderr" = "" ] || { echo "$version: $stderr" && false; }
        if [ "$version" = 1 ]; then
            sed '/^.group/,$d' right.tm | diff hand.tm <(cat - <(echo .end))
        else
            diff hand.tm right.tm
        fi
        by_hand "$version" | sed 's/$/\r/' >hand.msh
        gmsh-import --no-history hand.msh | diff - hand.tm
    done
}

# tets PHYSICAL-ENTITY… : .msh 2.2, tetrahedra in a row with these tags.
tets() {
    printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 "steel"\n3 2 "all"\n'
    printf '$EndPhysicalNames\n$Nodes\n%d\n' $(($# + 3))
    printf '1 0 0 0\n2 1 0 0\n3 0 1 0\n'
    local n=0
    for tags; do n=$((n + 1)) && echo "$((n + 3)) 0 0 $n"; done
    printf '$EndNodes\n$Elements\n%d\n' $#
    n=0
    for tags; do n=$((n + 1)) && echo "$n 4 2 ${tags/-/ } 1 2 3 $((n + 3))"; done
    echo '$EndElements'
}

regions() {
    rows .ele "$1" | awk 'NF == 6 { printf "%s ", $6 }'
}

@test "several groups of one element: a value for each combination, named by them" {
    need_gmsh
    two_geo
    sed -i '/left half/d; /right/d' two.geo
    printf 'Physical Volume("steel", 1) = {1};\nPhysical Volume("all", 2) = {1, 2};\n' >>two.geo
    printf 'Physical Volume(9) = {2};\n' >>two.geo
    for version in msh2 msh4; do
        by_gmsh a.msh -format "$version"
        run -0 --separate-stderr gmsh-import -o a.tm a.msh
        [[ "$stderr" == *': there are elements of several physical groups: 2 markers and regions stand for more than one (see .group)' ]]
        names a.tm | grep '^3' | diff - <(printf '%s\n' '3 1 steel' '3 10 steel + all' \
            '3 11 all + 9' '3 2 all' | sort)
        run -0 mesh-check a.tm # each cell once
        gmsh-export --format "$version" b.msh a.tm
        diff <(gmsh_sees a.msh groups) <(gmsh_sees b.msh groups | sed 's/$//') ||
            diff <(gmsh_sees a.msh 'sorted((k, v[0], round(v[1], 9)) for k, v in groups.items() if k[0] == 3)') \
                <(gmsh_sees b.msh 'sorted((k, v[0], round(v[1], 9)) for k, v in groups.items() if k[0] == 3)')
    done
}

@test "files of version 2 in which each element says its own group, whatever its entity" {
    tets 1-1 2-1 1-1 2-1 >shared.msh
    run -0 --separate-stderr gmsh-import -o shared.tm shared.msh
    [ "$stderr" = "" ]
    [ "$(regions shared.tm)" = '1 2 1 2 ' ]
    tets 1-1 2-2 0-7 0-2 1-2 >some.msh # the entity 2 has a group of its number
    run -0 --separate-stderr gmsh-import -o some.tm some.msh
    [[ "$(regions some.tm)" =~ ^'1 2 7 '[0-9]+' 1 '$ ]] || { regions some.tm && false; }
    tets 0-4 0-3 0-4 >none.msh
    gmsh-import none.msh >none.tm
    [ "$(regions none.tm)" = '4 3 4 ' ]
    tets 1-0 2-0 0-0 >zero.msh
    gmsh-import zero.msh >zero.tm
    [ "$(regions zero.tm)" = '1 2 0 ' ]
}

@test "elements of second order: their corners, and no other node" {
    need_gmsh
    two_geo
    by_gmsh one.msh
    gmsh-import one.msh >one.tm
    by_gmsh two.msh -order 2
    run -0 --separate-stderr gmsh-import -o two.tm two.msh
    [[ "$stderr" == "gmsh-import: two.msh: "*" elements' nodes between their corners: left out" ]]
    run -3 --separate-stderr gmsh-import --strict two.msh
    [ "$(header .ele two.tm)" = "$(header .ele one.tm)" ]
    run -0 mesh-check --json report.json two.tm
    [ "$(json report.json unused_nodes)" = 0 ]
}

@test "prisms, pyramids and hexahedra, with faces between and around them; turned ones" {
    cat >solids.msh <<'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
12
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
9 0.5 0.5 2
10 2 0 0
11 2 0 1
12 1 0.5 2
$EndNodes
$Elements
7
1 3 2 50 1 1 2 3 4
2 3 2 60 2 6 2 3 7
3 2 2 70 3 6 7 9
11 5 2 1 1 1 2 3 4 5 6 7 8
12 7 2 1 1 5 6 7 8 9
13 6 2 2 2 2 10 3 6 11 7
14 4 2 3 3 6 7 9 12
$EndElements
END
    run -0 --separate-stderr gmsh-import -o solids.tm solids.msh
    [ "$stderr" = "" ]
    mixed | sed '/^\.end/,$d' >right.tm
    diff <(rows .mix solids.tm | sed '/^\./,$d') <(rows .mix right.tm) ||
        [ "$(rows .mix solids.tm | sed '/^\./,$d' | awk '{ print $NF }' | tr '\n' ' ')" = '1 1 2 3 ' ]
    rows .facet solids.tm | sed '/^\./,$d' | awk '{ print $2, $3, $4, $NF }' |
        diff - <(printf '%s\n' '1 -1 4 50' '1 3 4 60' '2 4 3 70')
    run -0 mesh-check solids.tm
    [[ "$output" == *'nothing is wrong'* ]]
    # all of them mirrored
    sed 's/^11 5 .*/11 5 2 1 1 5 6 7 8 1 2 3 4/; s/^12 7 .*/12 7 2 1 1 5 8 7 6 9/
        s/^13 6 .*/13 6 2 2 2 6 11 7 2 10 3/; s/^14 4 .*/14 4 2 3 3 7 6 9 12/' \
        solids.msh >mirrored.msh
    run -0 --separate-stderr gmsh-import -o mirrored.tm mirrored.msh
    [ "$stderr" = 'gmsh-import: mirrored.msh: 4 of 4 cells were left-handed and are turned' ]
    run -0 mesh-check --json a.json solids.tm
    run -0 mesh-check --json b.json mirrored.tm
    [ "$(json a.json volume)" = "$(json b.json volume)" ]
    [ "$(json b.json inverted)" = 0 ]
    # a face that no cell has
    sed 's/^3 2 2 70 3 6 7 9/3 2 2 70 3 1 7 9/' solids.msh >loose.msh
    run -0 --separate-stderr gmsh-import -o loose.tm loose.msh
    [ "$stderr" = 'gmsh-import: loose.msh: 1 faces that no cell has: left out' ]
    run -3 gmsh-import --strict loose.msh
}

@test "surfaces, quadrilaterals, lines and points alone" {
    sed '/^1[1-4] /d; s/^7$/3/' <<'END' >quads.msh
$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 0 0 0
2 1 0 0
3 2 1 0
4 0 1 0
5 3 0 0
6 3 1 0
$EndNodes
$Elements
3
1 3 2 50 1 1 2 3 4
2 2 2 60 2 2 5 3
3 1 2 8 3 1 2
$EndElements
END
    run -0 --separate-stderr gmsh-import -o quads.tm quads.msh
    [ "$stderr" = 'gmsh-import: quads.msh: 1 quadrilaterals are two triangles each now' ]
    rows .face quads.tm | sed '/^\./,$d' |
        diff - <(printf '%s\n' '1 1 2 4 50' '2 2 3 4 50' '3 2 5 3 60')
    [ "$(header .edge quads.tm)" = '1 1' ]
    sed '/^[1-3] [1-3] 2/d; s/^3$/2/; s/^\$EndElements/1 15 2 4 4 1\n2 15 2 5 5 6\n&/' quads.msh >points.msh
    gmsh-import points.msh >points.tm
    rows .node points.tm | awk 'NF == 5 { printf "%s ", $5 }' | grep -qx '4 5 '
}

@test "Medit, VTK, Nastran, STL, PLY2 and UNV as Gmsh writes them" {
    need_gmsh
    two_geo
    by_gmsh two.msh
    gmsh-import two.msh >two.tm
    for suffix in mesh vtk bdf nas; do
        by_gmsh "two.$suffix" -save_all
        gmsh-import "two.$suffix" >a.tm
        [ "$(header .ele a.tm)" = "$(header .ele two.tm)" ]
        run -0 mesh-check --json report.json a.tm
        [ "$(json report.json volume | cut -c 1-5)" = 2.0 ] || [ "$(json report.json volume)" = 2 ] ||
            [[ "$(json report.json volume)" == 1.99999* ]] || [[ "$(json report.json volume)" == 2.00000* ]]
    done
    sed -i '/Point/d' two.geo
    by_gmsh two.unv
    gmsh-import two.unv >a.tm
    by_gmsh two.msh
    gmsh-import two.msh >two.tm
    same_mesh a.tm two.tm 1e-12
    names a.tm | grep -q '3 10 left_half'
    for suffix in stl ply2; do
        by_gmsh "two.$suffix"
        gmsh-import "two.$suffix" >a.tm
        [[ "$(header .face a.tm)" =~ ^[1-9][0-9]+\ 1$ ]]
    done
}

@test "what meshio writes" {
    need_meshio
    "$vtk_python" - <<'END'
import meshio, numpy
points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.]]) / 3
cells = [('triangle', [[0, 1, 3], [0, 2, 1]]), ('tetra', [[0, 1, 2, 3], [1, 2, 3, 4]])]
data = {'gmsh:physical': [numpy.array([3, 4]), numpy.array([1, 2])],
        'gmsh:geometrical': [numpy.array([3, 4]), numpy.array([1, 2])]}
names = {'steel': numpy.array([1, 3]), 'air': numpy.array([2, 3]), 'wall': numpy.array([3, 2])}
for file, format, binary in (('a.msh', 'gmsh22', False), ('b.msh', 'gmsh22', True),
                             ('c.mesh', 'medit', None)):
    mesh = meshio.Mesh(points, cells, field_data=names,
                       cell_data=data if 'gmsh' in format else
                       {'medit:ref': data['gmsh:physical']} if format == 'medit' else {})
    mesh.write(file, file_format=format, **({} if binary is None else {'binary': binary}))
END
    for file in a.msh b.msh c.mesh; do
        run -0 --separate-stderr gmsh-import -o a.tm "$file"
        [ "$(regions a.tm)" = '1 2 ' ] || { cat a.tm && false; }
        rows .face a.tm | sed '/^\./,$d' | awk '{ printf "%s ", $5 }' | grep -qx '3 4 '
        case $file in *.msh) names a.tm | grep -q '3 1 steel' ;; esac
    done
}

@test "a script with the name of a mesh is not run, nor options beside the file" {
    echo 'SystemCall "touch ran"; Point(1) = {0, 0, 0, 1};' >script.msh
    cp script.msh script.mesh
    for file in script.msh script.mesh; do
        run -3 --separate-stderr gmsh-import "$file"
        [ "${#stderr_lines[@]}" -eq 1 ]
        run -3 gmsh-import "--format=${file#*.}" script.msh
    done
    tets 1-1 >a.msh
    cp script.msh a.msh.opt
    gmsh-import a.msh >a.tm
    [ ! -e ran ]
}

@test "where another filter is right, or the format is not told, that is said" {
    surface cube off >cube.msh
    run -3 --separate-stderr gmsh-import cube.msh
    [[ "$stderr" == 'gmsh-import: cube.msh: does not begin as a .msh file'*'looks like an OFF surface: use '* ]]
    run -3 --separate-stderr gmsh-import <(echo nothing)
    [[ "$stderr" == *'neither its name nor its first bytes say that it is a mesh that Gmsh reads (--format says it)' ]]
    printf '\1\0\0\0\3\0\0\0' >a.meshb
    run -3 --separate-stderr gmsh-import a.meshb
    [[ "$stderr" == 'gmsh-import: a.meshb: is a binary file of Medit (.meshb), which Gmsh does not read'* ]]
    run -2 gmsh-import --format geo a.meshb
}

@test "cut anywhere: exit 3; nothing is left in TMPDIR" {
    mkdir t
    export TMPDIR=$PWD/t
    tets 1-1 2-2 1-3 >a.msh
    size=$(wc -c <a.msh)
    for cut in $(seq 8 7 $((size - 3))); do
        head -c "$cut" a.msh >cut.msh
        run -3 --separate-stderr gmsh-import cut.msh
        [[ "$stderr" == 'gmsh-import: cut.msh: '* ]] && [ "${#stderr_lines[@]}" -eq 1 ] &&
            [[ "$stderr" != *"$TMPDIR"* ]]
    done
    [ -z "$(ls t)" ]
}

# The billion is claimed in a file of less than 1 kB.
@test "counts of a billion: exit 3" {
    case ${TM_BUILD:?} in */san) skip "memory has no limit under the sanitizers" ;; esac
    n=1000000000
    head='$MeshFormat\n4.1 0 8\n$EndMeshFormat\n'
    old='$MeshFormat\n2.2 0 8\n$EndMeshFormat\n'
    printf "$head\$Nodes\n1 $n 1 $n\n3 1 0 $n\n1\n\$EndNodes\n" >a.msh
    printf "$head\$Entities\n$n $n $n $n\n\$EndEntities\n" >b.msh
    printf "$head\$Nodes\n1 1 1 1\n3 1 0 1\n1\n0 0 0\n\$EndNodes\n\$Elements\n1 $n 1 $n\n3 1 4 $n\n1 1 1 1 1\n\$EndElements\n" >c.msh
    printf "$old\$Nodes\n$n\n1 0 0 0\n\$EndNodes\n" >d.msh
    printf "$old\$Nodes\n1\n1 0 0 0\n\$EndNodes\n\$Elements\n$n\n1 15 2 1 1 1\n\$EndElements\n" >e.msh
    printf "MeshVersionFormatted 2\nDimension\n3\nVertices\n$n\n0 0 0 1\nEnd\n" >f.mesh
    printf "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS $n double\n0\n" >g.vtk
    for file in ?.msh f.mesh g.vtk; do
        run -3 --separate-stderr gmsh-import "$file"
        [ "${#stderr_lines[@]}" -eq 1 ]
    done
}

@test "damaged files: exit 0 or 3, and what is read is a stream" {
    need_gmsh
    two_geo
    sed -i 's/0.6/1/' two.geo
    by_gmsh a.msh
    by_gmsh b.msh -bin
    by_gmsh c.msh -format msh2
    by_gmsh d.msh -format msh2 -bin
    by_gmsh e.msh -format msh40
    by_gmsh f.mesh -save_all
    by_gmsh g.unv
    by_gmsh h.bdf
    by_gmsh i.vtk
    for file in ?.*; do
        for n in $(seq 12); do
            python3 - "$file" "$n" <<'END'
import random, sys
random.seed(sys.argv[1] + sys.argv[2])
data = bytearray(open(sys.argv[1], 'rb').read())
if int(sys.argv[2]) % 3 == 0:
    at = random.randrange(len(data))
    del data[at:at + random.randrange(1, 300)]
else:
    for _ in range(random.randrange(1, 4)):
        data[random.randrange(20, len(data))] = random.choice(b'0123456789-\n \xff')
open('wrong.' + sys.argv[1][2:], 'wb').write(data)
END
            status=0
            gmsh-import -o wrong.tm "wrong.${file#*.}" 2>message || status=$?
            case $status in
            0) mesh-check -q wrong.tm >out 2>message || [ $? -eq 1 ] || grep -q 'but mesh-check takes\|' message ;;
            3) [ "$(grep -c "^gmsh-import: wrong.${file#*.}: " message)" -ge 1 ] ;;
            *) cat message && false ;;
            esac
        done
    done
}

@test "where Gmsh has no memory for a kind of elements they are not left out" {
    case ${TM_BUILD:?} in */san*) skip "the sanitizers have an allocator of their own" ;; esac
    printf '%s\n' '$MeshFormat' '2.2 0 8' '$EndMeshFormat' '$Nodes' 4 '1 0 0 0' '2 1 0 0' \
        '3 0 1 0' '4 0 0 1' '$EndNodes' '$Elements' 1 '1 4 2 7 1 1 2 3 4' '$EndElements' >one.msh
    with_fault() {
        head -c 72 /dev/zero >count
        TM_FAULTS_COUNT=count TM_FAULTS=$1 LD_PRELOAD=$TM_BUILD/faults/preload.so \
            gmsh-import one.msh >out.tm 2>message
    }
    with_fault 'none 0 0'
    mv out.tm one.tm
    calls=$(od -An -t u8 -N 8 count)
    for ((call = calls - 99; call <= calls; call++)); do
        status=0
        with_fault "memory $call $call" || status=$?
        case $status in
        0) diff out.tm one.tm ;;
        3 | 4) [ "$(tail -n 1 out.tm)" != .end ] ;;
        *) return 1 ;;
        esac
    done
}
