# SPDX-License-Identifier: GPL-3.0-or-later
# A short run of the fuzzer; make fuzz is a long one.

bats_require_minimum_version 1.5.0

@test "damaged streams: no crash, no hang, no invalid mesh, in the library and all filters" {
    filters=$(cd "$BATS_TEST_DIRNAME/../../cmd" && basename -s .c -- *.c export/*.c)
    # shellcheck disable=SC2086 # a list of words
    run "$TM_BUILD/fuzz/fuzz" "$TM_BUILD/bin" 1200 $filters
    echo "$output"
    [ "$status" -eq 0 ]
}

@test "the corpus of every fuzz target, without a fuzzer" {
    corpus=$BATS_TEST_DIRNAME/../fuzz/corpus
    for target in "$TM_BUILD"/fuzz/replay/*; do
        [ -x "$target" ] || continue
        run "$target" "$corpus/${target##*/}"/*
        if [ "$status" -ne 0 ]; then
            echo "${target##*/}: exit status $status"
            tail -n 20 <<<"$output"
            return 1
        fi
    done
}
