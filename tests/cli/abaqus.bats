# SPDX-License-Identifier: GPL-3.0-or-later
# abaqus-import and abaqus-export: what one writes the other reads; files of Gmsh, meshio
# and hand-written ones; CalculiX reads ours; damaged files are refused.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers
load import

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# A mesh of import.bash without its edges, and with its faces in the order of their nodes.
meshes_without_edges() {
    meshes "$@" | sed '/^\.edge/,/^1 1 2 32/d' | without_attributes >whole.tm
    in_order whole.tm
}

# Sorts the rows of .face and .facet, which the format does not keep in order.
in_order() {
    python3 - "$1" <<'END'
import sys
block, rows, head = None, [], True
for line in open(sys.argv[1], encoding='utf-8'):
    if line[0] == '.' and rows:
        rows.sort(key=lambda r: (sorted(r[3:-1] if block == '.facet' else r[:-1]), r))
        for i, r in enumerate(rows):
            print(i + base, *r)
        rows = []
    if line[0] == '.':
        block, head = line.strip(), True
        print(line, end='')
    elif block in ('.face', '.facet') and not head:
        number, *row = map(int, line.split())
        base = number if not rows else base
        rows.append(row)
    else:
        head = False
        print(line, end='')
END
}

# back FILE.inp: what abaqus-import makes of it, in the same order; as it is in read.tm.
back() {
    abaqus-import -q "$1" >read.tm
    in_order read.tm
}

# Four nodes, for files that go on behind them: corner LINE…
corner() {
    printf '%s\n' '*NODE' '1, 0, 0, 0' '2, 1, 0, 0' '3, 0, 1, 0' '4, 0, 0, 1' "$@"
}

# The names of a stream, without their numbers.
names() {
    rows .group "$1" | cut -d ' ' -f 2- | sort
}

# The last number of each row of a block, on one line.
last() {
    rows "$1" "$2" | awk '{ printf "%s ", $NF }'
}

@test "what abaqus-export writes comes back: nodes, elements, markers, regions, names" {
    local kind
    for kind in tetrahedra mixed hexahedra surface points; do
        meshes_without_edges $kind >$kind.tm
        abaqus-export -q -o $kind.inp $kind.tm
        back $kind.inp >back.tm
        same_mesh $kind.tm back.tm
        # and once more the same bytes
        abaqus-export -q read.tm | cmp - $kind.inp
        abaqus-export -q -j 2 $kind.tm | cmp - $kind.inp
    done
    # and what was compared can differ
    sed 's/, S1$/, S2/' tetrahedra.inp >other.inp
    back other.inp >back.tm
    run -1 same_mesh tetrahedra.tm back.tm
}

@test "the same with other line ends, in small letters, with lines that go on" {
    meshes_without_edges mixed 2 | abaqus-export -q -o whole.inp
    abaqus-import -q --no-history whole.inp >whole.tm
    sed 's/$/\r/' whole.inp >crlf.inp
    tr '\n' '\r' <whole.inp >cr.inp
    sed '/^\*\*/!s/.*/\L&/' whole.inp >small.inp
    sed '/^\*[A-Z]/s/,/ ,\n/' whole.inp >long.inp
    sed '/^[0-9]/s/, */ ,\t/g' whole.inp >blanks.inp
    for file in crlf cr small long blanks; do
        run -1 cmp -s $file.inp whole.inp
        abaqus-import -q --no-history $file.inp | cmp - whole.tm
    done
}

@test "numbers: all bits come back, and CalculiX can read twenty letters of each" {
    cat >numbers.tm <<'END'
termesh 1
.node
6 3 0 0
1 1.2345678901234568e-300 -3.3333333333333334e-8 1e-9
2 1.2345678901234567e30 -1.2345678901234566e25 1e22
3 0.1 5e-324 1e-7
4 2.2250738585072014e-308 1 0.0033333333333333335
5 -3.333333333333333e-4 -0 -1.2345678901234567e20
6 123456.78901234567 -1.2345678901234567 9007199254740992
.end
END
    abaqus-export -o numbers.inp numbers.tm
    abaqus-import --no-history numbers.inp >back.tm
    python3 - <<'END'
read = lambda name: [[float(x) for x in line.split()] for line in open(name) if line.count(' ') == 3]
a, b = read('numbers.tm')[1:], read('back.tm')[1:]
assert len(a) == 6 and repr(a) == repr(b), (a, b)
rows = [line.split(', ')[1:] for line in open('numbers.inp') if line[0] in '123456']
for row, x in zip(rows, a):
    for text, number in zip(row, x[1:]):
        seen = float(text.strip()[:20])
        assert abs(seen - number) <= max(1e-15 * abs(number), 1e-17), (text, number)
END
    printf '%s\n' '*NODE' '1, 1.5D-3, -2d2, 0.1E+01' '2, 1., .5' '3, , , 3' >fortran.inp
    abaqus-import --no-history fortran.inp >fortran.tm
    [ "$(rows .node fortran.tm)" = "1 0.0015 -200 1
2 1 0.5 0
3 0 0 3" ]
}

@test "ids with gaps and in any order; rows that go on; types of all orders" {
    cat >gaps.inp <<'END'
*HEADING
a line of words, which is no data of ours
** a comment
*NODE, NSET=Nall
 900000000, 0, 0, 1
 7, 1, 0, 0
 20, 0, 1, 0
 3, 0, 0, 0
 1, 1, 1, 1

 50, .5, 0, 0
 51, .5, .5, 0
 52, 0, .5, 0
 53, 0, 0, .5
 54, .5, 0, .5
 55, 0, .5, .5
*MATERIAL, NAME=x
1, 2, 3
*Element, type = C3D10M ,
 elset = "two words"
 8, 3, 7, 20,
 900000000,
 50, 51, 52, 53, 54, 55
*ELEMENT, TYPE=STRI65, ELSET=bottom
 4, 3, 20, 7, 52, 51, 50
*ELEMENT, TYPE=B32, ELSET=beam
 5, 3, 50, 7
*ELEMENT, TYPE=MASS, ELSET=m
 99, 1
END
    run -0 --separate-stderr abaqus-import -o gaps.tm gaps.inp
    [[ "$stderr" == *"6 nodes of 3 elements of second order, of which the corners are taken: left out"* ]]
    [[ "$stderr" == *"1 elements of other types (MASS): left out"* ]]
    [ "$(rows .node gaps.tm)" = "1 1 1 1
2 0 0 0
3 1 0 0
4 0 1 0
5 0 0 1" ]
    [ "$(rows .ele gaps.tm) $(rows .face gaps.tm) $(rows .edge gaps.tm)" = \
        "1 2 3 4 5 1 1 2 4 3 1 1 2 3 1" ]
    [ "$(names gaps.tm)" = "1 1 beam
2 1 bottom
3 1 two words" ]
    run -3 abaqus-import --strict gaps.inp
}

@test "every shape: its faces S1 to S6, right-handed" {
    python3 - <<'END'
# corners in Abaqus' order, and its faces (Elements Guide)
shapes = {
    4: ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], 'C3D4', [(1, 2, 3), (1, 4, 2), (2, 4, 3), (3, 4, 1)]),
    5: ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (.5, .5, 1)], 'C3D5',
        [(1, 2, 3, 4), (1, 5, 2), (2, 5, 3), (3, 5, 4), (4, 5, 1)]),
    6: ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)], 'C3D6',
        [(1, 2, 3), (4, 6, 5), (1, 4, 5, 2), (2, 5, 6, 3), (3, 6, 4, 1)]),
    8: ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], 'C3D8R',
        [(1, 2, 3, 4), (5, 8, 7, 6), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 8, 4), (4, 8, 5, 1)])}
for k, (x, name, faces) in shapes.items():
    with open('shape%d.inp' % k, 'w') as f:
        print('*NODE', file=f)
        for i, p in enumerate(x):
            print(i + 1, *p, sep=', ', file=f)
        print('*ELEMENT, TYPE=%s\n1, ' % name + ', '.join(str(i + 1) for i in range(k)), file=f)
        for i, face in enumerate(faces):
            print('*SURFACE, NAME=F%d, TYPE=ELEMENT\n1, S%d' % (i + 1, i + 1), file=f)
    with open('shape%d.faces' % k, 'w') as f:
        for i, face in enumerate(faces):
            print(i + 1, *sorted(face), file=f)
END
    for k in 4 5 6 8; do
        run -0 --separate-stderr abaqus-import --no-history -o shape.tm shape$k.inp
        [ "$stderr" = "" ]
        mesh-check -q shape.tm
        jens-stats --json j.json shape.tm
        [ "$(json j.json negative)" = 0 ]
        if [ $k = 4 ]; then rows .face shape.tm | cut -d ' ' -f 2-; else
            rows .facet shape.tm | cut -d ' ' -f 5-; fi >faces
        python3 -c 'for line in open("faces"):
    *nodes, marker = map(int, line.split())
    print(marker, *sorted(nodes))' | sort | diff - shape$k.faces
    done
}

@test "sets: GENERATE, sets of sets, of nodes of elements, in several, all, internal ones" {
    corner '5, 1, 1, 1' '*ELEMENT, TYPE=C3D4, ELSET=base' '1, 1, 2, 3, 4' '2, 2, 3, 4, 5' \
        '*ELSET, ELSET=all, GENERATE' '1, 9' '*ELSET, ELSET=left' '1,' '*ELSET, ELSET=both' \
        'LEFT, 2' '*ELSET, ELSET=right' '2' '*ELSET, ELSET=Right' 2 '*ELSET, ELSET=more' right \
        '*ELSET, ELSET=_inner' 1 '*ELSET, ELSET=hidden, INTERNAL' 1 \
        '*NSET, NSET=ends, GENERATE' '1, 5, 4' '*NSET, NSET=of, ELSET=left' \
        '*NSET, NSET=left' '3, 4' >sets.inp
    run -0 --separate-stderr abaqus-import -o sets.tm sets.inp
    [[ "$stderr" == *"2 markers and regions stand for more than one set"* ]]
    [ "$(last .ele sets.tm)" = "1 4 " ]
    [ "$(last .node sets.tm)" = "3 2 2 2 1 " ]
    [ "$(names sets.tm)" = "0 1 ends
0 2 of
0 3 ends + of
3 1 left
3 2 right
3 3 more
3 4 right + more" ]
    # a section makes a set count
    { cat sets.inp && printf '%s\n' '*SOLID SECTION, ELSET=hidden, MATERIAL=x' '1.,'; } |
        abaqus-import -q >section.tm
    names section.tm | grep -qF 'left + hidden'
    { cat sets.inp && printf '%s\n' '*SOLID SECTION, ELSET=all, MATERIAL=x' '1.,'; } |
        abaqus-import -q >section.tm
    names section.tm | grep -qF 'all + left'
    abaqus-export section.tm | grep -A1 'ELSET=all' | grep '^1, 2$'
    # but Eall
    { sed 's/=all/=EALL/' sets.inp && printf '%s\n' '*SOLID SECTION, ELSET=EALL, MATERIAL=x' '1.,'; } |
        abaqus-import -q --no-history | diff - <(abaqus-import -q --no-history sets.inp)
    # everything, and nothing else, is a region
    corner '*ELEMENT, TYPE=C3D4, ELSET=only' '1, 1, 2, 3, 4' | abaqus-import -q >only.tm
    [ "$(names only.tm)" = "3 1 only" ]
    corner '*ELEMENT, TYPE=C3D4, ELSET=EALL' '1, 1, 2, 3, 4' | abaqus-import -q >all.tm
    [ "$(rows .ele all.tm)" = "1 1 2 3 4" ]
}

@test "sets of sets that go round end, those of a great many are fast, deep ones refused" {
    corner '*NSET, NSET=a' 'b, 1' '*NSET, NSET=b' 'a, 2' | abaqus-import -q >round.tm
    [ "$(last .node round.tm)" = "3 3 0 0 " ]
    { corner '*NSET, NSET=s0' 1; for i in $(seq 60); do
        printf '%s\n' "*NSET, NSET=s$i" "s$((i - 1)), s$((i - 1)), $((i % 4 + 1))"; done; } |
        timeout 20 abaqus-import -q >twice.tm
    [ "$(header .node twice.tm)" = "4 3 0 1" ]
    { corner '*NSET, NSET=s0' 1; for i in $(seq 120); do
        printf '%s\n' "*NSET, NSET=s$i" "s$((i - 1)),"; done; } >deep.inp
    run -3 --separate-stderr abaqus-import deep.inp
    [[ "$stderr" == "abaqus-import: deep.inp:"*"more than 100 sets, each in another, down to 's"* ]]
}

@test "surfaces: of sets, with a set's name, of shells, of nodes; what is none is counted" {
    corner '*ELEMENT, TYPE=C3D4, ELSET=solid' '1, 1, 2, 3, 4' '*ELEMENT, TYPE=S3, ELSET=skin' \
        '2, 1, 2, 4' '*SURFACE, NAME=low' 'solid, S1' '*SURFACE, NAME=skin' '1, S2' '1, S3' \
        '*SURFACE, NAME=shell' 'skin, SPOS' '*SURFACE, NAME=bad' '1, S5' '1' '2, E1' \
        '*SURFACE, NAME=spots, TYPE=NODE' '1, 1.' 'corner,' '*NSET, NSET=corner' 4 \
        '*SURFACE, NAME=cut, TYPE=CUTTING SURFACE' '1, 2, 3' '*SOLID SECTION, ELSET=solid' \
        >surfaces.inp
    run -0 --separate-stderr abaqus-import -o surfaces.tm surfaces.inp
    [[ "$stderr" == *"3 rows of surfaces that name no face of an element: left out"* ]]
    [[ "$stderr" == *"1 surfaces that are not of elements or nodes: left out"* ]]
    [ "$(names surfaces.tm)" = "0 1 spots
0 2 corner
0 3 spots + corner
2 1 low
2 2 skin
2 3 shell
2 4 skin + shell
3 1 solid" ]
    [ "$(last .face surfaces.tm)" = "4 1 2 " ]
    # a set and a surface of one name are one group
    corner '*ELEMENT, TYPE=C3D4' '1, 1, 2, 3, 4' '*ELEMENT, TYPE=S3, ELSET=Skin' '2, 1, 2, 4' \
        '*SURFACE, NAME=other' '1, S2' '*SURFACE, NAME=SKIN' '1, S2' '1, S3' | abaqus-import -q >one.tm
    [ "$(names one.tm)" = "2 1 Skin
2 2 other
2 3 Skin + other" ]
    [ "$(last .face one.tm)" = "3 1 " ]
}

# A part with a tetrahedron, and an assembly that has it once.
assembly() {
    cat <<'END'
*Part, name=Box
*Node
  10,  0., 0., 0.
  20, 1., 0.
  7,  0., 1., 0.
  3,  0., 0., 1.
*Element, type=C3D4
101, 10, 20, 7, 3
*Nset, nset=top
 3,
*Elset, elset=top, generate
 1, 200, 1
*End Part
*Assembly, name=Assembly
*Instance, name=Box-1, part=Box
*End Instance
END
}

@test "a part and its instance: names, sets and surfaces of the assembly" {
    { assembly && printf '%s\n' '*Elset, elset=_low_S1, internal, instance=Box-1' ' 101,' \
        '*Surface, type=ELEMENT, name=low' '_low_S1, S1' '*Nset, nset=fix, instance=Box-1' \
        ' top, 10' '*End Assembly'; } | abaqus-import >one.tm
    [ "$(rows .node one.tm)" = "1 0 0 1 1
2 0 1 0 0
3 0 0 0 1
4 1 0 0 0" ]
    [ "$(names one.tm)" = "0 1 fix
2 1 low
3 1 top" ]
    # a part alone stands where it is; an instance may have the mesh itself
    assembly | sed '/^.Assembly/,$d' | abaqus-import --no-history >part.tm
    { echo '*Instance, name=Box-1, part=None'; assembly | sed '1d; /^.End Part/,$d';
        echo '*End Instance'; } | abaqus-import --no-history | cmp - part.tm
    [ "$(rows .ele part.tm)" = "1 3 4 2 1 1" ]
}

@test "several instances: moved and turned, one mesh" {
    { assembly && printf '%s\n' '*Instance, name=Box-2, part=Box' '5., 0., 0.' \
        '5., 0., 0., 5., 0., 1., 90.' '*End Instance' '*Node' '1, 9, 9, 9' '*Nset, nset=RP' '1,' \
        '*Surface, type=ELEMENT, name=side' 'Box-1.101, S4' 'Box-2.101, S2' '*End Assembly'; } >two.inp
    run -0 --separate-stderr abaqus-import -o two.tm two.inp
    [ "$stderr" = "abaqus-import: two.inp: 2 instances are one mesh" ]
    [ "$(names two.tm)" = "0 1 RP
2 1 side
3 1 Box-1.top
3 2 Box-2.top" ]
    [ "$(header .node two.tm) $(header .ele two.tm) $(header .face two.tm)" = "9 3 0 1 2 4 1 2 1" ]
    # the second corner of the second is beside the first, in the direction of y
    rows .node two.tm | awk '$1 == 8 && $2 == 5 && $3 == 0 || $1 == 9 && $2 == 5 && $3 == 1 { n++ }
        END { exit n != 2 }'
    [ "$(last .ele two.tm)" = "1 2 " ]
    sed 's/part=Box/part=None/' two.inp >none.inp
    run -3 --separate-stderr abaqus-import none.inp
    [ "$stderr" = "abaqus-import: none.inp:15: there is no part 'None'" ]
}

@test "what is not read is refused by name" {
    local text
    is_refused() {
        corner "$@" >refused.inp
        run -3 --separate-stderr abaqus-import refused.inp
        [ "$output" = "" ]
    }
    is_refused '*INCLUDE, INPUT=mesh.msh'
    [ "$stderr" = "abaqus-import: refused.inp:6: *INCLUDE: another file is not read (put it in here): mesh.msh" ]
    is_refused '*ELEMENT, TYPE=C3D4, INPUT=rows.txt'
    [[ "$stderr" == *"*ELEMENT: its data are in another file, which is not read (put it in here): rows.txt" ]]
    for text in '*NGEN, NSET=a' '*ELGEN' '*NCOPY, CHANGE NUMBER=5' '*SYSTEM'; do
        is_refused "$text" '1, 2, 3'
        [[ "$stderr" == *"only nodes and elements that are listed are read" ]]
    done
    is_refused '*NODE, SYSTEM=C' '9, 1, 90, 0'
    [[ "$stderr" == *"only rectangular coordinates are read, not SYSTEM=C" ]]
    is_refused '*ELEMENT, TYPE=C3D4' '1, 1, 2, 3, 9'
    [ "$stderr" = "abaqus-import: refused.inp: element 1: there is no node 9" ]
    is_refused '*ELEMENT, TYPE=C3D4' '1, 1, 2, 3, 4' '1, 1, 2, 3, 4'
    [ "$stderr" = "abaqus-import: refused.inp: element 1 is there twice" ]
    is_refused '*NODE' '2, 1, 0, 0'
    [ "$stderr" = "abaqus-import: refused.inp: node 2 is there twice" ]
    is_refused '*ELEMENT, TYPE=C3D4' '1, 1, 2, 3' '*NSET, NSET=a' '1'
    [ "$stderr" = "abaqus-import: refused.inp:8: element 1 ends behind 3 nodes (it has 4)" ]
    is_refused '*NSET, NSET=a' 'b,'
    [ "$stderr" = "abaqus-import: refused.inp:7: there is no set 'b'" ]
    is_refused '*ELEMENT' '1, 1, 2, 3, 4'
    [ "$stderr" = "abaqus-import: refused.inp:6: *ELEMENT: has no TYPE" ]
    # members that are not there are counted
    corner '*NSET, NSET=a' '1, 9, 10' >missing.inp
    run -0 --separate-stderr abaqus-import -o missing.tm missing.inp
    [ "$stderr" = "abaqus-import: missing.inp: 2 members of sets that are not there: left out" ]
}

@test "names that a set cannot have: others in their place, and the right ones come back" {
    printf '%s\n' 'termesh 1' .node '6 3 0 1' '1 0 0 0 1' '2 1 0 0 2' '3 0 1 0 3' '4 0 0 1 4' \
        '5 2 0 0 5' '6 3 0 0 0' .group '7 0' '1 0 1 wall' '2 0 2 WALL' '3 0 3 äußere Wand' '4 0 4 9' \
        '5 0 5 Nall' '6 0 0 none' '7 3 8 nobody' .end >names.tm
    abaqus-export --strict -o names.inp names.tm
    sed -n 's/^\*NSET, NSET=//p' names.inp >sets
    [ "$(tr '\n' ' ' <sets)" = "none WALL wall_1 Node__u__ere_Wand_3 Node9_4 Nall_5 " ] ||
        [ "$(tr '\n' ' ' <sets)" = "none wall WALL_2 Node__u__ere_Wand_3 Node9_4 Nall_5 " ]
    [ "$(tr '[:lower:]' '[:upper:]' <sets | sort | uniq -d)" = "" ]
    abaqus-import -q names.inp | sed -n '/^\.node/,$p' | diff <(sed -n '/^\.node/,$p' names.tm) -
    printf 'termesh 1\n.node\n1 3 0 1\n1 0 0 0 1\n.group\n1 0\n1 0 1 %0200d\n.end\n' 7 |
        abaqus-export >long.inp
    grep -E '^\*NSET, NSET=Node0{10,}_1$' long.inp
    [ "$(grep '^\*NSET' long.inp | wc -L)" -le 92 ] # a name of 80
}

@test "names that are the same in several dimensions, or once they are set's names" {
    for seed in $(seq 40); do
        python3 - "$seed" >names.tm <<'END'
import random, sys
random.seed(int(sys.argv[1]))
values = [random.sample(range(1, 30), 4) for _ in range(4)]
print('termesh 1\n.node\n4 3 0 1')
for i, xyz in enumerate(('0 0 0', '1 0 0', '0 1 0', '0 0 1')):
    print(i + 1, xyz, values[0][i])
print('.ele\n1 4 1\n1 1 2 3 4', values[3][0])
print('.face\n4 1')
for i, face in enumerate(('1 3 2', '1 2 4', '2 3 4', '3 1 4')):
    print(i + 1, face, values[2][i])
rows = []
for d, here in enumerate((values[0], [], values[2], values[3][:1])):
    pool = ['a b', 'a_b', 'a/b', 'A_B', 'part', 'Part', 'x' * 79, 'x' * 78 + '-', '9', 'Face9']
    for v in here:
        pool += [f'a_b_{v}', f'a_b_{v}_{v}', f'part_{v}', 'x' * 65 + f'_{v}', f'Face9_{v}']
    for v, name in zip(here, random.sample(pool, len(here))):
        if random.random() < .9:
            rows.append(f'{d} {v} {name}')
print('.group\n%d 0' % len(rows))
for i, row in enumerate(rows):
    print(i + 1, row)
print('.end')
END
        abaqus-export --strict -o names.inp names.tm
        run -0 --separate-stderr abaqus-import -o read.tm names.inp
        [ "$stderr" = "" ]
        in_order read.tm >back.tm
        in_order names.tm >right.tm
        same_mesh right.tm back.tm
        for kind in '*NSET, NSET=' '*ELSET, ELSET=' '*SURFACE, TYPE=ELEMENT, NAME='; do
            [ "$(sed -n "s/^$kind//p" names.inp | tr '[:lower:]' '[:upper:]' | sort | uniq -d)" = "" ]
        done
    done
}

@test "what is in several sets is in each of them, and its value comes back" {
    for seed in $(seq 12); do
        python3 - "$seed" >several.tm <<'END'
import json, random, sys
random.seed(int(sys.argv[1]))
names, values, sets = {}, {}, {}
for d in (0, 2, 3):
    pool = random.sample(range(1, 40), 9)
    single = {v: random.choice(['s%d', 'S %d', 'a+b%d', None]) for v in pool[:4]}
    single = {v: n and n % v for v, n in single.items()}
    joined = {v: random.sample(pool[:4], random.randint(2, 4)) for v in pool[4:]}
    names[d] = {v: n for v, n in single.items() if n}
    seen = set()
    for v, of in joined.items():
        if frozenset(of) not in seen:
            names[d][v] = ' + '.join(single[g] or str(g) for g in of)
            seen.add(frozenset(of))
    # at times all are in one of the sets
    all = [v for v in joined if v in names[d] and pool[0] in joined[v]] + pool[:1]
    any = list(names[d]) + pool[:4] + [0]
    values[d] = random.choices(all if random.random() < .3 else any, k=12)
    for i, v in enumerate(values[d]):
        for g in joined[v] if v in joined and v in names[d] else [v] if v else []:
            sets.setdefault('%d %d' % (d, g), []).append(i + 1)
n = 12
print('termesh 1\n.node\n%d 3 0 1' % n)
for i in range(n):
    print(i + 1, i, i * i, i ** 3, values[0][i])
print('.ele\n%d 4 1' % (n - 3))
for i in range(n - 3):
    print(i + 1, i + 1, i + 2, i + 3, i + 4, values[3][i])
print('.face\n%d 1' % (n - 3))
for i in range(n - 3): # the one without its third node: no other tetrahedron has it
    print(i + 1, i + 1, i + 2, i + 4, values[2][i])
rows = ['%d %d %s' % (d, v, name) for d in names for v, name in names[d].items()]
print('.group\n%d 0' % len(rows))
for i, row in enumerate(rows):
    print(i + 1, row)
print('.end')
limit = {'0': n, '2': n - 3, '3': n - 3}
sets = {k: [i for i in v if i <= limit[k[0]]] for k, v in sets.items()}
json.dump({k: v for k, v in sets.items() if v}, open('sets.json', 'w'))
END
        abaqus-export --strict -o several.inp several.tm
        python3 - <<'END'
import json
right, found, key = json.load(open('sets.json')), {}, None
for line in open('several.inp'):
    if line.startswith('** termesh ') and len(line.split()) == 4:
        key = ' '.join(line.split()[2:])
        assert key not in found, key
        found[key] = []
    elif not line.startswith('*') and key:
        found[key] += line.split(',')[:1] if key[0] == '2' else line.split(',')
found = {k: sorted(int(i) for i in v if i.strip()) for k, v in found.items()}
assert found == right, (found, right)
END
        run -0 --separate-stderr abaqus-import -o read.tm several.inp
        [ "$stderr" = "" ]
        in_order read.tm >back.tm
        in_order several.tm >right.tm
        same_mesh right.tm back.tm
    done
}

@test "Gmsh's files: entities without a group, and groups by name" {
    load gmsh
    need_gmsh
    two_geo
    by_gmsh two.inp -save_all
    by_gmsh two.msh
    abaqus-import -q two.inp >entities.tm
    mesh-check --json check.json entities.tm >/dev/null
    [ "$(json check.json volume)" = 2 ]
    gmsh-import -q two.msh >two.tm
    gmsh-export -q part.inp two.tm
    abaqus-import -q part.inp >back.tm
    [ "$(names back.tm)" = "1 1 rim
2 1 wall
2 2 between
3 1 left_half
3 2 right" ]
    for block in .ele .face .edge; do
        [ "$(header $block back.tm)" = "$(header $block two.tm)" ]
    done
    mesh-check --json back.json back.tm >/dev/null
    [ "$(json back.json volume)" = 2 ]
}

@test "meshio reads ours, and we read what it writes" {
    need_meshio
    meshes_without_edges tetrahedra | abaqus-export -q -o ours.inp
    "$vtk_python" - <<'END'
import meshio, numpy as np
mesh = meshio.read('ours.inp')
assert len(mesh.points) == 64 and [(c.type, len(c.data)) for c in mesh.cells] == [('tetra', 162)]
assert len(mesh.cell_sets['solid'][0]) == 108 and len(mesh.cell_sets['Region_-3'][0]) == 54
x = mesh.points[mesh.cells[0].data]
volume = np.linalg.det(x[:, 1:] - x[:, :1]).sum() / 6
assert abs(volume - 1) < 1e-12, volume
points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]) / 3
none = np.array([], int)
mesh = meshio.Mesh(points, [('hexahedron', np.arange(8).reshape(1, 8)), ('quad', np.array([[0, 3, 2, 1]]))],
                   cell_sets={'Steel': [np.array([0]), none], 'low': [none, np.array([0])]},
                   point_sets={'fix': np.array([0, 3])})
meshio.write('theirs.inp', mesh)
END
    abaqus-import -q theirs.inp >theirs.tm
    [ "$(rows .mix theirs.tm) $(rows .facet theirs.tm)" = "1 8 1 2 3 4 5 6 7 8 1 1 1 -1 4 1 4 3 2 1" ]
    [ "$(names theirs.tm)" = "0 1 fix
2 1 low
3 1 Steel" ]
    [ "$(rows .node theirs.tm | head -n 2)" = "1 0 0 0 1
2 0.3333333333333333 0 0 0" ]
}

@test "CalculiX computes on ours: regions, surfaces and nodes by name" {
    command -v ccx >/dev/null || skip "there is no CalculiX (ccx)"
    for kind in tetrahedra hexahedra; do
        meshes_without_edges $kind 2 | abaqus-export -q -o mesh.inp
        { cat mesh.inp && cat <<'END'; } >job.inp
*MATERIAL, NAME=M
*ELASTIC
210000, .3
*SOLID SECTION, ELSET=Eall, MATERIAL=M
*BOUNDARY
Nall, 1, 3
*STEP
*STATIC
*DSLOAD
inlet_100__11, P, 2
*EL PRINT, ELSET=solid, TOTALS=ONLY
EVOL
*EL PRINT, ELSET=Region_-3, TOTALS=ONLY
EVOL
*NODE PRINT, NSET=spots_of_interest_3
U
*END STEP
END
        ccx job >ccx.log 2>&1
        run -1 grep ERROR ccx.log
        awk '/^ total volume for set (SOLID|REGION_-3)/ { getline; getline; sum += $1; n++ }
            /^ displacements .* SPOTS_OF_INTEREST_3/ { found = 1 }
            END { exit !(n == 2 && found && sum > 0.29629 && sum < 0.29630) }' job.dat
    done
}

@test "damaged files: never a crash, a hang, or much memory" {
    for kind in mixed tetrahedra; do
        meshes_without_edges $kind 2 | abaqus-export -q -o $kind.inp
        damage abaqus-import $kind.inp
    done
    { assembly && printf '%s\n' '*Instance, name=Box-2, part=Box' '5., 0., 0.' \
        '5., 0., 0., 5., 0., 1., 90.' '*End Instance' '*Elset, elset=c, instance=Box-1' 'top, 101' \
        '*Surface, type=ELEMENT, name=low' 'c, S1' 'Box-2.top, S2'; } >assembly.inp
    damage abaqus-import assembly.inp 200 '*End Part'
}
