# SPDX-License-Identifier: GPL-3.0-or-later
# medit-import and medit-export: what one writes the other reads, as text and binary, with
# solutions; files of Gmsh, meshio and hand-written ones; damaged files are refused.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers
load import

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# The names of a stream, without their numbers.
names() {
    rows .group "$1" | cut -d ' ' -f 2- | sort
}

@test "what medit-export writes comes back: nodes, elements, references, names, attributes" {
    local kind
    for kind in tetrahedra hexahedra surface points; do
        meshes $kind | without_attributes elements >$kind.tm
        medit-export --strict --sol $kind.sol -o $kind.mesh $kind.tm
        medit-import -q --sol $kind.sol $kind.mesh >back.tm
        same_mesh $kind.tm back.tm
        medit-export --sol again.sol back.tm | cmp - $kind.mesh
        cmp again.sol $kind.sol
        # binary has no names
        medit-export -q --binary --sol $kind.solb -o $kind.meshb $kind.tm
        medit-import -q --sol $kind.solb $kind.meshb >back.tm
        same_mesh $kind.tm back.tm --no-names
        medit-export -j 2 --sol again.solb --binary back.tm | cmp - $kind.meshb
        cmp again.solb $kind.solb
    done
    # and what was compared can differ
    sed '1,/^Tetrahedra/!s/ 7$/ 8/' tetrahedra.mesh >other.mesh
    medit-import -q --sol tetrahedra.sol other.mesh >back.tm
    run -1 same_mesh tetrahedra.tm back.tm
}

@test "mixed elements: in the order of their types, and the same" {
    meshes mixed | without_attributes >mixed.tm
    for option in '' --binary; do
        # shellcheck disable=SC2086 # none or one
        medit-export -q $option -o mixed.mesh mixed.tm
        medit-import -q mixed.mesh >back.tm
        # shellcheck disable=SC2086
        medit-export -q $option back.tm | cmp - mixed.mesh
        for file in mixed back; do
            mesh-check --json $file.json $file.tm >/dev/null || true
            jens-stats --json $file.j $file.tm >/dev/null
            rows .mix $file.tm | awk '{ print $2, $NF }' | sort | uniq -c >$file.regions
            rows .facet $file.tm | awk '{ print $4, $NF }' | sort | uniq -c >$file.markers
        done
        for key in nodes elements inverted boundary_faces components euler unused_nodes; do
            [ "$(json mixed.json $key)" = "$(json back.json $key)" ]
        done
        python3 -c 'import json
a, b = (json.load(open(f + ".json")) for f in ("mixed", "back"))
assert abs(a["volume"] - b["volume"]) < 1e-12 and abs(a["area"] - b["area"]) < 1e-12'
        [ "$(json mixed.j negative)" = "$(json back.j negative)" ]
        cmp mixed.regions back.regions
        cmp mixed.markers back.markers
        for file in mixed back; do rows .node $file.tm; done | python3 -c 'import sys
rows = [[float(x) for x in line.split()[1:]] for line in sys.stdin]
half = len(rows) // 2
assert half > 64 and rows[:half] == rows[half:]'
    done
}

# A square with all that a file of Mmg has; vertex 5 is the middle of an edge.
square() {
    cat <<'END'
MeshVersionFormatted 2 # of Mmg

Dimension 3
Vertices
5
0 0 0 1
1 0 0 2
1 1 0 0
0 1 0 0
.5 0. 1e0 -9
Corners 2
1 2
RequiredVertices
1
1
Triangles
2
1 2 3 4
1 3 4 5

Edges
2
1 2 7
2 3 0
Ridges
1
1
RequiredEdges 0
Normals
1
0 0 1
NormalAtVertices
1
1 1
Tetrahedra 1
1 3 2 5 6
End
END
}

@test "a file of Mmg: references, and what is left out is said" {
    square >square.mesh
    run -0 --separate-stderr medit-import -o square.tm square.mesh
    [ "${stderr_lines[0]}" = "medit-import: square.mesh: 1 elements were left-handed and are turned" ]
    [ "${stderr_lines[1]}" = "medit-import: square.mesh: 2 corners, 1 required vertices, 1 ridges: left out" ]
    [ "${stderr_lines[2]}" = "medit-import: square.mesh: other sections: Normals, NormalAtVertices: left out" ]
    [ "${#stderr_lines[@]}" -eq 3 ]
    [ "$(rows .node square.tm)" = "1 0 0 0 1
2 1 0 0 2
3 1 1 0 0
4 0 1 0 0
5 0.5 0 1 -9" ]
    [ "$(rows .ele square.tm)" = "1 1 3 5 2 6" ]
    [ "$(rows .face square.tm)" = "1 1 2 3 4
2 1 3 4 5" ]
    [ "$(rows .edge square.tm)" = "1 1 2 7
2 2 3 0" ]
    run -3 medit-import --strict square.mesh
    tr '\n' '\r' <square.mesh >cr.mesh
    sed 's/$/\r/' square.mesh >crlf.mesh
    sed 's/[A-Z]/\L&/' square.mesh >small.mesh
    for file in cr crlf small; do
        medit-import -q --no-history $file.mesh | cmp - <(medit-import -q --no-history square.mesh)
    done
    # no reference is no marker and no region
    sed '/^[.0-9].* /s/ -*[0-9]*$/ 0/' square.mesh >none.mesh
    medit-import -q none.mesh >none.tm
    [ "$(header .node none.tm) $(header .ele none.tm)" = "5 3 0 0 1 4 0" ]
}

@test "two dimensions, second order, every kind of value of a solution" {
    cat >plane.mesh <<'END'
MeshVersionFormatted 1
Dimension 2
Vertices
6
0 0 1
1 0 1
0 1 1
.5 0 0
.5 .5 0
0 .5 0
TrianglesP2
1
1 2 3 4 5 6 8
End
END
    printf '%s\n' 'MeshVersionFormatted 1' 'Dimension 2' 'SolAtVertices' 6 '3 1 2 3' >plane.sol
    for i in 1 2 3 4 5 6; do echo "$i.5 $i 2 3 4 5"; done >>plane.sol
    echo End >>plane.sol
    run -0 --separate-stderr medit-import --sol plane.sol -o plane.tm plane.mesh
    [[ "$stderr" == *"attributes of nodes: solution_1, solution_2 (2), solution_3 (3)"* ]]
    [[ "$stderr" == *"3 nodes of 1 elements of second order, of which the corners are taken: left out"* ]]
    [ "$(rows .node plane.tm)" = "1 0 0 0 1.5 1 2 3 4 5 1
2 1 0 0 2.5 2 2 3 4 5 1
3 0 1 0 3.5 3 2 3 4 5 1" ]
    [ "$(rows .face plane.tm)" = "1 1 2 3 8" ]
    printf '%s\n' 'termesh 1' .node '2 3 10 0' '1 0 0 0 1 2 3 4 5 6 7 8 9 10' \
        '2 1 0 0 .1 .2 .3 .4 .5 .6 .7 .8 .9 1' .end >ten.tm
    for option in '' --binary; do
        # shellcheck disable=SC2086 # none or one
        medit-export $option --sol ten.sol --kinds vector,scalar,tensor -o ten.mesh ten.tm
        run -0 --separate-stderr medit-import --sol ten.sol -o back.tm ten.mesh
        [[ "$stderr" == *"attributes of nodes: solution_1 (3), solution_2, solution_3 (6)" ]]
        same_mesh ten.tm back.tm
    done
    medit-export --sol ten.sol --kinds vector,scalar,tensor ten.tm >/dev/null
    [ "$(sed -n 5p ten.sol)" = "3 2 1 3" ]
    run -3 --separate-stderr medit-export --sol ten.sol --kinds tensor ten.tm
    [ "$stderr" = "medit-export: ten.tm: nodes have 10 attributes, but the kinds of values are of 6" ]
    run -2 --separate-stderr medit-export --sol ten.sol --kinds tensors ten.tm
    [ "${stderr_lines[0]}" = "medit-export: --kinds: 'tensors' is no list of scalar, vector and tensor" ]
    run -2 medit-export --kinds tensor ten.tm
    printf 'termesh 1\n.node\n1 3 0 0\n1 0 0 0\n.end\n' >none.tm
    run -3 --separate-stderr medit-export --sol none.sol none.tm
    [ "$stderr" = "medit-export: none.tm: has no attributes of nodes for a solution" ]
    [ ! -e none.sol ]
    run -3 --separate-stderr medit-import --sol plane.sol ten.mesh
    [ "$stderr" = "medit-import: plane.sol:4: has values of 6 vertices (the mesh has 2)" ]
}

@test "binary files of versions 1 to 4, and of either byte order" {
    python3 - <<'END'
import struct
xyz = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, .5)]
for version in 1, 2, 3, 4:
    for order in '<', '>':
        data = bytearray(struct.pack(order + 'ii', 1, version))
        whole, place = 'q' if version == 4 else 'i', 'q' if version > 2 else 'i'
        def section(code, body):
            size = len(data) + 4 + struct.calcsize(place) + len(body)
            data.extend(struct.pack(order + 'i', code) + struct.pack(order + place, size) + body)
        section(3, struct.pack(order + 'i', 3))
        section(4, struct.pack(order + whole, 4) + b''.join(
            struct.pack(order + '3' + ('f' if version == 1 else 'd') + whole, *x, i)
            for i, x in enumerate(xyz)))
        section(777, b'whatever')
        section(8, struct.pack(order + whole + '5' + whole, 1, 1, 2, 3, 4, 70007))
        section(6, struct.pack(order + whole + '4' + whole, 1, 1, 3, 2, -5))
        section(13, struct.pack(order + whole + '2' + whole, 2, 1, 2))
        data += struct.pack(order + 'i', 54) + struct.pack(order + place, 0)
        open('v%d%s.meshb' % (version, 'le' if order == '<' else 'be'), 'wb').write(data)
END
    for file in v*.meshb; do
        run -0 --separate-stderr medit-import --no-history -o made.tm "$file"
        [[ "$stderr" == *": 2 corners: left out"*": other sections: section 777: left out" ]]
        [ "$(rows .node made.tm)" = "1 0 0 0 0
2 1 0 0 1
3 0 1 0 2
4 0 0 0.5 3" ]
        [ "$(rows .ele made.tm) $(rows .face made.tm)" = "1 1 2 3 4 70007 1 1 3 2 -5" ]
    done
    [ "$file" = v4le.meshb ]
}

@test "Gmsh reads ours, and we what it writes" {
    load gmsh
    need_gmsh
    two_geo
    by_gmsh two.mesh
    by_gmsh two.msh
    medit-import -q two.mesh >two.tm
    gmsh-import -q two.msh >msh.tm
    for block in .ele .face .edge; do
        [ "$(header $block two.tm)" = "$(header $block msh.tm)" ]
    done
    mesh-check --json check.json two.tm >/dev/null
    [ "$(json check.json volume)" = 2 ]
    # Gmsh's references of vertices are entities, which it does not read itself
    awk '/^\.node/ { node = 1 } /^\.ele/ { node = 0 } node && NF == 5 { $5 = 0 } 1' two.tm >unmarked.tm
    same_mesh unmarked.tm <(gmsh-import -q two.mesh)
    meshes tetrahedra | without_attributes | medit-export -q -o ours.mesh
    medit-import -q ours.mesh >ours.tm
    gmsh-import -q ours.mesh >theirs.tm
    [ "$(header .ele ours.tm)" = "$(header .ele theirs.tm)" ]
    mesh-check --json ours.json ours.tm >/dev/null
    mesh-check --json theirs.json theirs.tm >/dev/null
    python3 -c 'import json
a, b = (json.load(open(f + ".json"))["volume"] for f in ("ours", "theirs"))
assert abs(a - b) < 1e-12'
}

@test "meshio reads ours, and we what it writes, text and binary" {
    need_meshio
    meshes mixed | without_attributes >mixed.tm
    medit-export -q -o ours.mesh mixed.tm
    medit-export -q --binary -o ours.meshb mixed.tm
    "$vtk_python" - <<'END'
import meshio, numpy as np
a, b = meshio.read('ours.mesh'), meshio.read('ours.meshb')
assert (a.points == b.points).all()
for mesh in a, b:
    count = {c.type: len(c.data) for c in mesh.cells}
    assert {'tetra', 'pyramid', 'wedge', 'hexahedron', 'triangle', 'quad', 'line'} == set(count), count
    refs = dict(zip([c.type for c in mesh.cells], mesh.cell_data['medit:ref']))
    assert set(refs['hexahedron']) <= {7, -3} and set(refs['line']) == {31, 32}
points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1],
                   [0, 1, 1], [2, 0, 0], [2, 0, 1]]) / 3
cells = [('hexahedron', np.arange(8).reshape(1, 8)), ('wedge', np.array([[1, 8, 2, 5, 9, 6]])),
         ('quad', np.array([[0, 3, 2, 1]]))]
mesh = meshio.Mesh(points, cells, cell_data={'medit:ref': [np.array([7]), np.array([8]), np.array([31])]},
                   point_data={'medit:ref': np.arange(10)})
meshio.write('theirs.mesh', mesh)
meshio.write('theirs.meshb', mesh)
END
    for file in theirs.mesh theirs.meshb; do
        medit-import -q $file >theirs.tm
        [ "$(header .mix theirs.tm) $(rows .facet theirs.tm | awk '{ print $4, $NF }')" = "2 1 4 31" ]
        [ "$(rows .mix theirs.tm | awk '{ print $2, $NF }' | sort | tr '\n' ' ')" = "6 8 8 7 " ]
        [ "$(rows .node theirs.tm | tail -n 1)" = \
            "10 0.6666666666666666 0 0.3333333333333333 9" ]
        mesh-check --json check.json theirs.tm >/dev/null
        [ "$(json check.json inverted)" = 0 ]
    done
}

@test "what is no mesh is refused" {
    is_refused() {
        printf '%s\n' "${@:2}" >refused.mesh
        run -3 --separate-stderr medit-import refused.mesh
        [ "$output" = "" ]
        [ "$stderr" = "medit-import: refused.mesh:$1" ] || { echo "$stderr" && false; }
    }
    local head=('MeshVersionFormatted 2' 'Dimension 3' Vertices 1 '0 0 0 0')
    is_refused "6: the file ends without the word End" "${head[@]}"
    is_refused "3: has no vertices" "${head[@]:0:2}" End ''
    is_refused "2: the dimension: 4 is out of range (2..3)" "${head[0]}" 'Dimension 4'
    is_refused "8: the number of a vertex: 2 is out of range (1..1)" "${head[@]}" Edges 1 '1 2 0'
    is_refused "4: Edges are before Vertices" "${head[@]:0:2}" Edges 1 '1 2 0' End
    is_refused "4: the file is too short for 999999999 rows" "${head[@]:0:2}" Vertices 999999999 '0 0 0 0'
    is_refused "6: a second section Vertices" "${head[@]}" Vertices 1 '0 0 0 0' End
}

@test "numbers behind the rows of a section are refused, in each, and others are skipped" {
    # SECTION LINE NUMBERS…: a row has one number more, or a row is too many
    local head=('MeshVersionFormatted 2' 'Dimension 3' Vertices 8 '0 0 0 0' '1 0 0 0'
        '1 1 0 0' '0 1 0 0' '0 0 1 0' '1 0 1 0' '1 1 1 0' '0 1 1 0')
    while read -r section row; do
        for more in 5 5.5 -1; do
            printf '%s\n' "${head[@]}" "$section" 1 "$row" End >right.mesh
            medit-import -q -o right.tm right.mesh
            printf '%s\n' "${head[@]}" "$section" 1 "$row $more" End >long.mesh
            printf '%s\n' "${head[@]}" "$section" 1 "$row" '' "$more" End >behind.mesh
            run -3 --separate-stderr medit-import long.mesh
            [ "$output" = "" ]
            [ "$stderr" = "medit-import: long.mesh:15: '$more' is where a word such as End should be" ]
            run -3 --separate-stderr medit-import behind.mesh
            [ "$stderr" = "medit-import: behind.mesh:17: '$more' is where a word such as End should be" ]
        done
    done <<'END'
Edges 1 2 0
Triangles 1 2 3 0
Quadrilaterals 1 2 3 4 0
Tetrahedra 1 2 3 5 0
Prisms 1 2 3 5 6 7 0
Hexahedra 1 2 3 4 5 6 7 8 0
Pyramids 1 2 3 4 5 0
Corners 1
RequiredVertices 1
END
    # as Gmsh 4.8 writes tetrahedra of second order
    printf '%s\n' "${head[@]}" Tetrahedra 1 '1 2 3 5 4 6 7 8 1 2 3' End >second.mesh
    run -3 medit-import second.mesh
    # behind the vertices, the dimension, and in solutions
    printf '%s\n' "${head[@]}" '1 2 3 4' End >vertices.mesh
    run -3 --separate-stderr medit-import vertices.mesh
    [ "$stderr" = "medit-import: vertices.mesh:13: '1' is where a word such as End should be" ]
    printf '%s\n' "${head[0]}" 'Dimension 3 3' "${head[@]:2}" End >dimension.mesh
    run -3 --separate-stderr medit-import dimension.mesh
    [ "$stderr" = "medit-import: dimension.mesh:2: '3' is where a word such as End should be" ]
    printf '%s\n' "${head[@]}" End >right.mesh
    printf '%s\n' 'MeshVersionFormatted 2' 'Dimension 3' SolAtVertices 8 '1 1' 1 2 3 4 5 6 7 '8 9' End >long.sol
    run -3 --separate-stderr medit-import --sol long.sol right.mesh
    [ "$stderr" = "medit-import: long.sol:13: '9' is where a word such as End should be" ]
    # whatever a section has that is not known
    printf '%s\n' "${head[@]}" Unknown 2 '1 2 3 "a" -4.5' 1 Vertexes 7 End >unknown.mesh
    run -0 --separate-stderr medit-import unknown.mesh
    [ "$stderr" = "medit-import: unknown.mesh: other sections: Unknown, Vertexes: left out" ]
}

@test "damaged files: never a crash, a hang, or much memory" {
    meshes mixed 2 | without_attributes elements >mixed.tm
    medit-export -q --sol mixed.sol -o mixed.mesh mixed.tm
    medit-export -q --binary --sol mixed.solb -o mixed.meshb mixed.tm
    damage medit-import mixed.mesh
    damage medit-import mixed.meshb
    # the same of solutions
    for sol in mixed.sol mixed.solb; do
        for i in $(seq 60); do
            python3 - "$sol" "$i" <<'END'
import random, sys
data = bytearray(open(sys.argv[1], 'rb').read())
random.seed(int(sys.argv[2]))
for _ in range(3):
    data[random.randrange(min(len(data), 200))] = random.choice(b'0123456789-. \xff\0')
open('damaged', 'wb').write(data if int(sys.argv[2]) % 2 else data[:random.randrange(len(data) - 5)])
END
            status=0
            timeout 20 medit-import -q --sol damaged -o out.tm mixed.mesh 2>note || status=$?
            [ "$status" -eq 0 ] || { [ "$status" -eq 3 ] && [ "$(wc -l <note)" -eq 1 ]; }
        done
    done
}
