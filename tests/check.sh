#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# All tests, from nothing: installs what is missing on Debian 12, builds, and runs them.
# The last line is "N passed, N failed"; exit status 0 if none failed. With SAN=1 in the
# environment, under the sanitizers.
set -eu
cd "$(dirname "$0")/.."
# shellcheck source=tests/packages.sh
. tests/packages.sh
# What only tests need is installed while the filters are built.
# shellcheck disable=SC2086 # lists of words
install_packages $build_packages
make -s -j "$(nproc)" WERROR=1 all &
# shellcheck disable=SC2086
install_packages $run_packages $test_packages
wait $!

build=build
[ "${SAN:-0}" = 0 ] || build=build/san
make -s -j "$(nproc)" WERROR=1 tests
exec sh tests/run.sh "$build"
