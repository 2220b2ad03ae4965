# SPDX-License-Identifier: GPL-3.0-or-later
# off-export: boundaries and all faces, of all that has faces.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# off FILE: the volume that it encloses, and its Euler number; exit status 1 if it is not
# closed and oriented, or has a vertex that no face has.
off() {
    awk 'NR == 1 { if ($0 != "OFF") exit wrong = 1; next }
        NR == 2 { n = $1; m = $2; next }
        NR <= n + 2 { x[NR - 3] = $1; y[NR - 3] = $2; z[NR - 3] = $3; next }
        { faces++
          if (NF != $1 + 1) wrong = 1
          for (i = 2; i <= NF; i++) {
              a = $i; b = i < NF ? $(i + 1) : $2
              edge[a, b]++; edges++; used[a] = 1
          }
          for (i = 3; i < NF; i++) {
              a = $2; b = $i; c = $(i + 1)
              volume += x[a] * (y[b] * z[c] - z[b] * y[c]) - y[a] * (x[b] * z[c] - \
                  z[b] * x[c]) + z[a] * (x[b] * y[c] - y[b] * x[c])
          } }
        END {
            for (v = 0; v < n; v++) if (!used[v]) wrong = 1
            for (e in edge) {
                split(e, side, SUBSEP)
                if (edge[e] != 1 || edge[side[2], side[1]] != 1) wrong = 1
            }
            printf "%.9g %d\n", volume / 6, n - edges / 2 + faces
            exit wrong || faces != m
        }' "$1"
}

@test "polyhedra: the boundary, outward" {
    cubes >cubes.tm
    off-export cubes.tm >cubes.off
    cat >expected.off <<'END'
OFF
12 10 0
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
4 0 6 9 3
4 0 1 7 6
4 3 9 10 4
4 0 3 4 1
4 6 7 10 9
4 1 2 8 7
4 4 10 11 5
4 1 4 5 2
4 7 8 11 10
4 2 5 11 8
END
    cmp cubes.off expected.off
    off-export --all cubes.tm |
        diff - <(sed '2s/10/11/; 20i 4 1 4 10 7' expected.off)
    sheared_boxes 5 >boxes.tm
    off-export -o boxes.off boxes.tm
    [ "$(off boxes.off)" = '125 2' ]
    [ "$(sed -n 2p boxes.off)" = "$((6 * 6 * 6 - 4 * 4 * 4)) $((6 * 25)) 0" ]
    off-export --all boxes.tm | sed -n 2p | grep -x "216 $(header .facet boxes.tm |
        cut -d ' ' -f 1) 0"
}

@test "tetrahedra of a surface have that surface; mixed elements are closed" {
    surface sphere off >sphere.off
    tetgen-mesh --quiet -Y sphere.off >sphere.tm
    off-export sphere.tm >again.off
    [ "$(off again.off)" = "$(off sphere.off)" ]
    [ "$(sed -n 2p again.off)" = "$(sed -n 2p sphere.off)" ]
    mixed | off-export >mixed.off
    [ "$(off mixed.off)" = '1.91666667 2' ]
    [ "$(sed -n 2p mixed.off)" = '12 14 0' ]
    # left-handed ones make no difference
    mixed | sed 's/^1 8 1 2 3 4 5 6 7 8/1 8 1 4 3 2 5 8 7 6/' | off-export >turned.off
    [ "$(off turned.off)" = '1.91666667 2' ]
}

@test "a surface as it is, without the nodes that it does not have" {
    printf '%s\n' 'termesh 1' .node '4 3 0 0' '0 9 9 9' '1 0.1 0 1e-20' '2 0 1 0' \
        '3 0 0 1' .face '1 1' '0 3 1 2 5' .end >surface.tm
    off-export surface.tm >surface.off
    printf 'OFF\n3 1 0\n0.1 0 1e-20\n0 1 0\n0 0 1\n3 2 0 1\n' | cmp - surface.off
}

@test "no faces, a stream cut short, three tetrahedra at a face: exit 3" {
    printf 'termesh 1\n.node\n1 3 0 0\n0 0 0 0\n.end\n' >points.tm
    run -3 --separate-stderr off-export -o out.off points.tm
    [[ "$stderr" == 'off-export: points.tm: holds points (.node alone), but '* ]]
    cubes | sed '$d' >short.tm
    run -3 --separate-stderr off-export -o out.off short.tm
    printf '%s\n' 'termesh 1' .node '6 3 0 0' '0 0 0 0' '1 1 0 0' '2 0 1 0' '3 0 0 1' \
        '4 0 0 -1' '5 0.1 0.1 -2' .ele '3 4 0' '0 0 1 2 3' '1 0 2 1 4' '2 0 2 1 5' \
        .end >three.tm
    run -3 --separate-stderr off-export -o out.off three.tm
    [ "$stderr" = 'off-export: three.tm: .ele: element 2: its face at nodes 0 1 2 has two '\
'elements already' ]
    [ ! -e out.off ]
}

@test "usage is exit 2" {
    run -2 --separate-stderr off-export --every x.tm
    run -2 --separate-stderr off-export x.tm y.tm
}
