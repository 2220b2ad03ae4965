# SPDX-License-Identifier: GPL-3.0-or-later
# polylla3d under a launcher: 1, 2, 3, 4 and 7 ranks write what one process writes.

bats_require_minimum_version 1.5.0
load helpers
load ranks

setup_file() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    awk 'BEGIN {
        srand(5)
        print 5000, 3, 1, 0
        for (i = 1; i <= 5000; i++) print i, rand(), rand(), rand(), i
    }' >points.node
    tetgen-mesh --no-history points.node >points.tm
    two_boxes >boxes.poly
    tetgen-mesh --no-history -q1.6 -a 0.0002 --switches A boxes.poly >boxes.tm
    # A cube of 14³ cells of six tetrahedra, whose longest edges are all alike, and one cell.
    for n in 14 1; do
        tet_grid $n >grid-$n.tm
    done
}

setup() {
    need_mpirun
    cd "$BATS_FILE_TMPDIR" || exit
}

@test "terminal regions: points, a surface with regions and markers, edges that are all alike" {
    for mesh in points boxes grid-14; do
        [ "$(header .ele $mesh.tm | cut -d' ' -f1)" -gt 16384 ]
        ranks_agree $mesh.tm polylla3d
    done
}

@test "stars" {
    ranks_agree points.tm polylla3d --star
    RANKS='2 7' ranks_agree boxes.tm polylla3d --star --ignore-markers
}

@test "meshes so small that ranks have nothing, and what rank 0 does alone" {
    printf 'termesh 1\n.node\n0 3 0 0\n.ele\n0 4 0\n.end\n' >none.tm
    cubes >cubes.tm
    for mesh in grid-1 none; do
        RANKS='1 2 7' ranks_agree $mesh.tm polylla3d
        RANKS=3 ranks_agree $mesh.tm polylla3d --star
    done
    for options in '--cells 20' '--star --absorb' '--mode face' --label '--star=centroid' '--levels 2'; do
        # shellcheck disable=SC2086 # words
        RANKS=2 ranks_agree grid-1.tm polylla3d $options
    done
    RANKS=2 ranks_agree cubes.tm polylla3d --cells 1
    [ "$(on_ranks 3 polylla3d --no-history <grid-1.tm)" = "$(polylla3d --no-history <grid-1.tm)" ]
}

@test "-o, and errors: one message, the exit status, no file" {
    on_ranks 3 polylla3d -q --no-history -o several.tm points.tm
    polylla3d -q --no-history points.tm | cmp - several.tm
    sed '/^\.ele/,$ s/^5 .*/5 1 2 3 99999/' points.tm >range.tm
    run -3 --separate-stderr on_ranks 3 polylla3d -o none.out range.tm
    [ "$output" = "" ]
    # shellcheck disable=SC2154 # run sets stderr
    [ "$(grep -c '^polylla3d: range.tm:[0-9]*: .ele: ' <<<"$stderr")" -eq 1 ]
    [ ! -e none.out ]
    sed 's/^\.end/.notes\nsome\n.end/' points.tm >notes.tm
    run -3 --separate-stderr on_ranks 3 polylla3d --strict -o none.out notes.tm
    [ "$(grep -c '^polylla3d: notes.tm: the block .notes, ' <<<"$stderr")" -eq 1 ]
    [ ! -e none.out ]
    run -2 on_ranks 2 polylla3d --no-such-option points.tm
}
