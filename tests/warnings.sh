#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Compiles everything, warnings being errors, with gcc and clang at all levels of
# optimisation, at link time too, and with the flags of Debian's packages, in the folder
# $1/warnings, which is removed. Takes some ten minutes; used by make warnings. Exit status
# 1 if there was a warning.
set -u
build=${1:-build}/warnings
cd "$(dirname "$0")/.." || exit 1
failed=0
trap 'rm -rf "$build"' EXIT

# try WHAT VARIABLE=VALUE… : what the compiler says is shown if it is anything.
try() {
    what=$1
    shift
    rm -rf "$build"
    if output=$(make -s -j "$(nproc)" BUILD="$build" WERROR=1 "$@" tests benchers 2>&1) &&
        [ -z "$output" ]; then
        echo "ok      $what"
    else
        echo "FAILED  $what"
        printf '%s\n' "$output"
        failed=1
    fi
}

# flags NAME : the flags of Debian's packages.
flags() {
    DEB_BUILD_MAINT_OPTIONS=hardening=+all dpkg-buildflags --get "$1"
}

for cc in gcc clang; do
    # Archives of what -flto makes need the compiler's own ar, and clang lld.
    case $cc in
    gcc) cxx=g++ ar=gcc-ar linker='' lto=-flto=auto ;;
    clang) cxx=clang++ ar=llvm-ar linker=-fuse-ld=lld lto=-flto ;;
    esac
    if ! command -v "$cc" >/dev/null || ! command -v "$ar" >/dev/null; then
        echo "left out: there is no $cc, or no $ar"
        continue
    fi
    for flags in -O0 -O1 -O2 -O3 "-O2 $lto"; do
        try "$cc $flags" CC="$cc" CXX="$cxx" AR="$ar" CFLAGS="$flags" CXXFLAGS="$flags" \
            LDFLAGS="$linker"
    done
    command -v dpkg-buildflags >/dev/null || continue
    try "$cc $(flags CFLAGS)" CC="$cc" CXX="$cxx" AR="$ar" CPPFLAGS="$(flags CPPFLAGS)" \
        CFLAGS="$(flags CFLAGS)" CXXFLAGS="$(flags CXXFLAGS)" LDFLAGS="$(flags LDFLAGS)"
done
exit "$failed"
