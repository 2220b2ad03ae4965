# SPDX-License-Identifier: GPL-3.0-or-later
# lepp-improve --surface-tolerance: on surfaces that are hard to fill, judged by
# tests/bench/surface-judge.py, which shares no code with it; and --against of tet-stats
# and mesh-check.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

# How fine the shapes are here: small.
fine() {
    case $1 in
    needles) echo 20 ;;
    strips) echo 40 ;;
    scan) echo 12 ;;
    wavy | patches) echo 6 ;;
    nested) echo 4 ;;
    *) echo 3 ;;
    esac
}

# The shapes that TetGen fills with good tetrahedra in a moment.
shapes() {
    python3 "$tests/shapes/awkward.py" | grep -vx gap
}

setup_file() {
    export tests=$BATS_TEST_DIRNAME/.. made=$BATS_FILE_TMPDIR
    for shape in $(shapes); do
        python3 "$tests/shapes/awkward.py" "$shape" "$(fine "$shape")" >"$made/$shape.surface"
        tetgen-mesh --quiet -q --no-history "$made/$shape.surface" >"$made/$shape.tm"
        lepp-improve -q --no-history --surface-tolerance 0.005 "$made/$shape.tm" \
            >"$made/$shape.improved.tm"
    done
}

setup() {
    load helpers
    cd "$BATS_TEST_TMPDIR" || exit
}

@test "every shape: a valid mesh, the surface within the tolerance as mesh-check proves it" {
    for shape in $(shapes); do
        echo "$shape"
        mesh-check -q --json check.json "$made/$shape.improved.tm" \
            --against "$made/$shape.tm" >/dev/null
        python3 - check.json <<'END'
import json, sys
a = json.load(open(sys.argv[1]))["against"]
most = max(a["surface"][way]["most"] for way in ("there", "back"))
print(most / a["diagonal"])
assert most <= 0.005 * a["diagonal"] * (1 + 1e-9)
END
    done
}

@test "every shape: distances, curves, corners, volumes, topology, regions by the judge" {
    need_vtk
    for shape in $(shapes); do
        echo "$shape"
        /usr/bin/python3 -B "$tests/bench/surface-judge.py" --samples 10000 \
            "$made/$shape.tm" "$made/$shape.improved.tm" 0.005
    done
}

@test "no shape has more bad tetrahedra than before" {
    for shape in $(shapes); do
        tet-stats -q --json stats.json "$made/$shape.tm" "$made/$shape.improved.tm" >/dev/null
        python3 - stats.json "$shape" <<'END'
import json, sys
s = json.load(open(sys.argv[1]))
was, now = (s[when]["bad_percent"] for when in ("before", "after"))
print(sys.argv[2], was, now)
assert now <= was
END
    done
}

@test "the same bytes with any number of threads; a tolerance of 0 is none; = is a length" {
    for shape in needles scan wavy; do
        lepp-improve -q --no-history -j 1 --surface-tolerance 0.005 "$made/$shape.tm" |
            cmp - "$made/$shape.improved.tm"
        lepp-improve -q --no-history -j 2 --surface-tolerance 0.005 "$made/$shape.tm" |
            cmp - "$made/$shape.improved.tm"
        lepp-improve -q --no-history "$made/$shape.tm" >kept.tm
        lepp-improve -q --no-history --surface-tolerance 0 "$made/$shape.tm" | cmp - kept.tm
        mesh-check -q --against "$made/$shape.tm" --json check.json "$made/$shape.tm" >/dev/null
        lepp-improve -q --no-history --surface-tolerance \
            "=$(python3 -c 'import json; print(repr(0.005 * json.load(open("check.json"))["against"]["diagonal"]))')" \
            "$made/$shape.tm" | cmp - "$made/$shape.improved.tm"
    done
}

@test "walls that nearly touch: a valid mesh, or a message" {
    python3 "$tests/shapes/awkward.py" gap 2 >gap.off
    if tetgen-mesh --quiet gap.off >gap.tm 2>err; then
        lepp-improve -q --surface-tolerance 0.005 gap.tm >improved.tm
        mesh-check improved.tm
    else
        [ -s err ]
    fi
}

@test "--against: a mesh is at its own surface, in any format of it" {
    surface sphere off >sphere.off
    surface sphere stl >sphere.stl
    surface sphere poly >sphere.poly
    surface sphere stream >sphere.tm
    tetgen-mesh --quiet -Y -q sphere.off >mesh.tm
    for file in sphere.off sphere.stl sphere.poly sphere.tm mesh.tm; do
        mesh-check --against "$file" --within 1e-9 --json check.json mesh.tm >/dev/null
        [ "$(json check.json against surface there parts)" = \
            "$(json check.json boundary_faces)" ]
        tet-stats --against "$file" --json stats.json mesh.tm >report
        grep -q "^  from the mesh's surface  *[0-9]" report
        [ "$(json stats.json against surface)" = "$(json check.json against surface)" ]
    done
}

@test "--against: how far a cube that is moved is, as numbers and as exit status" {
    surface cube off >cube.off
    tetgen-mesh --quiet cube.off >cube.tm
    awk 'NF == 3 && NR > 2 && !/^3 / { $1 += 0.25 } { print }' cube.off >moved.off
    run -0 mesh-check --against moved.off --json check.json cube.tm
    for what in surface curves corners; do
        for way in there back; do
            [ "$(json check.json against $what $way most)" = 0.25 ]
        done
    done
    [ "$(json check.json against most)" = 0.25 ]
    mesh-check --against moved.off --within =0.25 cube.tm
    run -1 mesh-check --against moved.off --within =0.2499 cube.tm
    [[ $output == *"farther than --within allows" ]]
    mesh-check --against moved.off --within 0.145 cube.tm
    run -1 mesh-check --against moved.off --within 0.144 cube.tm
    run -0 tet-stats --against moved.off --json - cube.tm cube.tm
    [[ $output == *'"against": {'* ]]
}

@test "--against: the wall between two regions is of the surface" {
    two_boxes >boxes.poly
    tetgen-mesh --quiet boxes.poly >boxes.tm
    mesh-check --against boxes.poly --within 1e-15 boxes.tm
    awk 'NF == 5 && $5 == 101 { $4 = 1.125 } { print }' boxes.poly >moved.poly
    run -1 mesh-check --against moved.poly --within =0.1 --json check.json boxes.tm
    [ "$(json check.json against surface there most)" = 0.125 ]
    [ "$(json check.json against curves there most)" = 0.125 ]
}

@test "--against: what is wrong is said" {
    surface cube off >cube.off
    tetgen-mesh --quiet cube.off >cube.tm
    printf 'termesh 1\n.node\n0 3 0 0\n.ele\n0 4 0\n.end\n' >none.tm
    run -2 mesh-check --within 0.1 cube.tm
    run -2 mesh-check --feature-angle 30 cube.tm
    run -2 tet-stats --feature-angle 30 cube.tm
    run -2 mesh-check --against - cube.tm
    run -2 mesh-check --against cube.off --within -1 cube.tm
    run -2 mesh-check --against cube.off --within 2 cube.tm
    run -2 mesh-check --against cube.off --feature-angle 181 cube.tm
    run -3 mesh-check --against none.tm cube.tm
    [[ $output == *"none.tm"* ]]
    run -3 mesh-check --against cube.off none.tm
    [[ $output == *"none.tm"* ]]
    run -4 mesh-check --against absent.off cube.tm
    mesh-check --against cube.off --feature-angle 95 --json check.json cube.tm
    [ "$(json check.json against curves there parts)" = 0 ]
}
