# shellcheck shell=sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The Debian 12 packages that termesh needs, by purpose, and install_packages() for the
# scripts that do their own set-up. To be sourced.

# shellcheck disable=SC2034 # used by those who source this
{
    build_packages="gcc libc6-dev libexpat1-dev libgmp-dev libgmsh-dev libopenmpi-dev libjs-three libp4est-dev
        make zlib1g-dev"
    run_packages="gnuplot-nox tetgen"
    test_packages="bats bsdutils chromium g++ gmsh libcmocka-dev
        libsuitesparse-dev locales mandoc pkg-config python3 python3-gmsh
        python3-meshio python3-vtk9 valgrind"
    lint_packages="clang-format clang-tidy cppcheck mandoc shellcheck"
}

# install_packages PACKAGE… : installs those that are missing, as root or by sudo, and
# says which. Nothing is done, and no right needed, where all are there. Fails with the
# reason on standard error.
install_packages() {
    if ! command -v dpkg-query >/dev/null; then
        echo "This is not Debian: these packages' programs are taken as installed: $*" >&2
        return 0
    fi
    missing=
    for package; do
        case $(dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null) in
        installed*) ;;
        *) missing="$missing $package" ;;
        esac
    done
    [ -n "$missing" ] || return 0
    as_root=
    if [ "$(id -u)" -ne 0 ]; then
        as_root=sudo
        if ! command -v sudo >/dev/null; then
            echo "These packages are missing:$missing" >&2
            echo "Run this as root, or install sudo, or install them yourself:" >&2
            echo "    apt-get update" >&2
            echo "    apt-get install --no-install-recommends$missing" >&2
            return 1
        fi
    fi
    echo "Installing:$missing"
    apt_log=$(mktemp) || return 1
    # shellcheck disable=SC2086 # a list of words
    if $as_root apt-get update >"$apt_log" 2>&1 &&
        $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y \
            --no-install-recommends $missing >>"$apt_log" 2>&1; then
        rm -f "$apt_log"
        return 0
    fi
    cat "$apt_log" >&2
    rm -f "$apt_log"
    echo "The packages could not be installed:$missing" >&2
    return 1
}
