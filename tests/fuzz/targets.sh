#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the fuzz targets that make built in the folder $1, each for $2 seconds, from the
# files of tests/fuzz/corpus; with more words only those targets. What they find is kept in
# the folder; exit status 1 if that is a fault. Used by make fuzz.
#
# What a fuzzer has learnt in many hours becomes a small corpus again by
#     BUILD/fuzz/targets/NAME -merge=1 -use_counters=0 NEW_FOLDER BUILD/fuzz/found/NAME
set -u
build=$1
seconds=$2
shift 2
here=$(dirname "$0")
found=$build/fuzz/found
failed=0

# shellcheck source=tests/mpi.sh
. "$here/../mpi.sh"
export CMOCKA_TEST_ABORT=1
export ASAN_OPTIONS="${ASAN_OPTIONS:-allocator_may_return_null=1}"

# No allocation is larger than what files of such a size can need.
fuzz() {
    mkdir -p "$found/$1" "$here/corpus/$1"
    "$build/fuzz/targets/$1" "-max_total_time=$seconds" -max_len=4096 -timeout=300 \
        -malloc_limit_mb=512 -rss_limit_mb=4096 -print_final_stats=1 -verbosity=1 \
        "-artifact_prefix=$found/$1-" "$found/$1" "$here/corpus/$1" >"$found/$1.log" 2>&1
}

if [ $# -eq 0 ]; then
    # shellcheck disable=SC2046 # a list of words
    set -- $(cd "$build/fuzz/targets" && ls)
fi
for target; do
    mkdir -p "$found"
    if fuzz "$target"; then
        echo "ok      $target: $(sed -n 's/^stat::number_of_executed_units: *//p' \
            "$found/$target.log") runs"
    else
        echo "FAILED  $target: see $found/$target.log"
        tail -n 40 "$found/$target.log"
        failed=1
    fi
done
exit "$failed"
