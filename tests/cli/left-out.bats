# SPDX-License-Identifier: GPL-3.0-or-later
# What exporters cannot carry: a note says it, --strict refuses it; what they can is there
# without a word.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# Prints two tetrahedra with all that a user may give beside them; with the name of a thing
# that one, without a name none: their markers and regions are 1 all over.
mesh_with() {
    python3 - "$1" <<'END'
import sys
thing = sys.argv[1]
print('termesh 1\n.node\n5 3', 1 if thing == 'node attribute' else 0, 1)
for v, x in enumerate(('0 0 0', '1 0 0', '0 1 0', '0 0 1', '1 1 1')):
    print(v, x, *([0.5] if thing == 'node attribute' else []),
          7 if v == 4 and thing == 'node marker' else
          -7 if v == 4 and thing == 'negative node marker' else
          0 if v == 4 and thing == 'nodes of a set' else 1)
extra = thing == 'other attribute'
print('.ele\n2 4', 2 if extra else 1)
for t, v in enumerate(('0 1 2 3', '1 2 3 4')):
    print(t, v, {'region': 7, 'odd region': 0.5}.get(thing, 1) if t else 1, *([3] if extra else []))
face = ['0 2 1', '0 1 3', '0 3 2', '1 2 4', '1 4 3', '2 3 4']
if thing == 'some faces':
    face = face[1::4]
print('.face\n%d 1' % len(face))
for f, v in enumerate(face):
    print(f, v, {'face marker': 5, 'negative face marker': -5}.get(thing, 1) if f == 1 else 1)
print('.edge\n2 1\n0 0 1', {'edge marker': 3, 'negative edge marker': -3, 'some edges': 0}.get(thing, 1), '\n1 1 4 1')
names = {'node name': 0, 'edge name': 1, 'face name': 2, 'region name': 3}
if thing in names:
    print('.group\n1 0\n0', names[thing], 1, 'a name')
if thing == 'part':
    print('part.node\n1 3 0 0\n0 0 0 0')
if thing == 'unknown block':
    print('.notes\nof somebody')
if thing == 'unmarked':
    print('.octant\n0 0\n.root\n0 0')
print('.end')
END
}

exporters='abaqus getfem m3d medit mvm off openfoam tetgen visf vtk vtu'

# Runs an exporter on with.tm with options; what it wrote is in the folder made.
export_it() {
    rm -rf made
    mkdir made
    case $1 in
    openfoam) openfoam-export "${@:2}" made/foam with.tm ;;
    tetgen) tetgen-export "${@:2}" made/mesh with.tm ;;
    *) "$1-export" "${@:2}" -o made/file with.tm ;;
    esac
}

# Prints x where the exporter leaves something of with.tm out, else '.'.
leaves_out() {
    set -e # which $() has not
    local status=0
    export_it "$1" 2>note
    [ -n "$(ls made)" ]
    if [ ! -s note ]; then
        export_it "$1" --strict
        echo .
        return
    fi
    cat note >&2
    [ "$(wc -l <note)" -eq 1 ]
    grep -Eq "^$1-export: with.tm: [1-9].*\): left out\$" note
    export_it "$1" -q 2>quiet
    [ ! -s quiet ]
    export_it "$1" --strict 2>refused || status=$?
    [ "$status" -eq 3 ]
    [ -z "$(ls made)" ]
    [ "$(sed 's/: the output cannot carry it$/: left out/' refused)" = "$(cat note)" ]
    echo x
}

@test "exporters and what they cannot carry" {
    while read -r line; do
        mesh_with "$line" >with.tm
        printf '%-21s' "$line"
        for exporter in $exporters; do printf ' %s' "$(leaves_out "$exporter")"; done
        echo
    done >table <<'END'
nothing
unmarked
node attribute
node marker
nodes of a set
face marker
negative face marker
some faces
edge marker
some edges
region
odd region
other attribute
node name
edge name
face name
region name
part
unknown block
END
    # abaqus getfem m3d medit mvm off openfoam tetgen visf vtk vtu
    diff - table <<'END'
nothing               . . . . . . . . . . .
unmarked              . . . . . . . . . . .
node attribute        x x x x x x x . x . .
node marker           . x x . x x x . x . .
nodes of a set        . x x . x x x . x . .
face marker           . . x . x x . . x . .
negative face marker  . x x . x x . . x . .
some faces            . . x . x x . . x . .
edge marker           x x x . x x x . x . .
some edges            x x x . x x x . x . .
region                . . x . x . . . x . .
odd region            x x x x x . x . x . .
other attribute       x x x x x . x . x . .
node name             . x x . x x x . x . .
edge name             . x x . x x x . x . .
face name             . . x . x x . . x . .
region name           . . x . x . . . x . .
part                  x x x x x x x . x x x
unknown block         x x x x x x x x x x x
END
}

# The formats that differ of those of Gmsh; msh4 and msh2 carry the same.
@test "gmsh-export and what its formats cannot carry" {
    [ -x "$TM_BUILD/bin/gmsh-export" ] || skip "there is no libgmsh"
    while read -r thing; do
        mesh_with "$thing" >with.tm
        printf '%-21s' "$thing"
        for format in msh4 msh2 msh1 mesh inp unv su2; do
            if gmsh-export --strict --format "$format" -o file with.tm 2>note; then
                printf ' .'
            else
                grep -q "^gmsh-export: with.tm: [1-9].*: the output cannot carry it$" note
                printf ' x'
            fi
        done
        echo
    done >table <<'END'
nothing
node attribute
node marker
negative node marker
face marker
negative face marker
edge marker
negative edge marker
region
odd region
other attribute
node name
edge name
face name
region name
part
unknown block
END
    # msh4 msh2 msh1 mesh inp unv su2; the cells have the region 1, as those names
    diff - table <<'END'
nothing               . . . . . . .
node attribute        x x x x x x x
node marker           . . . x x x x
negative node marker  x x x x x x x
face marker           . . . . . . .
negative face marker  x x x x x x x
edge marker           . . . . . . x
negative edge marker  x x x x x x x
region                . . . . . . x
odd region            x x x x x x x
other attribute       x x x x x x x
node name             . . x x x x x
edge name             . . x x . x x
face name             . . x x . x .
region name           . . x x . . x
part                  x x x x x x x
unknown block         x x x x x x x
END
}

@test "several things are one note, with their counts" {
    mesh_with 'face marker' | sed 's/^\.end/.notes\nx\nmore.text\ny\n.end/' >with.tm
    run -0 --separate-stderr m3d-export with.tm
    [ "$stderr" = 'm3d-export: with.tm: 6 markers of faces (.face), 2 blocks (.notes, '\
'more.text): left out' ]
    run -3 --separate-stderr m3d-export --strict with.tm
    [ "$output" = "" ]
    [ "$stderr" = 'm3d-export: with.tm: 6 markers of faces (.face), 2 blocks (.notes, '\
'more.text): the output cannot carry it' ]
}

@test "cells beside those of the mesh" {
    mesh_with nothing | sed 's/^\.end/.mix\n1 0\n0 4 0 1 2 3\n.end/' >with.tm
    for exporter in $exporters; do
        if [ "$exporter" = tetgen ]; then continue; fi
        run -0 --separate-stderr export_it "$exporter"
        [[ "$stderr" == *'2 cells (.ele)'*': left out' ]]
        run -3 --separate-stderr export_it "$exporter" --strict
    done
    # what octree-mesh keeps for itself is not missed; names and markers are
    command -v octree-mesh >/dev/null || skip "octree-mesh is not built"
    surface sphere off | octree-mesh -q -s 3 >octree.tm
    cp octree.tm with.tm
    for exporter in getfem m3d mvm oct off openfoam visf vtk vtu; do
        run -0 --separate-stderr export_it "$exporter" --strict
        [ "$stderr" = "" ]
    done
    surface sphere off >sphere.off
    octree-mesh -q -s 3 --polyhedra sphere.off >polyhedra.tm
    for octree in polyhedra.tm <(polylla3d -q octree.tm) <(octree-repair -q octree.tm | polylla3d -q); do
        cat "$octree" >with.tm
        grep -q '^surface.face' with.tm
        for exporter in openfoam visf vtk vtu; do
            run -0 --separate-stderr export_it "$exporter" --strict
            [ "$stderr" = "" ]
        done
    done
    surface sphere stream | awk '/^surface.face/ { print; getline; print $1, 1; faces = 1; next }
        faces && NF == 4 { print $0, 1 + NR % 2; next } { print }' | sed '$d' >marked.tm
    printf 'surface.group\n1 0\n1 2 2 even\n.end\n' >>marked.tm
    octree-mesh -q -s 3 marked.tm >with.tm
    for exporter in getfem openfoam vtk vtu; do
        run -0 --separate-stderr export_it "$exporter" --strict
    done
    for exporter in m3d mvm oct off visf; do
        run -0 --separate-stderr export_it "$exporter"
        [[ "$stderr" == *' markers of faces (.facet), 1 names of faces (.group): left out' ]]
        run -3 --separate-stderr export_it "$exporter" --strict
    done
}
