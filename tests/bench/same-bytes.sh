#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Do two builds make the same bytes? same-bytes.sh OLD NEW, both build folders: runs all
# filters of both on the same generated input and compares what they print, say, write and
# exit with; seconds are left out. The number of runs that differ is the exit status.
set -u
[ $# -eq 2 ] || {
    echo "usage: same-bytes.sh OLD-BUILD NEW-BUILD" >&2
    exit 2
}
old=$(cd "$1" && pwd) || exit 2
new=$(cd "$2" && pwd) || exit 2
work=$(mktemp -d) || exit 4
trap 'rm -rf "$work"' EXIT
mkdir "$work/in" "$work/old" "$work/new"
runs=0
differ=0

without_seconds() {
    find "$@" -type f -exec sed -i -e 's/"seconds": *[0-9.e+-]*//g' \
        -e '/: [0-9.]* s, [0-9.]* s of CPU, /d' {} +
}

# run_in FOLDER BIN COMMAND
run_in() {
    (
        cd "$1" || exit
        PATH=$2:$PATH sh -c "$3" >stdout 2>stderr </dev/null
        echo $? >status
    )
    without_seconds "$1"/*
}

# run NAME COMMAND… : in both builds, in folders of their own beside the input.
run() {
    name=$1
    shift
    runs=$((runs + 1))
    rm -rf "$work/old" "$work/new"
    mkdir "$work/old" "$work/new"
    run_in "$work/old" "$old/bin" "$*"
    run_in "$work/new" "$new/bin" "$*"
    if diff -rq "$work/old" "$work/new" >"$work/diff"; then
        return
    fi
    differ=$((differ + 1))
    echo "DIFFER  $name: $*"
    sed "s|$work/||g" "$work/diff"
    diff -r "$work/old" "$work/new" | head -n "${LINES_SHOWN:-6}"
}

# make FILE COMMAND… : input, made by the old build.
make_input() {
    file=$1
    shift
    (cd "$work/in" && PATH=$old/bin:$old/bench:$PATH sh -c "$*" >"$file" 2>/dev/null)
}

points() {
    awk -v n="$1" -v seed="$2" 'BEGIN { srand(seed); print n, 3, 0, 0
        for (i = 1; i <= n; i++) printf "%d %.17g %.17g %.17g\n", i, rand(), rand(), rand() }'
}

points 1500 5 >"$work/in/points.node"
make_input random.tm tetgen-mesh points.node
for shape in gear plate sheets spikes stairs turned hand folded; do
    make_input $shape.off shapes $shape
done
make_input gear.tm tetgen-mesh -q gear.off
make_input stairs.tm tetgen-mesh -q1.4 -Y stairs.off
make_input regions.tm "sed 's/.*/&/' gear.tm | awk '/^\\./ { b = \$1; h = 1; print; next }
    b == \".ele\" && h { print \$1, \$2, 1; h = 0; next }
    b == \".ele\" && NF >= 5 { print \$1, \$2, \$3, \$4, \$5, \$1 % 3; next } { h = 0; print }'"
make_input poly.tm "polylla3d gear.tm"
make_input star.tm "polylla3d --star random.tm"
make_input mixed.tm "octree-mesh -q -s 5 gear.off"
make_input spikes.tm "octree-mesh -q -s 5 spikes.off"
make_input bad.tm "sed 's/^\\(2[0-9] \\)[^ ]*/\\1 0.5/' mixed.tm"
make_input folded.tm "octree-mesh -q -s 4 --resolve 0 folded.off"
make_input boundary.off "off-export gear.tm"
make_input gear.mdl "awk 'NR == 2 { n = \$1; print \"ARRAY1<POINT3D>]\"; print n; next }
    NR > 2 && NR <= 2 + n { print } NR == 3 + n { print \"ARRAY1<STRING>]\"; print m }
    NR > 2 + n { print \$2, \$3, \$4, 0, 0, 0 } ' m=\$(sed -n '2s/^[0-9]* \\([0-9]*\\).*/\\1/p' gear.off) gear.off"
make_input mixed.m3d "m3d-export mixed.tm"
make_input mixed.mvm "mvm-export mixed.tm"
make_input mixed.oct "oct-export mixed.tm"
make_input poly.visf "visf-export poly.tm"
printf 'termesh 1\n.node\n1 3 0 0\n1 0 0 x\n.end\n' >"$work/in/wrong.tm"
: >"$work/in/empty.tm"
head -c 20000 "$work/in/gear.tm" >"$work/in/cut.tm"

in=../in
run mesh-surface "tetgen-mesh -q $in/gear.off"
run mesh-points "tetgen-mesh $in/points.node"
run mesh-quality "tetgen-mesh -q1.2 -a 0.01 -Y --json report $in/stairs.off"
for algorithm in bisection centroid wcentroid delaunay swap-centroid selective improve; do
    run "improve-$algorithm" "lepp-improve -a $algorithm --json report $in/random.tm"
done
run improve-surface "lepp-improve -v --json report $in/gear.tm"
run improve-regions "lepp-improve --json report $in/regions.tm"
run improve-stairs "lepp-improve -t 40 -s 3 $in/stairs.tm"
run improve-ops "lepp-improve --ops swap,smooth --json report $in/random.tm"
run improve-growth "lepp-improve --max-growth 1.1 --json report $in/gear.tm"
run improve-volume "lepp-improve -Q volume $in/gear.tm"
run swap-fixed "lepp-improve -a swap-centroid --path fixed --json report $in/random.tm"
run refine-set "lepp-improve -a bisection --set box=0,0,0,0.3,0.3,0.3 --until-size 0.05 $in/random.tm"
run improve-set "lepp-improve --set box=0,0,0,0.5,0.5,0.5 --json report $in/random.tm"
run selective-m "lepp-improve -a selective -m 1.1 -s converged --json report $in/random.tm"
run selective-full "lepp-improve -a selective --path full --max-star 6 $in/gear.tm"
run selective-both "lepp-improve -a selective --with both --json report $in/gear.tm"
run selective-swap "lepp-improve -a selective --with face-swap $in/regions.tm"
run tet-stats "tet-stats --json report --plot plot.svg --list $in/gear.tm"
run tet-stats-two "tet-stats $in/gear.tm $in/random.tm"
for mesh in gear random regions mixed spikes bad folded poly star; do
    run "check-$mesh" "mesh-check --json report $in/$mesh.tm"
    run "check-json-$mesh" "mesh-check -v --json - $in/$mesh.tm"
done
for mode in terminal edge face cavity; do
    run "poly-$mode" "polylla3d --mode $mode --json report $in/random.tm"
done
run poly-star "polylla3d --star --absorb --json report $in/gear.tm"
run poly-merge "polylla3d --merge-coplanar --max-tets 20 --no-swallow $in/regions.tm"
run poly-raw "polylla3d --no-repair --mode edge $in/gear.tm"
run poly-label "polylla3d --label --mode face --face-metric inradius $in/gear.tm"
run poly-centroid "polylla3d --star=centroid --absorb --json report $in/random.tm"
run poly-radius "polylla3d --star=0.05 $in/regions.tm"
run poly-cells "polylla3d --cells 60 --star --json report $in/random.tm"
run poly-size "polylla3d --size 0.2 --absorb $in/gear.tm"
run poly-terminal-face "polylla3d --mode terminal-face $in/random.tm"
run poly-partition "polylla3d --label $in/regions.tm | polylla3d --partition --star"
run poly-levels "polylla3d --star --levels 3 --json report $in/random.tm"
run poly-again "polylla3d --star --cells 50 --json report $in/poly.tm"
run poly-octants "polylla3d --json report $in/spikes.tm"
run poly-dual "poly-dual --json report $in/random.tm"
run poly-dual-regions "poly-dual --feature-angle 30 $in/regions.tm"
run poly-dual-convex "poly-dual --feature-angle 30 --convex --json report $in/gear.tm"
run octree-polyhedra "octree-mesh -s 5 --polyhedra --json report $in/gear.off"
for need in fv vem dg; do
    run "poly-stats-$need" "poly-stats --for $need $in/poly.tm"
done
run poly-stats "poly-stats --json report --plot plot.svg $in/poly.tm"
run poly-stats-star "poly-stats --json - $in/star.tm"
run octree-gear "octree-mesh -v -s 5 -u --json report $in/gear.off"
for shape in plate sheets spikes stairs turned hand; do
    run "octree-$shape" "octree-mesh -s 5 --json report $in/$shape.off"
done
run octree-folded "octree-mesh -s 4 --resolve 0 --feature-angle 30 $in/folded.off"
run octree-region "octree-mesh -a 3 -r $in/gear.mdl 6 --lenient $in/gear.off"
run repair-spikes "octree-repair -t 0.2 --trace trace --json report $in/spikes.tm"
run repair-folded "octree-repair -v -t 0.2 --json report $in/folded.tm"
run repair-refine "octree-repair -t 0.2 --method refine -i 3 $in/spikes.tm"
run repair-bad "octree-repair --json report $in/bad.tm"
for list in '' -e -s -j -a -l --certify; do
    run "jens$list" "jens-stats $list --json report $in/mixed.tm"
done
run jens-tets "jens-stats --histo histo --plot plot.svg --fail-below 0.1 $in/gear.tm"
for format in off vtk vtu getfem m3d mvm visf; do
    run "$format-export" "$format-export $in/mixed.tm"
    run "$format-export-tets" "$format-export $in/regions.tm"
    run "$format-export-poly" "$format-export $in/poly.tm"
done
run off-all "off-export --all $in/mixed.tm"
run oct-export "oct-export $in/mixed.tm"
run openfoam "openfoam-export -o case $in/poly.tm || openfoam-export case $in/poly.tm"
run openfoam-mixed "openfoam-export case $in/mixed.tm"
run visf-binary "visf-export --binary little --neighbours $in/poly.tm | od -An -tx1"
run visf-import "visf-import $in/poly.visf"
run tetgen-export "tetgen-export gear $in/regions.tm"
run tetgen-import "tetgen-export gear $in/gear.tm && tetgen-import gear"
run mdl-import "mdl-import $in/gear.mdl"
run m3d-import "m3d-import $in/mixed.m3d"
run mvm-import "m3d-import $in/mixed.mvm"
run oct-import "oct-import $in/mixed.oct"
for filter in "$old"/bin/*; do
    filter=$(basename "$filter")
    run "$filter-help" "$filter --help; $filter --version; $filter --nothing"
    run "$filter-wrong" "$filter $in/wrong.tm"
    run "$filter-cut" "$filter $in/cut.tm"
    run "$filter-empty" "$filter $in/empty.tm"
    run "$filter-points" "$filter $in/points.node"
done

echo "$runs runs, $differ differ"
[ "$differ" -eq 0 ]
