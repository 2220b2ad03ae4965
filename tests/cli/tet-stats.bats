# SPDX-License-Identifier: GPL-3.0-or-later
# tet-stats: tables, list, JSON, figure, exit statuses.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

setup() {
    load helpers
    cd "$BATS_TEST_TMPDIR" || exit
    # A regular tetrahedron of side sqrt(8), and the corner of a unit cube.
    cat >two.tm <<'END'
termesh 1
# made by hand
.node
8 3 0 0
0  1 1 1
1  -1 1 -1
2  1 -1 -1
3  -1 -1 1
4  0 0 0
5  1 0 0
6  0 1 0
7  0 0 1
.ele
2 4 0
0  0 1 2 3
1  4 5 6 7
.end
END
    # Four points of a square, the last one a little above it: four angles near 0, two
    # near 180.
    cat >sliver.tm <<'END'
termesh 1
.node
4 3 0 0
1  0 0 0
2  1 0 0
3  1 1 0
4  0 1 0.01
.ele
1 4 0
1  1 2 3 4
.end
END
    printf 'termesh 1\n.node\n0 3 0 0\n.ele\n0 4 0\n.end\n' >none.tm
}

@test "the tables of two known tetrahedra" {
    run -0 --separate-stderr tet-stats two.tm
    [ "$stderr" = "" ]
    diff - <(echo "$output" | sed 's/^  *//; s/   */  /g') <<'END'
nodes  8
tetrahedra  2
volume  2.833333
smallest dihedral angle  54.7356
largest dihedral angle  90.0000

tetrahedra, %
with an angle below 30 or above 150  0.00
with volume quality below 0.05  0.00
with volume quality below 0.10  0.00
with volume quality below 0.15  0.00
with volume quality below 0.20  0.00
with volume quality below 0.25  0.00
with volume quality below 0.30  0.00

dihedral angles, %
below 5  0.00
below 10  0.00
below 15  0.00
below 20  0.00
below 25  0.00
below 30  0.00
above 150  0.00
above 160  0.00
above 170  0.00
above 175  0.00

histogram of dihedral angles, %
0 to  10  0.00
10 to  20  0.00
20 to  30  0.00
30 to  40  0.00
40 to  50  0.00
50 to  60  25.00  ***************
60 to  70  0.00
70 to  80  50.00  ******************************
80 to  90  0.00
90 to 100  25.00  ***************
100 to 110  0.00
110 to 120  0.00
120 to 130  0.00
130 to 140  0.00
140 to 150  0.00
150 to 160  0.00
160 to 170  0.00
170 to 180  0.00

histogram of volume quality, %
0.0 to 0.1  0.00
0.1 to 0.2  0.00
0.2 to 0.3  0.00
0.3 to 0.4  0.00
0.4 to 0.5  0.00
0.5 to 0.6  50.00  ******************************
0.6 to 0.7  0.00
0.7 to 0.8  0.00
0.8 to 0.9  0.00
0.9 to 1.0  50.00  ******************************
END
}

@test "before and after, with the ratio of sizes, either of them from a pipe" {
    tet-stats sliver.tm two.tm >files
    grep -Eq '^ +before +after$' files
    grep -Eq '^nodes +4 +8   2\.00 times$' files
    grep -Eq '^tetrahedra +1 +2   2\.00 times$' files
    grep -Eq '^  with an angle below 30 or above 150 +100\.00 +0\.00$' files
    tet-stats - two.tm <sliver.tm >first
    tet-stats sliver.tm - <two.tm >second
    cmp files first
    cmp files second
}

@test "-t is the limit of bad angles, and met exactly is not bad" {
    tet-stats -t 54.7356103172453 two.tm | grep -Eq 'below 54\.7356 .* 0\.00$'
    tet-stats -t 54.7357 two.tm | grep -Eq 'below 54\.7357 .* 50\.00$'
    tet-stats --threshold=71 two.tm | grep -Eq 'below 71 or above 109 +100\.00$'
    tet-stats -t 0 sliver.tm | grep -Eq 'below 0 or above 180 +0\.00$'
}

@test "--list has a line for each tetrahedron, numbered as in the stream" {
    run -0 tet-stats --list two.tm
    [ "${lines[0]}" = "0 70.528779 70.528779 1.000000" ]
    [ "${lines[1]}" = "1 54.735610 90.000000 0.500000" ]
    [ "${#lines[@]}" -eq 2 ]
    run -0 tet-stats --list sliver.tm
    [ "${output%% *}" = 1 ]
}

@test "--list agrees with angles computed in another way" {
    many >many.tm
    tet-stats -q --list many.tm >list
    python3 - many.tm list <<'END'
import math, sys

def block(lines, name):
    start = lines.index(name) + 2
    return [line.split() for line in lines[start:start + int(lines[start - 1].split()[0])]]

def minus(a, b):
    return [x - y for x, y in zip(a, b)]

def dot(a, b):
    return sum(x * y for x, y in zip(a, b))

def across(edge, way):
    """The unit vector of the part of way at right angles to edge."""
    along = dot(way, edge) / dot(edge, edge)
    rest = [x - along * y for x, y in zip(way, edge)]
    length = math.hypot(*rest)
    return [x / length for x in rest]

def angle(p, q, r, s):
    u = across(minus(q, p), minus(r, p))
    v = across(minus(q, p), minus(s, p))
    return math.degrees(2 * math.atan2(math.hypot(*minus(u, v)),
                                       math.hypot(*[x + y for x, y in zip(u, v)])))

lines = open(sys.argv[1]).read().splitlines()
points = [[float(x) for x in row[1:4]] for row in block(lines, ".node")]
rows = block(lines, ".ele")
list_rows = open(sys.argv[2]).read().splitlines()
assert len(rows) == len(list_rows) == 20000
for row, printed in zip(rows, list_rows):
    a, b, c, d = (points[int(v)] for v in row[1:5])
    angles = [angle(a, b, c, d), angle(a, c, b, d), angle(a, d, b, c),
              angle(b, c, a, d), angle(b, d, a, c), angle(c, d, a, b)]
    _, least, largest, quality = map(float, printed.split())
    assert abs(min(angles) - least) < 2e-6, (row, angles, printed)
    assert abs(max(angles) - largest) < 2e-6, (row, angles, printed)
    longest = max(math.dist(p, q) for p in (a, b, c, d) for q in (a, b, c, d))
    ab, ac, ad = minus(b, a), minus(c, a), minus(d, a)
    six_volumes = abs(ab[0] * (ac[1] * ad[2] - ac[2] * ad[1])
                      + ab[1] * (ac[2] * ad[0] - ac[0] * ad[2])
                      + ab[2] * (ac[0] * ad[1] - ac[1] * ad[0]))
    assert abs(math.sqrt(2) * six_volumes / longest**3 - quality) < 2e-6, (row, printed)
END
}

@test "--json has the keys of the mesh, of two meshes before and after" {
    tet-stats --json one.json two.tm >table
    grep -q tetrahedra table
    [ "$(json one.json nodes)" = 8 ]
    [ "$(json one.json tets)" = 2 ]
    [ "$(json one.json bad_percent)" = 0 ]
    [ "$(json one.json max_dihedral)" = 90 ]
    [ "$(json one.json dihedral_histogram 18)" = "[95, 3]" ]
    [ "$(json one.json volume_quality_histogram 19)" = "[1, 1]" ]
    tet-stats --json two.json sliver.tm two.tm >table
    [ "$(json two.json before bad_percent)" = 100 ]
    [ "$(json two.json after bad_percent)" = 0 ]
    [ "$(json two.json after tets)" = 2 ]
    python3 - two.json <<'END'
import json, sys
mesh = json.load(open(sys.argv[1]))["before"]
assert list(mesh) == ["nodes", "tets", "volume", "min_dihedral", "max_dihedral",
                      "bad_percent", "dihedral_percent", "volume_quality_percent",
                      "dihedral_histogram", "volume_quality_histogram"]
assert list(mesh["dihedral_percent"]) == ["<5", "<10", "<15", "<20", "<25", "<30",
                                          ">150", ">160", ">170", ">175"]
assert list(mesh["volume_quality_percent"]) == ["<0.05", "<0.1", "<0.15", "<0.2",
                                                "<0.25", "<0.3"]
assert abs(mesh["dihedral_percent"]["<5"] - 400 / 6) < 1e-9
assert abs(mesh["dihedral_percent"][">175"] - 200 / 6) < 1e-9
assert abs(mesh["volume"] - 0.01 / 6) < 1e-15
assert len(mesh["dihedral_histogram"]) == 36
assert sum(count for _, count in mesh["dihedral_histogram"]) == 6
END
}

@test "--json - is the only thing on standard output" {
    tet-stats --json - two.tm >out.json
    [ "$(json out.json tets)" = 2 ]
    tet-stats -o table --json - two.tm >out.json
    [ "$(json out.json tets)" = 2 ]
    grep -q '^tetrahedra' table
}

@test "left-handed tetrahedra are turned, and the user is told" {
    sed 's/^1  4 5 6 7/1  5 4 6 7/' two.tm >turned.tm
    run -0 --separate-stderr tet-stats turned.tm
    [ "$stderr" = \
        "tet-stats: turned.tm: 1 of 2 tetrahedra were left-handed and are counted turned" ]
    [ "$output" = "$(tet-stats two.tm)" ]
    run -0 --separate-stderr tet-stats -q turned.tm
    [ "$stderr" = "" ]
}

@test "flat tetrahedra are bad and spoil nothing" {
    sed 's/0\.01/0/' sliver.tm >flat.tm
    [ "$(tet-stats --list flat.tm)" = "1 0.000000 180.000000 0.000000" ]
    tet-stats flat.tm | grep -Eq 'below 30 or above 150 +100\.00$'
    sed 's/^4  .*/4  0 0 0/' sliver.tm >point.tm
    [ "$(tet-stats --list point.tm)" = "1 0.000000 0.000000 0.000000" ]
}

@test "a mesh without tetrahedra" {
    run -0 tet-stats --json out.json --plot out.svg none.tm
    [[ "$output" =~ tetrahedra\ +0 ]]
    [[ ! "$output" =~ nan|inf ]]
    [ "$(json out.json tets)" = 0 ]
    [ "$(json out.json bad_percent)" = 0 ]
    grep -q '<svg' out.svg
    [ -z "$(tet-stats --list none.tm)" ]
    tet-stats none.tm two.tm | grep -Eq '^tetrahedra +0 +2$'
}

@test "--plot writes a figure with the sizes of both meshes" {
    tet-stats --plot figure.svg sliver.tm two.tm >table
    python3 -c 'import xml.dom.minidom, sys; xml.dom.minidom.parse(sys.argv[1])' figure.svg
    grep -q 'before: 1 tetrahedra, 100.0 % bad' figure.svg
    grep -q 'after: 2 tetrahedra, 0.0 % bad' figure.svg
    grep -q 'dihedral angle' figure.svg
    grep -q 'volume quality' figure.svg
    many | tet-stats -q --plot "a 'quoted' \"name\" \$(x).svg" >table
    grep -q "20.*000 tetrahedra" "a 'quoted' \"name\" \$(x).svg"
    [ "$(find . -name '*.svg*' | wc -l)" -eq 2 ]
}

@test "--plot without gnuplot: exit 4 with the package's name, and no file" {
    program=$(command -v tet-stats)
    mkdir empty
    run -4 --separate-stderr env PATH="$PWD/empty" "$program" --plot figure.svg two.tm
    [ "$stderr" = "tet-stats: --plot needs gnuplot (package gnuplot-nox)" ]
    [ ! -e figure.svg ]
}

@test "--plot with a gnuplot that fails: exit 4, and the old file is kept" {
    mkdir fake
    printf '#!/bin/sh\necho half a figure\nexit 1\n' >fake/gnuplot
    chmod +x fake/gnuplot
    echo old >figure.svg
    run -4 --separate-stderr env PATH="$PWD/fake:$PATH" tet-stats --plot figure.svg two.tm
    [ "$stderr" = "tet-stats: gnuplot failed with exit status 1" ]
    [ "$(cat figure.svg)" = old ]
    [ "$(find . -name 'figure*' | wc -l)" -eq 1 ]
}

@test "-j 2 gives the bytes of -j 1" {
    many >many.tm
    for threads in 1 2 5; do
        tet-stats -q -j $threads --json $threads.json many.tm >$threads.table
    done
    cmp 1.json 2.json
    cmp 1.json 5.json
    cmp 1.table 2.table
    cmp 1.table 5.table
}

@test "usage errors: exit 2" {
    run -2 tet-stats -t 91 two.tm
    run -2 tet-stats -t x two.tm
    run -2 tet-stats --plot
    run -2 tet-stats --no-such-option two.tm
    run -2 tet-stats two.tm two.tm two.tm
    run -2 tet-stats --list two.tm two.tm
    run -2 tet-stats - - <two.tm
}

@test "bad input: exit 3 with file and line, and nothing on standard output" {
    head -n 14 two.tm >cut.tm
    run -3 --separate-stderr tet-stats cut.tm
    [ "$output" = "" ]
    [[ "$stderr" =~ ^tet-stats:\ cut\.tm: ]]
    run -3 --separate-stderr tet-stats two.tm - <cut.tm
    [ "$output" = "" ]
    [[ "$stderr" =~ ^tet-stats:\ \<stdin\>: ]]
}

@test "what cannot be read or written: exit 4" {
    run -4 tet-stats no-such-file.tm
    run -4 tet-stats two.tm no-such-file.tm
    run -4 tet-stats -o /no-such-folder/out two.tm
    run -4 tet-stats --plot /no-such-folder/out.svg two.tm
    run -4 tet-stats --json /no-such-folder/out.json two.tm
    if [ -e /dev/full ]; then
        run -4 sh -c 'tet-stats two.tm >/dev/full'
        run -4 tet-stats --plot /dev/full two.tm
    fi
}
