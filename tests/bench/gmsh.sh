#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# gmsh-import of a million tetrahedra beside Gmsh itself, which only opens the file, and
# gmsh-export beside Gmsh, which opens and writes one: medians of CPU seconds.
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
cells=${CELLS:-55}
command -v gmsh-import >/dev/null || { echo "$0: gmsh-import is not built" >&2; exit 1; }
io make "$cells" >"$work/grid.tm"
sed -n '/^\.ele/{n;s/ .*/ tetrahedra/;p;q;}' "$work/grid.tm"

# The median CPU seconds of a command.
median() {
    cpu "$runs" "$@" | cut -d ' ' -f 1
}

for format in msh4 'msh4 --binary' msh2 'msh2 --binary'; do
    # shellcheck disable=SC2086 # words
    gmsh-export -q --format $format -o "$work/grid.msh" "$work/grid.tm"
    ours=$(median gmsh-import -q "$work/grid.msh")
    gmsh=$(median gmsh "$work/grid.msh" -parse_and_exit -nt 1 -v 0)
    # shellcheck disable=SC2086 # words
    written=$(median gmsh-export -q --format $format - "$work/grid.tm")
    suffix=${format%% *}
    binary=
    [ "$format" = "$suffix" ] || binary=-bin
    both=$(median gmsh "$work/grid.msh" -save -nt 1 -v 0 -format "$suffix" ${binary:+"$binary"} \
        -o "$work/again.msh")
    awk -v f="$format" -v o="$ours" -v g="$gmsh" -v w="$written" -v b="$both" 'BEGIN {
        printf "%-14s  gmsh-import %6.3f s, Gmsh opens %6.3f s: %.2f (at most 1.5 in text)", f, o, g, o / g
        printf "   gmsh-export %6.3f s, Gmsh opens and saves %6.3f s: %.2f\n", w, b, w / b
    }'
done
