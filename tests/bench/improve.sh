#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# lepp-improve -a improve beside Gmsh, TetGen and CGAL on the same meshes with the
# boundary kept: how large and how bad the mesh becomes, in how many CPU seconds; for us
# with one bound of the size after the other, which gives the front of quality against
# size, and beside each peer with that peer's size and CPU seconds as bounds. The figures
# go to build/bench/improve.tsv, and with gnuplot the fronts are drawn into
# build/bench/improve-front.svg. $1, TM_DATA and the rest: peers.inc; and
#   MESHES   of rnd2000 rnd20000 femur knot house2; all
#   GROWTHS  bounds of the size, in times the input
#   CGAL     runs of it: target edge length in mean edge lengths x iterations
# shellcheck source-path=SCRIPTDIR source=peers.inc
. "$(dirname "$0")/peers.inc"
growths=${GROWTHS:-0.9 1 1.25 1.5 2 3 4}
cgal_runs=${CGAL:-0.7x1 1x1 1.4x1 1x5}

# Prints what was measured on another day, on a machine like that of our design notes.
elsewhere() {
    while IFS='|' read -r of name ratio bad smallest seconds; do
        [ "$of" = "$1" ] || continue
        printf '%-27s %8s %6s %6s %8s %8s %8s %8s  %s\n' "$name" - "$ratio" "$bad" \
            "$smallest" - "$seconds" - '(measured elsewhere)'
        printf '%s\telsewhere\t%s\t-\t%s\t%s\n' "$1" "$name" "$ratio" "$bad" >>"$figures"
    done <<'TABLE'
rnd2000|Mmg -optim -nosurf|0.17|30.7|-|0.85
rnd2000|Mmg -noinsert|0.84|34.5|-|1.9
rnd2000|Stellar|0.19|39.1|15.5|16
rnd2000|Mmg, boundary free|1.24|2.1|-|1.0
rnd2000|CGAL, boundary free|0.52|1.4|-|1.5
rnd20000|Mmg -optim -nosurf|0.08|17.2|-|4.0
rnd20000|Mmg -noinsert|0.86|17.2|-|14.6
rnd20000|Mmg, boundary free|1.05|1.7|-|8.6
femur|Mmg -optim -nosurf|3.89|7.6|-|13.2
femur|Mmg -noinsert|0.94|46.8|-|6.6
femur|Stellar|0.98|46.4|3.6|165
femur|Mmg, boundary free|6.87|2.4|-|24.5
femur|CGAL, boundary free|3.55|1.2|-|33
TABLE
}

peers() {
    mesh=$1 stream=$work/$1.tm
    if have_gmsh; then
        row "$mesh" peer 'Gmsh' '' gmsh_optimize "$stream"
        row "$mesh" peer 'Gmsh 0.6 twice' '' gmsh_optimize "$stream" --threshold 0.6 --times 2
    else
        echo 'Gmsh: needs the package python3-gmsh'
    fi
    # O9/7 is all that TetGen's optimiser can do, S0 lets it do no more than that.
    for switches in q qY qYS0 O9/7; do
        row "$mesh" peer "TetGen -r$switches" '' tetgen_refine "$stream" "$switches"
    done
    if have_cgal; then
        for run in $cgal_runs; do
            row "$mesh" peer "CGAL $run" '' cgal_remesh "$stream" "${run%x*}" "${run#*x}"
        done
    else
        echo 'CGAL: needs the packages g++ and libcgal-dev'
    fi
    elsewhere "$mesh"
}

ours() {
    for growth in $growths; do
        # shellcheck disable=SC2046 # words
        row "$1" ours "at most $growth" "${growth_option:+$growth}" \
            improve "$work/$1.tm" $(growth "$growth")
    done
}

# Beside each peer that kept the boundary: ours with at most as many tetrahedra and, if
# that takes longer, stopped after ever fewer passes. Whoever has fewer bad ones for less
# CPU wins: our whole process with its text against the algorithm alone, where that is
# known.
duels() {
    awk -F '\t' -v mesh="$1" 'BEGIN { OFS = FS }
        $1 == mesh && $2 == "peer" && $11 == "ok" {
            print $3, $5, $6, $9 == "-" ? $10 : $9 }' "$figures" >"$work/duels"
    while IFS="$(printf '\t')" read -r name ratio bad seconds; do
        for stop in '' '-s 6' '-s 3' '-s 1'; do
            ours="vs $name${stop:+, $stop}"
            # shellcheck disable=SC2046,SC2086 # words
            row "$1" duel "$ours" '' improve "$work/$1.tm" $(growth "$ratio") $stop
            awk -v ours="$(figure "$1" "$ours" whole)" -v theirs="$seconds" \
                'BEGIN { exit !(ours + 0 <= theirs + 0) }' && break
        done
        target "  bad %" "$(figure "$1" "$ours" bad)" "$bad"
        target "  CPU s" "$(figure "$1" "$ours" whole)" "$seconds"
    done <"$work/duels"
}

# What the algorithm is to reach. Our whole process, with its text, against the others'
# algorithm alone.
aims() {
    gmsh=$(figure "$1" 'Gmsh 0.6 twice' alone)
    cgal=$(figure "$1" 'CGAL 1x5' alone)
    case $1 in
    rnd2000)
        target 'bad %, at most 1' "$(figure "$1" 'at most 1' bad)" 12
        target 'CPU s, at most 1 (Gmsh 0.6)' "$(figure "$1" 'at most 1' whole)" "$gmsh"
        ;;
    rnd20000)
        target 'bad %, at most 1' "$(figure "$1" 'at most 1' bad)" 6
        target 'CPU s, at most 1 (1/4 of Gmsh 0.6)' "$(figure "$1" 'at most 1' whole)" \
            "$(product "$gmsh" 0.25)"
        ;;
    femur)
        target 'bad %, at most 3' "$(figure "$1" 'at most 3' bad)" 5
        target 'CPU s, at most 3 (1/5 of CGAL 1x5)' "$(figure "$1" 'at most 3' whole)" \
            "$(product "$cgal" 0.2)"
        ;;
    house2) house_aims ;;
    esac
}

# Of all our runs that leave no bad tetrahedron, that with the largest smallest angle.
house_aims() {
    best=$(awk -F '\t' '$1 == "house2" && $2 ~ /^(ours|t38)$/ && $6 == 0 { print $7 "\t" $3 }' \
        "$figures" | sort -n | tail -n 1 | cut -f 2)
    if [ -z "$best" ]; then
        echo '  aim: no bad tetrahedron: NO'
        return
    fi
    target "bad %, $best" "$(figure house2 "$best" bad)" 0
    target "37 degrees to the smallest angle, $best" 37 "$(figure house2 "$best" smallest)"
    target "CPU s, $best" "$(figure house2 "$best" whole)" 0.53
}

: >"$figures"
all=$(meshes | tr '\n' ' ')
for mesh in ${MESHES:-$all}; do
    make_mesh "$mesh"
    head_row
    peers "$mesh"
    ours "$mesh"
    if [ "$mesh" = house2 ]; then
        for growth in 1.5 2 3 4; do
            # shellcheck disable=SC2046 # words
            row "$mesh" t38 "at most $growth, -t 38" "${growth_option:+$growth}" \
                improve "$work/$mesh.tm" -t 38 $(growth "$growth")
        done
    fi
    duels "$mesh"
    aims "$mesh"
done

echo
cp "$figures" build/bench/improve.tsv
echo 'build/bench/improve.tsv: these figures'
if command -v gnuplot >/dev/null; then
    gnuplot -c tests/bench/improve-front.gp build/bench/improve.tsv \
        build/bench/improve-front.svg "${MESHES:-$all}"
    echo 'build/bench/improve-front.svg: the fronts'
else
    echo 'The fronts are not drawn: that needs the package gnuplot-nox'
fi
