# SPDX-License-Identifier: GPL-3.0-or-later
# octree-repair under a launcher gives the bytes of one process, whatever the number of
# ranks.

bats_require_minimum_version 1.5.0
load helpers
load ranks

setup_file() {
    [ -x "$TM_BUILD/bin/octree-repair" ] || skip "there is no p4est"
    cd "$BATS_FILE_TMPDIR" || exit
    PATH=$PATH:$TM_BUILD/bench
    shapes sphere >sphere.off
    octree-mesh -s 6 -o sphere.tm sphere.off
    octree-mesh -s 3 -o small.tm sphere.off
    # Of every so many nodes one is elsewhere: inside elements are inverted there, on the
    # surface the node is off it.
    awk '/^\.node/ { nodes = 1; print; getline; print; next }
        /^\.mix/ { nodes = 0 }
        nodes && $5 == 0 && ++inside % 9000 == 5000 { $3 += 0.05 }
        nodes && $5 == 1 && ++outside % 5000 == 2500 {
            for (i = 2; i <= 4; i++) $i *= 0.985
            $5 = -1
        }
        { print }' sphere.tm >spoiled.tm
}

setup() {
    need_mpirun
    cd "$BATS_TEST_TMPDIR" || exit
    meshes=$BATS_FILE_TMPDIR
}

# same_on MESH RANKS… -- OPTION… : octree-repair of the mesh with these, on so many ranks.
# Whether they have worked together a line of many.err says.
same_on() {
    local mesh=$1 ranks=() status=0 many
    shift
    while [ "$1" != -- ]; do
        ranks+=("$1")
        shift
    done
    shift
    octree-repair --no-history -j 1 -o one.tm "$@" "$mesh" 2>one.err || status=$?
    for n in "${ranks[@]}"; do
        many=0
        rm -f many.tm
        on_ranks "$n" octree-repair -v --no-history -j 1 -o many.tm "$@" "$mesh" \
            2>many.err || many=$?
        [ "$many" -eq "$status" ]
        [ "$status" -gt 1 ] || cmp one.tm many.tm
    done
}

together() {
    grep -q "ranks: .* sent by each" many.err
}

@test "what is good is passed on, from files and pipes, and where ranks have nothing" {
    same_on "$meshes/sphere.tm" 3 -- -t 0.2
    together
    on_ranks 2 octree-repair --no-history -t 0.2 <"$meshes/sphere.tm" >many.tm
    cmp one.tm many.tm
    same_on "$meshes/small.tm" 7 -- -t 0.2
    together
}

@test "nodes around bad elements move" {
    same_on "$meshes/sphere.tm" 1 2 3 4 7 -- -t 0.305
    together
    run -0 jens-stats --fail-below 0.305 many.tm
    cmp -s "$meshes/sphere.tm" many.tm && return 1
    on_ranks 2 octree-repair --no-history -t 0.305 <"$meshes/sphere.tm" >many.tm
    cmp one.tm many.tm
}

@test "inverted elements, nodes off the surface, places by the attribute or found" {
    same_on "$meshes/spoiled.tm" 3 7 -- -t 0.1
    together
    run -0 jens-stats --fail-below 0.1 --certify many.tm
    run ! grep -q '^[0-9]* [^ ]* [^ ]* [^ ]* -1$' many.tm
    awk '/^\.node/ { nodes = 1; print; getline; print $1, 3, 0, 0; next }
        /^\.mix/ { nodes = 0 }
        nodes { print $1, $2, $3, $4; next }
        { print }' "$meshes/spoiled.tm" >plain.tm
    same_on plain.tm 2 -- -t 0.1
    together
}

@test "what rank 0 does alone" {
    same_on "$meshes/small.tm" 2 -- -t 0.4
    run ! together
    same_on "$meshes/small.tm" 3 -- --method refine -t 0.305 -i 2
    same_on "$meshes/small.tm" 2 -- -t 0.31 --time 60
    sed '/^surface/,$d' "$meshes/small.tm" >bare.tm
    echo .end >>bare.tm
    same_on bare.tm 2 -- -t 0.4
    awk '/^\.mix/ { print; getline; print; getline; $3 = $4 } { print }' \
        "$meshes/small.tm" >twice.tm
    same_on twice.tm 3 --
    grep -q "names a node twice" many.err
}
