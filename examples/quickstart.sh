#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The main job, from nothing: installs what is missing on Debian 12, builds the filters,
# makes surfaces, fills one of them with tetrahedra, improves them, and shows how much better
# they are. All that it makes is in build/.
set -eu
cd "$(dirname "$0")/.."
# shellcheck source=tests/packages.sh
. tests/packages.sh
# shellcheck disable=SC2086 # lists of words
install_packages $build_packages $run_packages

echo "Building the filters (some minutes of one core)"
make -s -j "$(nproc)"
PATH=$PWD/build/bin:$PATH

folder=build/quickstart
mkdir -p "$folder"
cd "$folder"

# awk prints numbers with the locale's decimal point.
LC_ALL=C awk -f ../../examples/knot.awk >knot.off
LC_ALL=C awk -f ../../examples/channel.awk >channel.stl

echo "tetgen-mesh -q knot.off | lepp-improve | tet-stats"
tetgen-mesh -q knot.off | tee mesh.tm | lepp-improve >better.tm
tet-stats --plot quality.svg mesh.tm better.tm | tee quality.txt | sed '/^histogram/,$d'

echo "The surface, both meshes, the whole table and the picture of it are in"
echo "    $PWD"
echo "as knot.off, mesh.tm, better.tm, quality.txt and quality.svg; and channel.stl, a surface"
echo "with named solids. README.md goes on from here."
