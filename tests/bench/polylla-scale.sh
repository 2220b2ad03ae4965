#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Whether polylla3d takes time and memory in proportion to its input, and how much beside
# mesh-check, which reads the same stream and looks at all of it once: the whole processes
# on random points. What mesh-check takes for a tetrahedron grows with the size too, by
# what reading and caches cost. The environment:
#   RUNS     so many runs, of which the median counts; 5
#   POINTS   so many points; 10000 100000. With 1000000 too it takes three minutes
# shellcheck source-path=SCRIPTDIR source=peers.inc
. "$(dirname "$0")/peers.inc"
sizes=${POINTS:-10000 100000}
aimed_from=100000

# run NAME COMMAND…: CPU seconds and kB; exit status 1 is no failure.
run() {
    name=$1
    shift
    # shellcheck disable=SC2016 # for the inner shell
    cpu 1 sh -c '"$@" || [ $? -eq 1 ]' sh "$@" >>"$work/$name.$n" 2>"$work/errors" ||
        { cat "$work/errors" >&2; exit 1; }
}

# per_tet NAME: microseconds of CPU and bytes for each tetrahedron.
per_tet() {
    awk -v s="$(median_of "$work/$1.$n")" -v tets="$tets" '$2 > kb { kb = $2 }
        END { print 1e6 * s / tets, 1024 * kb / tets }' \
        "$work/$1.$n" >"$work/$1.per-tet.$n"
    printf '  %-12s %8.3f s  %7.3f us and %6.1f bytes for each tetrahedron\n' "$1" \
        "$(median_of "$work/$1.$n")" "$(number "$1" "$n" 1)" "$(number "$1" "$n" 2)"
}

# number NAME POINTS COLUMN: 1 is microseconds, 2 bytes.
number() {
    cut -d ' ' -f "$3" "$work/$1.per-tet.$2"
}

ratio() {
    awk -v a="$1" -v b="$2" 'BEGIN { print a / b }'
}

# growth_of NAME: CPU per tetrahedron, to that of the fewest points.
growth_of() {
    ratio "$(number "$1" "$n" 1)" "$(number "$1" "$first" 1)"
}

first=
for n in $sizes; do
    points "$n" 1 >"$work/points.node"
    tetgen-mesh --no-history -o "$work/points.tm" "$work/points.node"
    tets=$(tets_of "$work/points.tm")
    # Turn by turn, so that all see the same machine.
    for _ in $(seq "$runs"); do
        run mesh-check mesh-check -q "$work/points.tm"
        run default polylla3d -q "$work/points.tm"
        run --star polylla3d -q --star "$work/points.tm"
    done
    echo "$n points, $tets tetrahedra"
    for name in mesh-check default --star; do
        per_tet "$name"
    done
    # For few tetrahedra, what the process itself takes counts too.
    for name in $([ "$n" -lt "$aimed_from" ] || echo default --star); do
        target "CPU of $name to mesh-check" \
            "$(ratio "$(number "$name" "$n" 1)" "$(number mesh-check "$n" 1)")" 3
        target "bytes per tetrahedron, $name" "$(number "$name" "$n" 2)" 100
    done
    if [ -n "$first" ]; then
        echo "CPU per tetrahedron, $n to $first points"
        printf '  %-47s %9.3f\n' 'mesh-check, as the floor' "$(growth_of mesh-check)"
        target default "$(growth_of default)" 1.3
        target --star "$(growth_of --star)" 2
    fi
    first=${first:-$n}
done
