# SPDX-License-Identifier: GPL-3.0-or-later
# mdl-import: a surface as the main mesh, which exporters write and meshers fill.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    surface sphere mdl >sphere.mdl
}

@test "the nodes and triangles of the file" {
    mdl-import --json count.json sphere.mdl >sphere.tm
    surface sphere stream >expected.tm
    paste -d ' ' <(rows .node sphere.tm) <(rows surface.node expected.tm) |
        awk '$1 != $5 - 1 || $2 != $6 || $3 != $7 || $4 != $8 { exit 1 } END { exit NR < 100 }'
    paste -d ' ' <(rows .face sphere.tm) <(rows surface.face expected.tm) |
        awk '$2 != $6 - 1 || $3 != $7 - 1 || $4 != $8 - 1 { exit 1 } END { exit NR < 100 }'
    [ "$(json count.json nodes)" = "$(rows .node sphere.tm | wc -l)" ]
    [ "$(json count.json triangles)" = "$(rows .face sphere.tm | wc -l)" ]
    # sections in another order, CR LF
    awk '/^\[Vert/ { nodes = 1 } /^\[Tri/ { nodes = 0 }
        nodes { first = first $0 "\r\n" } !nodes { printf "%s\r\n", $0 }
        END { printf "%s", first }' sphere.mdl | mdl-import --no-history |
        cmp - <(sed '/^# /d' sphere.tm)
}

@test "exporters write it, and tetgen-mesh fills it, as if it had read the file" {
    mdl-import sphere.mdl | off-export | cmp - <(surface sphere off)
    command -v tetgen >/dev/null || skip "there is no tetgen"
    mdl-import sphere.mdl | tetgen-mesh -q --no-history >filled.tm
    tetgen-mesh -q --no-history sphere.mdl >expected.tm
    [ "$(header .ele filled.tm)" = "$(header .ele expected.tm)" ]
    diff <(volumes filled.tm) <(volumes expected.tm)
    # the surface goes with the mesh
    [ "$(header surface.face filled.tm)" = "$(rows .face <(mdl-import sphere.mdl) | wc -l) 0" ]
}

@test "what is wrong in a file: exit 3" {
    sed '$s/^[0-9]*/9999/' sphere.mdl >wrong.mdl
    run -3 --separate-stderr mdl-import -o out.tm wrong.mdl
    [[ "$stderr" == 'mdl-import: wrong.mdl: triangle '*': point 9999 is out of range (below '* ]]
    sed '$d' sphere.mdl >short.mdl
    run -3 --separate-stderr mdl-import -o out.tm short.mdl
    [[ "$stderr" == 'mdl-import: short.mdl:'*': the file ends where point should be' ]]
    [ ! -e out.tm ]
}
