# SPDX-License-Identifier: GPL-3.0-or-later
# The polyhedra are good for virtual elements and for discontinuous Galerkin methods: the
# patch test, and the order of the errors. The solver is tests/solve/poisson.c; its exit
# status is 1 where a linear solution is not found but for rounding.

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
    PATH=${TM_BUILD:?}/solve:$PATH
}

# polyhedra OPTION… FILE: with exit status 1 there are some that are no stars.
polyhedra() {
    polylla3d -q "$@" || [ $? -eq 1 ]
}

# both OPTION… FILE: by both methods.
both() {
    poisson "$@" && poisson --dg "$@"
}

# solves TETRAHEDRA: with all sorts of polyhedra.
solves() {
    for options in '' --star '--star --absorb' --merge-coplanar \
        '--star --absorb --merge-coplanar' '--mode edge' '--mode face' '--mode cavity' \
        '--cells 30' '--cells 30 --star --absorb' --no-swallow '--max-tets 1' --no-repair; do
        echo "polylla3d $options"
        # shellcheck disable=SC2086 # words
        polyhedra $options "$1" >polyhedra.tm
        both polyhedra.tm
    done
}

# grid N: the unit cube as N^3 cubes.
grid() {
    sheared_boxes "$1" 0 | awk -v n="$1" '/^\./ { block = $1; rows = 0 }
        block == ".node" && rows++ > 1 {
            $2 = $1 % (n + 1) / n
            $3 = int($1 / (n + 1)) % (n + 1) / n
            $4 = int($1 / (n + 1)^2) / n
        }
        { print }'
}

# orders L2 H1 COARSE FINE [OPTION…]: from a mesh to one of half the size the errors of the
# smooth solution fall to these parts at most.
orders() {
    local most="$1 $2" coarse=$3 fine=$4
    shift 4
    for file in $coarse $fine; do
        poisson --wave "$@" "$file" | sed 's/,//g' | awk '{ print $9, $12 }'
    done | tee /dev/stderr | awk -v most="$most" '{ l2[NR] = $1; h1[NR] = $2 }
        END { split(most, m, " "); exit !(l2[2] < m[1] * l2[1] && h1[2] < m[2] * h1[1]) }'
}

@test "a linear solution is found: random points" {
    solves points.tm
}

@test "the example: a line for each model, the errors are of rounding" {
    cat example
    [ "$(grep -c '^[0-9]* unknowns, .* L2 error [0-9.]*e-1[0-9], .*e-1[0-9]$' example)" -eq 3 ]
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

@test "a linear solution is found: cubes, boxes, octants" {
    grid 3 >grid.tm
    both grid.tm
    sheared_boxes 4 >boxes.tm
    both boxes.tm
    # At the surface quadrilaterals are bent, which is nothing for virtual elements.
    octree-mesh -q -s 4 made/knot.off | polylla3d -q | poisson --dg
}

@test "on 12^3 cubes the errors are those that another program has found" {
    grid 12 >grid.tm
    poisson --wave grid.tm | grep '^1331 unknowns, .* L2 error 9.138e-03, H1 error 8.676e-02$'
    poisson --wave --dg grid.tm |
        grep '^6912 unknowns, .* L2 error 6.551e-03, H1 error 8.701e-02$'
}

@test "values are of second order, gradients of first" {
    grid 4 >grid-4.tm
    grid 8 >grid-8.tm
    orders 0.3 0.55 grid-4.tm grid-8.tm
    orders 0.3 0.55 grid-4.tm grid-8.tm --dg
    for options in '--max-tets 1' --star '--star --merge-coplanar'; do
        for volume in 0.001 0.000125; do
            # shellcheck disable=SC2086 # words
            polyhedra $options box-$volume.tm >$volume.tm
        done
        orders 0.4 0.7 0.001.tm 0.000125.tm
        orders 0.4 0.7 0.001.tm 0.000125.tm --dg
    done
}

@test "the solver finds what is wrong with polyhedra" {
    polylla3d -q --star points.tm >polyhedra.tm
    # A facet of another triangle; a cell that is inside out; a facet that is not plane.
    awk '/^\./ { block = $1 } block == ".facet" && $1 == 200 { $5 = $5 % 500 + 1 } 1' \
        polyhedra.tm >other.tm
    run -1 poisson other.tm
    run -1 poisson --dg other.tm
    awk '/^\./ { block = $1 } block == ".facet" && $1 ~ /^[0-9]+$/ && NF > 4 {
        n = $6; $6 = $7; $7 = n } 1' polyhedra.tm >inside-out.tm
    run -3 poisson inside-out.tm
    polylla3d -q --merge-coplanar=20 made/gear.better.tm >bent.tm
    run -1 poisson bent.tm
    run -3 poisson points.tm
}
