# SPDX-License-Identifier: GPL-3.0-or-later
# No reader uses a byte that it has not read or set: all of them under valgrind, on files
# that are cut off at every byte, or damaged.

bats_require_minimum_version 1.5.0

setup() {
    case ${TM_BUILD:?} in */san) skip "the sanitizers do not run under valgrind" ;; esac
    command -v valgrind >/dev/null || skip "there is no valgrind"
}

checked() {
    TM_CASES=300 valgrind -q --error-exitcode=99 "$TM_BUILD/tests/$1"
}

@test "files that are cut off, under valgrind" {
    checked test_truncation
}

@test "damaged files, under valgrind" {
    checked test_format_fuzz
}

@test "files of boxes and octants, under valgrind" {
    checked test_rule_files
}
