# SPDX-License-Identifier: GPL-3.0-or-later
# What every filter does alike, its man page, and what make install puts in place.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

load filters

@test "--help and --version: on standard output, exit 0" {
    asks() {
        run -0 --separate-stderr "$1" --help
        [ "$stderr" = "" ]
        [[ "${lines[0]}" == "usage: $1 "* ]]
        [ "$output" = "$("$1" -h)" ]
        run -0 --separate-stderr "$1" --version
        [ "$stderr" = "" ]
        [[ "$output" =~ ^$1\ \(termesh\)\ [0-9.]+$ ]]
        [ "$output" = "$("$1" -V)" ]
    }
    for_each_filter asks
}

@test "a good input: exit 0" {
    reads() {
        # shellcheck disable=SC2046 # words
        run -0 "$1" $(operands "$1" "$(input "$1")")
    }
    for_each_filter reads
}

@test "standard input, no operand or -, is as the file" {
    reads_standard_input() {
        # These read several files.
        case $1 in tetgen-import | openfoam-import) return 0 ;; esac
        if writes_files "$1"; then return 0; fi
        local options=(--no-history)
        if [ "$1" = mesh-view ]; then options+=(--title "a name"); fi # else the file's
        "$1" "${options[@]}" "$(input "$1")" >from-file
        "$1" "${options[@]}" <"$(input "$1")" >from-pipe
        "$1" "${options[@]}" - <"$(input "$1")" >from-dash
        cmp from-file from-dash
        cmp from-file from-pipe
    }
    for_each_filter reads_standard_input
}

@test "an unknown option: exit 2 and how it is called" {
    refuses() {
        run -2 --separate-stderr "$1" --no-such-option corner.tm
        [ "$output" = "" ]
        [[ "$stderr" == "$1: unknown option '--no-such-option'"* ]]
        [[ "$stderr" == *"usage: $1 "* ]]
    }
    for_each_filter refuses
}

@test "an empty input: exit 3, one line, nothing on standard output" {
    refuses_nothing() {
        : >empty.node
        # shellcheck disable=SC2046 # words
        run -3 --separate-stderr "$1" $(operands "$1" empty.node)
        [ "$output" = "" ]
        [ "${#stderr_lines[@]}" -eq 1 ]
        [[ "$stderr" == "$1: empty.node"* ]]
    }
    for_each_filter refuses_nothing
}

@test "a file that is not there: exit 4" {
    misses() {
        # shellcheck disable=SC2046 # words
        run -4 --separate-stderr "$1" $(operands "$1" nowhere.node)
        [[ "$stderr" == "$1: nowhere.node: "* ]]
    }
    for_each_filter misses
}

@test "a full disk: exit 4" {
    [ -e /dev/full ] || skip "there is no /dev/full"
    fills() {
        ! writes_files "$1" || return 0
        run -4 --separate-stderr sh -c "$1 '$(input "$1")' >/dev/full"
        [[ "$stderr" == *"No space left on device"* ]]
    }
    for_each_filter fills
}

@test "-o FILE is standard output's bytes, and stays as it was where the filter fails" {
    writes() {
        ! writes_files "$1" || return 0
        "$1" --no-history "$(input "$1")" >expected
        echo old >file
        "$1" --no-history -o file "$(input "$1")"
        cmp file expected
        echo old >file
        : >empty.node
        run -3 "$1" -o file empty.node
        [ "$(cat file)" = old ]
        [ -z "$(find . -name 'file?*')" ]
    }
    for_each_filter writes
}

@test "a reader that goes away is no error to speak of" {
    awk 'BEGIN {
        print "termesh 1\n.node\n20000 3 0 0"
        for (v = 1; v <= 20000; v++)
            print v, v % 27, v % 29, v % 31
        print ".ele\n20000 4 0"
        for (t = 1; t <= 20000; t++)
            print t, 1, 2, 3, 4
        print ".end"
    }' >many.tm
    sed -n '/^.node/,/^.ele/p' many.tm | sed '1d; $d' >many.node
    sed '/^.ele/,/^20000 1/d' many.tm >many-nodes.tm
    { sed '$d' many-nodes.tm; printf '.ele\n0 4 0\n.end\n'; } >many-empty.tm
    awk '/^\.ele/ { print ".face\n20000 0"; getline; faces = 1; next }
        faces && NF == 5 { NF = 4 } { print }' many.tm >faces.tm
    { printf '2 0\n20000\n'; sed 1d many.node | cut -d ' ' -f 2-; } >many.visf
    { printf 'MIXED\n20000 0\n'; sed 1d many.node | cut -d ' ' -f 2-; } >many.mvm
    closes() {
        case $1 in
        tet-stats) command="tet-stats --list many.tm" ;;
        jens-stats) command="jens-stats -l many.tm" ;;
        lepp-improve) command="lepp-improve -q many-empty.tm" ;;
        tetgen-import) command="tetgen-import many.node" ;;
        tetgen-mesh) command="tetgen-mesh --quiet many.node" ;;
        octree-mesh) command="octree-mesh -q surface.tm" ;;
        off-export | stl-export | ply-export | obj-export) command="$1 faces.tm" ;;
        visf-export) command="visf-export many-nodes.tm" ;;
        visf-import) command="visf-import many.visf" ;;
        m3d-import) command="m3d-import many.mvm" ;;
        abaqus-export | medit-export | vtk-export | m3d-export | mvm-export | getfem-export) command="$1 many.tm" ;;
        *) return 0 ;; # writes less than a pipe holds
        esac
        run -0 --separate-stderr bash -c "{ $command; echo \$? >status; } | head -n 1"
        [ "$stderr" = "" ]
        [ "${#lines[@]}" -eq 1 ]
        [ "$(cat status)" -eq 141 ]
    }
    for_each_filter closes
}

@test "a terminal as standard input: usage, exit 2" {
    command -v script >/dev/null || skip "there is no script(1)"
    script -qec true /dev/null </dev/null >/dev/null || skip "script(1) has no terminal"
    asks_for_input() {
        run -2 script -qec "$1 $(operands "$1" '')" /dev/null </dev/null
        [[ "$output" == *"usage: $1 "* ]]
    }
    for_each_filter asks_for_input
}

# The page as plain text; mandoc makes letters bold by printing them twice.
page() {
    mandoc -Tascii "$root/man/$1.1" | sed 's/.\x08//g'
}

@test "every filter has a man page with exactly the options that it has" {
    documented() {
        [ -f "$root/man/$1.1" ]
        "$1" --help | grep -oE '^ +(-[A-Za-z], )?--[a-z-]+' | grep -oE -- '--[a-z-]+' |
            sort >help
        page "$1" | grep -oE '^ {5}(-[A-Za-z][^ ]*, )?--[a-z-]+' | grep -oE -- '--[a-z-]+' |
            sort >described
        run -0 diff help described
    }
    for_each_filter documented
}

# The commands of a page's EXAMPLES: its literal blocks and its .Dl lines. (What they
# print stands in unfilled blocks.)
examples() {
    sed -n '/^\.Sh EXAMPLES/,/^\.Sh [^E]/p' "$1" |
        sed -n '/^\.Bd -literal/,/^\.Ed/{/^\.Bd/d; /^\.Ed/d; p}; s/^\.Dl //p' |
        sed 's/\\&//g; s/\\e/\\/g; s/\\(aq/'\''/g'
}

@test "the examples of all man pages run" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    command -v gnuplot >/dev/null || skip "there is no gnuplot"
    for page in "$root"/man/*.[157]; do
        ! is_left_out "$(basename "$page" .1)" || continue
        folder=$(basename "$page").examples
        mkdir "$folder"
        examples "$page" >"$folder/commands"
        [ -s "$folder/commands" ]
        # That a mesh is not good is an answer, no failure.
        echo 'mesh-check() { command mesh-check "$@" || [ $? -eq 1 ]; }' >"$folder/all"
        cat "$folder/commands" >>"$folder/all"
        echo "$page"
        run -0 bash -euc "cd '$folder' && . ./all"
    done
}

@test "only the filters that need p4est or Expat load them, or what they bring" {
    command -v ldd >/dev/null || skip "there is no ldd"
    case ${TM_BUILD:?} in */san) skip "the sanitizers load more" ;; esac
    loads() {
        run -0 ldd "$TM_BUILD/bin/$1"
        if needs_p4est "$1"; then
            [[ "$output" == *libp4est* ]]
        elif ! needs_gmsh "$1"; then
            if [ "$1" = vtu-import ]; then
                [[ "$output" == *libexpat* ]]
                output=$(grep -v libexpat <<<"$output")
            fi
            run -1 grep -vE 'lib(gmp|z|m|c)\.so|linux-vdso|ld-linux' <<<"$output"
        fi
    }
    for_each_filter loads
}

@test "only gmsh-import and gmsh-export load libgmsh, or what it brings" {
    command -v ldd >/dev/null || skip "there is no ldd"
    for file in "$TM_BUILD"/bin/* "$TM_BUILD"/libtermesh.so.*; do
        case ${file##*/} in mesh-convert) continue ;; esac
        run -0 ldd "$file"
        if needs_gmsh "${file##*/}"; then
            [[ "$output" == *libgmsh.so* ]]
        else
            [[ "$output" != *libgmsh.so* ]]
        fi
    done
}

@test "without libgmsh all else is built, and what is left out is said once" {
    case ${TM_BUILD:?} in */san | */coverage) skip "the same as in the usual build" ;; esac
    [ -x "$TM_BUILD/bin/gmsh-import" ] || skip "there is no libgmsh"
    mkdir build
    cp -pR "$TM_BUILD/cmd" "$TM_BUILD/lib" "$TM_BUILD/generate" "$TM_BUILD/generated" build
    rm -r build/cmd/common/gmsh
    run -0 --separate-stderr make -s -C "$root" BUILD="$PWD/build" has_gmsh= all
    [ "$output" = "" ]
    [[ "$stderr" == *"There is no gmshc.h: gmsh-import and gmsh-export are left out." ]]
    [ ! -e build/bin/gmsh-import ] && [ ! -e build/bin/gmsh-export ]
    [ ! -e build/cmd/common/gmsh ]
    [ -x build/bin/vtu-export ]
}

@test "without p4est all else is built, and what is left out is said once" {
    case ${TM_BUILD:?} in */san | */coverage) skip "the same as in the usual build" ;; esac
    echo '#include <p4est.h>' | cc -E -x c - >/dev/null 2>&1 && skip "p4est needs no mpicc"
    # Objects are the same with p4est and without it.
    mkdir build
    cp -pR "$TM_BUILD/cmd" "$TM_BUILD/lib" "$TM_BUILD/generate" "$TM_BUILD/generated" build
    without() {
        run -0 --separate-stderr make -s -C "$root" BUILD="$PWD/build" MPICC=/nonexistent "$@"
    }
    without all
    [ "$output" = "" ]
    [ "${#stderr_lines[@]}" -eq 1 ]
    [[ "$stderr" == *"octree-mesh and octree-repair are left out." ]]
    for file in "$root"/cmd/*.c "$root"/cmd/import/*.c "$root"/cmd/export/*.c; do
        filter=$(basename "$file" .c)
        if needs_p4est "$filter"; then
            [ ! -e "build/bin/$filter" ]
        else
            # shellcheck disable=SC2046 # words
            run -0 "build/bin/$filter" $(operands "$filter" "$(input "$filter")")
        fi
    done
    without -n tests
    [[ "$output" == *tests/test_lepp* ]]
    [[ "$output" != *tests/test_octree* ]]
    # Nothing in the shared library refers to what was left out.
    echo 'int main(void) { return 0; }' >main.c
    cc -o main main.c -Wl,--no-as-needed build/libtermesh.so.* -lgmp -lz -lm -lexpat
    without clean
    [ "$output$stderr" = "" ]
    [ ! -e build ]
}

@test "make install: filters, man pages, headers and library, and uninstall removes them" {
    variables=(BUILD="$TM_BUILD" PREFIX=/usr DESTDIR="$PWD/to")
    case ${TM_BUILD:?} in
    */san) variables=(SAN=1 BUILD="${TM_BUILD%/san}" "${variables[@]:1}") ;;
    */coverage) variables=(COVERAGE=1 BUILD="${TM_BUILD%/coverage}" "${variables[@]:1}") ;;
    esac
    run -0 --separate-stderr make -s -C "$root" "${variables[@]}" install
    [ "$output" = "" ]
    [ "$(to/usr/bin/tet-stats --list corner.tm)" = "$(tet-stats --list corner.tm)" ]
    for filter in $filters; do
        [ -x "to/usr/bin/$filter" ]
        [ -f "to/usr/share/man/man1/$filter.1" ]
        [ -f "to/usr/share/bash-completion/completions/$filter" ]
        [ -f "to/usr/share/zsh/site-functions/_$filter" ]
    done
    [ -f to/usr/share/man/man5/termesh-stream.5 ]
    [ -f to/usr/share/man/man7/termesh.7 ]
    make -s -C "$root" "${variables[@]}" uninstall
    run -0 find to -type f -o -type l -o -name '*termesh*'
    [ "$output" = "" ]
}

@test "the figures in README.md are what its pipeline gives" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    LC_ALL=C awk -f "$root/examples/knot.awk" >knot.off
    tetgen-mesh -q -o mesh.tm knot.off
    grep -qF "$(sed -n 2p mesh.tm)" "$root/README.md" || skip "TetGen is another version"
    lepp-improve mesh.tm >better.tm 2>message
    grep -qxFf message "$root/README.md"
    tet-stats mesh.tm better.tm | head -n 6 >table
    diff table <(grep -A 5 '^ *before *after$' "$root/README.md")
    command -v gnuplot >/dev/null || skip "there is no gnuplot"
    tet-stats -o table --plot figure.svg mesh.tm better.tm
    diff <(grep -o 'after: [^<]*' figure.svg) \
        <(grep -o 'after: [^<]*' "$root/examples/quickstart.svg")
}

@test "the pipelines of examples/Makefile run, each from what it builds" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    command -v gnuplot >/dev/null || skip "there is no gnuplot"
    run -0 make -s -C "$root/examples" build="$TM_BUILD" to="$PWD/made"
    for model in knot bar gear; do
        [ -s "made/$model.txt" ]
        [ -s "made/$model.svg" ]
    done
    run -0 make -C "$root/examples" build="$TM_BUILD" to="$PWD/made"
    [[ "$output" != *lepp-improve* ]]
    ! is_left_out octree-mesh || return 0
    run -0 make -s -C "$root/examples" build="$TM_BUILD" to="$PWD/made" LEVEL=4 mixed
    for model in knot bar gear; do
        [ -s "made/$model.mixed.txt" ]
        [ -s "made/$model.mixed.vtu" ]
    done
    ! is_left_out mesh-view || return 0
    run -0 make -s -C "$root/examples" build="$TM_BUILD" to="$PWD/made" LEVEL=4 view
    for model in knot bar gear; do
        grep -q '"content": "tetrahedra"' "made/$model.html"
        grep -q '"content": "mixed"' "made/$model.mixed.html"
    done
}
