# SPDX-License-Identifier: GPL-3.0-or-later
# tetgen-mesh: formats, options, what is wrong with surfaces, a TetGen that fails, the
# private folder.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir folder
    export TMPDIR=$BATS_TEST_TMPDIR/folder
}

# The private folder is gone after every test, however tetgen-mesh ended.
teardown() {
    [ -z "$(ls -A "$BATS_TEST_TMPDIR/folder")" ]
}

# Makes an executable script: script NAME, its text on stdin.
script() {
    { echo '#!/bin/sh'; cat; } >"$1"
    chmod +x "$1"
}

@test "a surface in every format gives the same mesh" {
    surface sphere off >sphere.off
    # M: else TetGen takes faces that are nearly in one plane for one
    tetgen-mesh --no-history --switches M sphere.off >expected.tm
    fills expected.tm "$(fan_volume sphere.off)"
    tetgen-mesh --no-history sphere.off >expected.tm
    for format in coff obj ply ply-little ply-big stl stl-binary mdl poly smesh; do
        echo "$format"
        surface sphere "$format" | tetgen-mesh --no-history >got.tm
        cmp got.tm expected.tm
        surface sphere "$format" >named
        tetgen-mesh --no-history named | cmp - expected.tm
    done
}

# The volume inside a triangulated OFF surface, as signed tetrahedra from the origin.
fan_volume() {
    awk 'NR == 2 { nodes = $1; n = 0 }
         NR > 2 && NR <= nodes + 2 { x[n] = $1; y[n] = $2; z[n++] = $3 }
         NR > nodes + 2 { a = $2; b = $3; c = $4
             sum += x[a] * (y[b] * z[c] - z[b] * y[c]) + \
                 y[a] * (z[b] * x[c] - x[b] * z[c]) + \
                 z[a] * (x[b] * y[c] - y[b] * x[c]) }
         END { printf "%.15g\n", sum / 6 }' "$1"
}

@test "a stream's surface is meshed and stays in the stream, with the history" {
    surface cube stream >cube.tm
    tetgen-mesh cube.tm >mesh.tm
    fills mesh.tm 1
    [ "$(sed -n 2p mesh.tm)" = '# made by hand' ]
    [ "$(rows surface.face mesh.tm)" = "$(rows surface.face cube.tm)" ]
    surface cube off | tetgen-mesh --no-history >expected.tm
    tetgen-mesh --no-history cube.tm | sed '2d; /^surface/,/^\.end/{/^\.end/!d}' |
        cmp - expected.tm
}

@test "another mesh in the stream is left out with a note" {
    surface cube off | tetgen-mesh --no-history | sed '$d' >both.tm
    surface cube stream | sed 1,2d >>both.tm
    run --separate-stderr tetgen-mesh both.tm
    [ "$status" -eq 0 ]
    [[ "${stderr_lines[0]}" == \
        'tetgen-mesh: both.tm: '*' rows of another mesh (.node): left out' ]]
    [ "$(grep -c '^\.node' <<<"$output")" -eq 1 ]
}

@test "tetrahedra: what refines them is needed; a stream of other elements is refused" {
    surface cube off | tetgen-mesh >mesh.tm
    run -3 --separate-stderr tetgen-mesh mesh.tm
    [ -z "$output" ]
    [[ $stderr == 'tetgen-mesh: mesh.tm: holds tetrahedra (.ele), but tetgen-mesh takes them to refine only: -q'* ]]
    run -2 --separate-stderr tetgen-mesh --regions -q mesh.tm
    run -3 --separate-stderr tetgen-mesh -r -q <(surface cube off)
    printf '%s\n' 'termesh 1' .node '8 3 0 0' '1 0 0 0' '2 1 0 0' '3 1 1 0' '4 0 1 0' \
        '5 0 0 1' '6 1 0 1' '7 1 1 1' '8 0 1 1' .mix '1 0' '1 8 1 2 3 4 5 6 7 8' .end >hexahedron.tm
    run -3 --separate-stderr tetgen-mesh hexahedron.tm
    [ -z "$output" ]
    [[ $stderr == 'tetgen-mesh: hexahedron.tm: holds mixed elements (.mix), but tetgen-mesh takes points'* ]]
}

@test "polygons need no cutting" {
    surface box off | tetgen-mesh >mesh.tm
    fills mesh.tm 1
    [ "$(header .face mesh.tm)" = '12 1' ]
}

@test "the history line says options, surface and what came out" {
    surface cube off >cube.off
    tetgen-mesh -q1.4 -a 0.1 cube.off >mesh.tm
    nodes=$(header .node mesh.tm) tets=$(header .ele mesh.tm)
    line="# tetgen-mesh [0-9.]* -q1.4 -a0.1 cube.off: ${nodes%% *} nodes, ${tets%% *} tetrahedra"
    sed -n 2p mesh.tm | grep -x "$line"
    tetgen-mesh --no-history -q1.4 -a 0.1 cube.off >bare.tm
    sed 2d mesh.tm | cmp - bare.tm
}

@test "-a bounds the volume of every tetrahedron" {
    surface cube off | tetgen-mesh -a 0.001 >mesh.tm
    fills mesh.tm 1
    volumes mesh.tm | awk '$1 > 0.001 + 1e-12 { exit 1 } END { exit NR < 1000 }'
}

@test "-q inserts nodes, and a smaller ratio more of them" {
    surface sphere off >sphere.off
    plain=$(tetgen-mesh sphere.off | header .node /dev/stdin)
    two=$(tetgen-mesh -q sphere.off | header .node /dev/stdin)
    tight=$(tetgen-mesh --quality=1.2 sphere.off | header .node /dev/stdin)
    [ "${plain%% *}" -lt "${two%% *}" ]
    [ "${two%% *}" -lt "${tight%% *}" ]
    tetgen-mesh --no-history -q2 sphere.off >a
    tetgen-mesh --no-history -q sphere.off | cmp - a
}

@test "-Y keeps the surface as it is" {
    surface sphere off >sphere.off
    tetgen-mesh -q -a 0.01 -Y sphere.off >mesh.tm
    faces=$(sed -n 2p sphere.off | cut -d ' ' -f 2)
    [ "$(header .face mesh.tm)" = "$faces 1" ]
    tetgen-mesh -q -a 0.01 sphere.off >free.tm
    [ "$(header .face free.tm)" != "$faces 1" ]
}

@test "--switches: regions become attributes of the tetrahedra" {
    cat >regions.smesh <<'END'
# two boxes, one on the other
12 3 1 1
0  0 0 0  1.5 3
1  1 0 0  1.5 3
2  1 1 0  1.5 3
3  0 1 0  1.5 3
4  0 0 1  2.5 4
5  1 0 1  2.5 4
6  1 1 1  2.5 4
7  0 1 1  2.5 4
8  0 0 2  3.5 5
9  1 0 2  3.5 5
10 1 1 2  3.5 5
11 0 1 2  3.5 5
11 1
4 0 1 2 3  7
4 4 5 6 7  8
4 8 9 10 11  9
4 0 1 5 4  0
4 1 2 6 5  0
4 2 3 7 6  0
4 3 0 4 7  0
4 4 5 9 8  -1
4 5 6 10 9  -1
4 6 7 11 10  -1
4 7 4 8 11  -1
0
2
1  0.5 0.5 0.5  10
2  0.5 0.5 1.5  20
END
    tetgen-mesh --switches A regions.smesh >mesh.tm
    fills mesh.tm 2
    [ "$(header .ele mesh.tm | cut -d ' ' -f 2,3)" = '4 1' ]
    [ "$(rows .ele mesh.tm | awk '{ print $6 }' | sort -u | xargs)" = '10 20' ]
    [ "$(header .node mesh.tm)" = '12 3 1 1' ]
    [ "$(rows .node mesh.tm | head -1)" = '0 0 0 0 1.5 3' ]
    [ "$(rows .face mesh.tm | awk '{ print $5 }' | sort -nu | xargs)" = '-1 0 7 8 9' ]
    run --separate-stderr tetgen-mesh -v regions.smesh
    [ "${stderr_lines[0]}" = 'tetgen-mesh: regions.smesh: .smesh, 12 nodes, 11 faces' ]
    [ "${stderr_lines[1]}" = \
        'tetgen-mesh: edges of more than two faces: 4; unused nodes: 0' ]
    tetgen-mesh --switches -A --no-history regions.smesh >dash.tm
    sed 2d mesh.tm | cmp - dash.tm
}

@test "numbers begin where TetGen's files begin" {
    surface cube smesh >one.smesh
    tetgen-mesh one.smesh >one.tm
    [ "$(rows .node one.tm | head -1)" = '1 0 0 0' ]
    # the same from 0
    awk 'NR == 1 || /^12 0$/ { print; faces += NR > 1; next }
         NF == 4 && !faces { print $1 - 1, $2, $3, $4; next }
         NF == 4 { print $1, $2 - 1, $3 - 1, $4 - 1; next }
         { print }' one.smesh >zero.smesh
    tetgen-mesh zero.smesh >zero.tm
    [ "$(rows .node zero.tm | head -1)" = '0 0 0 0' ]
    fills zero.tm 1
    [ "$(volumes zero.tm)" = "$(volumes one.tm)" ]
}

@test "the nodes of a .poly may be in the .node beside it" {
    surface cube node >cube.node
    { echo '0 3 0 0'; surface cube poly | sed 1,9d; } >cube.poly
    tetgen-mesh cube.poly >mesh.tm
    fills mesh.tm 1
    run --separate-stderr tetgen-mesh <cube.poly
    [ "$status" -eq 3 ]
    [[ $stderr == *'<stdin>: has no nodes: they are in a .node file beside it'* ]]
    rm cube.node
    run --separate-stderr tetgen-mesh cube.poly
    [ "$status" -eq 3 ]
    [ "$stderr" = \
        'tetgen-mesh: cube.poly: has no nodes, and there is no file cube.node with them' ]
    mkdir cube.node
    run --separate-stderr tetgen-mesh cube.poly
    [ "$status" -eq 4 ]
    [[ $stderr == 'tetgen-mesh: cube.node: '* ]]
}

@test "a hole of a .poly file stays empty" {
    { surface cube smesh | sed '$d' | sed '$d'; echo 1; echo 1 .5 .5 .5; echo 0; } >hole.smesh
    run --separate-stderr tetgen-mesh hole.smesh
    [ "$status" -eq 3 ]
    [[ $stderr == *'hole.smesh: TetGen made no tetrahedra'*'part 3'* ]]
}

@test "points alone give their Delaunay tetrahedra" {
    surface sphere node >points.node
    tetgen-mesh points.node >mesh.tm
    # what TetGen itself makes of them
    tetgen -Q points.node
    tetgen-import -q points.1 --no-history >expected.tm
    sed 2d mesh.tm | cmp - expected.tm
    [ "$(header .face mesh.tm | cut -d ' ' -f 2)" = 0 ]
    volumes mesh.tm | awk '$1 < 0 { exit 1 }'
    { echo 'OFF 4 0 0'; printf '%s\n' '0 0 0' '1 0 0' '0 1 0' '0 0 1'; } |
        tetgen-mesh >four.tm
    fills four.tm 0.166666666666666667
    for option in -q -a1 -Y; do
        run --separate-stderr tetgen-mesh "$option" points.node
        [ "$status" -eq 2 ]
        [[ $stderr == *'points alone'* ]]
    done
}

@test "duplicate and unused nodes are no obstacle" {
    # each face of the cube with corners of its own, and two nodes far away
    surface cube stl | awk '
        /^vertex/ { v[n++] = $2 " " $3 " " $4 }
        END {
            print "OFF\n" n + 2, n / 3, 0
            for (i = 0; i < n; i++) print v[i]
            print "5 5 5\n6 6 6"
            for (i = 0; i < n; i += 3) print 3, i, i + 1, i + 2
        }' >soup.off
    run --separate-stderr tetgen-mesh soup.off
    [ "$status" -eq 0 ]
    [ "${stderr_lines[0]}" = \
        'tetgen-mesh: nodes in the place of an earlier one, which TetGen joins: 28' ]
    [[ ${stderr_lines[1]} == 'tetgen-mesh: warnings of TetGen: 28 (-v shows them), the first: Warning:'* ]]
    echo "$output" >mesh.tm
    fills mesh.tm 1
    [ "$(header .node mesh.tm)" = '8 3 0 0' ]
    run --separate-stderr tetgen-mesh --quiet soup.off
    [ -z "$stderr" ]
}

@test "an open surface: the gap is named, and there is no mesh" {
    surface cube off | sed '2s/12/11/; $d' >open.off
    run --separate-stderr tetgen-mesh open.off
    [ "$status" -eq 3 ]
    [ -z "$output" ]
    [[ ${stderr_lines[0]} == 'tetgen-mesh: the surface is not closed: edges of one face only: 3, such as that from ('*') to ('*')' ]]
    [[ $stderr == *'open.off: TetGen made no tetrahedra: the surface encloses no volume'* ]]
}

@test "a surface that intersects itself: which faces do, and where" {
    cat >pierced.off <<'END'
OFF
8 8 0
0 0 0
2 0 0
0 2 0
0 0 2
.1 .1 -1
2.1 .2 1
.3 2.2 1
.2 .3 1.5
3 0 2 1
3 0 1 3
3 1 2 3
3 0 3 2
3 4 6 5
3 4 5 7
3 5 6 7
3 4 7 6
END
    run --separate-stderr tetgen-mesh pierced.off
    [ "$status" -eq 3 ]
    [ -z "$output" ]
    [[ $stderr == *'tetgen-mesh: faces 1 and 5 meet near (1.05, 1.05, 0)'* ]]
    [[ $stderr == *'tetgen-mesh: … and 2 pairs more'* ]]
    [[ $stderr != *terminate* ]] # what the C++ library says of it
    [[ ${stderr_lines[-1]} == 'tetgen-mesh: pierced.off: the surface intersects itself: TetGen cannot fill it (surface-mend '*'octree-mesh --lenient '* ]]
}

@test "a pair of faces that meet is listed once" {
    surface cube off >cube.off
    # one corner of one triangle is off: TetGen finds some pairs twice
    awk 'NR == 2 { $1++ } NR == 10 { print; print 1.0001, 1, 1; next }
        $1 == 3 && / 7/ && !done { sub(/ 7/, " 8"); done = 1 } { print }' cube.off >gap.off
    run -3 --separate-stderr tetgen-mesh gap.off
    [[ $stderr == *' meet near ('* ]]
    [ "$(sort <<<"$stderr" | uniq -d)" = "" ]
}

@test "faces with a node twice make no segment inside" {
    surface cube off >cube.off
    tetgen-mesh --no-history cube.off >expected.tm
    # between opposite corners: a segment that would cut the cube
    sed '2s/12/14/' cube.off >twice.off
    printf '3 0 0 6\n4 1 7 7 1\n' >>twice.off
    run -0 --separate-stderr tetgen-mesh --no-history twice.off
    [ "$stderr" = 'tetgen-mesh: faces with two corners in the same place: 2, which lose one, or are dropped' ]
    cmp expected.tm <<<"$output"
    # and one that has a corner too many
    surface box off | sed '$s/^4 \([0-9]*\)/5 \1 \1/' | tetgen-mesh --no-history |
        cmp - <(surface box off | tetgen-mesh --no-history)
}

# slit_box HOLES KIND prints a cube with square shafts through it, OFF, of which the top and
# the bottom are a polygon each, slit open from the front to the holes. doubled: the slits
# have nodes of their own on each side; touching: each hole begins at the front itself.
slit_box() {
    awk -v holes="$1" -v kind="$2" '
        function node(x, y) { xyz[n] = x " " y; return n++ }
        function wall(a, b) { from[++faces] = a; to[faces] = b }
        BEGIN {
            n = 0
            top = node(0, 0)
            last = top
            for (i = 0; i < holes; i++) {
                l = (i + .2) / holes; r = (i + .8) / holes
                rim = node(l, 0)
                a = kind == "touching" ? rim : node(l, .3)
                b = node(l, .7); c = node(r, .7); d = node(r, .3)
                a2 = kind == "doubled" ? node(l, .3) : a
                rim2 = kind == "doubled" ? node(l, 0) : rim
                wall(last, rim); last = rim2
                wall(a, b); wall(b, c); wall(c, d); wall(d, a2)
                list = kind == "touching" ? rim " " b " " c " " d " " rim : \
                    rim " " a " " b " " c " " d " " a2 " " rim2
                top = top " " list
            }
            e = node(1, 0); g = node(1, 1); h = node(0, 1)
            wall(last, e); wall(e, g); wall(g, h); wall(h, 0)
            top = top " " e " " g " " h
            print "OFF\n" 2 * n, faces + 2, 0
            for (z = 0; z < 2; z++)
                for (i = 0; i < n; i++)
                    print xyz[i], z
            k = split(top, v)
            printf "%d", k
            for (i = 1; i <= k; i++)
                printf " %d", v[i] + n
            printf "\n%d", k
            for (i = k; i > 0; i--)
                printf " %d", v[i]
            print ""
            for (i = 1; i <= faces; i++)
                print 4, from[i], to[i], to[i] + n, from[i] + n
        }'
}

@test "polygons that are slit open to their holes: the holes stay" {
    for holes in 1 2 5; do
        for kind in shared doubled touching; do
            echo "$holes $kind"
            slit_box $holes $kind >slit.off
            run -0 --separate-stderr tetgen-mesh slit.off
            [[ $stderr == *'faces that have a corner twice, slit open, which are cut into triangles: 2'* ]]
            echo "$output" >mesh.tm
            volume=.76
            [ $kind != touching ] || volume=.67
            fills mesh.tm $volume
            surface-import slit.off | tetgen-mesh --quiet >mesh.tm
            fills mesh.tm $volume
        done
    done
}

@test "binary STL with bytes behind the last triangle" {
    surface sphere stl-binary >exact.stl
    tetgen-mesh --no-history exact.stl >expected.tm
    for more in 1 3 50 1000; do
        { cat exact.stl; head -c $more /dev/zero | tr '\0' x; } >more.stl
        run -0 --separate-stderr tetgen-mesh --no-history -o got.tm more.stl
        [ "$stderr" = "tetgen-mesh: more.stl: $more bytes behind the last triangle are skipped" ]
        cmp got.tm expected.tm
        tetgen-mesh --no-history <more.stl | cmp - expected.tm
    done
}

@test "flat surfaces, flat points and too few points are refused" {
    printf 'OFF\n4 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 0 1 2 3\n' >flat.off
    printf '5 3\n1 0 0 0\n2 1 2 3\n3 2 1 3\n4 1 1 2\n5 4 5 9\n' >flat.node
    for file in flat.off flat.node; do
        run --separate-stderr tetgen-mesh "$file"
        [ "$status" -eq 3 ]
        [ "$stderr" = \
            "tetgen-mesh: $file: all points are in one plane (tetrahedra need a volume)" ]
    done
    printf '5 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 1 0\n5 -0 -0 -0\n' >few.node
    run --separate-stderr tetgen-mesh few.node
    [ "$status" -eq 3 ]
    [ "$stderr" = \
        'tetgen-mesh: few.node: 3 different points are too few for a tetrahedron (4)' ]
    run --separate-stderr tetgen-mesh </dev/null
    [ "$status" -eq 3 ]
}

@test "wrong input: file, line and cause, exit 3" {
    surface cube off | sed '4s/.*/0 0,5 0/' >comma.off
    run --separate-stderr tetgen-mesh comma.off
    [ "$status" -eq 3 ]
    [ "$stderr" = \
        "tetgen-mesh: comma.off:4: the y coordinate: '0,5' is not a number (the decimal sign is a point)" ]
    surface cube stl-binary | head -c 200 >short.stl
    run --separate-stderr tetgen-mesh short.stl
    [ "$status" -eq 3 ]
    [[ $stderr == *'has 200 bytes, but claims 12 triangles'* ]]
    echo 'what is this' >text
    run --separate-stderr tetgen-mesh text
    [ "$status" -eq 3 ]
    [[ $stderr == 'tetgen-mesh: text: is no surface that can be read (OFF, STL, '* ]]
    surface cube off | head -c 40 >short.off
    run --separate-stderr tetgen-mesh short.off
    [ "$status" -eq 3 ]
    run --separate-stderr tetgen-mesh missing.off
    [ "$status" -eq 4 ]
}

# Runs tetgen-mesh on a file, which must be refused; prints the peak of its memory, in kB.
memory() {
    python3 -c '
import resource, subprocess, sys
run = subprocess.run(["tetgen-mesh", sys.argv[1]], stderr=subprocess.DEVNULL)
assert run.returncode == 3, run
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' "$1"
}

@test "a claim of four billion nodes costs no memory" {
    printf 'OFF\n4000000000 1 0\n0 0 0\n' >claim.off
    printf '4000000000 3 0 0\n1 0 0 0\n' >claim.node
    printf 'ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n' >claim.ply
    printf '[A, ARRAY1<POINT3D>]\n4000000000\n0 0 0\n' >claim.mdl
    printf 'OFF\n4 1 0\n0 0 0\n' >modest.off
    modest=$(memory modest.off)
    for file in claim.*; do
        echo "$file: $(memory "$file") kB, $modest kB for a small claim"
        [ "$(memory "$file")" -lt $((modest + 2000)) ]
    done
}

@test "TetGen is missing: exit 4 and the package's name" {
    surface cube off >cube.off
    run --separate-stderr tetgen-mesh --tetgen /nonexistent cube.off
    [ "$status" -eq 4 ]
    [[ $stderr == "tetgen-mesh: cannot run '/nonexistent': No such file or directory (needs tetgen, Debian package tetgen;"* ]]
    run --separate-stderr env PATH=/nonexistent "$(command -v tetgen-mesh)" cube.off
    [ "$status" -eq 4 ]
    [[ $stderr == *"'tetgen'"*'Debian package tetgen'* ]]
}

@test "a TetGen that crashes, fails, makes nothing or nonsense" {
    surface cube off >cube.off
    script crash <<<"echo 'Sorry, I crash.'; kill -SEGV \$\$"
    run --separate-stderr tetgen-mesh --tetgen ./crash cube.off
    [ "$status" -eq 4 ]
    [ "${stderr_lines[0]}" = 'tetgen-mesh: tetgen: Sorry, I crash.' ]
    [ "${stderr_lines[1]}" = \
        "tetgen-mesh: './crash' was ended by signal 11 (Segmentation fault)" ]
    run --separate-stderr tetgen-mesh --tetgen false cube.off
    [ "$status" -eq 4 ]
    [ "$stderr" = "tetgen-mesh: 'false' failed with exit status 1" ]
    run --separate-stderr tetgen-mesh --tetgen true cube.off
    [ "$status" -eq 4 ]
    [[ $stderr == *"'true' ended well, but made no surface.1.node"* ]]
}

@test "TetGen runs in a folder for the user alone, without a shell, with nothing on stdin" {
    surface cube off >cube.off
    mkdir "folder/it's \$(touch harm) \"; *"
    script look <<'END'
for file; do :; done
stat -c %a "${file%/*}" >&2
cat
exec tetgen "$@"
END
    TMPDIR=$(echo folder/it*) run --separate-stderr tetgen-mesh -v --tetgen ./look cube.off
    [ "$status" -eq 0 ]
    mapfile -t said < <(sed -n 's/^tetgen-mesh: tetgen: //p' <<<"$stderr")
    [ "${said[0]}" = 700 ]
    [[ ${said[1]} == 'Opening '* ]]
    [ -z "$(find . -name harm)" ]
    rmdir folder/it*
}

@test "a signal ends TetGen and its children, and removes the folder" {
    surface cube off >cube.off
    script slow <<'END'
echo $$ >started.new
sleep 1000 &
echo $! >>started.new
mv started.new started
wait
END
    for signal in TERM INT HUP; do
        rm -f started
        # A signal that is ignored stays so: bash's background ignores SIGINT, nohup
        # SIGHUP. python3 undoes that.
        python3 -c 'import os, signal, sys
for s in signal.SIGTERM, signal.SIGINT, signal.SIGHUP:
    signal.signal(s, signal.SIG_DFL)
os.execvp(sys.argv[1], sys.argv[1:])' tetgen-mesh --tetgen ./slow cube.off -o out.tm &
        pid=$!
        while ! [ -e started ]; do sleep 0.02; done
        [ -n "$(ls folder)" ]
        kill "-$signal" "$pid"
        ended=0
        wait "$pid" || ended=$?
        [ "$ended" -eq $((128 + $(kill -l "$signal"))) ]
        [ -z "$(ls folder)" ]
        [ ! -e out.tm ]
        while read -r child; do
            while ps -o stat= -p "$child" | grep -v Z; do sleep 0.02; done
        done <started
    done
}

@test "no folder can be made: exit 4" {
    surface cube off >cube.off
    TMPDIR=/nonexistent run --separate-stderr tetgen-mesh cube.off
    [ "$status" -eq 4 ]
    [[ $stderr == 'tetgen-mesh: cannot make a folder in /nonexistent: '* ]]
}

@test "a locale with a decimal comma changes nothing" {
    surface sphere ply >sphere.ply
    tetgen-mesh -q1.4 -a 0.05 sphere.ply >expected.tm
    locales=$(comma_locale)
    [ "$(env LOCPATH="$locales" LC_ALL=comma printf '%.1f' 1)" = 1,0 ]
    env LOCPATH="$locales" LC_ALL=comma tetgen-mesh -q1.4 -a 0.05 sphere.ply >got.tm
    cmp got.tm expected.tm
}

@test "threads do not change the output" {
    surface sphere off >sphere.off
    tetgen-mesh --no-history -a 0.0005 sphere.off >one.tm
    tetgen-mesh --no-history -a 0.0005 -j 3 sphere.off | cmp - one.tm
}

@test "-o is whole or not there, --json counts, -v shows TetGen's words" {
    surface cube off >cube.off
    tetgen-mesh -o mesh.tm --json report cube.off
    fills mesh.tm 1
    [ "$(cat report)" = '{"nodes": 8, "tets": 6, "faces": 12, "edges": 12}' ]
    run --separate-stderr tetgen-mesh -o broken.tm text
    [ "$status" -ne 0 ]
    [ ! -e broken.tm ]
    run --separate-stderr tetgen-mesh -v cube.off
    [[ $stderr == *'tetgen-mesh: tetgen: Delaunizing vertices...'* ]]
    run -4 --separate-stderr bash -c 'tetgen-mesh cube.off >/dev/full'
}

@test "numbers and switches reach TetGen as they are meant" {
    surface sphere off >sphere.off
    # says what it is called with
    printf '%s\n' '#!/bin/sh' "echo \"\$*\" >>'$PWD/called'" 'exec tetgen "$@"' >recorder
    chmod +x recorder
    for ratio in 1000 100 20.5 1.4142135623730951 1e2; do
        tetgen-mesh --quiet --tetgen "$PWD/recorder" -q"$ratio" -o mesh.tm sphere.off
    done
    grep -o -e '-q[0-9.]* ' called | tr -d '\n' |
        grep -x -e '-q1000 -q100 -q20.5 -q1.4142135623730951 -q100 '
    tetgen-mesh --no-history --switches a1e-2 sphere.off | cmp - <(tetgen-mesh --no-history -a 0.01 sphere.off)
    tetgen-mesh --no-history --switches -q1.2/10T1e-9 sphere.off >mesh.tm
    run -2 --separate-stderr tetgen-mesh --switches m sphere.off
    [[ "$stderr" == "tetgen-mesh: --switches: 'm' is not possible here (nor any of "* ]]
    run -2 --separate-stderr tetgen-mesh --switches Av sphere.off
    [[ "$stderr" == "tetgen-mesh: --switches: 'v' would do nothing here (nor any of "* ]]
    run -2 --separate-stderr tetgen-mesh --switches A:2 sphere.off
    [[ "$stderr" == "tetgen-mesh: --switches: ':' is no switch of TetGen here"* ]]
}

@test "usage errors are exit 2" {
    surface cube off >cube.off
    for wrong in -q0.5 -qx -a0 -a-1 -ax --switches= --switches=I --switches=qo2 --switches=m \
        --switches=Ai --switches=d --switches=q1e3 --switches=v --switches=q1.2o -z \
        --threads=0; do
        echo "$wrong"
        run --separate-stderr tetgen-mesh "$wrong" cube.off
        [ "$status" -eq 2 ]
        [ -z "$output" ]
        [[ $stderr == 'tetgen-mesh: '* ]]
    done
    run --separate-stderr tetgen-mesh cube.off cube.off
    [ "$status" -eq 2 ]
    run tetgen-mesh --help
    [ "$status" -eq 0 ]
    for option in --quality --max-volume --keep-surface --switches --tetgen; do
        [[ $output == *"$option"* ]]
    done
    run tetgen-mesh --version
    [[ $output == 'tetgen-mesh (termesh) '* ]]
}

# grid ATTRIBUTES SEED: 3³ cubes of six tetrahedra each, with so many attributes: one that
# cubes have, one that tetrahedra have, and one that all have.
grid() {
    python3 - "$@" <<'END'
import itertools, random, sys
attributes, n = int(sys.argv[1]), 3
random.seed(sys.argv[2])
number = lambda p: 1 + p[0] + (n + 1) * (p[1] + (n + 1) * p[2])
print('termesh 1\n.node\n%d 3 0 0' % (n + 1) ** 3)
for z, y, x in itertools.product(range(n + 1), repeat=3):
    print(number((x, y, z)), x, y, z)
print('.ele\n%d 4 %d' % (6 * n ** 3, attributes))
row = 0
for cube in itertools.product(range(n), repeat=3):
    region = random.randrange(2)
    for order in itertools.permutations(range(3)):
        p, nodes = list(cube), [number(cube)]
        for axis in order:
            p[axis] += 1
            nodes.append(number(p))
        row += 1
        print(row, *nodes, *[region, random.randrange(4) // 3, 5][:attributes])
print('.end')
END
}

# Prints the volume of each region of a stream.
regions() {
    paste <(rows .ele "$1" | cut -d' ' -f6-) <(volumes "$1") | awk -F '\t' '
        { volume[$1] += $2 < 0 ? -$2 : $2 }
        END { for (region in volume) printf "%s: %.6f\n", region, volume[region] }' | sort
}

@test "refined tetrahedra keep their regions, whichever of their attributes says so" {
    for attributes in 1 2 3; do
        grid "$attributes" "$attributes" >coarse.tm
        tetgen-mesh --size 0.7 coarse.tm >fine.tm
        [ "$(rows .ele fine.tm | wc -l)" -gt 162 ]
        diff <(regions coarse.tm) <(regions fine.tm)
    done
}
