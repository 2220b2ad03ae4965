# SPDX-License-Identifier: GPL-3.0-or-later
# Names of markers and regions, from the surface to the solver.
# shellcheck disable=SC2016,SC2154 # $ of names and of sed; run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    channel >channel.stl
}

# A channel of 3 x 1 x 1 as text STL in three solids, each side in 2 x 2 squares; as OBJ
# with `channel obj`, whose groups are set by the words that follow.
channel() {
    python3 - "$@" <<'END'
import sys
def side(o, u, v, n=2):
    def at(i, j):
        return tuple(o[k] + u[k] * i / n + v[k] * j / n for k in range(3))
    for i in range(n):
        for j in range(n):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            yield from ((a, b, c), (a, c, d))
parts = {'inlet port': [side((0, 0, 0), (0, 0, 1), (0, 1, 0))],
         'outlet': [side((3, 0, 0), (0, 1, 0), (0, 0, 1))],
         'wall': [side((0, 0, 0), (0, 1, 0), (3, 0, 0)), side((0, 0, 1), (3, 0, 0), (0, 1, 0)),
                  side((0, 0, 0), (3, 0, 0), (0, 0, 1)), side((0, 1, 0), (0, 0, 1), (3, 0, 0))]}
nodes = {}
for name, sides in parts.items():
    if len(sys.argv) == 1:
        print('solid', name)
    else:
        print(sys.argv[2].replace('{}', name).replace('|', '\n'))
    for t in (t for s in sides for t in s):
        if len(sys.argv) == 1:
            print('facet normal 0 0 0\nouter loop')
            for p in t:
                print('vertex %g %g %g' % p)
            print('endloop\nendfacet')
        else:
            for p in t:
                if p not in nodes:
                    nodes[p] = len(nodes) + 1
                    print('v %g %g %g' % p)
            print('f', *(nodes[p] for p in t))
    if len(sys.argv) == 1:
        print('endsolid', name)
END
}

# The names and areas of the patches in a polyMesh folder.
patches() {
    python3 - "$1" <<'END'
import re, sys
def items(name):
    return open(sys.argv[1] + '/' + name).read().split('\n(\n', 1)[1]
points = [tuple(map(float, p.split())) for p in re.findall(r'\(([-0-9.e+ ]+)\)', items('points'))]
faces = [list(map(int, f.split())) for f in re.findall(r'\d\(([\d ]+)\)', items('faces'))]
def area(f):
    s = [0, 0, 0]
    for i in range(1, len(f) - 1):
        a, b = ([points[f[j]][k] - points[f[0]][k] for k in range(3)] for j in (i, i + 1))
        s = [s[k] + a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3] for k in range(3)]
    return sum(c * c for c in s) ** .5 / 2
for name, n, first in re.findall(r'(\S+)\n    {\n +type +patch;\n +nFaces +(\d+);\n +startFace +(\d+);', items('boundary')):
    print(name, '%.12g' % sum(area(f) for f in faces[int(first):int(first) + int(n)]))
END
}

groups() {
    sed -n '/^\.group/,/^\.[^g]/p' "$@" | sed '1,2d; $d'
}

expected_groups() {
    printf '%s\n' '1 2 1 inlet port' '2 2 2 outlet' '3 2 3 wall'
}

areas() {
    printf '%s\n' 'inlet_port 1' 'outlet 1' 'wall 12'
}

@test "three solids are three patches with their names and areas: tetrahedra, polyhedra" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    tetgen-mesh -q channel.stl | lepp-improve -q >tets.tm
    polylla3d -q --star tets.tm >cells.tm
    for mesh in tets cells; do
        run -0 groups $mesh.tm
        [ "$output" = "$(expected_groups)" ]
        openfoam-export "$mesh" $mesh.tm
        patches "$mesh" | diff - <(areas)
    done
}

@test "and of an octree mesh, repaired or not" {
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "there is no p4est"
    octree-mesh -s 4 channel.stl >octree.tm
    octree-repair -q -t 0.2 octree.tm >repaired.tm
    for mesh in octree repaired; do
        run -0 groups $mesh.tm
        [ "$output" = "$(expected_groups)" ]
        openfoam-export "$mesh" $mesh.tm
        patches "$mesh" | diff - <(areas)
    done
    # the surface that comes along has the names, too
    octree-mesh -s 3 repaired.tm >again.tm
    run -0 groups again.tm
    [ "$output" = "$(expected_groups)" ]
}

@test "where two groups meet on a flat or a round side, the mesh has an edge" {
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "there is no p4est"
    # a square of the wall is a window of its own
    awk '/^solid wall/ { wall = 1 } /^facet/ && wall && n++ < 2 { window = window $0 "\n"; w = 1; next }
        w { window = window $0 "\n"; w = !/^endfacet/; next } { print }
        END { printf "solid window\n%sendsolid\n", window }' channel.stl >window.stl
    octree-mesh -s 5 window.stl | octree-repair -q >window.tm
    openfoam-export window window.tm
    patches window | diff - <(printf '%s\n' 'inlet_port 1' 'outlet 1' 'wall 11.25' 'window 0.75')
}

# A cube whose top is two triangles, of two groups: cube NAME NAME [CORNER].
cube() {
    printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv %s\nv 0 1 1\n' "${3:-1 1 1}"
    printf 'g %s\nf 5 6 7\ng %s\nf 5 7 8\n' "$1" "$2"
    printf 'f %s\n' '1 4 3 2' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8'
}

@test "a group that ends across the grid has its area, facet by facet" {
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "there is no p4est"
    for level in 1 2 3 4; do
        rm -rf mesh
        cube half rest | octree-mesh -q -a $level | openfoam-export mesh -
        patches mesh | diff - <(printf '%s\n' 'half 0.5' 'rest 5.5')
    done
}

@test "names stay where octree-repair splits octants" {
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "there is no p4est"
    cube half rest '1.5 1.3 1.1' | octree-mesh -q -a 2 >mesh.tm
    for options in '--method refine -t 0.3 -i 1' '-t 0.3'; do
        # shellcheck disable=SC2086 # words
        octree-repair -q --strict $options mesh.tm >repaired.tm || [ $? -eq 1 ]
        run -0 groups repaired.tm
        [ "$output" = "$(printf '%s\n' '1 2 1 half' '2 2 2 rest')" ]
    done
}

@test "a name that OpenFOAM takes for a number, or for too long, is made a word" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    for name in 1in 2 3e5 .5 -1 +3 - .. 0x10; do
        rm -rf mesh
        cube "$name" rest | tetgen-mesh | openfoam-export --strict mesh -
        grep -qx "    _[^ ]*" mesh/boundary
    done
    rm -rf mesh
    cube "$(printf '%1100s' '' | tr ' ' x)" "$(printf '%1101s' '' | tr ' ' x)" |
        tetgen-mesh | openfoam-export mesh -
    [ "$(grep -o 'x\{900,\}[_0-9]*' mesh/boundary | sort -u | wc -l)" -eq 2 ]
    run -1 grep '.\{1030\}' mesh/boundary
}

@test "regions below 0 are regions; what a mesher has no place for it says, or refuses" {
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' \
        .ele '1 4 1' '1 1 2 3 4 -7' .group '1 0' '1 3 -7 steel' .end >below.tm
    run -0 --separate-stderr openfoam-export --strict mesh below.tm
    [ -z "$stderr" ]
    grep -qx '    steel' mesh/cellZones
    run -3 --separate-stderr getfem-export --strict below.tm
    [[ "$stderr" == *'1 regions of cells below 0'* ]]
    run -0 getfem-export -q below.tm
    [[ "$output" != *REGION* ]]
    printf '%s\n' '4 3 1 1' '1 0 0 0 1.5 8' '2 1 0 0 1.5 8' '3 0 1 0 1.5 8' '4 0 0 1 1.5 8' \
        '4 1' '3 1 3 2 1' '3 1 2 4 2' '3 2 3 4 3' '3 1 4 3 4' 0 1 '1 .1 .1 .1 7 -1' >all.smesh
    command -v tetgen >/dev/null || skip "there is no tetgen"
    run -3 --separate-stderr tetgen-mesh --strict all.smesh
    [[ "$stderr" == *'1 regions, which --regions would keep'* ]]
    run -0 tetgen-mesh --quiet --strict --regions all.smesh
    run -0 tetgen-mesh --quiet --strict --switches A all.smesh
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "there is no p4est"
    run -3 octree-mesh --strict -a 2 all.smesh
    run -0 --separate-stderr octree-mesh -a 2 all.smesh
    [[ "$stderr" == *'1 attributes of'*'4 markers of'* ]]
    [ "$(rows .mix /dev/stdin <<<"$output" | awk '{ print $NF }' | sort -u)" = 7 ]
}

@test "groups of OBJ: o, g and usemtl, those that tell faces apart" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    for words in 'g {}' 'o {}' 'usemtl {}' 'o part|g {}|usemtl steel' 'usemtl steel|o {}'; do
        channel obj "$words" >channel.obj
        tetgen-mesh channel.obj >mesh.tm
        run -0 groups mesh.tm
        [ "$output" = "$(expected_groups)" ]
    done
    channel obj 'o x|g {}|usemtl of {}' >channel.obj
    tetgen-mesh channel.obj >mesh.tm
    run -0 groups mesh.tm
    [ "${lines[0]}" = '1 2 1 inlet port/of inlet port' ]
    channel obj 'o all' >channel.obj
    tetgen-mesh channel.obj >mesh.tm
    run -0 groups mesh.tm
    [ "$output" = '1 2 1 all' ]
    channel obj '# none' >channel.obj
    tetgen-mesh channel.obj >mesh.tm
    run -1 grep '^.group' mesh.tm
}

@test "solids without a name have markers, of one name one, odd bytes are made a name" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    sed 's/solid outlet/solid/' channel.stl >nameless.stl
    tetgen-mesh nameless.stl >mesh.tm
    run -0 groups mesh.tm
    [ "$output" = "$(printf '%s\n' '1 2 1 inlet port' '2 2 3 wall')" ]
    rm -rf mesh && openfoam-export mesh mesh.tm
    patches mesh | diff - <(printf '%s\n' 'inlet_port 1' 'marker_2 1' 'wall 12')
    sed 's/solid outlet/solid wall/' channel.stl >same.stl
    tetgen-mesh same.stl >mesh.tm
    run -0 groups mesh.tm
    [ "$output" = "$(printf '%s\n' '1 2 1 inlet port' '2 2 2 wall')" ]
    # a control character, Latin-1, UTF-8, and what OpenFOAM's words cannot have
    sed "s/solid inlet port/solid a$(printf '\001')b/; s/solid outlet/solid gr$(printf '\374')n/
        s/solid wall/solid größe; {x} \"\$y\"/" channel.stl >odd.stl
    tetgen-mesh odd.stl >mesh.tm
    run -0 groups mesh.tm
    [ "$output" = "$(printf '%s\n' '1 2 1 a\x01b' '2 2 2 grün' '3 2 3 größe; {x} "$y"')" ]
    rm -rf mesh && openfoam-export mesh mesh.tm
    patches mesh | diff - <(printf '%s\n' 'a_x01b 1' 'grün 1' 'größe___x____y_ 12')
    sed 's/solid outlet/solid inlet_port/' channel.stl | tetgen-mesh >mesh.tm
    rm -rf mesh && openfoam-export mesh mesh.tm
    patches mesh | diff - <(printf '%s\n' 'inlet_port 1' 'inlet_port_2 1' 'wall 12')
}

@test "regions are zones of cells, marked faces inside zones of faces, with their names" {
    cubes | sed 's/^\(6 1 2 .*\) 0$/\1 7/; s/^\.end$/.group\n3 0\n1 3 2 steel\n2 2 7 inter face\n3 2 5 end\n.end/' |
        sed '/^\.cell/,/^\.group/{s/^2 1$/2 2/; s/^\([12] 6 .*\) \([12]\)$/\1 1 \2/}' >zones.tm
    openfoam-export --json report zones zones.tm
    [ "$(cat report)" = '{"points": 12, "faces": 11, "cells": 2, "patches": 5, '\
'"cell_zones": 2, "face_zones": 1}' ]
    grep -qx '    end' zones/boundary
    tr -s ' \n' ' ' <zones/cellZones | grep -q \
        '2 ( region_1 { type cellZone; cellLabels List<label> 1 ( 0 ) ; } steel { type cellZone; cellLabels List<label> 1 ( 1 ) ; } )'
    tr -s ' \n' ' ' <zones/faceZones | grep -q \
        '1 ( inter_face { type faceZone; faceLabels List<label> 1 ( 0 ) ; flipMap List<bool> 1 ( 0 ) ; } )'
    # zones of another mesh do not stay beside one that has none
    cubes | sed '/^\.cell/,${s/^2 1$/2 0/; s/^\([12] 6 .*\) [12]$/\1/}' >cubes.tm
    openfoam-export zones cubes.tm
    [ "$(tail -n 3 zones/cellZones | tr '\n' ' ')" = '0 ( ) ' ]
    [ "$(tail -n 3 zones/faceZones | tr '\n' ' ')" = '0 ( ) ' ]
}

@test "names go to TetGen's files and come back" {
    { cubes | sed '/^\.facet/,$d'; printf '%s\n' .ele '1 4 1' '1 1 2 4 7 5' .group '3 0' \
        '1 0 3 a node' '2 2 -1 # a "face"' '3 3 5 größer' .end; } >named.tm
    tetgen-export named named.tm
    tetgen-import --no-history named | cmp - named.tm
}

@test "GetFEM: facets of an octree mesh are regions, with their names as comments" {
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "there is no p4est"
    octree-mesh -s 3 channel.stl >mesh.tm
    getfem-export mesh.tm >mesh.getfem
    grep -qx '% REGION 1: inlet port' mesh.getfem
    awk '$1 == "BEGIN" && $2 == "REGION" { n = 0; next } $1 == "END" && $2 == "REGION" { print $3, n }
        { n++ }' mesh.getfem >regions
    awk '/^\.facet/ { f = 1; getline; next } /^\./ { f = 0 } f { n[$NF]++ }
        END { for (m = 1; m <= 3; m++) print m, n[m] }' mesh.tm | cmp - regions
}

@test "what a .group may not hold: exit 3, the row and why" {
    cubes | sed '$d' >head.tm
    wrong() {
        { cat head.tm; printf '%s\n' .group "$1" "${@:3}" .end; } >wrong.tm
        run -3 --separate-stderr vtu-export -o out wrong.tm
        # shellcheck disable=SC2053 # a pattern
        [[ "$stderr" == "vtu-export: wrong.tm:"*".group: "$2 ]]
        [ ! -e out ]
    }
    wrong '1 0' 'row 1: there is no name (the rest of the row)' '1 2 3  '
    wrong '1 0' 'row 1: 4 is no dimension*' '1 4 3 x'
    wrong '1 0' 'row 1: the marker 2147483648 does not fit*' '1 2 2147483648 x'
    wrong '1 1' 'the header says 1 (0)' '1 2 3 x'
    wrong '1 0' 'row 1: there is a control character in the name*' "1 2 3 x$(printf '\033')y"
    wrong '1 0' 'row 1: the name is not UTF-8' "1 2 3 $(printf '\374')"
    wrong '2 0' 'rows 1 and 2 have the same name*' '1 2 3 x' '2 2 4 x'
    wrong '2 0' 'rows 1 and 2 have the same value*' '1 2 3 x' '2 2 3 y'
    wrong '2 0' 'row 2 of 2 is missing*' '1 2 3 x'
    { cat head.tm; printf '%s\n' .group '3 0' '1 2 3 x' '2 1 3 x' '3 2 99 y' .end; } >right.tm
    run -0 vtu-export -o out right.tm
}
