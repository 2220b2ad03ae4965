# SPDX-License-Identifier: GPL-3.0-or-later
# gmsh-export: round trips through each format, and what Gmsh and meshio see in the files.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers
load gmsh

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    [ -x "$TM_BUILD/bin/gmsh-export" ] || skip "there is no libgmsh"
}

# Streams of each kind, with coordinates that are no short decimals, markers of faces,
# edges and nodes, regions and names; rows of a region are not together.
tetrahedra() {
    python3 - <<'END'
import math
n = 3
at = {}
for k in range(n + 1):
    for j in range(n + 1):
        for i in range(n + 1):
            at[i, j, k] = len(at) + 1
print('termesh 1\n.node\n%d 3 0 1' % len(at))
for (i, j, k), v in at.items():
    x = [repr(c).removesuffix('.0') for c in (i / 3, j * math.pi / 9, k / 7e-3 + 1e-9 * i)]
    print(v, *x, 9 if v == 1 else 4 if v in (5, 6) else 0)
cells, faces = [], []
for k in range(n):
    for j in range(n):
        for i in range(n):
            c = lambda a, b, d: at[i + a, j + b, k + d]
            for p, q in (((1, 0, 0), (1, 1, 0)), ((1, 1, 0), (0, 1, 0)), ((0, 1, 0), (0, 1, 1)),
                         ((0, 1, 1), (0, 0, 1)), ((0, 0, 1), (1, 0, 1)), ((1, 0, 1), (1, 0, 0))):
                cells.append((c(0, 0, 0), c(*p), c(*q), c(1, 1, 1), 2 + (i + j) % 2))
            if k == 0:
                faces += [(c(0, 0, 0), c(1, 1, 0), c(1, 0, 0), 7 + i), (c(0, 0, 0), c(0, 1, 0), c(1, 1, 0), 7 + i)]
print('.ele\n%d 4 1' % len(cells))
for t, row in enumerate(cells):
    print(t + 1, *row)
print('.face\n%d 1' % len(faces))
for f, row in enumerate(faces):
    print(f + 1, *row)
print('.edge\n3 1\n1 1 2 5\n2 2 3 6\n3 3 4 5')
print('.group\n6 0\n1 0 9 a corner\n2 1 5 "rim"\n3 2 7 wall\n4 2 8 outlet – Ä\n5 3 2 steel\n6 3 3 air gap\n.end')
END
}

# The nodes that the triangles have, and those.
triangles() {
    tetrahedra | sed '/^\.ele/,/^\.face/{/^\.face/!d}; /^5 3 2/d; /^6 3 3/d; s/^6 0$/4 0/' |
        awk '/^.node/ { n = 1 } /^.face/ { n = 0 } n && NF == 5 && $1 > 16 { next }
            n && $1 == 64 { $1 = 16 } 1'
}

points() {
    tetrahedra | sed '/^\.ele/,/^\.group/d' | sed '/^[2-6] [1-3] [2-8] /d' | awk '/^.node/ { n = 1 }
        n == 1 && NF == 5 && $5 == 0 { $5 = 1 } /^6 0$|^1 0 9/ { next } 1'
}

solids() {
    mixed | sed '/^\.end/d'
    printf '%s\n' .facet '4 1' '1 1 -1 4 1 4 3 2 5' '2 1 3 4 2 3 7 6 6' '3 2 4 3 6 7 9 7' \
        '4 1 2 4 5 6 7 8 0' .group '2 0' '1 3 2 wedges' '2 2 6 between' .end
}

# there_and_back FILE FORMAT OPTION…
there_and_back() {
    run -0 --separate-stderr gmsh-export --format "${@:2}" "a.${2/#msh*/msh}" "$1"
    gmsh-import --no-history "a.${2/#msh*/msh}" >a.tm
}

# Numbers in one form, which tells all doubles apart.
exact() {
    awk '{ for (i = 1; i <= NF; i++) printf "%.17g ", $i; print "" }'
}

@test "tetrahedra, there and back: all of them, nodes to the last bit where the format has it" {
    tetrahedra >t.tm
    for format in msh4 msh2; do
        there_and_back t.tm "$format" --binary --strict
        same_mesh a.tm t.tm
        diff <(names a.tm) <(names t.tm | tr '"' "'")
        # in order, but for the tetrahedra of msh2
        diff <(rows .node a.tm | exact) <(rows .node t.tm | exact)
        [ "$format" = msh2 ] || diff <(rows .ele a.tm) <(rows .ele t.tm)
    done
    for format in msh4 msh40 msh2; do
        there_and_back t.tm "$format" --strict
        same_mesh a.tm t.tm 1e-9
        diff <(names a.tm) <(names t.tm | tr '"' "'")
    done
    there_and_back t.tm msh1
    same_mesh a.tm t.tm 1e-9
    [[ "$stderr" == 'gmsh-export: t.tm: 1 names of nodes (.group), 1 names of edges (.group), 2 names of faces (.group), 2 names of regions (.group): left out' ]]
    # without points
    awk '/^.node/ { n = 1 } /^.ele/ { n = 0 } n && NF == 5 { $5 = 0 } 1' t.tm >u.tm
    there_and_back u.tm unv
    same_mesh a.tm u.tm
    names a.tm | grep -q '3 3 air_gap'
    there_and_back u.tm mesh
    same_mesh a.tm u.tm 1e-9
    there_and_back u.tm bdf
    same_mesh a.tm u.tm 1e-3
    [ "$(header .edge a.tm)" = '3 1' ]
    there_and_back t.tm msh4 --no-points
    same_mesh a.tm u.tm 1e-9
}

@test "mixed elements, surfaces and points, there and back" {
    solids >s.tm
    for options in msh4 'msh4 --binary' msh2 'msh2 --binary' msh40; do
        # shellcheck disable=SC2086 # words
        there_and_back s.tm $options
        same_mesh a.tm <(sed '/^4 1 2 4 5 6 7 8 0/d; /^.facet/{n;s/4/3/}' s.tm)
        diff <(names a.tm) <(names s.tm)
        run -0 mesh-check a.tm
    done
    triangles >f.tm
    points >p.tm
    for options in 'msh4 --binary' 'msh2 --binary'; do
        # shellcheck disable=SC2086 # words
        there_and_back f.tm $options
        same_mesh a.tm f.tm
        diff <(names a.tm) <(names f.tm | tr '"' "'")
        # shellcheck disable=SC2086 # words
        there_and_back p.tm $options
        same_mesh a.tm p.tm
    done
}

@test "Gmsh sees the groups, their elements and their sizes" {
    need_gmsh
    tetrahedra >t.tm
    for format in msh4 msh40 msh2 msh1; do
        gmsh-export -q --format "$format" a.msh t.tm
        gmsh_sees a.msh 'sorted((d, str(n), v[0], "%.12g" % v[1]) for (d, n), v in groups.items())' >seen
        python3 - "$format" >right <<'END'
import math, sys
h = math.pi / 9 / 3 / 7e-3
rows = [(0, 'a corner', 9, 1, 0), (0, None, 4, 2, 0), (1, "'rim'", 5, 2, 2 / 3), (1, None, 6, 1, 1 / 3),
        (2, 'wall', 7, 6, math.pi / 9), (2, 'outlet – Ä', 8, 6, math.pi / 9), (2, None, 9, 6, math.pi / 9),
        (3, 'steel', 2, 90, 15 * h), (3, 'air gap', 3, 72, 12 * h)]
print(sorted((d, name if name and sys.argv[1] != 'msh1' else str(n), c, s) for d, name, n, c, s in rows))
END
        python3 - seen right <<'END'
import sys
seen, right = (eval(open(f).read()) for f in sys.argv[1:])
assert len(seen) == len(right), (seen, right)
for a, b in zip(seen, right):
    assert a[:3] == b[:3] and abs(float(a[3]) - b[3]) <= 1e-9 * max(1, b[3]), (a, b)
END
    done
}

@test "meshio reads .msh 2.2 and 4.1, text and binary, .mesh and .inp" {
    need_meshio
    awk '/^.node/ { n = 1 } /^.ele/ { n = 0 } n && NF == 5 { $5 = 0 } 1' <(tetrahedra) >t.tm
    gmsh-export -q a.msh t.tm
    gmsh-export -q --binary b.msh t.tm
    gmsh-export -q --format msh2 c.msh t.tm
    gmsh-export -q --format msh2 --binary d.msh t.tm
    gmsh-export -q e.mesh t.tm
    gmsh-export -q f.inp t.tm
    "$vtk_python" - a.msh b.msh c.msh d.msh e.mesh f.inp <<'END'
import sys, meshio, numpy
def volume(m):
    total = {}
    for b, block in enumerate(m.cells):
        if block.type != 'tetra':
            continue
        x = m.points[block.data]
        size = numpy.linalg.det(x[:, 1:] - x[:, :1]) / 6
        data = next((m.cell_data[k][b] for k in ('gmsh:physical', 'medit:ref') if k in m.cell_data),
                    numpy.zeros(len(size), int))
        for r in set(data):
            total[int(r)] = total.get(int(r), 0) + size[data == r].sum()
    return total
right = numpy.pi / 9 / 3 / 7e-3
for path in sys.argv[1:]:
    m = meshio.read(path)
    counts = {}
    for block in m.cells:
        counts[block.type] = counts.get(block.type, 0) + len(block.data)
    assert counts == {'tetra': 162, 'triangle': 18, 'line': 3}, (path, counts)
    v = volume(m)
    tolerance = 1e-12 if path.endswith('.msh') else 1e-10
    if not path.endswith('.inp'):
        assert abs(v[2] / (15 * right) - 1) < tolerance and abs(v[3] / (12 * right) - 1) < tolerance, (path, v)
    assert abs(sum(v.values()) / (27 * right) - 1) < tolerance, (path, v)
    if path.endswith('.msh'):
        assert {k: tuple(int(i) for i in x) for k, x in m.field_data.items()} == {
            "'rim'": (5, 1), 'wall': (7, 2), 'outlet – Ä': (8, 2), 'steel': (2, 3), 'air gap': (3, 3)}, m.field_data
    if path.endswith('.inp'):
        assert {'steel', 'air_gap', 'wall'} <= set(m.cell_sets) and 'wall' in m.point_sets, m.cell_sets.keys()
END
}

@test "the user's pipeline: Gmsh, lepp-improve, Gmsh: names and volumes stay" {
    need_gmsh
    two_geo
    by_gmsh part.msh
    gmsh-import part.msh | lepp-improve -q | gmsh-export better.msh
    gmsh_sees part.msh 'sorted((d, n, "%.9f" % v[1]) for (d, n), v in groups.items() if d > 0)' >before
    gmsh_sees better.msh 'sorted((d, n, "%.9f" % v[1]) for (d, n), v in groups.items() if d > 0)' >after
    diff before after
    grep -q "(3, 'left half', '1.000000000')" after
    gmsh-import better.msh | mesh-check | grep -q 'nothing is wrong'
}

@test "numbers that Gmsh does not take: 0 and below; what --strict refuses" {
    cat >t.tm <<'END'
termesh 1
.node
6 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0 0 2
6 9 9 9
.ele
2 4 1
1 1 2 3 4 0
2 4 2 3 5 -3
.face
2 1
1 1 3 2 -1
2 1 2 4 0
.group
2 0
1 3 -3 cold
2 3 5 warm
.end
END
    run -0 --separate-stderr gmsh-export a.msh t.tm
    [ "${stderr_lines[0]}" = 'gmsh-export: t.tm: 1 regions of cells below 0 (.ele), 1 markers of faces below 0 (.face): left out' ]
    [ "${stderr_lines[1]}" = 'gmsh-export: t.tm: 1 nodes that nothing has which is written (.node): left out' ]
    [ "${stderr_lines[2]}" = 'gmsh-export: t.tm: 2 markers and regions below 0, whose groups have other numbers: left out' ]
    gmsh-import --no-history a.msh >a.tm
    diff a.tm - <<'END'
termesh 1
.node
5 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0 0 2
.ele
2 4 1
1 1 2 3 4 7
2 4 2 3 5 6
.face
1 1
1 1 3 2 1
.group
1 0
1 3 6 cold
.end
END
    run -3 gmsh-export --strict b.msh t.tm
    [ ! -e b.msh ]
}

# corner FACE REGION NAME…: a tetrahedron with markers FACE, 2 and 3 and a region, and
# .group with these names, "DIMENSION VALUE NAME".
corner() {
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' \
        .ele '1 4 1' "1 1 2 3 4 $2" .face '4 1' "1 1 3 2 $1" '2 1 2 4 2' '3 2 3 4 3' '4 3 1 4 3' \
        .edge '1 1' '1 1 2 40'
    printf '%s\n' .group "$(($# - 2)) 0"
    printf '%s\n' "${@:3}" | grep . | cat -n | awk '{ $1 = $1 } 1'
    echo .end
}

@test "numbers of groups: the highest that a format has comes back, a higher one is refused" {
    numbered() {
        [ "$1" = face ] && corner "$2" 5 '3 1 none' || corner 5 "$2" '3 1 none'
    }
    while read -r format most; do
        for kind in face region; do
            numbered "$kind" "$most" >most.tm
            run -0 --separate-stderr gmsh-export --format "$format" -o "a.$format" most.tm
            if [[ $format != key ]]; then
                gmsh-import -q --format "${format/msh4/msh}" "a.$format" >back.tm
                diff <(rows .face most.tm | sort) <(rows .face back.tm | sort)
                diff <(rows .ele most.tm) <(rows .ele back.tm)
            fi
            [[ $format != msh4 ]] || continue
            for number in $((most + 1)) 2147483647; do
                numbered "$kind" "$number" >above.tm
                run -3 --separate-stderr gmsh-export -o b.out --format "$format" above.tm
                [ "$stderr" = "gmsh-export: above.tm: has a marker or region $number, too long for the format $format ($most at most; msh4 has it)" ]
                [ ! -e b.out ]
            done
        done
    done <<'END'
bdf 99999999
unv 999999999
key 999999
msh4 2147483647
END
}

@test "names that Gmsh cuts, joins or takes for another group's: left out, with --strict refused" {
    # loses FORMAT WHAT: of names.tm
    loses() {
        run -0 --separate-stderr gmsh-export --format "$1" -o a.out names.tm
        [ "$stderr" = "${2:+gmsh-export: names.tm: $2 (.group): left out}" ] || { echo "$1: $stderr" && false; }
        local status=3
        [ "$2" ] || status=0
        run -$status gmsh-export --strict -q --format "$1" -o b.out names.tm
    }
    local format long joined='1 names that are others'\'' in this format'
    long=$(printf '%0128d' 0)
    for format in msh4 msh40 msh2; do
        corner 1 4 "2 1 $long" >names.tm
        loses $format ''
        gmsh-export -q --format $format -o a.msh names.tm
        gmsh-import -q a.msh | grep -x "1 2 1 $long"
        corner 1 4 "2 1 1$long" "3 4 äöü$long" >names.tm
        loses $format 'what 2 names have behind 128 bytes'
        corner 1 4 '2 1 a"b' "2 2 a'b" '2 3 a b' "3 4 a'b" >names.tm
        loses $format "$joined"
        corner 1 4 '2 1 a b' '2 2 a_b' '3 4 a b' >names.tm
        loses $format ''
    done
    for format in inp key unv; do
        corner 1 4 "2 1 1$long" '2 2 a b' '3 4 c d' >names.tm
        loses $format ''
        corner 1 4 '2 1 a b' '2 2 a_b' '3 4 c d' >names.tm
        loses $format "$joined"
        corner 1 4 '2 1 a b c' '2 2 a_b c' '2 3 a b_c' >names.tm
        loses $format "${joined/1 names/2 names}"
        # what is not there does not count
        corner 1 4 '2 1 a b' '2 9 a_b' '3 9 a b' >names.tm
        loses $format ''
    done
    corner 1 4 '2 1 a b' '2 2 a_b' >names.tm
    run -0 --separate-stderr gmsh-export -o a.su2 names.tm
    [ "${stderr_lines[1]}" = "gmsh-export: names.tm: $joined (.group): left out" ]
    # sets of .inp are their names, in capitals or not; .key has them of each dimension
    corner 1 4 '2 1 part' '3 4 Part' >names.tm
    loses inp "$joined"
    loses key ''
    loses unv ''
    # Gmsh reads one name for each number of .unv
    corner 4 4 '2 4 inlet' '2 2 outlet' '3 4 steel' >names.tm
    loses unv '1 names of groups with the number of one of a higher dimension, whose name Gmsh reads'
    loses msh4 ''
    corner 4 4 '2 4 inlet' >names.tm
    loses unv '1 names of groups with the number of one of a higher dimension, whose name Gmsh reads'
    corner 4 4 '2 2 outlet' '3 4 steel' >names.tm
    loses unv ''
    corner 4 4 '2 4 steel' '3 4 steel' >names.tm
    loses unv ''
    gmsh-export -q -o a.unv names.tm
    gmsh-import -q a.unv | grep -c ' 4 steel$' | grep -x 2
    corner 4 4 '1 40 rim' >names.tm
    loses unv ''
}

@test "names of several names are all those groups again" {
    sed 's/^2 0$/3 0/' >t.tm <<'END'
termesh 1
.node
5 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1
.ele
2 4 1
1 1 2 3 4 5
2 2 3 4 5 1
.group
2 0
1 3 1 all
2 3 5 steel + all + 9
3 3 2 steel
.end
END
    for format in msh4 msh2; do
        gmsh-export --format "$format" a.msh t.tm
        gmsh-import --no-history a.msh >a.tm
        names a.tm | diff - <(printf '%s\n' '3 1 all' '3 10 all + steel + 9' '3 2 steel' | sort)
        gmsh-export --format "$format" b.msh a.tm
        cmp a.msh b.msh || { gmsh-import --no-history b.msh | diff - a.tm; }
    done
    # one of them is no name: it is a name of its own
    sed 's/steel + all + 9/steel + none/' t.tm | gmsh-export a.msh
    gmsh-import a.msh >a.tm
    names a.tm | grep -qx '3 5 steel + none'
}

@test "the format: by suffix, by --format, and what is wrong with it" {
    tetrahedra >t.tm
    for suffix in msh msh2 mesh inp bdf nas unv su2 key; do
        gmsh-export -q "a.$suffix" t.tm
        [ -s "a.$suffix" ]
        ! grep -q "${TMPDIR:-/tmp}/gmsh" "a.$suffix"
        gmsh-export -q -j 2 -o "b.$suffix" t.tm
        cmp "a.$suffix" "b.$suffix"
    done
    gmsh-export -q --format msh2 - t.tm | cmp - a.msh2
    gmsh-export -q --format msh2 - <t.tm | cmp - a.msh2
    gmsh-export -q -o a.MSH t.tm
    cmp a.MSH a.msh
    run -2 --separate-stderr gmsh-export a.xyz t.tm
    [[ "$stderr" == 'gmsh-export: the format is not known: '* ]]
    run -2 gmsh-export - t.tm
    run -2 gmsh-export --format xyz a.msh t.tm
    run -2 --separate-stderr gmsh-export --binary a.inp t.tm
    [[ "$stderr" == 'gmsh-export: --binary: only msh4 and msh2 can be binary, not inp'* ]]
    run -2 gmsh-export
    run -4 gmsh-export nowhere/a.msh t.tm
    [ -e /dev/full ] || return 0
    run -4 --separate-stderr sh -c 'gmsh-export -q --format msh4 - t.tm >/dev/full'
    [[ "$stderr" == *'No space left on device' ]]
}

@test "cells that a format does not have are refused, and polyhedra by all" {
    solids >s.tm
    for format in mesh inp unv; do
        run -3 --separate-stderr gmsh-export -q "a.$format" s.tm
        [[ "$stderr" == "gmsh-export: s.tm: .mix: has 1 pyramids, which Gmsh does not write to the format $format (msh4 has them)" ]]
        [ ! -e "a.$format" ]
    done
    for format in bdf su2 key; do
        gmsh-export -q "a.$format" s.tm
    done
    [ "$(grep -cE '^C(HEXA|PYRAM|PENTA|TETRA)' a.bdf)" -eq 4 ]
    grep -qx 'NELEM= 4' a.su2
    [ "$(sed -n '/^NELEM/,/^NPOIN/p' a.su2 | grep -cE '^1[0-4] ')" -eq 4 ]
    boxes 2 >b.tm
    run -3 --separate-stderr gmsh-export a.msh b.tm
    [[ "$stderr" == *'b.tm: holds polyhedra (.cell), but gmsh-export takes points'* ]]
}

@test "corners that are one in the digits of a format are told" {
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '0 1e6 0 0' '1 1000000.001 0 0' '2 1e6 1 0' \
        '3 1e6 0 1' .ele '1 4 0' '0 0 1 2 3' .end >far.tm
    for format in bdf key mesh msh; do
        run -0 --separate-stderr gmsh-export "far.$format" far.tm
        if [ "$format" = bdf ]; then
            [ "$stderr" = 'gmsh-export: far.tm: 1 of 1 tetrahedra have two corners that are one in the 9 digits of the file' ]
        else
            [ "$stderr" = "" ]
        fi
    done
}
