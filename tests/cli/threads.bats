# SPDX-License-Identifier: GPL-3.0-or-later
# The same bytes for every number of threads: each filter, on meshes that are read, walked
# and written in several chunks.
# shellcheck disable=SC2154 # setup_file of filters.bash sets filters

bats_require_minimum_version 1.5.0
load helpers
load filters
load large

# Runs the filter with so many threads in a folder of its own. (octree-repair ends with 1.)
run_with() {
    mkdir "$1-$2"
    # shellcheck disable=SC2046 # words
    (cd "$1-$2" && "$1" --quiet --no-history --threads "$2" $(more_options "$1") \
        $(operands "$1" "../$(large_input "$1")") >printed 2>messages; echo $? >status)
}

same_for_all_threads() {
    run_with "$1" 1
    grep -q '^[01]$' "$1-1/status"
    for threads in 2 3 8; do
        run_with "$1" "$threads"
        diff -r "$1-1" "$1-$threads"
    done
}

@test "each filter gives the same bytes with 1, 2, 3 and 8 threads" {
    make_large_inputs
    for_each_filter same_for_all_threads
}

# Runs all filters on the small input in the folder $1, behind the words that follow.
run_small() {
    local to=$1
    shift
    mkdir "$to"
    for filter in ${some:-$filters}; do
        # shellcheck disable=SC2046 # words
        (mkdir "$to/$filter" && cd "$to/$filter" && "$@" "$filter" --quiet --no-history \
            $(operands "$filter" "../../$(input "$filter")") >printed 2>messages; echo $? >status)
    done
}

@test "each filter gives the same bytes in three locales" {
    run_small in-posix env LC_ALL=POSIX
    LOCPATH=$(comma_locale)
    localedef -i tr_TR -f UTF-8 "$LOCPATH/turkish"
    export LOCPATH
    [ "$(LC_ALL=comma printf '%.1f' 1)" = 1,0 ]
    for locale in comma turkish; do
        run_small "in-$locale" env "LC_ALL=$locale"
        diff -r in-posix "in-$locale"
    done
}

# Its arithmetic is in software. Whole programs are slow: those that compute most.
@test "the same bytes under valgrind" {
    case ${TM_BUILD:?} in */san*) skip "the sanitizers do not run under valgrind" ;; esac
    command -v valgrind >/dev/null || skip "there is no valgrind"
    some="lepp-improve polylla3d jens-stats"
    surface cube off >cube.off
    tetgen-mesh --quiet -a 0.02 cube.off >corner.tm
    run_small alone env
    run_small valgrind valgrind -q --log-file=/dev/null
    diff -r alone valgrind
}
