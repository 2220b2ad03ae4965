# SPDX-License-Identifier: GPL-3.0-or-later
# octree-mesh under a launcher gives the bytes of one process, whatever the number of ranks.

bats_require_minimum_version 1.5.0
load helpers
load ranks

setup() {
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "there is no p4est"
    need_mpirun
    cd "$BATS_TEST_TMPDIR" || exit
    PATH=$PATH:$TM_BUILD/bench
}

# same_on RANKS… -- OPTION… : octree-mesh with these, on so many ranks.
same_on() {
    local ranks=() status many
    while [ "$1" != -- ]; do
        ranks+=("$1")
        shift
    done
    shift
    status=0
    octree-mesh --no-history -j 1 --json one.json -o one.tm "$@" 2>one.err || status=$?
    for n in "${ranks[@]}"; do
        many=0
        rm -f many.tm many.json
        on_ranks "$n" octree-mesh --no-history -j 1 \
            --json many.json -o many.tm "$@" 2>many.err || many=$?
        [ "$many" -eq "$status" ]
        cmp one.tm many.tm
        cmp one.json many.json
        cmp one.err <(sed '/^---*$/,$d' many.err)
    done
}

@test "a sphere, and one that is tiny, on ranks that have nothing" {
    shapes sphere >sphere.off
    same_on 2 7 -- -s 5 sphere.off
    same_on 1 7 -- -s 2 sphere.off
}

@test "sharp edges, with levels as attributes" {
    shapes gear >gear.off
    same_on 2 3 4 7 -- -s 5 -u gear.off
    shapes stairs >stairs.off
    same_on 3 -- -s 5 --feature-angle 30 stairs.off
}

@test "octants of one level, of boxes, with the sizes of curvature" {
    shapes torus >torus.off
    same_on 3 -- -a 5 torus.off
    shapes gear >gear.off
    same_on 2 -- -s 6 --curvature 20 gear.off
}

@test "thin parts, several shells, one within another" {
    shapes sheets >sheets.off
    same_on 3 -- -s 5 sheets.off
    shapes gyroid >gyroid.off
    same_on 4 -- -s 5 gyroid.off
    shapes spool >spool.off
    same_on 3 -- -s 5 spool.off
}

# nested: a sphere within a sphere, three times as small.
nested() {
    shapes sphere | awk 'NR == 2 { nodes = $1; faces = $2; next }
        NR > 2 && NR <= 2 + nodes { node[NR - 3] = $0 }
        NR > 2 + nodes { face[NR - 3 - nodes] = $0 }
        END {
            print "OFF"
            print 2 * nodes, 2 * faces, 0
            for (i = 0; i < nodes; i++) print node[i]
            for (i = 0; i < nodes; i++) {
                split(node[i], p)
                print p[1] / 3, p[2] / 3, p[3] / 3
            }
            for (i = 0; i < faces; i++) print face[i]
            for (i = 0; i < faces; i++) {
                split(face[i], c)
                print 3, c[2] + nodes, c[3] + nodes, c[4] + nodes
            }
        }'
}

@test "hollows, pieces that the surface has not: rank 0 goes on alone" {
    shapes slit >slit.off
    same_on 3 -- -s 4 slit.off
    nested >nested.off
    same_on 2 -- -s 4 nested.off
    python3 -c "import json; assert json.load(open('one.json'))['regions'] == 2"
}

@test "nodes that stay off the surface" {
    shapes folded >folded.off
    same_on 2 -- -s 5 folded.off
    same_on 3 -- -s 5 --resolve 0 folded.off
    same_on 7 -- -s 4 folded.off
    shapes spikes >spikes.off
    same_on 3 -- -s 5 spikes.off
}

@test "walls, polyhedra, open surfaces: rank 0 works alone" {
    shapes segments >walls.off
    same_on 2 -- -s 4 walls.off
    shapes gear >gear.off
    same_on 2 -- -s 4 --polyhedra gear.off
    same_on 2 -- -s 4 --lenient gear.off
}

@test "to standard output; a surface that is not there" {
    shapes gear >gear.off
    octree-mesh -q --no-history -s 4 gear.off >one.tm
    on_ranks 3 octree-mesh -q --no-history -s 4 gear.off >many.tm
    cmp one.tm many.tm
    run -4 --separate-stderr on_ranks 3 octree-mesh -s 4 none.off
    [ -z "$output" ]
}
