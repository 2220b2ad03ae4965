# SPDX-License-Identifier: GPL-3.0-or-later
# visf-export and visf-import: what the viewers read, and that one gives back what the
# other was given.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    cubes 0 >cubes.tm
    # what ViSF does not have: attributes, markers, history
    sed -e 's/^11 1$/11 0/; s/^2 1$/2 0/' -e '/^\.facet/,/^\.cell/s/^\([0-9]* -*[0-9]* '\
'-*[0-9]* 4 .*\) [0-9]*$/\1/' -e '/^\.cell/,$s/^\([0-9] 6 .*\) [0-9]*$/\1/' cubes.tm >plain.tm
    cat >cubes.visf <<'END'
2 2
12
0 0 0
1 0 0
2 0 0
0 1 0
1 1 0
2 1 0
0 0 1
1 0 1
2 0 1
0 1 1
1 1 1
2 1 1
11
4 0 6 9 3
4 0 1 7 6
4 3 9 10 4
4 0 3 4 1
4 6 7 10 9
4 1 4 10 7
4 1 2 8 7
4 4 10 11 5
4 1 4 5 2
4 7 8 11 10
4 2 5 11 8
0
2
6 0 1 2 3 4 5
6 5 6 7 8 9 10
END
}

# decode FILE: a binary ViSF file as the text that says the same.
decode() {
    python3 - "$1" <<'END'
import struct, sys
data = open(sys.argv[1], 'rb').read()
order = '>' if data[:1] in b'0\0' else '<'
at = 1

def take(form, count):
    global at
    values = struct.unpack_from('%s%d%s' % (order, count, form), data, at)
    at += 4 * count
    return values

def lists(count):
    for i in range(count):
        k, = take('i', 1)
        print(k, *take('i', k))

kind, nodes = take('i', 2)
print(2, kind)
print(nodes)
for v in range(nodes):
    print(*('%.9g' % x for x in take('f', 3)))
if kind > 0:
    polygons, = take('i', 1)
    print(polygons)
    lists(polygons)
    flag, = take('i', 1)
    print(flag)
    if flag:
        lists(polygons)
if kind > 1:
    cells, = take('i', 1)
    print(cells)
    lists(cells)
assert at == len(data), (at, len(data))
END
}

@test "polyhedra: the text that both viewers read" {
    visf-export cubes.tm | cmp - cubes.visf
    # numbered from 1 it is the same file
    cubes 1 | visf-export - | cmp - cubes.visf
}

@test "per cell: each polygon once for each cell, outward" {
    visf-export --per-cell cubes.tm >per-cell.visf
    { sed -n '1,14p' cubes.visf; echo 12; sed -n '16,21p' cubes.visf; echo 4 7 10 4 1
        sed -n '22,26p' cubes.visf; printf '0\n2\n6 0 1 2 3 4 5\n6 6 7 8 9 10 11\n'; } |
        cmp - per-cell.visf
}

@test "neighbours: the polygons with an edge in common, per cell those of the cell" {
    visf-export --neighbours cubes.tm >near.visf
    [ "$(sed -n 27p near.visf)" = 1 ]
    sed -n '28,38p' near.visf | awk '{ $1 = ""; print }' |
        while read -r line; do echo "$line" | tr ' ' '\n' | sort -n | xargs; done >near
    # polygon 5 is between the cubes: all four sides of both are at its edges
    [ "$(sed -n 6p near)" = '1 2 3 4 6 7 8 9' ]
    [ "$(sed -n 1p near)" = '1 2 3 4' ]
    [ "$(sed -n 2p near)" = '0 3 4 5 6' ]
    visf-export --neighbours --per-cell cubes.tm >near.visf
    [ "$(sed -n '29,40s/ .*//p' near.visf | sort -u)" = 4 ]
    # whoever is my neighbour, has me
    sheared_boxes 3 | visf-export --neighbours >boxes.visf
    awk 'NR == 2 { nodes = $1 } NR == nodes + 3 { polygons = $1 }
        NR > 2 && NR > nodes + polygons + 4 && NR <= nodes + 2 * polygons + 4 {
            p = NR - nodes - polygons - 5
            for (i = 2; i <= NF; i++) has[p, $i]++
        }
        END { for (pair in has) {
            split(pair, x, SUBSEP); pairs++
            if (has[pair] != 1 || has[x[2], x[1]] != 1 || x[1] == x[2]) exit 1
        } exit pairs < 500 }' boxes.visf
}

@test "binary files, in either order, say what the text says" {
    sheared_boxes 3 >boxes.tm
    for options in '' --neighbours --per-cell '--neighbours --per-cell'; do
        for order in little big; do
            # shellcheck disable=SC2086 # words
            visf-export $options boxes.tm >text.visf
            # shellcheck disable=SC2086 # words
            visf-export --binary "$order" $options boxes.tm >binary.visf
            decode binary.visf >decoded
            cmp <(sed '3,66d' text.visf) <(sed '3,66d' decoded)
            paste <(sed -n '3,66p' text.visf) <(sed -n '3,66p' decoded) | awk '
                { for (i = 1; i <= 3; i++) if (($i - $(i + 3)) ^ 2 > 1e-12) exit 1 }'
        done
    done
    [ "$(visf-export --binary big boxes.tm | head -c 5 | od -An -tx1)" = ' 30 00 00 00 02' ]
    [ "$(visf-export --binary little boxes.tm | head -c 5 | od -An -tx1)" = \
        ' 31 02 00 00 00' ]
}

@test "points, a surface, tetrahedra, mixed elements" {
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' \
        '4 0 0 0.33333333333333331' .ele '1 4 0' '1 1 2 3 4' .face '1 1' '1 1 3 2 7' \
        .end >corner.tm
    visf-export corner.tm >corner.visf
    printf '%s\n' '2 2' 4 '0 0 0' '1 0 0' '0 1 0' '0 0 0.333333333' \
        4 '3 0 1 3' '3 1 2 3' '3 2 0 3' '3 0 2 1' 0 1 '4 0 1 2 3' | cmp - corner.visf
    sed '/^\.ele/,/^1 1 2/d' corner.tm | visf-export --per-cell >corner.visf
    printf '%s\n' '2 1' 4 '0 0 0' '1 0 0' '0 1 0' '0 0 0.333333333' 1 '3 0 2 1' 0 |
        cmp - corner.visf
    sed '/^\.ele/,/^1 1 3/d' corner.tm | visf-export --neighbours >corner.visf
    printf '%s\n' '2 0' 4 '0 0 0' '1 0 0' '0 1 0' '0 0 0.333333333' | cmp - corner.visf
    mixed | visf-export >mixed.visf
    [ "$(sed -n '1p; 15p' mixed.visf | xargs)" = '2 2 17' ]
    tail -n 4 mixed.visf | awk '{ print $1 }' | xargs | grep -x '6 5 5 4'
}

@test "import of an export is the same mesh, in all forms" {
    visf-export cubes.tm | visf-import --no-history | cmp - plain.tm
    visf-export --per-cell cubes.tm | visf-import --no-history | cmp - plain.tm
    sheared_boxes 4 0 | awk '
        /^\.end/ { print; next }
        /^\./ { block = $1; print; getline; $NF = 0; if (block == ".node") $3 = 0; print; next }
        block == ".node" { print $1, $2, $3, $4; next }
        block == ".facet" || block == ".cell" { sub(/ [^ ]*$/, "") }
        { print }' >boxes.tm
    for options in '' --neighbours '--binary little' '--binary big --neighbours'; do
        # shellcheck disable=SC2086 # words
        visf-export $options boxes.tm >boxes.visf
        visf-import --no-history boxes.visf >again.tm
        case $options in
        *binary*) # coordinates are floats
            cmp <(sed -n '/^\.facet/,$p' boxes.tm) <(sed -n '/^\.facet/,$p' again.tm) ;;
        *) cmp boxes.tm again.tm ;;
        esac
    done
    # the numbers are other ones, but once that is settled, it stays
    visf-export --per-cell boxes.tm | visf-import --no-history >per-cell.tm
    [ "$(header .facet per-cell.tm)" = "$(header .facet boxes.tm)" ]
    visf-export --per-cell per-cell.tm | visf-import --no-history | cmp - per-cell.tm
}

@test "import of surfaces and points" {
    surface sphere stream | sed '/^#/d; s/^surface//' >sphere.tm
    visf-export sphere.tm >sphere.visf
    visf-import --no-history sphere.visf >again.tm
    visf-export again.tm | cmp - sphere.visf
    [ "$(header .face again.tm)" = "$(header .face sphere.tm)" ]
    visf-export --binary little --neighbours sphere.tm >binary.visf
    visf-import --no-history binary.visf >binary.tm
    cmp <(sed -n '/^\.face/,$p' again.tm) <(sed -n '/^\.face/,$p' binary.tm)
    printf '2 0\n2\n0 0 0\n1 2.5 -3e2\n' | visf-import --no-history | cmp - <(
        printf 'termesh 1\n.node\n2 3 0 0\n0 0 0 0\n1 1 2.5 -300\n.end\n')
}

@test "import: without the flag line, with comments, on fewer lines, of the first version" {
    sed '27d' cubes.visf | visf-import --no-history | cmp - plain.tm
    visf-export --neighbours cubes.tm | sed '27s/.*/11/' | visf-import --no-history |
        cmp - plain.tm
    sed '1s/$/ # by hand/' cubes.visf | tr '\n' ' ' | sed 's/# by hand//' |
        visf-import --no-history | cmp - plain.tm
    sed '3s/$/ # the first/; 4s/$/\r/' cubes.visf | visf-import --no-history |
        cmp - plain.tm
    visf-export --binary big cubes.tm | sed '1s/^0/\x00/' | visf-import --no-history |
        cmp - plain.tm
    visf-export --binary little cubes.tm | sed '1s/^1/\x01/' >first.visf
    visf-import --no-history first.visf | cmp - plain.tm
    # a surface without the flag
    printf '2 1\n3\n0 0 0\n1 0 0\n0 1 0\n1\n3 0 1 2\n' | visf-import | grep -x '0 0 1 2'
}

@test "import: polygons that turn as they like are oriented" {
    sed -e 's/^4 0 6 9 3/4 3 9 6 0/; s/^4 1 4 10 7/4 7 10 4 1/; s/^4 2 5 11 8/4 8 11 5 2/' \
        cubes.visf >turned.visf
    run -0 --separate-stderr visf-import --no-history -o turned.tm turned.visf
    [ "$stderr" = \
        'visf-import: turned.visf: 2 polygons of the boundary were inward and are turned' ]
    # that between the cubes stays as it is, but is outward for the other one
    grep -x '5 1 0 4 7 10 4 1' turned.tm
    grep -x '0 0 -1 4 3 0 6 9' turned.tm
    vtu-export turned.tm >turned.vtu
    # polygons of no polyhedron
    sed -e '15s/11/12/; 26a 3 0 1 2' cubes.visf >more.visf
    run -0 --separate-stderr visf-import --no-history -o more.tm more.visf
    cmp more.tm plain.tm
    [ "$stderr" = 'visf-import: more.visf: 1 polygons of no polyhedron: left out' ]
    run -3 visf-import --strict -o strict.tm more.visf
    [ ! -e strict.tm ]
}

@test "import: a cell in a hollow of another one" {
    # The inner cube has its own six facets; the outer cell has those and six more.
    { echo '2 2'; echo 16
        for s in '0 3' '1 2'; do
            for z in $s; do for y in $s; do for x in $s; do echo "$x $y $z"; done; done; done
        done
        echo 12
        for o in 0 8; do
            for q in '0 2 3 1' '4 5 7 6' '0 1 5 4' '1 3 7 5' '3 2 6 7' '2 0 4 6'; do
                echo "4 $(for v in $q; do echo $((v + o)); done | xargs)"
            done
        done
        printf '0\n2\n12 0 1 2 3 4 5 6 7 8 9 10 11\n6 6 7 8 9 10 11\n'; } >hollow.visf
    visf-import hollow.visf >hollow.tm
    rows .facet hollow.tm | awk '{ print $2, $3 }' | sort | uniq -c | xargs |
        grep -x '6 0 -1 6 1 0'
    run -0 visf-import <(sed 's/^4 8 10 11 9/4 9 11 10 8/; s/^4 0 2 3 1/4 1 3 2 0/' hollow.visf)
}

@test "import: what is wrong or cannot be in a stream, exit 3" {
    refuses() {
        run -3 --separate-stderr visf-import -o out.tm file.visf
        [[ "$stderr" == "visf-import: file.visf$1"* ]]
        [ ! -e out.tm ]
    }
    echo 'OFF' >file.visf && refuses ': is no ViSF file'
    echo '2 3' >file.visf && refuses ': is no ViSF file'
    printf '2 0\n4000000\n0 0 0\n' >file.visf && refuses ':2: the number of points'
    printf '2 0\n1\n0 0 nan\n' >file.visf && refuses ":3: a z coordinate: 'nan'"
    printf '2 0\n1\n0 0 0\n7\n' >file.visf && refuses ':4: there is more behind'
    sed 's/^4 0 6 9 3/4 0 6 9 12/' cubes.visf >file.visf && refuses ':16: a number in the'
    sed 's/^4 0 6 9 3/2 0 6/' cubes.visf >file.visf && refuses ':16: the number of corners'
    sed '$s/10$/11/' cubes.visf >file.visf && refuses ':30: a number in the'
    sed 's/^6 0 1 2 3 4 5/5 0 1 2 3 4/' cubes.visf >file.visf &&
        refuses ': polyhedron 0 is not closed'
    sed 's/^6 0 1 2 3 4 5/6 0 1 2 3 4 4/' cubes.visf >file.visf &&
        refuses ': polyhedron 0 has a polygon twice'
    sed 's/^4 0 6 9 3/4 0 9 6 3/' cubes.visf >file.visf &&
        refuses ': polyhedron 0 is not closed'
    { sed 's/^2$/3/' cubes.visf; echo 6 5 6 7 8 9 10; } >file.visf &&
        refuses ': polyhedron 2 has a polygon twice, or one that two others have'
    printf '2 1\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n1\n4 0 1 2 3\n0\n' >file.visf &&
        refuses ': polygon 0 of the surface has 4 corners'
    # the second cube over the first one
    sed '5s/2/0.5/; 8s/2/.5/; 11s/2/.5/; 14s/2/.5/' cubes.visf >file.visf &&
        refuses ': polyhedra 0 and 1 are on the same side of polygon 5'
}

@test "import: a file that ends early, exit 3" {
    last=$(wc -l <cubes.visf)
    for n in $(seq 0 $((last - 1))); do
        head -n "$n" cubes.visf >short.visf
        run -3 --separate-stderr visf-import short.visf
        [ "$output" = "" ]
    done
    visf-export --binary little --neighbours cubes.tm >whole.visf
    for n in 0 1 3 5 9 20 160 400 600 $(($(wc -c <whole.visf) - 1)); do
        head -c "$n" whole.visf >short.visf
        run -3 --separate-stderr visf-import short.visf
        [ "$output" = "" ]
    done
}

@test "reports of exporters and of the importer" {
    visf-export --json report -o out.visf cubes.tm
    [ "$(cat report)" = '{"nodes": 12, "polyhedra": 2}' ]
    visf-import --json report -o out.tm out.visf
    [ "$(cat report)" = '{"nodes": 12, "polyhedra": 2}' ]
    mixed >mixed.tm
    run -0 --separate-stderr off-export --json - -o out.off mixed.tm
    [ "$stderr" = '{"nodes": 12, "elements": 4}' ]
    printf 'termesh 1\n.node\n1 3 0 0\n0 0 0 0\n.end\n' >points.tm
    run -0 --separate-stderr vtu-export --json - -o out.vtu points.tm
    [ "$stderr" = '{"nodes": 1}' ]
}

@test "who reads a ViSF file as a stream is told" {
    for options in '' '--binary little' '--binary big'; do
        # shellcheck disable=SC2086 # words
        visf-export $options cubes.tm >cubes.visf
        run -3 --separate-stderr tet-stats cubes.visf
        [[ "$stderr" == *'looks like a ViSF mesh: use visf-import' ]]
    done
}

@test "export: usage is exit 2, a wrong stream exit 3" {
    run -2 --separate-stderr visf-export --binary middle cubes.tm
    [[ "$stderr" == "visf-export: --binary: 'middle' is none of little, big"* ]]
    run -3 --separate-stderr visf-export <(printf 'termesh 1\n.end\n')
    [[ "$stderr" == *': holds nothing, but visf-export takes points '* ]]
    sed 's/^11 2 1 1$/11 2 1 1e39/' cubes.tm >far.tm
    run -3 --separate-stderr visf-export -o far.visf far.tm
    [ "$stderr" = 'visf-export: far.tm: .node: 1e+39 is too large for a 32-bit float, '\
'which ViSF has' ]
    [ ! -e far.visf ]
    { sed '/^\.ele/,$d' cubes.tm | sed '/^\.facet/,$d'
        printf '%s\n' .ele '3 4 0' '0 0 1 3 6' '1 0 1 3 7' '2 0 1 3 9' .end; } >three.tm
    run -3 --separate-stderr visf-export three.tm
    [ "$stderr" = 'visf-export: three.tm: .ele: elements 0 and 1 are on the same side of '\
'their face at nodes 0 3 1' ]
    sed -i 's/^1 0 1 3 7/1 0 1 3 2/' three.tm
    run -3 --separate-stderr visf-export three.tm
    [ "$stderr" = 'visf-export: three.tm: .ele: element 2: its face at nodes 0 3 1 has '\
'two elements already' ]
    sed -i 's/^1 0 1 3 2/1 0 1 3 3/' three.tm
    run -3 --separate-stderr visf-export three.tm
    [ "$stderr" = 'visf-export: three.tm: .ele: element 1 has a node twice' ]
}

@test "a locale with a decimal comma changes nothing" {
    sed 's/^11 2 1 1$/11 2 1.5 1/' cubes.tm >half.tm
    env LOCPATH="$(comma_locale)" LC_ALL=comma visf-export half.tm >half.visf
    grep -x '2 1.5 1' half.visf
    env LOCPATH="$(comma_locale)" LC_ALL=comma visf-import half.visf | grep -x '11 2 1.5 1'
}

@test "corners that are one in nine digits, or in floats, are told" {
    # 1e-3 apart at 1e6, and at 0; -0 is 0
    for at in 1000000 0 -0; do
        printf '%s\n' 'termesh 1' .node '4 3 0 0' "0 $at $at $at" "1 ${at#-}.001 $at $at" \
            "2 $at ${at#-}.001 $at" "3 $at $at ${at#-}.001" .ele '1 4 0' '0 0 1 2 3' .end >"$at.tm"
    done
    run -0 --separate-stderr visf-export 1000000.tm
    [ "$stderr" = \
        'visf-export: 1000000.tm: 1 of 1 tetrahedra have two corners that are one in the 9 digits of the file' ]
    run -0 --separate-stderr visf-export --binary big -o out.visf 1000000.tm
    [ "$stderr" = "visf-export: 1000000.tm: 1 of 1 tetrahedra have two corners that \
are one in the 32-bit floats of the file" ]
    polylla3d -q 1000000.tm >cells.tm
    run -0 --separate-stderr visf-export cells.tm
    [[ "$stderr" == *'4 of 4 facets have two corners'* ]]
    for at in 0 -0; do
        run -0 --separate-stderr visf-export "./$at.tm"
        [ "$stderr" = "" ]
    done
}
