#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# polylla3d with 18 sets of options on 28 meshes: random, structured, thin, of several
# regions, touching themselves, inside of surfaces. In each result mesh-check finds nothing,
# but for edges and corners at which the tetrahedra touch too, and the volume of each region
# is that of the tetrahedra, to 1e-12 of the whole; not with --merge-coplanar=10, whose
# facets are bent. Prints what is wrong, and how many of the combinations are right.
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
python=${PYTHON:-python3}

$python -B tests/bench/awkward_tets.py "$work"
for n in 30 100 400 1500; do
    points $n $n >"$work/points.node"
    tetgen-mesh -q --no-history "$work/points.node" >"$work/random-$n.tm" 2>/dev/null ||
        tetgen-mesh --no-history "$work/points.node" >"$work/random-$n.tm"
done
for shape in gear:1 torus:12 star:1 spool:1 step:1 wedge:1; do
    shapes "${shape%:*}" "${shape#*:}" >"$work/shape.off"
    tetgen-mesh -q1.4 --quiet --no-history "$work/shape.off" >"$work/${shape%:*}.tm"
done

# The kinds of defects that mesh-check finds.
defects() {
    mesh-check "$1" | sed '1,/^$/d; /^ /d; s/  .*//'
}

total=0
wrong=0
for mesh in "$work"/*.tm; do
    defects "$mesh" >"$work/defects"
    while read -r options; do
        total=$((total + 1))
        status=0
        # shellcheck disable=SC2086 # words
        polylla3d -q --no-history $options "$mesh" >"$work/cells" 2>"$work/errors" ||
            status=$?
        # 1: not all are such stars as were asked for.
        if [ "$status" -gt 1 ] || ! defects "$work/cells" | cmp -s - "$work/defects" ||
            ! $python -B tests/bench/region_volumes.py "$mesh" "$work/cells" \
                "${options##*=}" >>"$work/errors" 2>&1; then
            wrong=$((wrong + 1))
            echo "$(basename "$mesh" .tm), polylla3d $options:"
            tail -n 3 "$work/errors"
        fi
    done <<END

--star
--star=0.02
--star=centroid
--absorb
--star --absorb
--no-swallow
--max-tets 5 --star
--mode edge
--mode face
--mode terminal-face --star
--mode cavity
--cells 20
--cells 20 --star
--size 0.3 --star=centroid
--merge-coplanar
--star --merge-coplanar=10
--levels 2
END
done
echo "$((total - wrong)) of $total combinations are right"
[ "$wrong" -eq 0 ]
