# SPDX-License-Identifier: GPL-3.0-or-later
# Shares of octrees that several ranks make together.

bats_require_minimum_version 1.5.0
load helpers
load ranks

setup() {
    [ -x "$TM_BUILD/ranks/octree_share" ] || skip "there is no p4est"
    need_mpirun
}

@test "ranks make the octree of one process" {
    for n in 1 3; do
        on_ranks "$n" "$TM_BUILD/ranks/octree_share" "$n"
    done
}
