#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Whether lepp-improve -a improve takes time and memory in proportion: the whole process
# on 20 000 and on 200 000 random points. The environment: peers.inc; and
#   GROWTHS   bounds of the size, in times the input
# shellcheck source-path=SCRIPTDIR source=peers.inc
. "$(dirname "$0")/peers.inc"
growths=${GROWTHS:-1 2}

for n in 20000 200000; do
    make_mesh rnd$n
done
for growth in $growths; do
    echo
    for n in 20000 200000; do
        # shellcheck disable=SC2046,SC2086 # words
        cpu 1 lepp-improve -q $improve_options $(growth "$growth") -o "$out" \
            "$work/rnd$n.tm" >"$work/cpu"
        before=$(tets_of "$work/rnd$n.tm")
        after=$(tets_of "$out")
        awk -v before="$before" -v after="$after" \
            '{ print 1e6 * $1 / before, 1024 * $2 / after }' "$work/cpu" >"$work/per-tet.$n"
        printf 'at most %s, %6d points, %7d -> %7d tetrahedra: %s\n' "$growth" $n \
            "$before" "$after" "$(awk '{ printf "%.2f us per input tetrahedron, %.0f bytes " \
                "per output tetrahedron", $1, $2 }' "$work/per-tet.$n")"
    done
    target 'CPU per tetrahedron, 200 000 to 20 000' "$(paste "$work/per-tet.200000" \
        "$work/per-tet.20000" | awk '{ print $1 / $3 }')" 1.5
    target 'bytes per output tetrahedron, 200 000' \
        "$(cut -d ' ' -f 2 "$work/per-tet.200000")" 250
done
