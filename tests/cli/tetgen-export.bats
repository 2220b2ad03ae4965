# SPDX-License-Identifier: GPL-3.0-or-later
# tetgen-export: what it writes, TetGen reads, and tetgen-import gives back.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    cat >two.tm <<'END'
termesh 1
.node
5 3 2 1
0 0 0 0 1.5 -2 7
1 1 0 0 1e-300 0 7
2 0 1 0 0.1 0 -1
3 0 0 0.30000000000000004 0 0 0
4 1 1 1 0 0 0
.ele
2 4 1
0 0 1 2 3 2.5
1 1 2 3 4 -1
.face
1 1
0 0 2 1 9
.edge
1 0
0 0 1
surface.node
3 3 0 0
0 0 0 0
1 1 0 0
2 0 1 0
surface.face
1 0
0 0 1 2
.end
END
}

@test "a file for every block that TetGen knows" {
    tetgen-export out two.tm
    [ "$(echo out.*)" = \
        'out.edge out.ele out.face out.node out.surface.face out.surface.node' ]
    printf '2 4 1\n0 0 1 2 3 2.5\n1 1 2 3 4 -1\n' | cmp - out.ele
    sed -n '/^.node/,/^.ele/p' two.tm | sed '1d; $d' | cmp - out.node
}

@test "import of the export is the stream again, byte for byte" {
    tetgen-export --no-history out <two.tm
    tetgen-import --no-history out.node out.ele out.face out.edge out.surface.* |
        cmp - two.tm
    # and of a mesh of thousands of rows, numbered from 1, on several threads
    surface sphere off | tetgen-mesh --no-history -q1.4 -a 0.001 >sphere.tm
    [ "$(wc -l <sphere.tm)" -gt 20000 ]
    tetgen-export -j 3 sphere sphere.tm
    tetgen-import --no-history sphere | cmp - sphere.tm
}

@test "TetGen reads what was exported" {
    surface sphere smesh >s.smesh
    { sed '$d' s.smesh; printf '1\n1 0 0 0 5 -1\n'; } >r.smesh
    tetgen-mesh --switches A -q1.4 r.smesh >sphere.tm
    tetgen-export sphere sphere.tm
    run tetgen -r sphere
    [ "$status" -eq 0 ]
    tets=$(header .ele sphere.tm) nodes=$(header .node sphere.tm)
    [[ $output == *"Mesh points: ${nodes%% *}"$'\n'* ]]
    [[ $output == *"Mesh tetrahedra: ${tets%% *}"$'\n'* ]]
    tetgen-import -q --no-history sphere.1 >again.tm
    fills again.tm "$(volumes sphere.tm | awk '{ sum += $1 } END { printf "%.15g", sum }')"
    [ "$(rows .ele again.tm | awk '{ print $6 }' | sort -u)" = 5 ]
}

@test "other blocks are left out with a note" {
    sed 's/^surface\.face/notes.text/' two.tm |
        awk '{ print } /^\.edge/ { edge = 1 }
             edge && /^0 0 1/ { print ".mix\n1 0\n0 4 0 1 2 3"; edge = 0 }' >more.tm
    run --separate-stderr tetgen-export --json report out more.tm
    [ "$status" -eq 0 ]
    [ -z "$output" ]
    [ "$stderr" = 'tetgen-export: more.tm: 1 cells (.mix), 1 block (notes.text): left out' ]
    [ "$(cat report)" = \
        '{"files": ["out.node", "out.ele", "out.face", "out.edge", "out.surface.node"]}' ]
    run --separate-stderr tetgen-export --quiet out more.tm
    [ -z "$stderr" ]
}

@test "nothing is written of a stream that is wrong or empty" {
    head -n 12 two.tm >short.tm
    run --separate-stderr tetgen-export out short.tm
    [ "$status" -eq 3 ]
    [[ $stderr == 'tetgen-export: short.tm:'* ]]
    printf 'termesh 1\n.end\n' >none.tm
    run --separate-stderr tetgen-export out none.tm
    [ "$status" -eq 3 ]
    [[ $stderr == 'tetgen-export: none.tm: holds nothing, but tetgen-export takes points'* ]]
    [ -z "$(find . -name 'out*')" ]
}

@test "one file that cannot be made: no other is left unfinished" {
    mkdir -p out.face/in.the.way
    run --separate-stderr tetgen-export out two.tm
    [ "$status" -eq 4 ]
    [[ $stderr == 'tetgen-export: out.face: cannot write: '* ]]
    [ -z "$(find . -name '*.??????' -type f)" ]
    run --separate-stderr tetgen-export /nonexistent/out two.tm
    [ "$status" -eq 4 ]
    [[ $stderr == 'tetgen-export: /nonexistent/out.node: cannot write: '* ]]
}

@test "a disk that is full: exit 4, no file is left" {
    surface sphere off | tetgen-mesh -q1.4 -a 0.001 >sphere.tm
    run --separate-stderr bash -c 'ulimit -f 8; trap "" XFSZ; tetgen-export out sphere.tm'
    [ "$status" -eq 4 ]
    [[ $stderr == *'tetgen-export: out.node: cannot write: '* ]]
    [ -z "$(find . -name 'out*')" ]
}

@test "new files have the mode that the shell would give" {
    umask 027
    tetgen-export out two.tm
    [ "$(stat -c %a out.ele)" = 640 ]
}

@test "usage errors are exit 2" {
    run --separate-stderr tetgen-export
    [ "$status" -eq 2 ]
    [[ $stderr == 'tetgen-export: BASE is missing'* ]]
    run --separate-stderr tetgen-export -o out.tm out two.tm
    [ "$status" -eq 2 ]
    run --separate-stderr tetgen-export out two.tm more.tm
    [ "$status" -eq 2 ]
    run tetgen-export --help
    [ "$status" -eq 0 ]
}

@test "a locale with a decimal comma changes nothing" {
    env LOCPATH="$(comma_locale)" LC_ALL=comma tetgen-export out two.tm
    grep -x '3 0 0 0.30000000000000004 0 0 0' out.node
    grep -x '1 1 0 0 1e-300 0 7' out.node
}

@test "files of another mesh that would be read with these: exit 4, nothing is written" {
    printf '%s\n' 'termesh 1' .node '1 3 0 0' '1 0 0 0' .end >point.tm
    for suffix in .ele .face .edge .group; do
        tetgen-export mesh two.tm
        printf '1 0\n1 2 9 rim\n' >mesh.group
        find . -name 'mesh.*' ! -name mesh.node ! -name "mesh$suffix" -delete
        for packed in '' .gz; do
            [ -z "$packed" ] || gzip "mesh$suffix"
            cp mesh.node before
            run -4 --separate-stderr tetgen-export mesh point.tm
            [[ "$stderr" == "tetgen-export: mesh$suffix$packed: is there, of another mesh: "* ]]
            cmp mesh.node before
        done
        rm mesh.*
    done
    tetgen-export mesh two.tm
    echo '1 0 1 2 9 rim' >mesh.group
    run -4 tetgen-export mesh two.tm
    rm mesh.group
    tetgen-export mesh two.tm
    # those of parts alone are of no mesh beside them
    sed '/^\.node/,/^0 0 1$/d' two.tm >part.tm
    tetgen-export mesh part.tm
    tetgen-export -q mesh.surface part.tm
}

@test "the name of one of the files stands for all" {
    tetgen-export plain two.tm
    for suffix in node ele face edge group; do
        tetgen-export "other.$suffix" two.tm
        cmp other.node plain.node
        cmp other.ele plain.ele
        rm other.*
    done
    mkdir folder
    tetgen-export folder/.node two.tm
    [ -e folder/.node.node ]
    tetgen-export x.y two.tm
    [ -e x.y.node ]
}
