# SPDX-License-Identifier: GPL-3.0-or-later
# The polyhedra are good for the virtual element method: the patch test. The solver is
# tests/vem/vem-poisson.c; its exit status is 1 where the error is above 1e-9.

bats_require_minimum_version 1.5.0

setup_file() {
    root=$(cd "$BATS_TEST_DIRNAME/../.." && pwd)
    export root
    cd "$BATS_FILE_TMPDIR" || exit
    export LC_ALL=C
    awk 'BEGIN {
        srand(5)
        print 500, 3
        for (i = 1; i <= 500; i++) print i, rand(), rand(), rand()
    }' >points.node
    tetgen-mesh -o points.tm points.node
    make -s -C "$root/examples" build="$TM_BUILD" to="$PWD/made" poisson >example
    # Two boxes side by side, with a marked wall between them; one box, finer and finer.
    cat >boxes.smesh <<'END_OF_FILE'
12 3
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
9 2 0 0
10 2 1 0
11 2 0 1
12 2 1 1
11 1
4 1 2 3 4 1
4 5 6 7 8 1
4 1 2 6 5 1
4 3 4 8 7 1
4 4 1 5 8 1
4 2 3 7 6 2
4 2 9 10 3 1
4 6 11 12 7 1
4 2 9 11 6 1
4 10 3 7 12 1
4 9 10 12 11 1
0
2
1 0.5 0.5 0.5 10
2 1.5 0.5 0.5 20
END_OF_FILE
    tetgen-mesh -q -a 0.01 --switches A -o boxes.tm boxes.smesh
    for volume in 0.001 0.000125; do
        awk 'BEGIN {
            print "OFF\n8 6 0"
            for (v = 0; v < 8; v++) print v % 2, int(v / 2) % 2, int(v / 4)
            print "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5"
        }' | tetgen-mesh -q -a $volume -o box-$volume.tm
    done
}

setup() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    PATH=${TM_BUILD:?}/vem:$PATH
}

# polyhedra OPTION… FILE: with exit status 1 there are some that are no stars.
polyhedra() {
    polylla3d -q "$@" || [ $? -eq 1 ]
}

# solves TETRAHEDRA: with all sorts of polyhedra.
solves() {
    for options in '' --star '--star --absorb' --merge-coplanar \
        '--star --absorb --merge-coplanar' '--mode edge' '--mode face' '--mode cavity' \
        --no-swallow '--max-tets 1' --no-repair; do
        echo "polylla3d $options"
        # shellcheck disable=SC2086 # words
        polyhedra $options "$1" | vem-poisson
    done
}

@test "a linear solution is found: random points" {
    solves points.tm
}

@test "the example: a line for each model, the errors are of rounding" {
    cat example
    [ "$(grep -c '^[0-9]* unknowns, .* mean square [0-9.]*e-1[0-9]$' example)" -eq 3 ]
}

@test "a linear solution is found: improved TetGen meshes of a knot and of a gear" {
    solves made/knot.better.tm
    solves made/gear.better.tm
}

@test "a linear solution is found: two regions" {
    solves boxes.tm
    polylla3d -q --merge-coplanar boxes.tm >polyhedra.tm
    [ "$(rows .cell polyhedra.tm | awk '{ print $NF }' | sort -u | xargs)" = "10 20" ]
}

@test "coplanar facets that were joined are polygons, not all of them triangles" {
    polylla3d -q --merge-coplanar made/gear.better.tm >polyhedra.tm
    [ "$(rows .facet polyhedra.tm | awk '$4 > 3' | wc -l)" -gt 100 ]
}

@test "the error of a smooth solution falls with the size of the elements" {
    for options in --star '--star --merge-coplanar'; do
        for volume in 0.001 0.000125; do
            # shellcheck disable=SC2086 # words
            polyhedra $options box-$volume.tm | vem-poisson --wave | sed 's/.* //'
        done >errors
        xargs <errors
        # Half the size: of second order is a quarter.
        [ "$(awk 'NR == 1 { e = $1 } NR == 2 { print $1 < e / 2 }' errors)" = 1 ]
    done
}

@test "the solver finds what is wrong with polyhedra" {
    polylla3d -q --star points.tm >polyhedra.tm
    # A facet of another triangle; a cell that is inside out; a facet that is not plane.
    awk '/^\./ { block = $1 } block == ".facet" && $1 == 200 { $5 = $5 % 500 + 1 } 1' \
        polyhedra.tm >other.tm
    run -1 vem-poisson other.tm
    awk '/^\./ { block = $1 } block == ".facet" && $1 ~ /^[0-9]+$/ && NF > 4 {
        n = $6; $6 = $7; $7 = n } 1' polyhedra.tm >inside-out.tm
    run -3 vem-poisson inside-out.tm
    polylla3d -q --merge-coplanar=20 made/gear.better.tm >bent.tm
    run -1 vem-poisson bent.tm
    run -3 vem-poisson points.tm
}
