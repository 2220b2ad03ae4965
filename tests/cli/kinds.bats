# SPDX-License-Identifier: GPL-3.0-or-later
# Which filters take which kinds of mesh: all of them against all of those.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

kinds='nothing part points surface tetrahedra no-tetrahedra mixed mixed-facets polyhedra'

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    tetrahedron='4 3 0 0,1 0 0 0,2 1 0 0,3 0 1 0,4 0 0 1'
    sides='4 0,1 1 3 2,2 1 2 4,3 2 3 4,4 1 4 3'
    cube='8 3 0 0,1 0 0 0,2 1 0 0,3 1 1 0,4 0 1 0,5 0 0 1,6 1 0 1,7 1 1 1,8 0 1 1'
    hexahedron=".node,$cube,.mix,1 0,1 8 1 2 3 4 5 6 7 8"
    facets='.facet,4 0,1 1 -1 3 1 3 2,2 1 -1 3 1 2 4,3 1 -1 3 2 3 4,4 1 -1 3 1 4 3'
    mesh nothing
    mesh part "surface.node,$tetrahedron,surface.face,$sides,"
    mesh points ".node,$tetrahedron,"
    mesh surface ".node,$tetrahedron,.face,$sides,"
    mesh tetrahedra ".node,$tetrahedron,.ele,1 4 0,1 1 2 3 4,"
    mesh no-tetrahedra ".node,$tetrahedron,.ele,0 4 0,"
    mesh mixed "$hexahedron,"
    mesh mixed-facets "$hexahedron,.facet,1 1,1 1 -1 4 1 4 3 2 5,"
    mesh polyhedra ".node,$tetrahedron,$facets,.cell,1 0,1 4 1 2 3 4,"
}

# mesh NAME LINES, with commas for their ends.
mesh() {
    printf 'termesh 1\n%s.end\n' "$(echo "$2" | tr , '\n')
" | grep . >"$1.tm"
}

filters() {
    for file in "$TM_BUILD"/bin/*; do
        case ${file##*/} in
        *-import | mesh-convert) ;;
        *) echo "${file##*/}" ;;
        esac
    done
}

# The exit status of a filter for a kind; its messages go to stderr.txt.
status_of() {
    rm -rf folder folder.*
    case $1 in
    gmsh-export) set -- "$1" --format msh4 - "$2" ;;
    openfoam-export | tetgen-export) set -- "$1" folder "$2" ;;
    esac
    local status=0
    "$@" >out.txt 2>stderr.txt || status=$?
    echo "$status"
}

# The whole table.
expected() {
    cat <<'END'
                nothing part points surface tetrahedra no-tetrahedra mixed mixed-facets polyhedra
abaqus-export   3 3 0 0 0 0 0 0 3
getfem-export   3 3 3 0 0 3 0 0 3
gmsh-export     3 3 0 0 0 0 0 0 3
jens-stats      3 3 3 3 0 0 0 0 3
lepp-improve    3 3 3 3 0 0 3 3 3
m3d-export      3 3 3 3 0 3 0 0 3
medit-export    3 3 0 0 0 0 0 0 3
mesh-check      3 0 3 0 0 0 0 0 0
mesh-view       3 3 0 0 0 0 0 0 0
mvm-export      3 3 3 3 0 3 0 0 3
obj-export      3 3 3 0 0 3 0 0 0
oct-export      3 3 3 3 3 3 3 3 3
octree-mesh     3 0 3 0 3 3 3 3 3
octree-repair   3 3 3 3 3 3 0 0 3
off-export      3 3 3 0 0 3 0 0 0
openfoam-export 3 3 3 3 0 3 0 0 0
ply-export      3 3 3 0 0 3 0 0 0
poly-dual       3 3 3 3 0 0 3 3 3
poly-stats      3 3 3 3 3 3 3 3 0
polylla3d       3 3 3 3 0 0 3 3 0
stl-export      3 3 3 0 0 3 0 0 0
surface-mend    3 0 3 0 3 3 3 3 3
tet-stats       3 3 3 3 0 0 3 3 3
tetgen-export   3 0 0 0 0 0 3 3 3
tetgen-mesh     3 0 0 0 3 3 3 3 3
visf-export     3 3 0 0 0 0 0 0 0
vtk-export      3 3 0 0 0 0 0 0 0
vtu-export      3 3 0 0 0 0 0 0 0
END
}

@test "each filter takes the kinds that it says, and refuses the others with the right words" {
    printf '%-16s%s\n' '' "$kinds" >table
    for filter in $(filters); do
        row=
        for kind in $kinds; do
            status=$(status_of "$filter" "$kind.tm")
            row="$row $status"
            [ "$status" -ne 3 ] || [ "$filter" = oct-export ] ||
                grep -q "^$filter: $kind.tm: \(holds .* but $filter takes\|has no elem\|has mixed elements, but no .octant\|has no \(faces\|cells\)\)" \
                    stderr.txt || { cat stderr.txt && false; }
            [ "$status" -ne 3 ] || ! [ -s out.txt ]
        done
        printf '%-16s%s\n' "$filter" "${row# }" >>table
    done
    cat table
    expected | awk -v filters="$(filters | tr '\n' ' ')" \
        'NR == 1 || index(" " filters, " " $1 " ")' | diff - table
}

@test "the words: what is there, what is right, which filters take it" {
    run -3 lepp-improve mixed.tm
    [ "$output" = 'lepp-improve: mixed.tm: holds mixed elements (.mix), but lepp-improve takes '\
'tetrahedra (.ele) (what it holds is for polylla3d, octree-repair, jens-stats, mesh-check, mesh-view and exporters)' ]
    run -3 tet-stats nothing.tm
    [ "$output" = 'tet-stats: nothing.tm: holds nothing, but tet-stats takes tetrahedra (.ele)' ]
    run -3 polylla3d mixed-facets.tm
    [[ $output == 'polylla3d: mixed-facets.tm: has mixed elements, but no .octant '* ]]
}

@test "a gate on --json does not pass for the wrong kind: there is none" {
    for kind in points surface mixed polyhedra; do
        run -3 tet-stats --json report.json "$kind.tm"
        [ ! -e report.json ]
    done
    tet-stats --json report.json no-tetrahedra.tm
    grep -q '"tets": 0' report.json
}

@test "points in a stream are what a .node file is to tetgen-mesh" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    tetgen-mesh points.tm | tet-stats --json report.json - >/dev/null
    grep -q '"tets": 1' report.json
}
