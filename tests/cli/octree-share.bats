# SPDX-License-Identifier: GPL-3.0-or-later
# Shares of octrees that several ranks make together.

bats_require_minimum_version 1.5.0
load helpers

setup() {
    [ -x "$TM_BUILD/ranks/octree_share" ] || skip "there is no p4est"
    command -v mpirun >/dev/null || skip "there is no mpirun"
}

@test "ranks make the octree of one process" {
    # What tests/run.sh sets is for one process.
    for name in $(env | sed -n 's/^\(OMPI_MCA_[a-z_]*\)=.*/\1/p') HWLOC_COMPONENTS; do
        unset "$name"
    done
    for ranks in 1 2 3 7; do
        timeout 120 mpirun --allow-run-as-root --oversubscribe -n "$ranks" \
            "$TM_BUILD/ranks/octree_share" "$ranks"
    done
}
