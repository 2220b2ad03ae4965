#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What the compiler does not see: format, suspicious code, scripts, man pages, and the
# rules of the house. Used by make lint, with the build folder for the generated headers;
# exit status 1 if anything was found.
set -u
build=${1:-build}
cd "$(dirname "$0")/.." || exit 1
failed=0
list=$(mktemp) || exit 4
trap 'rm -f "$list" "$list.headers"' EXIT

c_files=$(find lib cmd tests examples -name '*.[ch]')
cxx_sources=$(find tests -name '*.cc')
scripts="$(find cmd tests examples -name '*.sh') $(find tests -name '*.bats' -o -name '*.bash')
.ci/run"
pages=$(find man -name '*.[157]')

need() {
    command -v "$1" >/dev/null && return
    echo "make lint needs $1: install the Debian package $2" >&2
    exit 1
}

# step WHAT COMMAND… : runs it; its output is shown if it fails.
step() {
    what=$1
    shift
    if output=$("$@" 2>&1); then
        echo "ok      $what"
    else
        echo "FAILED  $what"
        printf '%s\n' "$output"
        failed=1
    fi
}

format() {
    # shellcheck disable=SC2086 # a list of files
    clang-format --dry-run -Werror $c_files $cxx_sources
}

# Of the tests without tests/unit, which take as long as a fifth of all and are seen by the
# compilers and cppcheck, and of each function so many states, which take a third as long
# as clang's own 225 000; ALL=1: these, too, and all of them.
tidy() {
    folders='lib cmd tests/fuzz tests/solve tests/shapes'
    states='-Xclang -analyzer-config -Xclang max-nodes=60000'
    [ -z "${ALL:-}" ] || states=
    export states
    mpi=$(mpicc --showme:compile | sed 's/-I/-isystem /g')
    export build mpi
    # shellcheck disable=SC2016,SC2086 # expanded by the inner shell; a list of words
    find $folders ${ALL:+tests/unit} -name '*.c' -print0 | xargs -0 -P "$(nproc)" -n 4 sh -c 'clang-tidy --quiet "$@" -- \
        -std=c17 -D_GNU_SOURCE -Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes \
        "-I$build/generated" $mpi $states 2>/dev/null' sh
}

# The suppressions are wrong alarms of cppcheck: it does not follow a pointer into the
# block that keeps it, nor an array that a loop has filled, nor see that filter_fail()
# does not return.
suspicious() {
    cppcheck -j "$(nproc)" --quiet --std=c11 --enable=warning,performance,portability \
        --inline-suppr --error-exitcode=1 -D_GNU_SOURCE \
        "-I$build/generated" --suppress=memleak:lib/stream/reader.c \
        --suppress=uninitvar --suppress=nullPointerRedundantCheck lib cmd tests
}

shell() {
    # shellcheck disable=SC2086 # a list of files
    shellcheck -x $scripts
}

manual() {
    # shellcheck disable=SC2086 # a list of files
    mandoc -Tlint -Wwarning $pages
}

# A file says its license; nothing is left to do.
notices() {
    found=0
    for file in Makefile $c_files $cxx_sources $scripts $pages; do
        head -n 3 "$file" | grep -q 'SPDX-License-Identifier: GPL-3.0-or-later' || {
            echo "$file: has no line SPDX-License-Identifier: GPL-3.0-or-later"
            found=1
        }
    done
    # shellcheck disable=SC2086 # a list of files
    grep -nE 'TO[D]O|FIX[M]E' $c_files $cxx_sources $scripts $pages && found=1
    return "$found"
}

# The floors of lib/, from the ground up: a folder includes from those before it only.
floors="base ranks ranks/mpi number text geom stream stream/ranks element mesh mesh/ranks
surface surface/measure surface/mend examine examine/poly examine/ranks format
format/openfoam format/surface format/vtk format/abaqus format/medit
optimise tet tet/parts tet/share tet/envelope tet/operation tet/delaunay
tet/improve tet/lepp octree/forest octree/share octree/transition octree/interior octree/feature
octree/layer octree/repair octree/shared_repair poly/fit poly poly/ranks poly/dual poly/cluster poly/octant view"

# Who has no use for a tm_error gives NULL: none but lib/base/error.c looks into one that a
# caller gave.
errors() {
    found=0
    for file in $c_files; do
        case $file in
        lib/base/error.c | *.h) continue ;;
        lib/*) ;;
        *) continue ;;
        esac
        sed 's/tm_error \*//g' "$file" | grep -nE '\berror->|\*([a-z]+->)?error\b' |
            sed "s|^|$file: |" | grep . && found=1
    done
    return "$found"
}

floor() {
    n=0
    for folder in $floors; do
        n=$((n + 1))
        [ "$folder" != "$1" ] || { echo "$n" && return; }
    done
    echo 0
}

# No folder of lib/ includes from a higher floor, and each has a floor; termesh.h has them
# all.
arrows() {
    found=0
    find lib/* -name '*.[ch]' -not -path '*/generate/*' -not -name termesh.h >"$list"
    while read -r file; do
        folder=$(dirname "$file")
        from=$(floor "${folder#lib/}")
        [ "$from" -gt 0 ] || { echo "$folder: is on no floor" && found=1 && continue; }
        sed -n 's|^#include "\(.*/[^"]*\)"|\1|p' "$file" >"$list.headers"
        while read -r header; do
            target=$(cd "$folder" && cd "$(dirname "$header")" && pwd) || found=1
            to=$(floor "${target#"$PWD"/lib/}")
            [ "$to" -le "$from" ] || {
                echo "$file: $header is on a higher floor"
                found=1
            }
        done <"$list.headers"
    done <"$list"
    return "$found"
}

# A function that a program may call stands under a comment, in the same paragraph; what
# base/error.h says of all _free() functions need not be said again.
contracts() {
    sed -n 's|^#include "\(.*\)"|lib/\1|p' lib/termesh.h >"$list"
    [ -s "$list" ] || return 1
    found=0
    while read -r file; do
        awk -v RS= '!/\/\*/ && match($0, /(^|\n)[a-z][^;{=#]* \**tm_[a-z0-9_]+\([^{]*;/) &&
            !/^(static|typedef|#|extern "C")/ && !/tm_[a-z0-9_]+_free\(/ {
                print FILENAME ": has no comment: " $0; bad = 1 }
            END { exit bad }' "$file" || found=1
    done <"$list"
    return "$found"
}

# What a folder can show at a glance.
sizes() {
    most=30
    find lib cmd -name '*.[ch]' -exec dirname {} + | sort | uniq -c |
        awk -v most="$most" '$1 > most { print $2 ": " $1 " files (" most " at most)"; bad = 1 }
            END { exit bad }'
}

need clang-format clang-format
need clang-tidy clang-tidy
need cppcheck cppcheck
need shellcheck shellcheck
need mandoc mandoc

step "clang-format" format
step "cppcheck" suspicious
step "shellcheck" shell
step "mandoc" manual
step "notices" notices
step "errors may be NULL" errors
step "floors of lib/" arrows
step "contracts" contracts
step "sizes of folders" sizes
step "clang-tidy" tidy
exit "$failed"
