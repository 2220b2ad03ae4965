#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Are the bytes the same from every compiler, level of optimisation and set of
# instructions, number of threads and locale, and under valgrind? Builds into
# build/determinism/, runs all filters on generated input, and prints for each way how many
# of the runs differ from those of the first. The environment:
#   WAYS      some of: gcc-O2 gcc-O0 gcc-O3 clang-O2 clang-O0 clang-O3 gcc-avx2 gcc-native
#             clang-native (the builds), j1 j2 j8 comma turkish utf8 valgrind; all
#   BASE      a folder with bin/ that is the first one; build/determinism/gcc-O2
# The exit status is 1 where some differ.
set -u
cd "$(dirname "$0")/../.." || exit 4
builds=$PWD/build/determinism
work=$(mktemp -d) || exit 4
trap 'rm -rf "$work"' EXIT
ways=${WAYS:-gcc-O0 gcc-O3 clang-O0 clang-O2 clang-O3 gcc-avx2 gcc-native clang-native j1 j2 j8 \
    comma turkish utf8 valgrind}

# Makes the filters: build_in NAME COMPILER FLAGS
build_in() {
    echo "building $1: $2 $3" >&2
    make -s -j "$(nproc)" BUILD="$builds/$1" CC="${LAUNCHER:-} $2" CFLAGS="$3 -w" LDFLAGS= \
        filters >"$work/log" 2>&1 || {
        cat "$work/log" >&2
        exit 4
    }
}

# The flags of a way that is a build.
flags_of() {
    case $1 in
    *-avx2) echo "-O2 -mavx2 -mfma" ;;
    *-native) echo "-O3 -march=native" ;;
    *) echo "-${1#*-}" ;;
    esac
}

# Runs all commands in a folder of their own: run_all BIN FOLDER. $before and $after are
# words before each command and options behind it.
run_all() {
    mkdir -p "$2"
    number=0
    while read -r filter options; do
        number=$((number + 1))
        [ -x "$1/$filter" ] || continue
        mkdir "$2/$number"
        # shellcheck disable=SC2086 # words
        (cd "$2/$number" && $before "$1/$filter" --quiet --no-history $after $options \
            >stdout 2>stderr </dev/null; echo $? >status)
    done <"$work/commands"
    find "$2" -type f -exec sed -i 's/"seconds": *[0-9.e+-]*//g' {} +
}

# Prints how a way compares: compare WAY BIN
compare() {
    run_all "$2" "$work/run/$1"
    different=0
    for folder in "$work/run/first"/*; do
        number=${folder##*/}
        diff -r "$work/run/first/$number" "$work/run/$1/$number" >"$work/diff" 2>&1 && continue
        different=$((different + 1))
        echo "    $(sed -n "${number}p" "$work/commands")"
        head -n 4 "$work/diff" | cut -c 1-200
    done
    printf '%-14s %5d runs %5d differ\n' "$1" "$(ls "$work/run/first" | wc -l)" "$different"
    rm -rf "$work/run/$1"
    [ "$different" -eq 0 ] || failed=1
}

# A locale of that name, in $LOCPATH: locale NAME SOURCE CHARACTERS
locale() {
    [ -d "$work/locale/$1" ] && return
    mkdir -p "$work/locale"
    localedef -i "$2" -f "$3" "$work/locale/$1" 2>/dev/null || echo "no locale $2" >&2
}

# Generated input in $work/in.
make_input() {
    make -s build/bench/shapes || exit 4
    mkdir "$work/in"
    for shape in gear spikes; do
        build/bench/shapes "$shape" >"$work/in/$shape.off"
    done
    cd "$work/in" || exit 4
    PATH=$1:$PATH
    tetgen-mesh --quiet -q1.4 gear.off >gear.tm
    awk 'BEGIN { srand(5); print 900, 3, 0, 0
        for (i = 1; i <= 900; i++) printf "%d %.17g %.17g %.17g\n", i, rand(), rand(), rand() }' \
        >points.node
    tetgen-mesh --quiet points.node >random.tm
    awk '$1 == ".ele" { print; getline; print $1, $2, 1; cells = 1; next } /^\./ { cells = 0 }
        cells { $0 = $0 " " 1 + $1 % 3 } 1' random.tm >regions.tm
    octree-mesh --quiet -s 4 gear.off >mixed.tm
    octree-mesh --quiet -s 4 spikes.off >spikes.tm
    polylla3d --quiet gear.tm >poly.tm
    for format in abaqus medit vtk vtu; do
        "$format-export" --quiet regions.tm >"regions.$format"
    done
    m3d-export --quiet mixed.tm >mixed.m3d
    oct-export --quiet mixed.tm >mixed.oct
    visf-export --quiet poly.tm >poly.visf
    openfoam-export --quiet foam poly.tm
    [ -z "$(find . -type f -empty)" ] || exit 4
    cd - >/dev/null || exit 4
}

commands() {
    in=$work/in
    cat <<LIST
tetgen-mesh -q1.2 -a 0.001 $in/gear.off
tetgen-mesh $in/points.node
lepp-improve --json report $in/random.tm
lepp-improve --json report $in/gear.tm
lepp-improve -a bisection -s 2 $in/random.tm
lepp-improve -a centroid $in/random.tm
lepp-improve -a delaunay $in/random.tm
lepp-improve -a swap-centroid $in/random.tm
lepp-improve -a selective --path full --with both $in/random.tm
lepp-improve -Q volume $in/gear.tm
polylla3d --json report $in/random.tm
polylla3d --star --absorb $in/gear.tm
polylla3d --mode face $in/random.tm
polylla3d --cells 60 --star $in/random.tm
polylla3d --levels 3 --star $in/random.tm
polylla3d $in/spikes.tm
poly-dual --feature-angle 30 --convex $in/gear.tm
poly-stats --for vem --json report $in/poly.tm
poly-stats --for dg $in/poly.tm
tet-stats --json report --list $in/gear.tm
jens-stats --json report --histo histo $in/mixed.tm
jens-stats -e --certify $in/mixed.tm
jens-stats -a $in/mixed.tm
mesh-check --json report $in/gear.tm
mesh-check --json report $in/spikes.tm
mesh-view $in/gear.tm
octree-mesh -s 5 --json report $in/gear.off
octree-mesh -s 4 --polyhedra $in/spikes.off
octree-mesh -s 4 --feature-angle 30 $in/spikes.off
octree-repair -t 0.35 --json report $in/spikes.tm
surface-mend --weld auto --json report $in/gear.off
surface-import $in/gear.off
abaqus-import $in/regions.abaqus
medit-import $in/regions.medit
vtk-import $in/regions.vtk
vtu-import $in/regions.vtu
m3d-import $in/mixed.m3d
oct-import $in/mixed.oct
visf-import $in/poly.visf
openfoam-import $in/foam
tetgen-import $in/points.node
LIST
    for format in abaqus getfem m3d medit mvm obj off ply stl visf vtk vtu; do
        for mesh in regions mixed poly; do
            echo "$format-export $in/$mesh.tm"
        done
    done
    echo "oct-export $in/mixed.tm"
    echo "tetgen-export out $in/regions.tm"
    echo "openfoam-export out $in/poly.tm"
    echo "gmsh-export out.msh $in/mixed.tm"
}

# Runs that valgrind does in a minute.
small() {
    grep -v -e octree -e bisection -e selective -e delaunay -e centroid -e view -e gmsh -e tetgen-mesh
}

failed=0
before=
after=
first=${BASE:-$builds/gcc-O2}
[ -n "${BASE:-}" ] || build_in gcc-O2 gcc -O2
make_input "$first/bin"
commands >"$work/commands"
run_all "$first/bin" "$work/run/first"
for way in $ways; do
    case $way in
    j*)
        after="--threads ${way#j}"
        compare "$way" "$first/bin"
        after=
        ;;
    comma | turkish | utf8)
        case $way in
        comma) locale comma de_DE ISO-8859-1 ;;
        turkish) locale turkish tr_TR UTF-8 ;;
        utf8) locale utf8 en_US UTF-8 ;;
        esac
        before="env LOCPATH=$work/locale LC_ALL=$way"
        compare "$way" "$first/bin"
        before=
        ;;
    valgrind)
        before="valgrind -q --log-file=/dev/null"
        small <"$work/commands" >"$work/few" && mv "$work/few" "$work/commands"
        rm -rf "$work/run/first"
        before='' && run_all "$first/bin" "$work/run/first"
        before="valgrind -q --log-file=/dev/null"
        compare "$way" "$first/bin"
        before=
        ;;
    *)
        build_in "$way" "${way%%-*}" "$(flags_of "$way")"
        compare "$way" "$builds/$way/bin"
        ;;
    esac
done
exit "$failed"
