#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the tests that make built in the folder $1 and all of tests/cli, and ends with the
# line "N passed, N failed". Used by make check; exit status 1 if a test failed.
set -u
build=${1:-build}
here=$(dirname "$0")
case $build in
/*) ;;
*) build=$PWD/$build ;;
esac
PATH=$build/bin:$PATH
TM_BUILD=$build
export PATH TM_BUILD
log=$(mktemp) || exit 4
trap 'rm -f "$log"' EXIT

passed=0
failed=0

# As the filters set it (lib/octree/forest/mpi_start.h): MPI for one process.
mpi='OMPI_MCA_pml=ob1 OMPI_MCA_btl=self OMPI_MCA_ess_singleton_isolated=1
    OMPI_MCA_orte_create_session_dirs=0 OMPI_MCA_shmem=mmap HWLOC_COMPONENTS=no_os,stop'

# A program is one test, or says itself how many it is, as cmocka does.
for program in "$build"/tests/*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    name=$(basename "$program")
    # shellcheck disable=SC2086 # words
    env $mpi "$program" >"$log" 2>&1
    status=$?
    good=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$log")
    bad=$(sed -n 's/^\[  FAILED  \] \([0-9]*\) test.*/\1/p' "$log" | head -n 1)
    if [ "$status" -eq 0 ]; then
        passed=$((passed + ${good:-1}))
        echo "ok      $name: ${good:-1}"
    else
        passed=$((passed + ${good:-0}))
        failed=$((failed + ${bad:-1}))
        echo "FAILED  $name (exit status $status)"
        cat "$log"
    fi
done

for file in "$here"/cli/*.bats; do
    bats --tap "$file" >"$log" 2>&1
    good=$(grep -c '^ok' "$log")
    bad=$(grep -c '^not ok' "$log")
    planned=$(sed -n 's/^1\.\.\([0-9]*\)$/\1/p' "$log")
    lost=$((${planned:-1} - good - bad))
    passed=$((passed + good))
    failed=$((failed + bad + lost))
    if [ $((bad + lost)) -eq 0 ]; then
        echo "ok      $(basename "$file"): $good"
        grep '# skip' "$log"
    else
        echo "FAILED  $(basename "$file")"
        cat "$log"
    fi
done

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
