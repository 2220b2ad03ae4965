#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the tests that make built in the folder $1 and all of tests/cli, as many at a time
# as there are processors and one more, as ranks wait for each other, and ends with the line
# "N passed, N failed". With more words only those, which name programs (test_lepp) or files
# (lepp-improve). Used by make check; exit status 1 if a test failed, 2 if there is none of
# that name.
set -u
build=${1:-build}
[ $# -eq 0 ] || shift
here=$(dirname "$0")
case $build in
/*) ;;
*) build=$PWD/$build ;;
esac
PATH=$build/bin:$PATH
TM_BUILD=$build
logs=$(mktemp -d) || exit 4
export PATH TM_BUILD logs
trap 'rm -rf "$logs"' EXIT
trap 'exit 4' HUP INT TERM

# A test program, or a file of tests/cli; nothing where there is no such thing.
find_test() {
    if [ -f "$build/tests/$1" ] && [ -x "$build/tests/$1" ]; then
        echo "$build/tests/$1"
    elif [ -f "$here/cli/${1%.bats}.bats" ]; then
        echo "$here/cli/${1%.bats}.bats"
    fi
}

if [ $# -eq 0 ]; then
    for program in "$build"/tests/*; do
        [ -f "$program" ] && [ -x "$program" ] && echo "$program"
    done >"$logs/all"
    printf '%s\n' "$here"/cli/*.bats >>"$logs/all"
fi
for name; do
    found=$(find_test "$name")
    if [ -z "$found" ]; then
        echo "There is no test program and no file of tests/cli called $name." >&2
        exit 2
    fi
    echo "$found" >>"$logs/all"
done

# shellcheck source=tests/mpi.sh
. "$here/mpi.sh"

passed=0
failed=0

# count NAME STATUS GOOD BAD : adds a test's counts and says them, or shows its log.
count() {
    passed=$((passed + $3))
    failed=$((failed + $4))
    if [ "$4" -eq 0 ]; then
        echo "ok      $1: $3"
        grep '# skip' "$logs/$1.log"
    else
        echo "FAILED  $1 (exit status $2)"
        cat "$logs/$1.log"
    fi
}

# A program is one test, or says itself how many it is, as cmocka does.
count_program() {
    good=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$logs/$1.log")
    bad=$(sed -n 's/^\[  FAILED  \] \([0-9]*\) test.*/\1/p' "$logs/$1.log" | head -n 1)
    if [ "$2" -eq 0 ]; then
        count "$1" 0 "${good:-1}" 0
    else
        count "$1" "$2" "${good:-0}" "${bad:-1}"
    fi
}

# Tests of a file that did not run have failed; without a plan it is one test.
count_file() {
    good=$(grep -c '^ok' "$logs/$1.log")
    planned=$(sed -n 's/^1\.\.\([0-9]*\)$/\1/p' "$logs/$1.log")
    bad=$((${planned:-1} - good))
    [ "$2" -eq 0 ] || [ "$bad" -gt 0 ] || bad=1
    count "$1" "$2" "$good" "$bad"
}

# Says how all ended, in the order of the list, each as soon as it and those before have.
report() {
    while read -r test; do
        name=${test##*/}
        until [ -e "$logs/$name.status" ]; do sleep 0.1; done
        case $name in
        *.bats) count_file "$name" "$(cat "$logs/$name.status")" ;;
        *) count_program "$name" "$(cat "$logs/$name.status")" ;;
        esac
    done <"$logs/all"
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}

report &
reporter=$!
trap 'kill "$reporter" 2>/dev/null; rm -rf "$logs"' EXIT

# Each leaves NAME.log and then NAME.status. With TM_COUNTS, a folder, what the compiler
# was told to count (make coverage) goes to a folder in it, for each test, and what they
# took of processors to TM_COUNTS.seconds.
# shellcheck disable=SC2016 # expanded by the inner shell
tr '\n' '\0' <"$logs/all" | xargs -0 -n 1 -P $(($(nproc) + 1)) sh -c '
    log=$logs/${1##*/}
    [ -z "${TM_COUNTS:-}" ] || export GCOV_PREFIX="$TM_COUNTS/${1##*/}"
    case $1 in
    *.bats) bats --tap "$1" >"$log.log" 2>&1 </dev/null ;;
    *) "$1" >"$log.log" 2>&1 </dev/null ;;
    esac
    echo $? >"$log.new"
    if [ -n "${TM_COUNTS:-}" ]; then
        times >"$log.times"
        sed -n "2s/[ms]/ /gp" "$log.times" | while read -r minutes seconds more rest; do
            echo "${1##*/} $((60 * (minutes + more) + ${seconds%.*} + ${rest%%.*}))"
        done >>"$TM_COUNTS.seconds"
    fi
    mv "$log.new" "$log.status"' sh

# What was not run, as xargs was killed, has failed.
while read -r test; do
    name=${test##*/}
    [ -e "$logs/$name.status" ] && continue
    echo "was not run, or killed" >>"$logs/$name.log"
    echo 4 >"$logs/$name.status"
done <"$logs/all"
wait "$reporter"
