# SPDX-License-Identifier: GPL-3.0-or-later
# octree-mesh and octree-repair give the same bytes for every number of threads, on meshes
# that are large enough to be cut into many chunks.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "there is no p4est"
    cd "$BATS_TEST_TMPDIR" || exit
    PATH=$PATH:$TM_BUILD/bench
}

# same_mesh OPTION… : octree-mesh with these, which makes many chunks.
same_mesh() {
    octree-mesh -q --no-history -j 1 --json one.json "$@" >one.tm || [ $? -eq 1 ]
    python3 -c "import json; assert json.load(open('one.json'))['octants'] > 20000"
    octree-mesh -q --no-history -j 3 --json many.json "$@" >many.tm || [ $? -eq 1 ]
    cmp one.tm many.tm
    cmp one.json many.json
}

# same_repair OPTION… : octree-repair with these.
same_repair() {
    octree-repair -q --no-history -j 1 --json one.json "$@" >one.tm || [ $? -eq 1 ]
    octree-repair -q --no-history -j 3 --json many.json "$@" >many.tm || [ $? -eq 1 ]
    cmp one.tm many.tm
    cmp <(without_seconds one.json) <(without_seconds many.json)
}

without_seconds() {
    sed 's/"seconds": *[0-9.e+-]*//' "$1"
}

@test "octree-mesh: sharp edges, leaves as attributes, octants of one level" {
    shapes gear >gear.off
    same_mesh -s 6 -u gear.off
    same_mesh -a 5 gear.off
    shapes stairs >stairs.off
    same_mesh -s 6 --feature-angle 30 stairs.off
}

@test "octree-mesh: thin parts, curvature, listed leaves" {
    shapes sheets >sheets.off
    same_mesh -s 5 sheets.off
    shapes gear >gear.off
    same_mesh -s 6 --curvature 20 --resolve 2 gear.off
    seq 0 7 20000 >leaves.txt
    same_mesh -s 5 -l leaves.txt gear.off
}

@test "octree-mesh: a surface that is open" {
    shapes gear >gear.off
    awk 'NR == 2 { $2 -= 3; nodes = $1 } NR < 3 || NR <= 2 + nodes || ++face > 3' gear.off \
        >open.off
    same_mesh -s 6 --lenient open.off
}

@test "octree-mesh: walls between regions, polyhedra" {
    shapes segments >walls.off
    same_mesh -s 6 walls.off
    shapes gear >gear.off
    same_mesh -s 5 --polyhedra gear.off
}

@test "octree-repair: nodes move, elements are divided, octants split" {
    shapes gear >gear.off
    octree-mesh -q -s 5 gear.off >gear.tm
    same_repair -t 0.35 gear.tm
    same_repair -t 0.2 gear.tm
    shapes spikes >spikes.off
    octree-mesh -q -s 5 spikes.off >spikes.tm
    same_repair -t 0.3 spikes.tm
    same_repair -t 0.32 --method refine -i 2 spikes.tm
}

@test "octree-repair: inverted elements, nodes off the surface, no surface, walls" {
    shapes folded >folded.off
    octree-mesh -q -s 5 --resolve 0 folded.off >folded.tm
    same_repair -t 0.2 folded.tm
    shapes stairs >stairs.off
    octree-mesh -q -s 5 stairs.off >stairs.tm
    awk '/^\./ { block = $1 } block == ".node" && NF == 5 && $1 % 997 == 0 { $2 += 0.02 }
        { print }' stairs.tm >moved.tm
    same_repair -t 0.2 moved.tm
    awk '/^surface/ { out = 1 } /^\./ { out = 0 } !out' moved.tm >alone.tm
    same_repair -t 0.2 alone.tm
    shapes segments >walls.off
    octree-mesh -q -s 5 walls.off >walls.tm
    same_repair -t 0.33 walls.tm
}
