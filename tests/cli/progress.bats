# SPDX-License-Identifier: GPL-3.0-or-later
# What filters say while they work: the line on a terminal, and the stages of -v.
# shellcheck disable=SC2016,SC2154 # for an inner shell; run sets stderr

bats_require_minimum_version 1.5.0

setup_file() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    surface sphere off >sphere.off
    tetgen-mesh -q --no-history sphere.off >sphere.tm
}

setup() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    out=$BATS_TEST_TMPDIR
    export TERM=xterm
}

# Runs a command with a terminal of its own as standard error and the most of FILE on standard input,
# until WAIT is on the terminal or, where WAIT is a number, for so many seconds; then does
# THEN: "rest", the rest of FILE follows; "end", it does not; "INT" or another signal, the
# command gets that and ends; "end INT", it does not end by that, but with its input; else
# it is a shell command. Prints what was on the terminal, with
# \r and \e as letters, and returns the status: watch FILE WAIT THEN COMMAND…
# COLUMNS is how wide the terminal is.
watch() {
    python3 - "$@" <<'END'
import fcntl, os, pty, select, signal, struct, subprocess, sys, termios, time
file, wait, then, *command = sys.argv[1:]
data = open(file, 'rb').read()
most = data[:-20]
master, slave = pty.openpty()
size = struct.pack('HHHH', 24, int(os.environ.get('COLUMNS', 80)), 0, 0)
fcntl.ioctl(slave, termios.TIOCSWINSZ, size)
def begin():
    fcntl.ioctl(2, termios.TIOCSCTTY, 0)
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL) # whatever these tests were started with
child = subprocess.Popen(
    command, stdin=subprocess.PIPE, stderr=slave, start_new_session=True, preexec_fn=begin)
os.close(slave)
child.stdin.write(most)
child.stdin.flush()
seen = b''

def listen(until, seconds):
    global seen
    end = time.monotonic() + seconds
    while not (until and until in seen):
        left = end - time.monotonic()
        if left <= 0:
            return False
        if select.select([master], [], [], left)[0]:
            try:
                some = os.read(master, 4096)
            except OSError:
                return False
            if not some:
                return False
            seen += some
    return True

if wait.replace('.', '').isdigit():
    listen(None, float(wait))
elif not listen(wait.encode(), 60):
    sys.exit(f'{wait!r} did not come: {seen!r}')
if then == 'rest':
    child.stdin.write(data[len(most):])
elif then.isupper():
    child.send_signal(getattr(signal, 'SIG' + then))
    child.wait(60) # its input goes on
elif then.startswith('end '):
    child.send_signal(getattr(signal, 'SIG' + then[4:]))
elif then != 'end':
    subprocess.run(then, shell=True, check=True)
child.stdin.close()
listen(None, 60)
status = child.wait()
text = seen.replace(b'\x1b', b'\\e').replace(b'\r\n', b'\n').replace(b'\r', b'\\r')
sys.stdout.buffer.write(text)
sys.exit(status if status >= 0 else 128 - status)
END
}

@test "on a terminal there is a line, which is erased at the end" {
    run -0 watch sphere.tm ', 0 s' rest off-export -o "$out/off"
    [[ "$output" == '\roff-export: reading, '[1-9]*' kB, 0 s\e[K'*'\r\e[K' ]]
    off-export sphere.tm | cmp - "$out/off"
}

@test "messages are on lines of their own" {
    run -0 watch sphere.tm ', 0 s' rest lepp-improve -o "$out/tm"
    [[ "$output" == '\rlepp-improve: reading, '*'\r\e[Klepp-improve: '*' bad'* ]]
    run -3 watch sphere.tm ', 0 s' end tet-stats
    [[ "$output" == '\rtet-stats: reading, '*'\r\e[Ktet-stats: <stdin>:'*truncated* ]]
}

@test "a signal erases the line, and leaves nothing behind" {
    mkdir "$out/made"
    for signal in INT TERM HUP; do
        status=$((128 + $(kill -l $signal)))
        run "-$status" watch sphere.tm ', 0 s' $signal off-export -o "$out/made/off"
        [[ "$output" == *'s\e[K\r\e[K' ]]
    done
    [ -z "$(ls "$out/made")" ]
}

@test "an ignored signal stays ignored" {
    run -3 watch sphere.tm ', 0 s' 'end HUP' sh -c 'trap "" HUP; exec off-export'
    [[ "$output" == *'\r\e[Koff-export: <stdin>:'*truncated* ]]
}

@test "the line is not wider than the terminal" {
    COLUMNS=20 run -0 watch sphere.tm '[K' rest off-export -o "$out/off"
    [[ "$output" == '\roff-export: reading\e[K'*'\r\e[K' ]]
}

@test "no line: with -q, in the background, of a filter that waits, where none can be" {
    run -0 watch sphere.tm 1 rest off-export -q -o "$out/off"
    [ -z "$output" ]
    run -0 watch sphere.tm 1 rest bash -mc 'off-export -o "$1" <&0 & wait' sh "$out/off"
    [[ "$output" != *reading* ]]
    TERM=dumb run -0 watch sphere.tm 1 rest off-export -o "$out/off"
    [ -z "$output" ]
    run -0 watch sphere.tm 1 rest sh -c 'off-export -o "$1" 2>"$1.err"' sh "$out/off"
    [ -z "$output" ]
    [ ! -s "$out/off.err" ]
    run -0 watch sphere.tm 1 rest sh -c 'off-export -o "$1" 2>&1 | cat >"$1.err"' sh "$out/off"
    [ ! -s "$out/off.err" ]
    printf 'twenty bytes or less' >little
    run -3 watch little 1 end off-export
    [[ "$output" != *reading* ]]
}

@test "what TetGen says is passed on" {
    command -v tetgen >/dev/null || skip "there is no tetgen"
    mkfifo "$out/go"
    cat >"$out/slow" <<END
#!/bin/sh
echo Delaunizing vertices...
echo 'Refining mesh...'
read -r _ <"$out/go"
exec tetgen "\$@"
END
    chmod +x "$out/slow"
    run -0 watch sphere.off 'Refining mesh, ' "echo >'$out/go'" \
        tetgen-mesh --tetgen "$out/slow" -o "$out/tm" sphere.off
    [[ "$output" == '\rtetgen-mesh: TetGen: Refining mesh, 0 s\e[K'*'\r\e[K'* ]]
    [[ "$output" != *$'\n''\r'* ]]
    run watch sphere.off 'Refining mesh, ' INT \
        tetgen-mesh --tetgen "$out/slow" -o "$out/tm2" sphere.off
    [[ "$output" == *'\r\e[K' ]]
    [ ! -e "$out/tm2" ]
}

@test "-v: a line for each stage, not only on a terminal" {
    stage='[0-9]+\.[0-9]{2} s, [0-9]+\.[0-9]{2} s of CPU, [0-9]+\.[0-9] MB at most$'
    run -0 --separate-stderr lepp-improve -v -o "$out/tm" sphere.tm
    grep -Ev "$stage" <<<"$stderr" >"$out/others"
    [ "$(wc -l <"$out/others")" -eq 1 ]
    run -0 sed -nE "s/^(lepp-improve: .*): $stage/\1/p" <<<"$stderr"
    [ "$output" = "lepp-improve: reading
lepp-improve: finding neighbours
lepp-improve: improving
lepp-improve: writing" ]
    run -0 --separate-stderr lepp-improve -o "$out/tm" sphere.tm
    [ "$stderr" = "$(cat "$out/others")" ]
    run -0 --separate-stderr lepp-improve -v -q -o "$out/tm" sphere.tm
    [ -z "$stderr" ]
}

@test "the same bytes, whether somebody is told or not" {
    run -0 watch sphere.tm ', 0 s' rest polylla3d --no-history -o "$out/told"
    polylla3d --no-history -q sphere.tm | cmp - "$out/told"
}
