# SPDX-License-Identifier: GPL-3.0-or-later
# tetgen-mesh and the program that it runs: what that makes is not trusted, and TMPDIR.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

load helpers

setup() {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir folder
    export TMPDIR=$PWD/folder
    surface cube off >cube.off
}

# Makes a program of standard input; base is where TetGen's files are, without suffix.
program() {
    # shellcheck disable=SC2016 # for the program to expand
    { printf '#!/bin/sh\nfor last; do :; done\nbase=${last%%.poly}.1\n'; cat; } >"$1"
    chmod +x "$1"
}

@test "a file that another program made: exit 4, the program, the file and the line" {
    program made <<'END'
cp node "$base.node"
[ ! -e ele ] || cp ele "$base.ele"
END
    refused() {
        run -4 --separate-stderr tetgen-mesh --tetgen ./made cube.off
        [ "$output" = "" ]
        [[ "$stderr" == "tetgen-mesh: './made' made a file that is not TetGen's: surface.1.$1: "?* ]]
        [ "$(ls folder)" = "" ]
    }
    : >node
    refused node:1
    echo '1 3 0 0' >node
    refused node:2
    printf '1 3 0 0\n\1\2\377\n' >node
    refused node:2
    head -c 4096 /bin/sh >node
    refused node:1
    printf '%s\n' '4 3 0 0' '1 0 0 0' '2 1 0 0' '3 0 1 0' '4 0 0 1' >node
    printf '%s\n' '1 4 0' '1 1 2 3 5' >ele
    refused ele:2
    printf '%s\n' '1 4 0' '1 1 2 3 x' >ele
    refused ele:2
}

@test "what TetGen made, cut off anywhere, is refused" {
    program cut <<'END'
tetgen "$@"
head -c "$SIZE" "$base.$SUFFIX" >part
mv part "$base.$SUFFIX"
END
    tetgen-mesh --no-history cube.off >expected
    for SUFFIX in node ele face edge; do
        export SUFFIX SIZE
        cuts=0
        # The last line is a comment.
        for ((SIZE = 0; SIZE < 300; SIZE += 7)); do
            status=0
            tetgen-mesh --no-history --tetgen ./cut cube.off >got 2>message || status=$?
            if [ "$status" -eq 0 ]; then
                cmp got expected
                continue
            fi
            cuts=$((cuts + 1))
            [ "$status" -eq 4 ]
            [ ! -s got ]
            grep "^tetgen-mesh: './cut' made a file that is not TetGen's: surface.1.$SUFFIX:" message
        done
        [ "$cuts" -gt 5 ]
    done
}

@test "a full disk under TetGen: exit 4 and the reason, at every size" {
    unshare --mount true 2>/dev/null || skip "no file systems can be mounted"
    surface sphere off >sphere.off
    for size in 8 16 32 64 100 128; do
        run -4 --separate-stderr unshare --mount sh -c \
            "mount -t tmpfs -o size=${size}k none folder && tetgen-mesh -a 0.001 sphere.off"
        [ "$output" = "" ]
        [[ "${stderr_lines[-1]}" == "tetgen-mesh: "*"$TMPDIR"*": No space left on device"* ]]
    done
}

@test "files that may not grow: exit 4, and nothing is left" {
    surface sphere off >sphere.off
    run -4 --separate-stderr bash -c "ulimit -f 2; tetgen-mesh -a 0.001 sphere.off"
    [ "$output" = "" ]
    [ "$(ls folder)" = "" ]
    tetgen-mesh -a 0.001 sphere.off >mesh.tm
    run -4 --separate-stderr bash -c "ulimit -f 2; lepp-improve -q mesh.tm -o better.tm"
    [[ "$stderr" == "lepp-improve: "*": File too large" ]]
    run -4 --separate-stderr bash -c "ulimit -f 2; tetgen-export base mesh.tm"
    [[ "$stderr" == "tetgen-export: base.node: "*": File too large" ]]
    rm separate-stderr-*
    [ "$(echo *)" = "cube.off folder mesh.tm sphere.off" ]
}

@test "TMPDIR may be relative, begin with a dash, have any letter" {
    tetgen-mesh --no-history cube.off >expected
    for name in -x -- '-o a' relative ./relative . ' ' "it's"; do
        mkdir -p -- "$name"
        TMPDIR=$name tetgen-mesh --no-history cube.off | cmp - expected
        [ "$name" = . ] || [ "$(ls -- "$name")" = "" ]
    done
    for name in nowhere /nonexistent/nowhere cube.off; do
        TMPDIR=$name run -4 --separate-stderr tetgen-mesh cube.off
        [[ "$stderr" == "tetgen-mesh: cannot make a folder in $name: "*"TMPDIR"* ]]
    done
    TMPDIR=$(printf 'n%.0s' {1..2000}) run -4 --separate-stderr tetgen-mesh cube.off
    [[ "$stderr" == "tetgen-mesh: the path in TMPDIR is too long" ]]
}
