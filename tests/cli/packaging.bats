# SPDX-License-Identifier: GPL-3.0-or-later
# Debian packages of the tree, where the tools are there to build them.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    root=$(cd "$BATS_TEST_DIRNAME/../.." && pwd)
}

@test "what termesh is built with stands in debian/control as in tests/packages.sh" {
    # shellcheck source=tests/packages.sh
    source "$root/tests/packages.sh"
    for package in $build_packages; do
        case $package in
        gcc | libc6-dev | make) ;; # build-essential
        *) grep -q "^Build-Depends:.* $package\(,\|$\)" "$root/examples/packaging/debian/control" ;;
        esac
    done
}

@test "the package of the shared library is named as the library" {
    library=$(basename "$TM_BUILD"/libtermesh.so.*)
    name=libtermesh$(sed -E 's/.*[.]so[.]([0-9]+)[.].*/\1/' <<<"$library")
    grep -q "^Package: $name\$" "$root/examples/packaging/debian/control"
    grep -q "^Depends: $name (= " "$root/examples/packaging/debian/control"
    [ -f "$root/examples/packaging/debian/$name.install" ]
    grep -q "$name" "$root/README.md"
}

@test "what make install puts in place is in a package" {
    case ${TM_BUILD:?} in */san | */coverage) skip "the same is installed" ;; esac
    make -s -C "$root" BUILD="$TM_BUILD" DESTDIR="$PWD/to" PREFIX=/usr \
        LIBDIR=/usr/lib/this-machine ZSHCOMPLETIONDIR=/usr/share/zsh/vendor-completions install
    (cd to && find . ! -type d | sed 's|^\./||') >files
    cat "$root"/examples/packaging/debian/*.install |
        sed -e 's/[.]/[.]/g' -e 's|[*]|[^/]*|g' -e 's|.*|^&(/.*)?$|' >packed
    [ "$(grep -c . files)" -gt 100 ]
    run grep -v -E -f packed files
    [ "$output" = "" ]
}

@test "packages are built in a clean folder; lintian finds nothing; the filters run" {
    case ${TM_BUILD:?} in */san | */coverage) skip "the packages are the same" ;; esac
    for program in dpkg-buildpackage dh; do
        command -v "$program" >/dev/null || skip "there is no $program"
    done
    [ -x "$TM_BUILD/bin/octree-mesh" ] || skip "there is no p4est"
    processors=$(nproc)
    export DEBFULLNAME=Packer DEBEMAIL=packer@debian.org
    export DEB_BUILD_OPTIONS="noopt noautodbgsym parallel=$processors"
    sh "$root/examples/packaging/build.sh" out
    for package in out/*.deb; do
        dpkg-deb -x "$package" to
    done
    for filter in "$TM_BUILD"/bin/*; do
        filter=${filter##*/}
        [ "$("to/usr/bin/$filter" --version)" = "$("$filter" --version)" ]
        [ -f "to/usr/share/man/man1/$filter.1.gz" ]
        [ "$filter" != mesh-convert ] || continue # a script of two options
        [ -f "to/usr/share/bash-completion/completions/$filter" ]
        [ -f "to/usr/share/zsh/vendor-completions/_$filter" ]
    done
    mixed >mixed.tm
    to/usr/bin/jens-stats mixed.tm | cmp - <(jens-stats mixed.tm)
    find to/usr/lib -name libtermesh.so | grep -q .
    [ -f to/usr/include/termesh/termesh.h ]
    command -v lintian >/dev/null || skip "there is no lintian, but the packages are right"
    # It is no upload to Debian.
    run -0 lintian --allow-root --fail-on error,warning \
        --suppress-tags initial-upload-closes-no-bugs out/*.changes
}
