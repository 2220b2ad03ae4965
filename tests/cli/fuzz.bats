# SPDX-License-Identifier: GPL-3.0-or-later
# A short run of the fuzzer; make fuzz is a long one.

bats_require_minimum_version 1.5.0

@test "damaged streams: no crash, no hang, no invalid mesh, in the library and all filters" {
    filters=$(cd "$BATS_TEST_DIRNAME/../../cmd" && basename -s .c -- *.c export/*.c)
    # shellcheck disable=SC2086 # a list of words
    run "$TM_BUILD/fuzz/fuzz" "$TM_BUILD/bin" 3000 $filters
    echo "$output"
    [ "$status" -eq 0 ]
}
