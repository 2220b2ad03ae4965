# SPDX-License-Identifier: GPL-3.0-or-later
# openfoam-export: what checkMesh asks of a mesh, asked here.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# check FOLDER: prints points, cells, faces, faces inside, patches and the volume. Exit
# status 1 where a file is not what its head says, or the mesh fails a criterion of
# checkMesh: all points used, faces of different points, owner < neighbour, upper-triangular
# order, the patches one after another behind the faces inside, cells closed (each edge
# twice, once in each sense, and the area vectors add up to nothing), volumes positive,
# the boundary closed.
check() {
    python3 - "$1" <<'END'
import re, sys
from collections import Counter

kinds = {'points': 'vectorField', 'faces': 'faceList', 'owner': 'labelList',
         'neighbour': 'labelList', 'boundary': 'polyBoundaryMesh'}

def read(name):
    text = open(sys.argv[1] + '/' + name).read()
    head, rest = text.split('}\n', 1)
    assert re.search(r'class +%s;' % kinds[name], head), head
    assert re.search(r'object +%s;' % name, head), head
    assert re.search(r'format +ascii;', head), head
    count, items = re.fullmatch(r'\s*(\d+)\n\(\n(.*)\)\n', rest, re.S).groups()
    return int(count), items, head

def lines(name):
    count, items, head = read(name)
    items = items.splitlines()
    assert len(items) == count, name
    return items

points = [tuple(map(float, p.strip('()').split())) for p in lines('points')]
faces = []
for f in lines('faces'):
    k, nodes = re.fullmatch(r'(\d+)\(([\d ]*)\)', f).groups()
    faces.append([int(v) for v in nodes.split()])
    assert len(faces[-1]) == int(k) == len(set(faces[-1])) >= 3
owner = [int(c) for c in lines('owner')]
neighbour = [int(c) for c in lines('neighbour')]
inside, cells = len(neighbour), max(owner) + 1
note = 'nPoints: %d nCells: %d nFaces: %d nInternalFaces: %d' % (
    len(points), cells, len(faces), inside)
assert note in read('owner')[2] and note in read('neighbour')[2]
assert len(owner) == len(faces)
assert {v for f in faces for v in f} == set(range(len(points)))
pairs = list(zip(owner, neighbour))
assert all(o < n for o, n in pairs)
assert pairs == sorted(pairs)
patches, at = read('boundary'), inside
found = re.findall(r'    (\S+)\n    {\n\s+type +patch;\n\s+nFaces +(\d+);\n'
                   r'\s+startFace +(\d+);\n    }\n', patches[1])
assert len(found) == patches[0]
for name, count, start in found:
    assert int(start) == at and int(count) > 0
    assert owner[at:at + int(count)] == sorted(owner[at:at + int(count)])
    at += int(count)
assert at == len(faces)

def cross(f):
    """Twice the area vector, and six times the volume to the origin."""
    a, s, volume = points[f[0]], [0, 0, 0], 0
    for i in range(1, len(f) - 1):
        b, c = points[f[i]], points[f[i + 1]]
        u, w = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
        n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
             u[0] * w[1] - u[1] * w[0]]
        s = [s[k] + n[k] for k in range(3)]
        volume += sum(n[k] * a[k] for k in range(3))
    return s, volume

edges = [Counter() for c in range(cells + 1)]
area = [[0, 0, 0] for c in range(cells)]
volume = [0] * cells
for f, face in enumerate(faces):
    s, v = cross(face)
    sides = [(owner[f], 1)] + ([(neighbour[f], -1)] if f < inside else [])
    for c, sign in sides:
        area[c] = [area[c][k] + sign * s[k] for k in range(3)]
        volume[c] += sign * v / 6
    for c, sign in sides + ([] if f < inside else [(cells, 1)]):
        for i in range(len(face)):
            e = (face[i - 1], face[i])
            edges[c][e if sign > 0 else e[::-1]] += 1
for e in edges:
    assert all(n == 1 and e[b, a] == 1 for (a, b), n in list(e.items()))
assert all(abs(x) < 1e-9 for a in area for x in a)
assert all(v > 0 for v in volume)
print(len(points), cells, len(faces), inside, ','.join(name for name, *rest in found),
      '%.9g' % sum(volume))
END
}

@test "two cubes: every byte of the lists" {
    cubes >cubes.tm
    openfoam-export mesh cubes.tm
    [ "$(check mesh)" = '12 2 11 1 marker_1,marker_2,marker_3,marker_4,marker_5 2' ]
    sed -n '/^(/,$p' mesh/faces | xargs -d '\n' | grep -xF '( 4(1 4 10 7) 4(0 6 9 3) '\
'4(0 1 7 6) 4(3 9 10 4) 4(1 2 8 7) 4(4 10 11 5) 4(0 3 4 1) 4(1 4 5 2) 4(6 7 10 9) '\
'4(7 8 11 10) 4(2 5 11 8) )'
    sed -n '/^(/,$p' mesh/owner | xargs | grep -xF '( 0 0 0 0 1 1 0 1 0 1 1 )'
    [ "$(sed -n '/^(/,$p' mesh/neighbour | xargs)" = '( 1 )' ]
    # the facet between them may say so the other way round, and have a marker
    sed 's/^6 1 2 4 2 5 11 8 0/6 2 1 4 8 11 5 2 77/' cubes.tm >turned.tm
    openfoam-export again turned.tm
    diff again/owner mesh/owner
    diff again/boundary mesh/boundary
    check again
    grep -xF '4(7 10 4 1)' again/faces && return 1
    grep -xF '4(7 1 4 10)' again/faces
}

@test "polyhedra: the patches are the markers of the boundary" {
    sheared_boxes 4 >boxes.tm
    openfoam-export mesh boxes.tm
    [ "$(check mesh)" = "125 64 240 144 $(echo marker_{1..6} | tr ' ' ,) 64" ]
    # negative markers, nodes that no cell has
    sheared_boxes 2 0 | awk '/^27 3/ { $1 = 28 } /^\.facet/ { print "27 9 9 9 0 0" } { print }' |
        sed 's/ 3$/ -3/' | openfoam-export more
    [ "$(check more | cut -d ' ' -f 1-5)" = \
        '27 8 36 12 marker_-3,marker_1,marker_2,marker_4,marker_5,marker_6' ]
}

@test "tetrahedra with markers of their triangles; mixed elements" {
    surface sphere smesh >s.smesh
    { sed '$d' s.smesh; printf '1\n1 0 0 0 5 -1\n'; } >r.smesh
    tetgen-mesh --switches A -q1.4 r.smesh >sphere.tm
    openfoam-export sphere sphere.tm
    volume=$(volumes sphere.tm | awk '{ sum += $1 } END { printf "%.9g", sum }')
    faces=$(header .face sphere.tm)
    check sphere >found
    [ "$(awk '{ print $2, $6 }' found)" = "$(header .ele sphere.tm | cut -d ' ' -f 1) \
$volume" ]
    [ "$(awk '{ print $3 - $4 }' found)" = "${faces%% *}" ]
    # a marker for the upper half
    awk '/^\./ { block = $1; header = 1; print; next }
        header { header = 0; if (block == ".face") $2 = 1; print; next }
        block == ".node" { z[$1] = $4 }
        block == ".face" { $5 = z[$2] + z[$3] + z[$4] > 0 ? 7 : -1; print; next }
        { print }' sphere.tm | openfoam-export halves
    check halves | grep ' marker_-1,marker_7 '
    mixed | openfoam-export mixed
    [ "$(check mixed)" = '12 4 17 3 marker_0 1.91666667' ]
    mixed | sed 's/^1 8 1 2 3 4 5 6 7 8/1 8 1 4 3 2 5 8 7 6/' | openfoam-export turned
    check turned
    # Markers of boundary polygons, wherever they begin; what is no face is passed over.
    mixed | sed 's/^\.end/.facet\n4 1\n1 1 -1 4 3 2 1 4 5\n2 4 -1 3 12 6 7 -7\n3 1 -1 3 1 2 3 8\n4 1 2 4 5 6 7 8 9\n.end/' |
        openfoam-export marked
    [ "$(check marked)" = '12 4 17 3 marker_-7,marker_0,marker_5 1.91666667' ]
    # Those of .facet stand over those of .face.
    mixed | sed 's/^\.end/.face\n2 1\n1 6 7 12 3\n2 2 3 10 4\n.facet\n1 1\n1 4 -1 3 12 6 7 -7\n.end/' |
        openfoam-export both
    [ "$(check both)" = '12 4 17 3 marker_-7,marker_0,marker_4 1.91666667' ]
}

@test "a folder that is there is used again, but not with other files in it" {
    cubes >cubes.tm
    openfoam-export mesh cubes.tm
    sheared_boxes 2 >boxes.tm
    openfoam-export mesh boxes.tm
    check mesh | grep '^27 8 '
    [ "$(cd mesh && echo ./*)" = './boundary ./faces ./neighbour ./owner ./points' ]
    touch mesh/cellLevel
    cp mesh/points points
    run -4 --separate-stderr openfoam-export mesh cubes.tm
    [[ "$stderr" == "openfoam-export: mesh: there is also 'cellLevel' in the folder"* ]]
    cmp mesh/points points
}

@test "the folders that it is in are made, too" {
    cubes >cubes.tm
    openfoam-export mesh cubes.tm
    openfoam-export new/constant/polyMesh cubes.tm
    diff -r mesh new/constant/polyMesh
    openfoam-export "$PWD/new/other/polyMesh/" cubes.tm
    diff -r mesh new/other/polyMesh
}

@test "whole or not at all" {
    sheared_boxes 8 >boxes.tm
    run -4 --separate-stderr bash -c \
        'ulimit -f 4; trap "" XFSZ; openfoam-export mesh boxes.tm'
    [[ "$stderr" == *'openfoam-export: mesh/'*': cannot write: '* ]]
    [ ! -e mesh ]
    run -4 --separate-stderr bash -c \
        'ulimit -f 4; trap "" XFSZ; openfoam-export new/constant/polyMesh boxes.tm'
    [ ! -e new ]
    mkdir old
    run -4 --separate-stderr bash -c \
        'ulimit -f 4; trap "" XFSZ; openfoam-export old/constant//polyMesh/ boxes.tm'
    [ -z "$(ls old)" ]
    touch file
    run -4 --separate-stderr openfoam-export -q file/mesh boxes.tm
    [[ "$stderr" == 'openfoam-export: file/mesh: cannot make the folder: '* ]]
    run -4 --separate-stderr openfoam-export file boxes.tm
    mkdir -p mesh/points/in.the.way
    run -4 --separate-stderr openfoam-export mesh boxes.tm
    [ "$(ls mesh)" = points ]
}

# checked FINDING COUNT: whether the note says so often that checkMesh would fail at it, or
# nothing where that is 0.
checked() {
    if [ "$2" -eq 0 ]; then
        [[ "$stderr" != *"$1"* ]]
    else
        [[ "$stderr" == *" would fail: $2 $1"* ]]
    fi
}

@test "what checkMesh would fail at is said, as poly-stats measures it, and what may help" {
    awk 'BEGIN { srand(11); print 600, 3; for (i = 1; i <= 600; i++) print i, rand(), rand(), rand() }' |
        tetgen-mesh --quiet >points.tm
    polylla3d -q --star points.tm >stars.tm
    poly-stats -q --json stars.json -o table stars.tm
    run -0 --separate-stderr openfoam-export stars stars.tm
    for key in wrong_pyramids:pyramids reversed:'faces with a non-orth' skew:'faces with a skew'; do
        count=$(json stars.json finite_volume "${key%%:*}")
        [ "$count" -gt 0 ]
        checked "${key#*:}" "$count"
    done
    [[ "$stderr" == *", the worst $(printf %.3g "$(json stars.json finite_volume max_skewness)")"* ]]
    [[ "$stderr" == *"what may help: "*"polylla3d "* ]]
    [[ "$stderr" != *allGeometry* ]]
    run -0 --separate-stderr openfoam-export -v stars stars.tm
    for key in small_weights:'faces with a weight' small_volume_ratios:'faces between' \
        small_determinants:'cells with a determinant' concave:'concave cells' \
        no_fan:'faces whose tetrahedra'; do
        checked "${key#*:}" "$(json stars.json finite_volume "${key%%:*}")"
    done
    [[ "$stderr" == *"allGeometry would fail: "*" concave cells"* ]]
    run -0 --separate-stderr openfoam-export -q quiet stars.tm
    [ "$stderr" = "" ]
    diff -r stars quiet
    # Tetrahedra that lean over, elements, what is fit.
    printf 'termesh 1\n.node\n5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 20 0 1\n5 20 0 -1
.ele\n2 4 0\n1 1 2 3 4\n2 1 3 2 5\n.end\n' >lean.tm
    run -0 --separate-stderr openfoam-export lean lean.tm
    [[ "$stderr" == *"a skewness above 4"*"what may help: lepp-improve"* ]]
    mixed | sed 's/^4 1$/2 1/; /^3 6 /d; /^4 4 /d; s/^9 .*/9 60 0.5 1.2/' >far.tm
    run -0 --separate-stderr openfoam-export far far.tm
    [[ "$stderr" == *"checkMesh would fail: "*"what may help: octree-mesh --polyhedra of its surface"* ]]
    # Polyhedra: by what they were made from.
    advice() {
        { printf 'termesh 1\n%s' "$1"; sed -e 1d -e '/^#/d' stars.tm; } >told.tm
        openfoam-export told told.tm 2>&1 | sed -n 's/.*what may help: //p'
    }
    [[ "$(advice $'# tetgen-mesh 1: a\n')" == 'octree-mesh --polyhedra of its surface'* ]]
    [[ "$(advice $'# tetgen-mesh 1: a\n# poly-dual 1: b\n# vtk-export 1: c\n')" == poly-dual* ]]
    [[ "$(advice $'# octree-mesh 1: a\n')" == 'octree-mesh --polyhedra with another -s' ]]
    [[ "$(advice $'# octree-mesh 1: a\n# polylla3d 1: b\n')" == *'polylla3d --star=centroid'* ]]
    sheared_boxes 4 >boxes.tm
    run -0 --separate-stderr openfoam-export boxes boxes.tm
    [[ "$stderr" != *checkMesh* ]]
}

@test "a report, usage, wrong input" {
    cubes >cubes.tm
    openfoam-export --json report mesh cubes.tm
    [ "$(cat report)" = '{"points": 12, "faces": 11, "cells": 2, "patches": 5, '\
'"cell_zones": 0, "face_zones": 0}' ]
    run -2 --separate-stderr openfoam-export
    [[ "$stderr" == 'openfoam-export: FOLDER is missing'* ]]
    run -2 --separate-stderr openfoam-export -o x mesh cubes.tm
    run -2 --separate-stderr openfoam-export mesh cubes.tm more.tm
    printf 'termesh 1\n.node\n1 3 0 0\n0 0 0 0\n.end\n' >points.tm
    run -3 --separate-stderr openfoam-export none points.tm
    [[ "$stderr" == 'openfoam-export: points.tm: holds points (.node alone), but '* ]]
    sed '$d' cubes.tm >short.tm
    run -3 --separate-stderr openfoam-export none short.tm
    [ ! -e none ]
}
