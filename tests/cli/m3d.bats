# SPDX-License-Identifier: GPL-3.0-or-later
# m3d-import, m3d-export and mvm-export: one gives back what the other was given.
# shellcheck disable=SC2154,SC2016 # run sets stderr; sed has its own $

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    cat >mixed.m3d <<'END'
[Nodes, ARRAY1<STRING>]
12

1 0 0 0
1 1 0 0
1 1 1 0
1 0 1 0
1 0 0 1
1 1 0 1
1 1 1 1
1 0 1 1
1 0.5 0.5 2
1 2 0 0
1 2 0 1
1 1 0.5 2

[Elements, ARRAY1<STRING>]
4

H 0 1 2 3 4 5 6 7 1000.0 0.45 1.0
P 4 5 6 7 8 1000.0 0.45 1.0
R 1 9 2 5 10 6 1000.0 0.45 1.0
T 5 6 8 11 1000.0 0.45 1.0
END
    cat >mixed.mvm <<'END'
MIXED
12 4

0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
0.5 0.5 2
2 0 0
2 0 1
1 0.5 2
H 0 1 2 3 4 5 6 7
P 4 5 6 7 8
R 1 9 2 5 10 6
T 5 6 8 11
END
    # the stream that these are of: base 0, no regions
    mixed | awk '$0 == ".end" { print; next }
        /^\./ { block = $1; print; getline; print block == ".mix" ? "4 0" : $0; next }
        block == ".node" { $1-- }
        block == ".mix" { $1--; for (i = 3; i < NF; i++) $i--; NF-- }
        { print }' >mixed.tm
}

@test "the file of all elements, both ways; a wedge turns the other way" {
    m3d-export mixed.tm | cmp - mixed.m3d
    mvm-export mixed.tm | cmp - mixed.mvm
    m3d-import --no-history mixed.m3d | cmp - mixed.tm
    m3d-import --no-history mixed.mvm | cmp - mixed.tm
    mixed | m3d-export | cmp - mixed.m3d
    grep -x '2 6 1 2 9 5 6 10' mixed.tm
}

@test "tetrahedra as they are; left-handed ones are turned" {
    surface sphere off | tetgen-mesh --quiet -q >sphere.tm
    m3d-export -j 3 sphere.tm >sphere.m3d
    m3d-export sphere.tm | cmp - sphere.m3d
    m3d-import sphere.m3d | m3d-export | cmp - sphere.m3d
    mvm-export sphere.tm | m3d-import | m3d-export | cmp - sphere.m3d
    rows .ele sphere.tm | wc -l | grep -x "$(grep -c ^T sphere.m3d)"
    paste -d ' ' <(rows .ele sphere.tm | cut -d ' ' -f 2-5) \
        <(sed -n 's/^T \(.*\) 1000.0 0.45 1.0/\1/p' sphere.m3d) |
        awk '{ for (i = 1; i < 5; i++) if ($i != $(i + 4) + 1) exit 1 }'
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' \
        .ele '1 4 0' '1 1 3 2 4' .end >left.tm
    run -0 --separate-stderr m3d-export left.tm
    [ "${lines[-1]}" = 'T 0 2 3 1 1000.0 0.45 1.0' ]
    [ "$stderr" = 'm3d-export: left.tm: 1 of 1 tetrahedra were left-handed and are turned' ]
}

@test "sections in any order, others, lines that end in CR LF, plus signs, tabs" {
    awk '/^\[Nodes/ { nodes = 1 } /^\[Elements/ { nodes = 0 }
        nodes { first = first $0 "\r\n" } !nodes { printf "%s\r\n", $0 }
        END { print "[Version, STRING]\r\n3 of [all]\r"; printf "%s", first }' mixed.m3d \
        >turned.m3d
    m3d-import --no-history turned.m3d | cmp - mixed.tm
    sed 's/^1 1 0.5 2/\t1  +1.00000000E+00 +5.00000000E-01   +2.0 /; s/^$/ /' mixed.m3d |
        m3d-import --no-history | cmp - mixed.tm
}

@test "other materials are left out, with a note" {
    sed '/^P/s/0.45/0.3/' mixed.m3d >soft.m3d
    run -0 --separate-stderr m3d-import --no-history -o out.tm soft.m3d
    [ "$stderr" = 'm3d-import: soft.m3d: the constants of the material of 1 elements, '\
'which are others than 1000.0 0.45 1.0: left out' ]
    cmp out.tm mixed.tm
    run -3 m3d-import --strict -o strict.tm soft.m3d
    [ ! -e strict.tm ]
}

@test "JSON: what the mesh holds" {
    m3d-import --json in.json mixed.m3d >/dev/null
    mvm-export --json out.json mixed.tm >/dev/null
    cmp in.json out.json
    [ "$(json in.json nodes) $(json in.json elements)" = '12 4' ]
}

@test "what is wrong in a file: exit 3, the line, and what would be right" {
    fails() { # SED-COMMAND MESSAGE
        sed "$1" mixed.m3d >wrong.m3d
        run -3 --separate-stderr m3d-import -o out.tm wrong.m3d
        [ "$stderr" = "m3d-import: wrong.m3d$2" ]
    }
    fails '$s/11/12/' ': element 3: node 12 is out of range (below 12)'
    fails '$s/T/Q/' ":23: 'Q' is no element (T, P, R or H)"
    fails '$s/11/-1/' ':23: node: -1 is out of range (0..4294967294)'
    fails '$d' ':23: the file ends where an element should be'
    fails '4s/0 0/0 x/' ":4: a coordinate: 'x' is not a number"
    fails '4s/0 0/0 1e999/' ":4: a coordinate: '1e999' is too large (below 1.8e308)"
    fails '/Elements/,$d' ': has no section [Elements, ARRAY1<STRING>]'
    fails '1i [Nodes, ARRAY1<STRING>]\n0' ':3: a second section Nodes'
    fails '1s/.*/{/' ':1: begins with neither a section such as [Nodes, ARRAY1<STRING>] '\
'nor MIXED'
    fails '18s/4/4000000000/' ':24: the file ends where an element should be'
    sed '$s/$/ 7/' mixed.mvm >wrong.mvm
    run -3 --separate-stderr m3d-import -o out.tm wrong.mvm
    [ "$stderr" = "m3d-import: wrong.mvm:19: '7' follows the last element (the line should "\
'end there)' ]
    [ ! -e out.tm ]
}

@test "a stream without elements: exit 3" {
    cubes >cubes.tm
    for filter in m3d-export mvm-export; do
        run -3 --separate-stderr "$filter" -o out cubes.tm
        [[ "$stderr" == "$filter: cubes.tm: holds polyhedra (.cell), but "* ]]
    done
    [ ! -e out ]
}

@test "a byte of 0 is no letter of an element: exit 3" {
    printf '[Nodes, ARRAY1<STRING>]\n1\n\n1 0 0 0\n\n[Elements, ARRAY1<STRING>]\n1\n\n\0 0 1000.0 0.45 1.0\n' >zero.m3d
    run -3 --separate-stderr m3d-import zero.m3d
    [ "$output" = "" ]
    [[ "$stderr" == *"is no element (T, P, R or H)"* ]]
}
