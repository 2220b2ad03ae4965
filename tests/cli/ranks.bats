# SPDX-License-Identifier: GPL-3.0-or-later
# Ranks of a launcher: streams in slices, statistics, what only rank 0 does, what becomes of
# errors and of a rank that is killed.

bats_require_minimum_version 1.5.0
load helpers
load ranks

setup_file() {
    cd "$BATS_FILE_TMPDIR" || exit
    awk 'BEGIN { print 12000, 3; for (i = 1; i <= 12000; i++) print i, rand(), rand(), rand() }' |
        tetgen-mesh -o tets.tm
    surface sphere off | octree-mesh -s 6 -u -o mixed.tm
    octree-mesh --polyhedra -s 5 -o cells.tm <<<"$(surface sphere off)"
    cubes >small.tm
    awk 'BEGIN { print 20, 3; for (i = 1; i <= 20; i++) print i, rand(), rand(), rand() }' |
        tetgen-mesh -o small-tets.tm
}

setup() {
    need_mpirun
    cd "$BATS_TEST_TMPDIR" || exit
    meshes=$BATS_FILE_TMPDIR
    copy=$TM_BUILD/ranks/slices_copy
}

@test "a stream in slices is written as it was, from and to files and pipes" {
    for mesh in tets mixed cells small; do
        cp "$meshes/$mesh.tm" in.tm
        counts='2 7'
        [ $mesh != mixed ] || counts='1 2 3 4 7'
        for n in $counts; do
            : >out.tm
            on_ranks "$n" "$copy" in.tm out.tm
            cmp in.tm out.tm
        done
        on_ranks 3 "$copy" in.tm - >out.tm
        cmp in.tm out.tm
        on_ranks 2 "$copy" - - <in.tm >out.tm
        cmp in.tm out.tm
        : >out.tm
        on_ranks 7 "$copy" - out.tm <in.tm
        cmp in.tm out.tm
    done
    gzip -k in.tm
    on_ranks 2 "$copy" in.tm.gz - >out.tm
    cmp in.tm out.tm
}

# Ways to spoil a line of a stream: sed programs for line L.
spoiled() {
    cat <<END
${1}d
${1}s/\$/ 7 7/
${1}s/.*/hello/
${1},\$d
${1}p
${1}s/[0-9]*\$/99999999/
${1}s/ .*/ x y/
${1}s/^/# a comment\n\n/
END
}

@test "what is wrong is said as by one process, the first of several in the file" {
    rows=$(wc -l <"$meshes/tets.tm")
    for line in 900 $((rows - 2000)); do
        spoiled $line >programs
        while read -r program <&3; do
            sed "$program" "$meshes/tets.tm" >in.tm
            alone=0 together=0
            "$copy" in.tm - >one.out 2>one.err || alone=$?
            if [ $line -eq 900 ]; then
                on_ranks 3 "$copy" in.tm - >several.out 2>several.err || together=$?
            else
                on_ranks 3 "$copy" - - <in.tm >several.out 2>piped.err || together=$?
                sed 's/^-:/in.tm:/' piped.err >several.err
            fi
            [ $alone -eq $together ]
            grep '^in.tm' several.err | cmp - one.err
            [ $alone -ne 0 ] || cmp one.out several.out
        done 3<programs
    done
}

@test "tet-stats and jens-stats: the same for any number of ranks" {
    ranks_agree "$meshes/tets.tm" tet-stats
    RANKS=3 ranks_agree "$meshes/tets.tm" tet-stats "$meshes/small-tets.tm"
    RANKS=7 ranks_agree "$meshes/small-tets.tm" tet-stats
    RANKS=3 ranks_agree "$meshes/tets.tm" tet-stats --list
    ranks_agree "$meshes/mixed.tm" jens-stats
    for option in -s -j -a -l --verdict "--certify --fail-below 0.9"; do
        # shellcheck disable=SC2086 # some are two words
        RANKS=3 ranks_agree "$meshes/mixed.tm" jens-stats $option
    done
    RANKS="2 7" ranks_agree "$meshes/tets.tm" jens-stats -j
    tet-stats <"$meshes/tets.tm" >one.out
    on_ranks 4 tet-stats <"$meshes/tets.tm" | cmp - one.out
    on_ranks 2 jens-stats -o several.out --plot several.svg "$meshes/mixed.tm"
    jens-stats -o one.out --plot one.svg "$meshes/mixed.tm"
    cmp one.out several.out
    cmp one.svg several.svg
}

@test "poly-stats: the same for any number of ranks" {
    polylla3d --mode edge -o edge.tm "$meshes/tets.tm"
    [ "$(header .cell edge.tm | cut -d' ' -f1)" -gt 40960 ] # of slices of 8192
    ranks_agree edge.tm poly-stats
    RANKS='2 7' ranks_agree "$meshes/cells.tm" poly-stats --for fv
    polylla3d --star -o star.tm "$meshes/small-tets.tm"
    for mesh in star.tm "$meshes/small.tm"; do
        RANKS=7 ranks_agree "$mesh" poly-stats --for vem
    done
    poly-stats -o one.out --plot one.svg edge.tm
    on_ranks 3 poly-stats -o several.out --plot several.svg - <edge.tm
    cmp one.out several.out
    cmp one.svg several.svg
}

@test "left-handed tetrahedra and coordinates too large are found on any rank" {
    sed '/^\.ele/,/^\.face/ s/^\([0-9]*\) \([0-9]*\) \([0-9]*\) \([0-9]*\) \([0-9]*\)$/\1 \3 \2 \4 \5/' \
        "$meshes/tets.tm" >turned.tm
    ranks_agree turned.tm tet-stats
    grep -q 'were left-handed' several.err
    sed '/^\.ele/,$!s/^11000 [^ ]*/11000 1e60/' "$meshes/tets.tm" >large.tm
    run -3 on_ranks 3 tet-stats large.tm
    [ "$(grep -c '^tet-stats: large.tm: .node: node 11000 at' <<<"$output")" -eq 1 ]
}

# What VTK reads of two files, cell by cell: points, their data, the cell's data.
same_cells() {
    /usr/bin/python3 - "$@" <<'END'
import sys, vtk
from vtk.util.numpy_support import vtk_to_numpy as rows

def cells_of(file):
    reader = vtk.vtkXMLPUnstructuredGridReader() if file.endswith('.pvtu') else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(file)
    reader.Update()
    grid = reader.GetOutput()
    data = lambda of: [rows(of.GetArray(i)) for i in range(of.GetNumberOfArrays())]
    xyz, of_points, of_cells, ids = rows(grid.GetPoints().GetData()), data(grid.GetPointData()), data(grid.GetCellData()), vtk.vtkIdList()
    cells = []
    for c in range(grid.GetNumberOfCells()):
        grid.GetCellPoints(c, ids)
        points = [ids.GetId(i) for i in range(ids.GetNumberOfIds())]
        cells.append((grid.GetCellType(c), [tuple(xyz[p]) for p in points],
                      [tuple(a[p] for a in of_points) for p in points], [float(a[c]) for a in of_cells]))
    return sorted(cells)

one, pieces = map(cells_of, sys.argv[1:])
assert one == pieces and len(one) > 0, (len(one), len(pieces))
END
}

@test "vtu-export -o FILE.pvtu: pieces that VTK reads as the whole" {
    octree-mesh -s 5 -u -o marked.tm <<<"$(surface cube smesh)"
    tetgen-mesh -q -a 0.0001 -o faces.tm <<<"$(surface cube off)"
    for mesh in marked faces; do
        vtu-export -o one.vtu $mesh.tm
        vtu-import -q one.vtu | vtu-export -o back.vtu
        for n in 1 3 7; do
            rm -f x*
            on_ranks $n vtu-export -o x.pvtu $mesh.tm
            same_cells one.vtu x.pvtu
            vtu-import -q x.pvtu | vtu-export -o pieces.vtu
            same_cells back.vtu pieces.vtu
        done
    done
    sed '/^\.ele/,/^\.face/{/^\.face/!d}' faces.tm >surface.tm
    on_ranks 3 vtu-export -o x.pvtu <surface.tm
    vtu-export -o one.vtu surface.tm
    same_cells one.vtu x.pvtu
    on_ranks 2 vtu-export -o x.pvtu "$meshes/small.tm"
    vtu-export -o one.vtu "$meshes/small.tm"
    same_cells one.vtu x.pvtu
    sed '/^\.ele/,$d' "$meshes/tets.tm" | sed '$a .end' >points.tm
    on_ranks 2 vtu-export -o x.pvtu points.tm
    vtu-export -o one.vtu points.tm
    same_cells one.vtu x.pvtu
    mkdir 'a&b'
    vtu-export -o 'a&b/a&b.pvtu' "$meshes/small-tets.tm"
    vtu-export -o one.vtu "$meshes/small-tets.tm"
    same_cells one.vtu 'a&b/a&b.pvtu'
    run -4 on_ranks 2 vtu-export -o no-such-folder/x.pvtu "$meshes/tets.tm"
    sed 's/^\.end/.notes\nsome\n.end/' "$meshes/tets.tm" >notes.tm
    run -3 on_ranks 2 vtu-export -o y.pvtu --strict notes.tm
    [ ! -e y.pvtu ]
}

@test "filters that do not work on ranks do so on rank 0 alone" {
    vtu-export "$meshes/small.tm" >one.vtu
    on_ranks 3 vtu-export "$meshes/small.tm" >several.vtu
    cmp one.vtu several.vtu
    on_ranks 2 tetgen-mesh -o several.tm <<<"$(surface cube off)"
    tetgen-mesh -o one.tm <<<"$(surface cube off)"
    cmp one.tm several.tm
    [ "$(on_ranks 3 tet-stats --version | wc -l)" -eq 1 ]
    [ "$(on_ranks 3 tet-stats --help)" = "$(tet-stats --help)" ]
}

@test "errors: one message, the exit status" {
    run -2 on_ranks 3 tet-stats --no-such-option
    [ "$(grep -c 'unknown option' <<<"$output")" -eq 1 ]
    run -4 on_ranks 3 tet-stats no-such-file.tm
    [ "$(grep -c 'cannot open' <<<"$output")" -eq 1 ]
    : >empty.tm
    run -3 on_ranks 3 jens-stats empty.tm
    [ "$(grep -c '^jens-stats: empty.tm' <<<"$output")" -eq 1 ]
    run -1 on_ranks 3 jens-stats --fail-below 0.99 "$meshes/tets.tm"
    run -4 on_ranks 2 tet-stats -o no-such-folder/out "$meshes/tets.tm"
    run -4 on_ranks 2 tet-stats -o /dev/full "$meshes/tets.tm"
}

@test "a rank that is killed ends all, and no file is there" {
    for which in 0 1; do
        mkfifo pipe.$which
        timeout 60 mpirun --allow-run-as-root --oversubscribe -n 3 \
            tet-stats -o out.txt --json out.json <pipe.$which >several.out 2>several.err &
        job=$!
        { head -c 100000 "$meshes/tets.tm"; sleep 60; } >pipe.$which &
        writer=$!
        until [ "$(pgrep -P "$(pgrep -P $job | head -n 1)" -c)" -ge 3 ] 2>/dev/null; do
            sleep 0.2
        done
        sleep 1
        for pid in $(pgrep -P "$(pgrep -P $job | head -n 1)"); do
            grep -qz "^OMPI_COMM_WORLD_RANK=$which$" "/proc/$pid/environ" && kill -KILL "$pid"
        done
        ended=0
        wait $job || ended=$?
        kill $writer
        [ $ended -ne 0 ] && [ $ended -ne 124 ]
        [ ! -e out.txt ] && [ ! -e out.json ]
        [ -z "$(pgrep -f "tet-stats -o out.txt" || true)" ]
    done
}
