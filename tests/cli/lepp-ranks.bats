# SPDX-License-Identifier: GPL-3.0-or-later
# lepp-improve under a launcher gives the bytes and the status that it gives without one.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

setup_file() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    tetrahedra 600 >points.tm
}

setup() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    out=$BATS_TEST_TMPDIR
}

# Prints the tetrahedra of so many random points in the unit cube.
tetrahedra() {
    awk -v n="$1" 'BEGIN {
        srand(3)
        print n, 3, 0, 0
        for (i = 1; i <= n; i++)
            print i, rand(), rand(), rand()
    }' | tetgen-mesh --no-history -
}

# ranks N COMMAND…: under a launcher. What run.sh sets for a process alone keeps several
# from finding each other.
ranks() {
    count=$1
    shift
    unset "${!OMPI_MCA_@}" HWLOC_COMPONENTS
    timeout 120 mpirun --allow-run-as-root --oversubscribe -n "$count" "$@"
}

@test "a small mesh" {
    lepp-improve points.tm >"$out/one.tm"
    for n in 1 3; do
        ranks "$n" lepp-improve points.tm >"$out/ranks.tm"
        cmp "$out/one.tm" "$out/ranks.tm"
    done
    lepp-improve --no-history points.tm >"$out/one.tm"
    ranks 2 lepp-improve --no-history -o "$out/file.tm" points.tm
    cmp "$out/one.tm" "$out/file.tm"
    ranks 2 lepp-improve --no-history <points.tm >"$out/ranks.tm"
    cmp "$out/one.tm" "$out/ranks.tm"
}

@test "what rank 0 does alone" {
    for options in "-a selective" "--surface-tolerance 0.01" "--max-growth 0.8" \
        "--set box=0,0,0,0.5,0.5,0.5" "-a bisection --until-size 0.5"; do
        # shellcheck disable=SC2086 # options and their arguments
        lepp-improve $options points.tm >"$out/one.tm"
        # shellcheck disable=SC2086
        ranks 2 lepp-improve $options points.tm >"$out/ranks.tm"
        cmp "$out/one.tm" "$out/ranks.tm"
    done
    lepp-improve --json="$out/one.json" points.tm >/dev/null
    ranks 2 lepp-improve --json="$out/ranks.json" points.tm >/dev/null
    for name in one ranks; do
        sed 's/"seconds": [^,]*,//' "$out/$name.json" >"$out/$name.txt"
    done
    cmp "$out/one.txt" "$out/ranks.txt"
}

@test "errors are said once, and no file is left" {
    sed '/^\.ele/,$d' points.tm >"$out/cut.tm"
    status_of_one=0
    lepp-improve "$out/cut.tm" >/dev/null 2>"$out/one.txt" || status_of_one=$?
    [ "$status_of_one" -gt 0 ]
    run --separate-stderr ranks 3 lepp-improve -o "$out/none.tm" "$out/cut.tm"
    [ "$status" -eq "$status_of_one" ]
    [ "$(grep -c '^lepp-improve: ' <<<"$stderr")" -eq 1 ]
    [ ! -e "$out/none.tm" ]
}
