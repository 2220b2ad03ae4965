# SPDX-License-Identifier: GPL-3.0-or-later
# polylla3d and poly-dual give the same bytes for every number of threads, on meshes that
# several of them work on.

bats_require_minimum_version 1.5.0

setup_file() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    for thickness in 1 0.001; do
        awk -v z=$thickness 'BEGIN {
            srand(5)
            print 3500, 3
            for (i = 1; i <= 3500; i++) print i, rand(), rand(), z * rand()
        }' >points.node
        tetgen-mesh --no-history points.node >points-$thickness.tm
    done
    two_boxes >boxes.poly
    tetgen-mesh --no-history -q1.6 -a 0.0002 --switches A boxes.poly >boxes.tm
    # A cube of 15³ cells of six tetrahedra, whose longest edges are all alike.
    tet_grid 15 >grid.tm
}

setup() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    out=$BATS_TEST_TMPDIR
}

# same MESH FILTER OPTION…
same() {
    local mesh=$1
    shift
    "$@" -q --no-history -j 1 --json "$out/1.json" "$mesh" >"$out/1.tm" || [ $? -eq 1 ]
    [ -s "$out/1.tm" ]
    "$@" -q --no-history -j 3 --json "$out/2.json" "$mesh" >"$out/2.tm" || [ $? -eq 1 ]
    cmp "$out/1.tm" "$out/2.tm"
    cmp <(grep -v threads "$out/1.json") <(grep -v threads "$out/2.json")
}

@test "polylla3d: the same bytes for 1 and 3 threads, whatever the mesh and the options" {
    local mesh options
    for mesh in points-1 points-0.001 boxes grid; do
        while read -r options; do
            # shellcheck disable=SC2086 # words
            same $mesh.tm polylla3d $options
        done <<'END'

--star
--star=0.02 --absorb
--star=centroid --absorb
--absorb --merge-coplanar
--star --levels 2
--cells 900 --star --absorb
--max-tets 20 --no-swallow
--mode edge --no-repair
--mode face --ignore-markers
--label
END
        [ "$(header .ele $mesh.tm | cut -d' ' -f1)" -gt 16384 ]
    done
}

@test "polylla3d: cells that are given are repaired with the same bytes by every number of threads" {
    polylla3d -q --no-history --label --mode edge points-1.tm >given.tm
    same given.tm polylla3d --partition
    same given.tm polylla3d --partition --star
    [ "$(json "$out/1.json" polyhedra)" -gt 1000 ]
}

@test "poly-dual: the same bytes for 1 and 3 threads" {
    same boxes.tm poly-dual
    same boxes.tm poly-dual --convex
}
