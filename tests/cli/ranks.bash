# SPDX-License-Identifier: GPL-3.0-or-later
# Filters on several processes of a launcher: what they write is that of one.
# shellcheck shell=bash

# What run.sh sets for a process alone keeps several from finding each other.
need_mpirun() {
    command -v mpirun >/dev/null || skip "there is no mpirun"
    unset "${!OMPI_MCA_@}" HWLOC_COMPONENTS
}

# on_ranks N COMMAND…
on_ranks() {
    timeout 120 mpirun -q --allow-run-as-root --oversubscribe --mca pml ob1 --mca btl self,vader -n "$@"
}

# ranks_agree MESH FILTER OPTION…: 1, 2, 3, 4 and 7 ranks say and write what the filter
# without a launcher does: standard output, --json, exit status.
ranks_agree() {
    local mesh=$1 ranks status=0
    shift
    "$@" --no-history --json one.json "$mesh" >one.out || status=$?
    for ranks in ${RANKS:-1 2 3 4 7}; do
        local other=0
        rm -f several.json
        on_ranks "$ranks" "$@" --no-history --json several.json "$mesh" \
            >several.out 2>several.err || other=$?
        cmp one.out several.out && cmp one.json several.json && [ $status -eq $other ] || {
            echo "$ranks ranks, $mesh: exit status $other, not $status"
            cat several.err
            return 1
        }
    done
}
