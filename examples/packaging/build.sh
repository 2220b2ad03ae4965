#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds Debian packages of this tree, in a folder of its own under TMPDIR, and puts them
# into a folder: build.sh [FOLDER]. What is packed is in debian/ beside this script;
# DEBFULLNAME and DEBEMAIL say who packs it.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../..
mkdir -p "${1:-.}"
to=$(cd "${1:-.}" && pwd)
for program in dpkg-buildpackage dh; do
    command -v "$program" >/dev/null || {
        echo "$0: needs $program: install the Debian packages build-essential and debhelper" >&2
        exit 4
    }
done

version=$(sed -n 's/^#define TM_VERSION *"\(.*\)"/\1/p' "$root/lib/base/version.h")
name=${DEBFULLNAME:-$(id -un)}
email=${DEBEMAIL:-$(id -un)@$(hostname)}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 4' HUP INT TERM
tree=$work/termesh-$version
mkdir "$tree"
for file in Makefile LICENSE NEWS README.md cmd lib man; do
    cp -R "$root/$file" "$tree"
done
cp -R "$here/debian" "$tree"
sed "s/@MAINTAINER@/$name <$email>/" "$here/debian/control" >"$tree/debian/control"
cat >"$tree/debian/changelog" <<END
termesh ($version-1) unstable; urgency=medium

  * Version $version; what is new stands in NEWS.

 -- $name <$email>  $(LC_ALL=C date -R ${SOURCE_DATE_EPOCH:+-d "@$SOURCE_DATE_EPOCH"})
END
cd "$tree"
dpkg-buildpackage -b -us -uc >"$work/log" 2>&1 || {
    cat "$work/log" >&2
    exit 4
}
cp "$work"/*.deb "$work"/*.changes "$work"/*.buildinfo "$to"
(cd "$work" && ls -- *.deb)
