# SPDX-License-Identifier: GPL-3.0-or-later
# Broken surfaces all the way: surface-mend, tetgen-mesh, mesh-check. What comes out has
# the volume that was meant, or is refused for the true reason, with a place.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    cd "$BATS_TEST_TMPDIR" || exit
}

broken() {
    python3 "$BATS_TEST_DIRNAME/../shapes/broken.py" "$@" 2>volume >broken.stl
}

# What the faults need to be told.
options_for() {
    case " $* " in *' gap '*) echo --weld auto ;; esac
    case " $* " in *' hole '*) echo --fill 0.6 ;; esac
    case " $* " in *' island '*) echo --islands 0.01 ;; esac
}

# A place in a message: three numbers in brackets.
has_place() {
    grep -q '([-0-9.e+]*, [-0-9.e+]*, [-0-9.e+]*)' "$1"
}

# right KIND…: the mesh has the volume, which mesh-check and the surface agree on. Faults
# of the positions change it by as much as they moved them.
right() {
    broken "$@"
    # shellcheck disable=SC2046 # words
    surface-mend --quiet $(options_for "$@") -o mended.tm broken.stl
    mesh-check --json surface.json -q mended.tm
    tetgen-mesh --quiet -q mended.tm -o mesh.tm
    mesh-check --json mesh.json -q mesh.tm
    cat surface.json mesh.json | grep -o '"volume": [-0-9.e]*' |
        awk -v want="$(cat volume)" -v by="$([[ " $* " == *' gap '* ]] && echo 1e-6 || echo 1e-9)" \
            '{ e = $2 - want; if (e < 0) e = -e; if (e > by) exit 1 } END { exit NR != 2 }'
}

# refused KIND…: by all three, with a place; surface-mend writes it all the same.
refused() {
    broken "$@"
    [ "$(cat volume)" = refused ]
    # shellcheck disable=SC2046 # words
    surface-mend $(options_for "$@") -o mended.tm broken.stl 2>said && return 1
    grep -q ': still: ' said
    has_place said
    mesh-check mended.tm >said && return 1
    has_place said
    grep -q "$reason" said
    tetgen-mesh -q mended.tm -o mesh.tm 2>said && return 1
    has_place said
    [ ! -e mesh.tm ]
}

@test "one fault: noise, gap, double, back, degenerate, flat, junction, turned, inward, hole, island, wall, crack" {
    for kind in noise gap double back degenerate flat junction turned inward hole island wall crack; do
        echo "$kind"
        right $kind
    done
}

@test "two faults" {
    for kinds in 'noise turned' 'gap double' 'junction noise' 'flat double' 'hole turned' \
        'wall noise' 'crack double' 'inward gap' 'back shuffle' 'degenerate junction' \
        'island hole' 'wall inward' 'double hole'; do
        echo "$kinds"
        # shellcheck disable=SC2086 # words
        right $kinds
    done
}

@test "shells within: as regions, and as cavities where they look inward" {
    for kinds in 'inside noise' 'inside turned' 'inside double'; do
        # shellcheck disable=SC2086 # words
        broken $kinds
        surface-mend --quiet broken.stl | tetgen-mesh --quiet --regions -q -o mesh.tm
        mesh-check -q --json mesh.json mesh.tm
        grep -q '"volume": \(2\|1.99999999\|2.00000000\)[0-9]*,' mesh.json
        [ "$(rows .ele mesh.tm | awk '{ print $6 }' | sort -u | xargs)" = '1 2' ]
    done
    for kinds in 'cavity noise' 'cavity shuffle' 'cavity junction'; do
        # shellcheck disable=SC2086 # words
        broken $kinds
        surface-mend --quiet broken.stl | tetgen-mesh --cavities -q -o mesh.tm 2>said
        grep -q 'looks inward, at (.*): left empty' said
        mesh-check --json mesh.json mesh.tm | grep -q 'Euler number *2'
        grep -q '"volume": 1.9[34][0-9]*,' mesh.json
    done
}

@test "what cannot be mended is refused, with the reason and a place" {
    reason='^crossings: [1-9]'
    for kinds in cross touch 'cross noise' 'cross turned' 'touch double' 'cross hole'; do
        echo "$kinds"
        # shellcheck disable=SC2086 # words
        refused $kinds
    done
    reason='^open edges: [1-9]'
    for kinds in torn 'torn noise' 'torn turned' 'torn double'; do
        echo "$kinds"
        # shellcheck disable=SC2086 # words
        refused $kinds
    done
}
