# SPDX-License-Identifier: GPL-3.0-or-later
# Files of every kind given to every filter that reads files: packed ones, with a byte
# order mark, and those that another filter reads, or none.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# One octant, of which one element is the mesh.
write_oct() {
    cat <<'END'
8 12 1
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
0 1 0
1 2 0
2 3 0
3 0 0
4 5 0
5 6 0
6 7 0
7 4 0
0 4 0
1 5 0
2 6 0
3 7 0
8 0 1 2 3 4 5 6 7 0
0
Geometric Transform
0 0 0
0 0 0
1
END
}

# Samples of what filters read, each with its reader in its name.
write_samples() {
    for form in off coff obj ply ply-little stl stl-binary node poly smesh mdl; do
        surface sphere "$form" >"$form.surface"
    done
    mv mdl.surface sphere.mdl-import
    cube_tm >cube.stream
    tetgen-export cube cube.stream
    mv cube.ele cube.tetgen-import
    mv cube.face face.tetgen-import
    mixed >mixed.tm
    m3d-export mixed.tm >a.m3d-import
    mvm-export mixed.tm >b.m3d-import
    cubes >cubes.tm
    for options in '' '--binary little' '--binary big'; do
        # shellcheck disable=SC2086 # words
        visf-export $options cubes.tm >"a${options##* }.visf-import"
    done
    write_oct >a.oct-import
    vtu-export mixed.tm >a.vtu-import
    vtk-export --no-quality mixed.tm >a.vtk-import
    abaqus-export mixed.tm >a.abaqus-import
    medit-export mixed.tm >a.medit-import
    medit-export --binary mixed.tm >b.medit-import
    printf '*HEADING\n*NODE\n1, 0, 0, 0\n' >b.abaqus-import
    printf '** made by hand\n*Node\n1, 0, 0, 0\n' >c.abaqus-import
    getfem-export mixed.tm >'a GetFEM mesh.none'
    if [ -x "$TM_BUILD/bin/gmsh-export" ]; then
        for format in msh4 msh2 msh1; do
            gmsh-export -q --format "$format" -o "$format.gmsh-import" cube.stream
        done
    fi
    rm -f mixed.tm cubes.tm cube.*[!mt]
    write_others
}

cube_tm() {
    echo 'termesh 1
.node
4 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
.ele
1 4 0
1 1 2 3 4
.face
4 1
1 1 3 2 1
2 1 2 4 1
3 2 3 4 2
4 1 4 3 2
.end'
}

# What no filter reads, or with a name that says so, by the words that say what it is.
write_others() {
    printf '# made by hand\nmesh3d\n' >'a Netgen mesh.none'
    printf 'ISO-10303-21;\nHEADER;\n' >'a STEP file.none'
    printf '%72sS%7d\n%72sG%7d\n' '' 1 '' 1 >'an IGES file.none'
    printf '*KEYWORD\n*NODE\n' >'an LS-DYNA.none'
    printf '$ made by hand\nSOL 101\nCEND\nBEGIN BULK\n' >'a Nastran.use gmsh-import of a file'
    printf 'GRID,1,,0.,0.,0.\n' >'a Nastran input file.use gmsh-import of a file'
    printf '/*------------*- C++ -*-----*/\nFoamFile\n{\n}\n' >'an OpenFOAM file.with its folder'
    printf '%%PDF-1.4\n%%\342\343\317\323\n' >'a PDF document.none'
    printf '\211PNG\r\n\032\n' >'a PNG image.none'
    printf '\211HDF\r\n\032\n' >'an HDF5 file.use gmsh-import of a file'
    printf '<!DOCTYPE html>\n<html><body>404</body></html>\n' >'an HTML page.none'
    printf 'PK\003\004\024\000' >'a zip archive.unpack'
    printf 'BZh91AY&SY' >'bzip2 data.unpack'
    printf '\3757zXZ\000' >'xz data.unpack'
    surface cube off | iconv -f ascii -t utf-16 >'UTF-16 text.save it as UTF-8'
    printf 'version https://git-lfs.github.com/spec/v1\noid sha256:00\n' \
        >'a pointer of Git LFS.git lfs pull'
}

# What a filter must say of a sample: says SAMPLE.
says() {
    case $1 in
    *.surface) echo 'use tetgen-mesh, octree-mesh or surface-import' ;;
    *.none) echo "looks like ${1%.none}*no filter reads it" ;;
    *.stream) echo 'looks like a termesh stream: it needs no import' ;;
    *-import) echo "use ${1##*.}" ;;
    *) echo "looks like ${1%.*}*: *${1##*.}" ;;
    esac
}

# is_refused SAMPLE FILTER OPERAND…
is_refused() {
    sample=$1
    shift
    run -3 --separate-stderr "$@"
    [ "$output" = '' ] && [ "${#stderr_lines[@]}" -eq 1 ] &&
        [[ "$stderr" == "$1: "*"; looks like "* ]] && [[ "$stderr" == *$(says "$sample")* ]] ||
        { echo "$sample: $stderr" && false; }
}

@test "every importer and every file: who reads it is named" {
    write_samples
    for filter in "$TM_BUILD"/bin/*-import; do
        filter=${filter##*/}
        for sample in *.*; do
            case $sample:$filter in
            *."$filter":* | node.surface:tetgen-import) continue ;;
            poly.surface:tetgen-import | smesh.surface:tetgen-import) continue ;;
            *'use gmsh-import of a file':gmsh-import | *.medit-import:gmsh-import) continue ;;
            *.surface:surface-import | *.mdl-import:surface-import | *.stream:surface-import) continue ;;
            *'its folder':openfoam-import) continue ;;
            *:tetgen-import)
                cp "$sample" wrong.node
                is_refused "$sample" tetgen-import wrong.node
                rm wrong.node
                ;;
            *) is_refused "$sample" "$filter" "$sample" ;;
            esac
        done
    done
}

@test "filters that read streams or surfaces name the reader of any other file" {
    write_samples
    for sample in *.*; do
        case $sample in
        *.stream) continue ;;
        esac
        is_refused "$sample" tet-stats "$sample"
        case $sample in
        *.surface | *.mdl-import) continue ;;
        esac
        is_refused "$sample" tetgen-mesh "$sample"
        [ ! -x "$TM_BUILD/bin/octree-mesh" ] || is_refused "$sample" octree-mesh "$sample"
        is_refused "$sample" oct-import -s "$sample" a.oct-import
    done
}

@test "a damaged file of the filter's own format: no other filter is named" {
    write_samples
    for sample in *-import; do
        filter=${sample##*.}
        cp "$sample" cut.node
        truncate -s -7 cut.node
        run -3 --separate-stderr "$filter" cut.node
        [[ "$stderr" != *'looks like'* ]] || [ "$filter" = tetgen-import ]
    done
    surface cube off | head -n 12 >cut.off
    run -3 --separate-stderr tetgen-mesh cut.off
    [[ "$stderr" != *'looks like'* ]]
}

# Packed -------------------------------------------------------------------------------

# same FILTER OPERAND-OF-THE-FILE… : FILE and FILE.gz give the same.
same() {
    "$@" --no-history >plain.out
    last=${*: -1}
    gzip -c "$last" >packed.gz
    "${@:1:$#-1}" --no-history packed.gz >packed.out
    cmp plain.out packed.out
}

@test "gzip: every reader, from a file and from a pipe" {
    write_samples
    same tet-stats cube.stream
    for sample in *.surface; do
        case $sample in
        poly.* | smesh.*) # their kind is in their suffix
            form=${sample%.*}
            cp "$sample" "a.$form"
            tetgen-mesh --no-history "a.$form" >plain.out
            gzip "a.$form"
            tetgen-mesh --no-history "a.$form.gz" | cmp - plain.out
            continue
            ;;
        esac
        same tetgen-mesh "$sample"
        gzip -c "$sample" | tetgen-mesh --no-history | cmp - plain.out
    done
    for sample in *-import; do
        [ "${sample##*.}" = tetgen-import ] || same "${sample##*.}" "$sample"
    done
    gzip -c cube.stream | tet-stats - >packed.out
    tet-stats cube.stream | cmp - packed.out
}

@test "gzip: TetGen's files, a .node beside a .poly, rules and octants" {
    cube_tm >cube.tm
    tetgen-export cube cube.tm
    tetgen-import --no-history cube >from-files
    for file in cube.node cube.ele cube.face; do
        gzip -c "$file" >packed && mv packed "$file"
    done
    tetgen-import --no-history cube | cmp - from-files
    surface cube poly >whole.poly
    { echo 0 3 0 0 && sed '1,/^8 /d' whole.poly; } >apart.poly
    awk '/^12 /{ exit } 1' whole.poly >apart.node
    tetgen-mesh --no-history apart.poly >plain.out
    for file in apart.node apart.poly; do
        gzip -c "$file" >packed && mv packed "$file"
    done
    tetgen-mesh --no-history apart.poly | cmp - plain.out
    # named with .gz
    for file in *.node *.ele *.face *.poly; do
        mv "$file" "$file.gz"
    done
    tetgen-mesh --no-history apart.poly.gz | cmp - plain.out
    tetgen-import --no-history cube | cmp - from-files
    tetgen-import --no-history cube.ele.gz cube.node.gz cube.face.gz | cmp - from-files
    tetgen-import --no-history cube.ele.gz | grep -qx .ele
    mv cube.node.gz away.gz
    run -3 --separate-stderr tetgen-import cube.ele.gz
    [ "$stderr" = 'tetgen-import: cube.ele.gz: its .node file is not among the files' ]
    [ -x "$TM_BUILD/bin/octree-mesh" ] || return 0
    surface cube off | gzip >cube.off.gz
    printf 'n_regions 1\n.2 .2 .2 .7 .7 .7 3\n' | gzip >boxes.gz
    octree-mesh --no-history -a 1 -b boxes.gz -r cube.off.gz 2 cube.off.gz >octree.tm
    [ -s octree.tm ]
}

@test "gzip: members one behind the other, and zeros behind them, as zcat" {
    cube_tm >cube.tm
    tet-stats cube.tm >plain.out
    for size in 1 10 100; do
        { head -c "$size" cube.tm | gzip && gzip </dev/null &&
            tail -c +$((size + 1)) cube.tm | gzip; } >two.gz
        tet-stats two.gz | cmp - plain.out
    done
    { cat two.gz && head -c 1000 /dev/zero; } | tet-stats | cmp - plain.out
}

@test "gzip: cut short anywhere, damaged, or followed by something else: exit 3" {
    cube_tm | gzip -n >whole.gz
    surface cube off | gzip -n >off.gz
    size=$(wc -c <whole.gz)
    for cut in $(seq 2 $((size - 1))); do
        run -3 --separate-stderr tet-stats <(head -c "$cut" whole.gz)
        [[ "$stderr" == *'gzip data is cut short' ]]
    done
    run -3 --separate-stderr tetgen-mesh <(head -c 60 off.gz)
    [[ "$stderr" == *'gzip data is cut short' ]]
    for filter in tet-stats tetgen-mesh mdl-import; do
        run -3 --separate-stderr "$filter" <(cat whole.gz && echo more)
        [[ "$stderr" == *'gzip data ends, and something else follows' ]]
    done
    # the sum behind the data
    { head -c $((size - 6)) whole.gz && printf '\1\2' && tail -c 4 whole.gz; } >wrong.gz
    run -3 --separate-stderr tet-stats wrong.gz
    [ "$stderr" = 'tet-stats: wrong.gz: gzip data is damaged: incorrect data check' ]
    head -c 60 whole.gz >short.gz # lines of what is packed are not known
    run -3 --separate-stderr tet-stats short.gz
    [ "$stderr" = 'tet-stats: short.gz: gzip data is cut short' ]
    run -3 --separate-stderr tet-stats <(gzip -c whole.gz)
    [[ "$stderr" == *'looks like gzip data within gzip data: unpack it with zcat' ]]
}

@test "gzip: damaged anywhere: exit 0 or 3" {
    many 200 | gzip -n >whole.gz
    for n in $(seq 100); do
        python3 -c '
import random, sys
n = int(sys.argv[1])
random.seed(n)
data = bytearray(open("whole.gz", "rb").read())
for _ in range(1 + n % 3):
    data[random.randrange(2, len(data))] = random.randrange(256)
sys.stdout.buffer.write(data)' "$n" >wrong.gz
        status=0
        tet-stats wrong.gz >/dev/null 2>message || status=$?
        [ "$status" -eq 0 ] || [ "$status" -eq 3 ] || { cat message && false; }
    done
}

# Byte order marks ---------------------------------------------------------------------

@test "a byte order mark is skipped in text that others write" {
    write_samples
    marked() {
        printf '\357\273\277' | cat - "$1"
    }
    for sample in off coff obj ply ply-little stl node; do
        tetgen-mesh --no-history "$sample.surface" >plain.out
        marked "$sample.surface" | tetgen-mesh --no-history | cmp - plain.out
    done
    for form in poly smesh; do
        mv "$form.surface" "a.$form"
        marked "a.$form" >"b.$form"
        tetgen-mesh --no-history "a.$form" >plain.out
        tetgen-mesh --no-history "b.$form" | cmp - plain.out
    done
    for sample in sphere.mdl-import a.m3d-import b.m3d-import a.oct-import a.visf-import; do
        "${sample##*.}" --no-history "$sample" >plain.out
        marked "$sample" | "${sample##*.}" --no-history | cmp - plain.out
    done
    run -3 --separate-stderr tet-stats <(marked off.surface)
    [[ "$stderr" == *'looks like an OFF surface: use tetgen-mesh, octree-mesh or surface-import' ]]
}

@test "a stream that begins with one is refused by name" {
    cube_tm >cube.tm
    for filter in tet-stats vtk-export tetgen-mesh; do
        run -3 --separate-stderr "$filter" <(printf '\357\273\277' | cat - cube.tm)
        [[ "$stderr" == *': begins with a byte order mark: a stream has none' ]]
    done
}

# Control characters -------------------------------------------------------------------

@test "no byte that a terminal obeys gets into a message; letters stay whole" {
    name=$(printf 'x\033[31m\302\233é\233€.off')
    shown='x\x1b[31m\xc2\x9bé\x9b€.off'
    run -4 --separate-stderr tet-stats "$name"
    [ "$stderr" = "tet-stats: $shown: cannot open: No such file or directory" ]
    printf 'OFF\n1 0 0\n\033]0;x\a 0 0\n' >"$name"
    run -3 --separate-stderr tetgen-mesh "$name"
    [ "$stderr" = "tetgen-mesh: $shown:3: the x coordinate: '\x1b]0;x\x07' is not a number" ]
    run -2 --separate-stderr tet-stats "--$name"
    [ "${stderr_lines[0]}" = "tet-stats: unknown option '--$shown'" ]
    run -2 --separate-stderr lepp-improve -a "$name"
    [[ "${stderr_lines[0]}" == "lepp-improve: -a: '$shown' is none of "* ]]
    run -3 --separate-stderr tet-stats <(printf 'termesh 1\n\033[31m\n')
    [[ "$stderr" != *$'\033'* ]]
}

@test "a long word is cut between letters" {
    for blanks in '' x xx; do
        printf 'OFF\n1 0 0\n%s%s 0 0\n' "$blanks" "$(printf '€%.0s' $(seq 20))" >long.off
        run -3 --separate-stderr tetgen-mesh long.off
        [[ "$stderr" == *"'$blanks€€€"*"€' is not a number" ]]
    done
}

@test "nor of what another program says" {
    cat >loud <<'END'
#!/bin/sh
printf 'Warning: \033[31mred\n'
exit 1
END
    chmod +x loud
    surface cube off >cube.off
    run -4 --separate-stderr tetgen-mesh --tetgen ./loud cube.off
    [ "${stderr_lines[0]}" = 'tetgen-mesh: tetgen: Warning: \x1b[31mred' ]
}
