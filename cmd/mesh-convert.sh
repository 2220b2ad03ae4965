#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# mesh-convert: a mesh in one format as a file in another: the two filters that their
# names tell, one behind the other.
set -u
name=mesh-convert
PATH=$(cd "$(dirname "$0")" && pwd):$PATH
usage="usage: $name [-hV] IN OUT"

fail() {
    status=$1
    shift
    printf '%s: %s\n' "$name" "$*" >&2
    exit "$status"
}

help() {
    cat <<END
$usage
Writes the mesh or surface in the file IN as the file OUT, each in the format that its
suffix tells, by an importer and an exporter of termesh.

  -h, --help     print this
  -V, --version  print the version

in:  .tm; .off .stl .ply .obj .mdl .poly .smesh; .node .ele; .m3d .mvm; .oct; .visf;
     .vtu .pvtu; .vtk; .inp; .mesh .meshb; .msh .bdf .nas .unv .med .cgns .ply2; a folder
     polyMesh
out: .tm; .off; .stl; .ply; .obj; .node .ele; .m3d; .mvm; .oct; .visf; .vtu .pvtu; .vtk;
     .html; .inp; .mesh .meshb; .msh .bdf .nas .unv .su2 .key .med .cgns; a folder polyMesh
END
}

# What follows the last dot of a file's name, in small letters.
suffix_of() {
    file=${1##*/}
    case $file in
    polyMesh) echo polymesh ;;
    *.*) printf '%s\n' "${file##*.}" | tr '[:upper:]' '[:lower:]' ;;
    esac
}

importer_of() {
    suffix=$(suffix_of "$1")
    [ "$suffix" != gz ] || suffix=$(suffix_of "${1%.*}")
    case $suffix in
    tm) echo stream ;;
    off | stl | ply | obj | mdl | poly | smesh) echo surface-import ;;
    node | ele) echo tetgen-import ;;
    m3d | mvm) echo m3d-import ;;
    oct) echo oct-import ;;
    visf) echo visf-import ;;
    vtu | pvtu) echo vtu-import ;;
    vtk) echo vtk-import ;;
    inp) echo abaqus-import ;;
    mesh | meshb) echo medit-import ;;
    polymesh) echo openfoam-import ;;
    msh | bdf | nas | unv | med | cgns | ply2) echo gmsh-import ;;
    esac
}

exporter_of() {
    case $(suffix_of "$1") in
    tm) echo stream ;;
    off | stl | ply | obj | m3d | mvm | oct | visf | vtu | vtk) echo "$(suffix_of "$1")-export" ;;
    inp) echo abaqus-export ;;
    mesh | meshb) echo medit-export ;;
    node | ele) echo tetgen-export ;;
    pvtu) echo vtu-export ;;
    html) echo mesh-view ;;
    polymesh) echo openfoam-export ;;
    msh | bdf | nas | unv | su2 | key | med | cgns) echo gmsh-export ;;
    esac
}

# Writes the stream on standard input, or in FILE, as the file $out.
export_mesh() {
    case $exporter in
    tetgen-export) tetgen-export "${out%.*}" "$@" ;;
    openfoam-export | gmsh-export) "$exporter" "$out" "$@" ;;
    mesh-view) mesh-view --title "${in##*/}" -o "$out" "$@" ;;
    medit-export)
        case $(suffix_of "$out") in meshb) set -- --binary "$@" ;; esac
        medit-export -o "$out" "$@"
        ;;
    *) "$exporter" -o "$out" "$@" ;;
    esac
}

# What the importer is to read: all of TetGen's files that belong together.
operand_of() {
    case ${1%.gz} in
    *.node | *.ele) file=${1%.gz} && printf '%s\n' "${file%.*}" ;;
    *) printf '%s\n' "$1" ;;
    esac
}

# The status is the exporter's, unless the importer failed first.
convert() {
    imported=$({ { "$importer" "$operand"; echo $? >&3; } | export_mesh >&4; } 3>&1)
    status=$?
    broken_pipe=141
    [ "$imported" -eq 0 ] || [ "$imported" -eq "$broken_pipe" ] || status=$imported
    return "$status"
} 4>&1

case ${1-} in
-h | --help) help && exit ;;
-V | --version) tet-stats --version | sed "s/^tet-stats/$name/" && exit ;;
--) shift ;;
-?*) fail 2 "unknown option '$1'
$usage" ;;
esac
[ $# -eq 2 ] || fail 2 "two files are needed
$usage"
in=${1%/}
out=${2%/}
case $in in -*) in=./$in ;; esac
case $out in -*) out=./$out ;; esac
importer=$(importer_of "$in")
exporter=$(exporter_of "$out")
operand=$(operand_of "$in")
[ -n "$importer" ] || fail 2 "$in: no importer is known for this suffix ($name --help lists them)"
[ -n "$exporter" ] || fail 2 "$out: no exporter is known for this suffix ($name --help lists them)"
for filter in "$importer" "$exporter"; do
    [ "$filter" = stream ] || command -v "$filter" >/dev/null ||
        fail 4 "there is no $filter (it was left out when termesh was built)"
done
case $importer,$exporter in
stream,stream) fail 2 "both are streams" ;;
stream,*) export_mesh "$in" ;;
*,stream) "$importer" -o "$out" "$operand" ;;
*) convert ;;
esac
