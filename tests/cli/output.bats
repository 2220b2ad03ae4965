# SPDX-License-Identifier: GPL-3.0-or-later
# What all filters write, and where: reports, files and their names, terminals; and what
# they say where it cannot be done.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

load helpers
load filters

# Whether there are no other files than when this was called first.
leaves_nothing() {
    [ -f .before ] || ls >.before
    ls | diff .before -
}

@test "--json where it cannot be written: exit 4, and nothing else is written" {
    leaves_nothing
    too_long=$(printf '%0256d' 0)
    refuses() {
        for place in nowhere/report /dev/full . "" "$too_long"; do
            # shellcheck disable=SC2046 # words
            set -- "$1" $(operands "$1" "$(input "$1")")
            status=0
            "$1" --json "$place" "${@:2}" >written 2>message || status=$?
            [ "$status" -eq 4 ]
            [ ! -s written ]
            grep "^$1: ${place:0:99}.*cannot write: " message
            rm written message
            leaves_nothing
            ! writes_files "$1" || continue
            echo old >file
            status=0
            "$1" --json "$place" -o file "$(input "$1")" 2>message || status=$?
            [ "$status" -eq 4 ]
            [ "$(cat file)" = old ]
            rm file message
            leaves_nothing
        done
    }
    for_each_filter refuses
}

@test "--json FILE is an object, and what else is written is the same" {
    reports() {
        # shellcheck disable=SC2046 # words
        "$1" --no-history $(operands "$1" "$(input "$1")") >expected
        # shellcheck disable=SC2046 # words
        "$1" --no-history --json report $(operands "$1" "$(input "$1")") >written
        cmp written expected
        python3 -c 'import json, sys; sys.exit(type(json.load(sys.stdin)) != dict)' <report
    }
    for_each_filter reports
}

@test "a full disk: exit 4, and what could not be written" {
    [ -w /dev/full ] || skip "there is no /dev/full"
    refuses() {
        ! writes_files "$1" || return 0
        # shellcheck disable=SC2046 # words
        run -4 --separate-stderr "$1" -q -o /dev/full $(operands "$1" "$(input "$1")")
        [[ "$stderr" == *"$1: /dev/full: cannot write: "* ]]
        # shellcheck disable=SC2046 # words
        "$1" $(operands "$1" "$(input "$1")") 2>message >/dev/full && return 1
        grep -q "^$1: <stdout>: cannot write: " message
    }
    for_each_filter refuses
}

@test "SIGKILL or SIGQUIT while it writes leaves nothing behind" {
    case ${TM_BUILD:?} in */san*) skip "the sanitizers have a write() of their own" ;; esac
    python3 -c 'import os; os.close(os.open(".", os.O_TMPFILE | os.O_WRONLY))' ||
        skip "here are no files without a name"
    cat >kill.c <<'END'
#include <signal.h>
#include <stdlib.h>
#include <sys/types.h>
#include <unistd.h>
ssize_t write(int fd, const void *bytes, size_t count)
{
    (void)fd, (void)bytes;
    raise(atoi(getenv("KILLS")));
    return (ssize_t)count;
}
END
    cc -shared -fPIC -o kill.so kill.c || skip "no such library can be made"
    mkdir to
    cp corner.tm to/old
    for signal in 9 3; do
        for name in new old; do
            run -$((128 + signal)) env KILLS=$signal LD_PRELOAD=./kill.so \
                prlimit --core=0 lepp-improve -q -o "to/$name" corner.tm
            [ "$(ls to)" = old ]
            cmp to/old corner.tm
        done
    done
}

# Runs a command that the permissions of folders are for, as they are not for root.
without_privilege() {
    if [ "$(id -u)" -eq 0 ]; then
        setpriv --bounding-set=-dac_override,-dac_read_search "$@"
    else
        "$@"
    fi
}

# Each file that filters write under a name: writes NAME, for all of them in turn.
write_each() {
    for filter in $filters; do
        write() {
            case $2 in
            -o) "$1" --no-history -o "$3" "$(input "$1")" ;;
            *) # shellcheck disable=SC2046 # words
                "$1" --no-history "$2" "$3" $(operands "$1" "$(input "$1")") ;;
            esac
        }
        for option in -o --json; do
            [ "$option" != -o ] || ! writes_files "$filter" || continue
            echo "$filter $option"
            "$1" "$filter" "$option"
        done
    done
}

@test "names as long as names can be" {
    name=$(printf 'n%.0s' {1..255})
    leaves_nothing
    write_long() {
        write "$1" "$2" "$name" >standard-output
        [ -s "$name" ]
        rm -rf "$name" standard-output out*
        leaves_nothing
    }
    write_each write_long
    tetgen-export "${name:5}" corner.tm
    [ -s "${name:5}.node" ]
    [ -s "${name:5}.face" ]
    jens-stats --histo "$name" corner.tm
    [ -s "$name" ]
}

@test "a symbolic link is written through: it stays, what it leads to is replaced or made" {
    mkdir -p there/deep
    ln -s there/file link
    ln -s ../link there/link-to-link
    ln -s "$PWD/there/new" there/to-new
    follows() {
        for name in link there/link-to-link; do
            echo old >there/file
            write "$1" "$2" "$name" >standard-output
            [ "$(readlink link)" = there/file ]
            [ "$(readlink there/link-to-link)" = ../link ]
            [ "$(cat there/file)" != old ]
        done
        write "$1" "$2" there/to-new >standard-output
        [ -L there/to-new ]
        [ -s there/new ]
        rm there/file there/new
        [ "$(cd there && echo *)" = "deep link-to-link to-new" ]
    }
    write_each follows
    ln -s circle circle
    run -4 --separate-stderr off-export -o circle corner.tm
    [[ "$stderr" == "off-export: circle: cannot write: "* ]]
}

@test "-o on what leads to a descriptor, as /dev/stdout does: it is written as it is" {
    off-export corner.tm >expected
    ln -s /proc/self/fd/1 stdout # not that of /dev, which a fault would remove
    off-export -o stdout corner.tm >file
    [ -L stdout ]
    cmp file expected
    exec 7>file
    off-export -o /dev/fd/7 corner.tm
    exec 7>&-
    cmp file expected
    off-export -o stdout corner.tm | cmp - expected
    [ "$(find . -name '*termesh*')" = "" ]
}

@test "a file that may be written in a folder that may not: it is written directly" {
    mkdir closed
    echo old >closed/file
    chmod a-w closed
    without_privilege sh -c ': >closed/other' 2>/dev/null && skip "all folders may be written"
    writes_directly() {
        echo "old, and longer than what will be there$(printf ' %.0s' {1..9999})" >closed/file
        write "$1" "$2" expected >standard-output
        export -f write operands input
        without_privilege bash -c "write $1 $2 closed/file" >standard-output
        # The seconds of a report differ.
        diff <(sed 's/"seconds":[^,}]*//g' closed/file) <(sed 's/"seconds":[^,}]*//g' expected)
        rm -rf out*
    }
    write_each writes_directly
    run -4 --separate-stderr without_privilege off-export -o closed/other corner.tm
    [[ "$stderr" == "off-export: closed/other: cannot write: Permission denied" ]]
    [ "$(ls -A closed)" = file ]
    chmod u+w closed
}

@test "binary output to a terminal is refused, but for -o -" {
    command -v script >/dev/null || skip "there is no script(1)"
    script -qec true /dev/null </dev/null >/dev/null || skip "script(1) has no terminal"
    for command in "vtu-export" "visf-export --binary little" "visf-export --binary big"; do
        run -2 script -qec "$command corner.tm" /dev/null </dev/null
        [[ "$output" == *": the output is binary"*"-o FILE"*"-o - forces it"* ]]
        $command corner.tm >expected
        script -qec "stty raw -echo; $command -o - corner.tm" /dev/null </dev/null | cmp - expected
        script -qec "$command -o file corner.tm" /dev/null </dev/null
        cmp file expected
        script -qec "$command corner.tm | cat >file" /dev/null </dev/null
        cmp file expected
    done
    run -0 script -qec "visf-export corner.tm" /dev/null </dev/null
}

@test "no SVG and no page goes into a file with the suffix of another kind of picture" {
    for filter in tet-stats jens-stats poly-stats; do
        for suffix in png PDF jpeg; do
            run -2 --separate-stderr "$filter" --plot "figure.$suffix" "$(input "$filter")"
            [ "$output" = "" ]
            [[ "${stderr_lines[0]}" == "$filter: 'figure.$suffix': no $suffix file is written, but SVG"* ]]
            [ ! -e "figure.$suffix" ]
        done
    done
    run -2 lepp-improve -a selective --plot figure.png corner.tm
    [ -x "$TM_BUILD/bin/mesh-view" ] || return 0
    run -2 --separate-stderr mesh-view -o page.png corner.tm
    [[ "${stderr_lines[0]}" == "mesh-view: 'page.png': no png file is written, but a page"* ]]
    [ ! -e page.png ]
}

@test "--plot: what is no picture is refused, also where gnuplot says that all is well" {
    mkdir bin
    echo old >figure.svg
    for made in '' 'echo nonsense' 'head -c 9999 /bin/sh' 'printf "<?xml version=\"1.0\"?>\n<svg>"' \
        'echo "<svg></svg>"; exit 1'; do
        printf '#!/bin/sh\n%s\n' "$made" >bin/gnuplot
        chmod +x bin/gnuplot
        for filter in tet-stats jens-stats poly-stats; do
            PATH=$PWD/bin:$PATH run -4 --separate-stderr "$filter" --plot figure.svg "$(input "$filter")"
            [ "$output" = "" ]
            [[ "$stderr" == "$filter: gnuplot "* ]]
            [ "$(cat figure.svg)" = old ]
        done
    done
    printf '#!/bin/sh\ncat >script\necho "<svg></svg>"\n' >bin/gnuplot
    PATH=$PWD/bin:$PATH tet-stats --plot figure.svg corner.tm
    [ "$(cat figure.svg)" = "<svg></svg>" ]
    grep '^unset multiplot' script
}

@test "--plot needs no folder for temporary files, and writes through a link" {
    command -v gnuplot >/dev/null || skip "there is no gnuplot"
    ln -s picture figure.svg
    # shellcheck disable=SC2030
    for TMPDIR in nowhere "$PWD"; do
        export TMPDIR
        tet-stats --plot figure.svg corner.tm >table
        [ -L figure.svg ]
        python3 -c 'import sys, xml.etree.ElementTree as x; x.parse(sys.argv[1])' picture
        rm picture
    done
    run -4 --separate-stderr tet-stats --plot nowhere/figure.svg corner.tm
    [ "$output" = "" ]
    [[ "$stderr" == "tet-stats: nowhere/figure.svg: cannot write: "* ]]
}

@test "one file for two outputs: exit 2, and the two options" {
    same() {
        writes_files "$1" ||
            run -2 --separate-stderr "$1" -o same --json same "$(input "$1")"
        writes_files "$1" || [[ "$stderr" == "$1: --json and -o are the same file, 'same'"* ]]
        [ ! -e same ]
    }
    for_each_filter same
    for filter in tet-stats jens-stats poly-stats; do
        run -2 "$filter" --plot same --json same "$(input "$filter")"
        run -2 "$filter" --plot same -o same "$(input "$filter")"
    done
    run -2 jens-stats --histo same -o same corner.tm
    [ ! -e same ]
}

@test "one file for two outputs whose names are not alike: exit 4, nothing is written" {
    mkdir folder
    ln -s "$PWD" folder/link
    ln -s same.svg link.svg
    leaves_nothing
    refuses() {
        status=0
        "$@" >written 2>message || status=$?
        [ "$status" -eq 4 ]
        grep ': cannot write: two outputs have this name$' message
        [ ! -s written ]
        rm written message
        leaves_nothing
    }
    refuses jens-stats --plot same.svg --histo same.svg corner.tm
    for other in ./same.svg "$PWD/same.svg" folder/../same.svg folder/link/same.svg link.svg; do
        refuses tet-stats -o same.svg --plot "$other" corner.tm
        refuses tet-stats -o same.svg --json "$other" corner.tm
        refuses jens-stats --json same.svg --histo "$other" corner.tm
    done
    refuses vtu-export -o pieces.pvtu --json pieces_0.vtu corner.tm
    refuses tetgen-export mesh --json mesh.ele corner.tm
    refuses openfoam-export foam --json foam/owner corner.tm
    jens-stats -o same.svg --histo folder/same.svg corner.tm
    rm same.svg folder/same.svg
    leaves_nothing
    # what has no name is written on
    tet-stats -o /dev/stdout --json /dev/fd/1 corner.tm >both
    grep -q '^{' both
    grep -q '^tetrahedra ' both
}

@test "-o /dev/stdout goes on where standard output is" {
    { echo head && off-export -o /dev/stdout corner.tm && echo tail; } >whole
    { echo head && off-export corner.tm && echo tail; } | cmp - whole
    echo before >grown
    off-export -o /dev/fd/1 corner.tm >>grown
    { echo before && off-export corner.tm; } | cmp - grown
}

@test "gnuplot's end is told, with the first of what it said, escaped" {
    mkdir bin
    for end in 'exit 3' 'kill -TERM $$'; do
        printf '#!/bin/sh\nprintf "\\033[31mbad\\nmore\\n" >&2\n%s\n' "$end" >bin/gnuplot
        chmod +x bin/gnuplot
        PATH=$PWD/bin:$PATH run -4 --separate-stderr tet-stats --plot figure.svg corner.tm
        [[ "$stderr" == 'tet-stats: gnuplot '*'status 3: \x1b[31mbad' ||
            "$stderr" == 'tet-stats: gnuplot '*'signal 15 (Terminated): \x1b[31mbad' ]]
    done
}

@test "-o or --json to a named pipe that nobody reads any more: SIGTERM ends it, nothing is left" {
    many 300 >many.tm
    mkfifo pipe
    leaves_nothing
    for command in "mesh-check --json pipe many.tm" "tet-stats --list --json - -o pipe many.tm" \
        "vtk-export -o pipe many.tm" "vtk-export --json report -o pipe many.tm" \
        "lepp-improve -s 1 -a bisection --json report -o pipe many.tm"; do
        # shellcheck disable=SC2086 # words
        python3 - $command <<'END'
import fcntl, os, signal, subprocess, sys, time
fd = os.open('pipe', os.O_RDWR)
os.write(fd, bytes(fcntl.fcntl(fd, fcntl.F_SETPIPE_SZ, 4096)))
filter = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
asleep = 0
while asleep < 5:
    state = open('/proc/%d/stat' % filter.pid).read().rpartition(') ')[2][0]
    assert state in 'RSD', state
    asleep = asleep + 1 if state == 'S' else 0
    time.sleep(0.02)
filter.terminate()
sys.exit(filter.wait(20) != -signal.SIGTERM)
END
        leaves_nothing
    done
}

@test "a filter is ended: gnuplot ends, too" {
    mkdir bin
    printf '%s\n' '#!/bin/sh' "echo \$\$ >'$PWD/pid.new'" "mv '$PWD/pid.new' '$PWD/pid'" \
        'exec sleep 1000' >bin/gnuplot
    chmod +x bin/gnuplot
    for signal in KILL TERM; do
        for filter in tet-stats jens-stats poly-stats; do
            rm -f pid
            PATH=$PWD/bin:$PATH "$filter" --plot figure.svg "$(input "$filter")" >table &
            while ! [ -e pid ]; do
                kill -0 $!
                sleep 0.02
            done
            kill "-$signal" $!
            while ps -p "$(cat pid)" -o stat= | grep -v Z; do sleep 0.02; done
            [ ! -e figure.svg ]
        done
    done
}

@test "a set of files: where one cannot have its name none has, and the old ones are back" {
    case ${TM_BUILD:?} in */san*) skip "the sanitizers have an allocator of their own" ;; esac
    for file in node face; do echo "old $file" >"set.$file"; done
    for ((which = 1; which < 20; which++)); do
        head -c 72 /dev/zero >count
        status=0
        TM_FAULTS_COUNT=count TM_FAULTS="name $which $which" LD_PRELOAD=$TM_BUILD/faults/preload.so \
            tetgen-export --json report set corner.tm 2>message || status=$?
        [ "$status" -eq 4 ] || break
        [ "$(cat set.node set.face)" = "$(printf 'old node\nold face')" ]
        [ "$(echo set.* report* termesh.*)" = "set.face set.node report* termesh.*" ]
    done
    [ "$which" -gt 4 ]
    [ "$status" -eq 0 ]
    [ "$(echo set.* report* termesh.*)" = "set.ele set.face set.node report termesh.*" ]
    tetgen-import set | mesh-check
}
