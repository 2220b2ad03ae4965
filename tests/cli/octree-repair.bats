# SPDX-License-Identifier: GPL-3.0-or-later
# octree-repair: what is good stays, what is bad is mended, nodes come to the surface; the
# loop that refines, and its files.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    [ -x "$TM_BUILD/bin/octree-repair" ] || skip "there is no p4est"
    cd "$BATS_TEST_TMPDIR" || exit
    cat >cube.off <<'END'
OFF
8 6 0
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
END
    octree-mesh --no-history -s 3 cube.off >good.tm
    # A node inside, moved over its neighbours: elements around it are inverted.
    awk '/^\.node/ { nodes = 1 } /^\.mix/ { nodes = 0 }
        nodes && NF == 5 && $5 == 0 && n++ == 40 { $2 += 0.15; $3 += 0.15 }
        { print }' good.tm >bad.tm
    # A node that is held back before its patch.
    awk '/^\.node/ { nodes = 1 } /^\.mix/ { nodes = 0 }
        nodes && NF == 5 && $5 == 1 && $2 == 0 && !done {
            $2 = 0.002; $5 = -1; done = 1 }
        { print }' good.tm >held.tm
}

# report KEY: a number of the JSON report, of `after` where there are two.
report() {
    tr '{,}' '[\n*]' <report.json | sed -n "s/.*\"$1\": *//p" | tail -n 1
}

# A corner of a cube, cut off: half of its bounding box is outside.
make_corner() {
    cat >corner.off <<'END'
OFF
4 4 0
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
END
}

# is_near KEY NUMBER: all numbers of that key in the report are, but for rounding.
is_near() {
    tr '{,}' '[\n*]' <report.json | sed -n "s/.*\"$1\": *//p" |
        awk -v is="$2" '{ n++; if (($1 - is) ^ 2 > 1e-18) exit 1 } END { if (n != 2) exit 1 }'
}

@test "a good mesh is returned byte for byte, unknown blocks too" {
    sed '$d' good.tm >more.tm
    printf '%s\n' .note 'for element 1' .end >>more.tm
    octree-repair --no-history -t 0.2 more.tm >same.tm
    cmp more.tm same.tm
    octree-repair --no-history --method refine -q more.tm >same.tm
    cmp more.tm same.tm
}

@test "inverted elements are mended, and nothing else changes" {
    run -1 jens-stats --fail-below 0.2 bad.tm
    run -0 octree-repair -t 0.2 --json report.json -o mended.tm bad.tm
    [ "$(report bad)" -eq 0 ]
    run -0 jens-stats --fail-below 0.2 --certify mended.tm
    run -0 mesh-check mended.tm
    # The elements are the same, and so is each node of the boundary.
    sed -n '/^\.mix/,/^\.octant/p' bad.tm >old
    sed -n '/^\.mix/,/^\.octant/p' mended.tm >new
    cmp old new
    awk '/^\.node/,/^\.mix/ { if (NF == 5 && $5 > 1) print }' bad.tm >old
    awk '/^\.node/,/^\.mix/ { if (NF == 5 && $5 > 1) print }' mended.tm >new
    [ -s old ]
    cmp old new
}

@test "a node that was held back is brought to the surface" {
    run -0 octree-repair -t 0.2 --json report.json -o mended.tm held.tm
    [ "$(report held)" -eq 0 ]
    before=$(awk '/^\.node/,/^\.mix/ { if (NF == 5 && $5 < 0) print $1 }' held.tm)
    [ -n "$before" ]
    [ "$(awk -v n="$before" '/^\.node/,/^\.mix/ { if (NF == 5 && $1 == n) print $2, $5 }' \
        mended.tm)" = "0 1" ]
}

@test "markers and attributes of nodes stay, and what refining drops is said" {
    awk '/^\.node/ { print; getline; print $1, 3, 2, 1; nodes = 1; next } /^\./ { nodes = 0 }
        nodes { print $0, 5, 1 + $1 % 9; next } 1' bad.tm >marked.tm
    octree-repair -q -t 0.2 -o mended.tm marked.tm
    rows() { awk '/^\.node/,/^\.mix/ { if (NF == 7) print $1, $5, $6, $7 }' "$1"; }
    rows marked.tm | cmp - <(rows mended.tm)
    run -0 --separate-stderr octree-repair --method refine -t 0.2 -o mended.tm marked.tm
    [[ "$stderr" == *"(attributes of .node, markers of .node): left out" ]]
    [ "$(header .node mended.tm | cut -d ' ' -f 2-)" = "3 1 0" ]
    run -3 octree-repair --strict --method refine -t 0.2 marked.tm
}

@test "places of nodes are found where the stream does not say them" {
    # Without the attribute; the node that is off its patch is off the surface.
    awk '/^\.node/ { nodes = 1; print; getline; print $1, 3, 0, 0; next }
        /^\.mix/ { nodes = 0 }
        nodes { print $1, $2, $3, $4; next }
        { print }' held.tm >plain.tm
    run -0 octree-repair --json report.json -o mended.tm plain.tm
    [ "$(report held)" -eq 0 ]
    [ "$(awk '/^\.node/ { getline; print NF, $3; exit }' mended.tm)" = "4 0" ]
    run -0 mesh-check mended.tm
    run -0 jens-stats --fail-below 0.1 mended.tm
}

@test "--method refine: the loop, its lines and its files" {
    run -0 --separate-stderr octree-repair --method refine --trace step -o mended.tm bad.tm
    [[ "${stderr_lines[0]}" =~ ^"Octants to improve in iteration 0: "[0-9]+$ ]]
    [ "${stderr_lines[1]}" = "No more Octants to improve in iteration 1." ]
    for suffix in histo m3d vtk oct; do
        [ -s step_0.$suffix ]
        [ -s step_1.$suffix ]
    done
    [ "Octants to improve in iteration 0: $(wc -l <step_0.ref)" = "${stderr_lines[0]}" ]
    [ ! -e step_1.ref ]
    [ "$(head -n 1 step_1.histo)" = "negative 0" ]
    run -0 mesh-check mended.tm
    run -0 oct-import -m step_1.m3d step_1.oct
}

# drop_octants FILE: without the octants that have no elements; with an attribute as id.
drop_octants() {
    awk '/^[a-z]*\./ && octants { print kept, 1; printf "%s", rows; octants = 0 }
        /^\.octant/ { octants = 1; print; getline; next }
        octants && !/^#/ { if ($6 < $7) { id = 7 * $1 + 100; $1 = kept++ + 1
            rows = rows $0 " " id "\n" }; next }
        { print }' "$1"
}

@test "octants that are missing are made again: the mesh is the same" {
    make_corner
    octree-mesh --no-history -s 4 corner.off >all.tm
    drop_octants all.tm >less.tm
    [ "$(header .octant less.tm | cut -d ' ' -f 1)" -lt \
        "$(header .octant all.tm | cut -d ' ' -f 1)" ]
    refine() {
        octree-repair -q --no-history -t 0.4 -i 1 --method refine --trace "$1" -o "$1.out" \
            "$1.tm" || [ $? -eq 1 ]
    }
    refine all
    refine less
    cmp all.out less.out
    cmp all_1.oct less_1.oct
    # their ids are in the trace's first files
    awk '{ print 7 * ($1 + 1) + 100 }' all_0.ref | cmp - less_0.ref
    oct-export --ids less.tm | cmp - less_0.oct
    oct-import -m less_0.m3d less_0.oct >again.tm
    rows .octant again.tm | awk '{ print $2, $6, $7, $8 }' |
        diff - <(rows .octant less.tm | awk '{ print $2, $6 - 1, $7 - 1, $8 }')
}

@test "--octants: a list is split, and the loop goes on as if it had found it" {
    make_corner
    octree-mesh --no-history -s 4 corner.off >all.tm
    drop_octants all.tm >less.tm
    step() { octree-repair -q --no-history -t 0.4 --method refine "$@"; }
    run -1 step -i 2 --trace loop -o loop.tm all.tm
    [ -s loop_0.ref ] && [ -s loop_1.ref ]
    # step by step, from ids too, in any order and twice
    awk '{ print 7 * ($1 + 1) + 100 }' loop_0.ref | sort -r >ids.ref
    cat ids.ref ids.ref >twice.ref
    run -1 step -i 1 --octants twice.ref --trace one -o one.tm less.tm
    cmp one_0.ref <(sort -n ids.ref)
    cmp one_1.ref loop_1.ref
    cmp one_1.oct loop_1.oct
    run -1 step -i 1 --octants loop_1.ref --trace two -o two.tm one.tm
    cmp two.tm loop.tm
    run -1 step -i 2 --octants loop_0.ref -o two.tm all.tm
    cmp two.tm loop.tm
    # of a good mesh, too, and by the other method
    echo 0 >first.ref
    run -0 octree-repair -q --json report.json --octants first.ref -o split.tm good.tm
    [ "$(report iterations)" -eq 1 ]
    [ "$(header .octant split.tm)" = "$(($(header .octant good.tm | cut -d ' ' -f 1) + 7)) 0" ]
    run -0 mesh-check split.tm
}

@test "--octants: wrong lists and octants that are not there" {
    echo 512 >beyond.ref
    run -3 --separate-stderr octree-repair --octants beyond.ref -o out.tm good.tm
    [ "$stderr" = 'octree-repair: beyond.ref: octant 512 is not in the mesh (no octant has '\
'that id)' ]
    echo 0 1 >beyond.ref
    run -3 --separate-stderr octree-repair --octants beyond.ref -o out.tm good.tm
    [[ "$stderr" == *"beyond.ref:1: '1' follows the octant"* ]]
    echo 0 >first.ref
    run -4 octree-repair --octants nowhere.ref -o out.tm good.tm
    run -2 octree-repair --octants first.ref -i 0 -o out.tm good.tm
    { sed '/^surface.node/,$d' good.tm; echo .end; } >alone.tm
    run -3 --separate-stderr octree-repair -q --octants first.ref -o out.tm alone.tm
    [[ "$stderr" == *"there are no octants to refine"* ]]
    awk '/^[a-z]*\./ { skip = $1 == ".octant" } !skip' good.tm >without.tm
    run -3 --separate-stderr octree-repair -q --octants first.ref -o out.tm without.tm
    [[ "$stderr" == *"without.tm: has no octants to split"* ]]
    [ ! -e out.tm ]
}

@test "what cannot be is left: exit 1, the best state, a line for each octant" {
    run -1 --separate-stderr octree-repair -t 1 -i 0 -o left.tm good.tm
    [[ "$stderr" == *": octant "*" is left to improve"* ]]
    [[ "$stderr" == *"elements are still bad (0 of them invalid"* ]]
    [ "${#stderr_lines[@]}" -le 10 ]
    worst() { jens-stats "$1" | sed -n 's/^worst quality *//p'; }
    awk -v a="$(worst left.tm)" -v b="$(worst good.tm)" 'BEGIN { exit !(a >= b) }'
    run -0 mesh-check left.tm
}

@test "no gain elsewhere lets the worst fall below the threshold, or further below" {
    make_corner
    octree-mesh --no-history -s 3 corner.off >corner.tm
    octree-repair -q -t 0.2 -i 0 --json report.json -o left.tm corner.tm || [ $? -eq 1 ]
    worst() { jens-stats "$1" | sed -n 's/^worst quality *//p'; }
    awk -v a="$(worst left.tm)" -v b="$(worst corner.tm)" 'BEGIN { exit !(a >= b) }'
    run -0 mesh-check left.tm
    run -0 jens-stats --certify left.tm
}

@test "the report: before and after of all that may not become worse, and what is left" {
    run -1 --separate-stderr octree-repair -t 1 -i 0 --json report.json -o left.tm good.tm
    [ "$(report corners)" -eq 8 ]
    is_near sharp_length 12
    [ "$(report defects)" -eq 0 ]
    [ "$(report components)" -eq 1 ]
    [ "$(report euler)" -eq 2 ]
    is_near volume 1
    for key in to_surface from_surface to_sharp from_sharp; do
        is_near "$key" 0
    done
    named=$(grep -c 'octant [0-9]* is left to improve' <<<"$stderr")
    more=$(sed -n 's/.*: \([0-9]*\) more octants are left.*/\1/p' <<<"$stderr")
    left=$(sed 's/.*"left": \[\([^]]*\)\].*/\1/' report.json | tr ',' '\n' | wc -l)
    [ "$left" -eq $((named + more)) ]
}

@test "what the surface is too sharp for is forced, and not bad" {
    cat >pyramid.off <<'END'
OFF
5 5 0
0 0 0
1 0 0
1 1 0
0 1 0
0.5 0.5 3
4 0 3 2 1
3 0 1 4
3 1 2 4
3 2 3 4
3 3 0 4
END
    octree-mesh -q --no-history --resolve 0 -s 2 pyramid.off >pyramid.tm
    run -0 --separate-stderr octree-repair -t 0.2 --json report.json -o sharp.tm pyramid.tm
    [[ "$stderr" == *": 1 elements are below the threshold because the surface is as sharp"* ]]
    [ "$(report forced)" -eq 1 ]
    [ "$(report bad)" -eq 0 ]
    grep -q '"left": \[\]' report.json
    # 3 / 6.75^1.5 between three sloping edges of the tip, over that of the best pyramid.
    jens-stats sharp.tm | awk '/^worst quality/ { exit !(($3 - 0.188) ^ 2 < 1e-6) }'
}

@test "ended by --time or a signal it writes the best so far, exit 1" {
    run -1 --separate-stderr octree-repair -t 1 --time 1e-9 -o early.tm good.tm
    [[ "$stderr" == *"ended early, by --time: "* ]]
    run -0 mesh-check early.tm
    octree-mesh --no-history -s 5 cube.off >large.tm
    for signal in INT TERM; do
        # In the background a shell makes its children ignore INT; env takes it back.
        : >notes
        env --default-signal=INT octree-repair -v -t 1 -o "$signal.tm" large.tm \
            2>notes 3>&- &
        until grep -q "octants to improve in iteration 0" notes; do sleep 0.05; done
        kill -s "$signal" $!
        wait $! && status=0 || status=$?
        [ "$status" -eq 1 ]
        grep -q 'ended early, by a signal: ' notes
        run -0 mesh-check "$signal.tm"
        worst() { jens-stats "$1" | sed -n 's/^worst quality *//p'; }
        awk -v a="$(worst "$signal.tm")" -v b="$(worst large.tm)" \
            'BEGIN { exit !(a >= b || a >= 0.2) }'
    done
}

@test "without a surface nodes of the boundary stay, and no octant is split" {
    { sed '/^surface.node/,$d' bad.tm; echo .end; } >alone.tm
    run -0 --separate-stderr octree-repair -o mended.tm alone.tm
    [[ "$stderr" == *"there is no surface"* ]]
    run -0 jens-stats --certify mended.tm
    run -3 octree-repair --method refine alone.tm
    [[ "$output" == *"no octants to refine"* ]]
}

@test "wrong use and wrong input" {
    run -2 octree-repair -t 2 good.tm
    run -2 octree-repair --method other good.tm
    run -2 octree-repair --max-growth 0.5 good.tm
    run -2 octree-repair --time -1 good.tm
    printf '%s\n' 'termesh 1' .node '0 3 0 0' .end >empty.tm
    run -3 --separate-stderr octree-repair empty.tm
    [[ "$stderr" == 'octree-repair: empty.tm: holds points (.node alone), but '* ]]
}

@test "a list splits its octants and no others; tips made anew keep growth and shape" {
    "$TM_BUILD/bench/shapes" spikes >spikes.off
    octree-mesh -q -s 4 -o spikes.tm spikes.off
    run octree-repair -q -t 0.2 --json report.json -o mended.tm spikes.tm
    python3 - report.json spikes.off <<'END'
import json, sys
report = json.load(open(sys.argv[1]))
before, after = report["before"], report["after"]
assert after["elements"] <= 1.1 * before["elements"]
lines = open(sys.argv[2]).read().split()
n, f = int(lines[1]), int(lines[2])
xyz = [list(map(float, lines[4 + 3 * i:7 + 3 * i])) for i in range(n)]
at, volume = 4 + 3 * n, 0
for _ in range(f):
    k = int(lines[at])
    p = [xyz[int(i)] for i in lines[at + 1:at + 1 + k]]
    at += 1 + k
    for a, b, c in ((p[0], p[i], p[i + 1]) for i in range(1, k - 1)):
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                   + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
assert abs(after["volume"] - volume) <= abs(before["volume"] - volume) + 1e-3 * volume
assert not None in after.values()
END
    # One octant, of which no neighbour is smaller, is eight then: the rest is as it was.
    surface sphere off >sphere.off
    octree-mesh -q -s 3 --resolve 0 -o sphere.tm sphere.off
    octant=$(rows .octant sphere.tm | awk '$2 == 3 && $7 > $6 { print $1 - 1; exit }')
    echo "$octant" >one.ref
    octree-repair -q --method refine -i 1 --octants one.ref -o split.tm sphere.tm || [ $? -eq 1 ]
    [ "$(rows .octant split.tm | awk '$2 == 4' | wc -l)" = 8 ]
}

# A ring N nodes long and M around, whose hole is a point, turned by an angle.
make_horn() {
    awk -v n="$1" -v m="$2" -v turn="$3" 'BEGIN {
        print "OFF"; print n * m, 2 * n * m, 0
        for (i = 0; i < n; i++) for (j = 0; j < m; j++) {
            a = 2 * atan2(0, -1) * i / n + turn; b = 2 * atan2(0, -1) * j / m
            print (1 + cos(b)) * cos(a), (1 + cos(b)) * sin(a), sin(b) }
        for (i = 0; i < n; i++) for (j = 0; j < m; j++) {
            a = i * m; b = (i + 1) % n * m; k = (j + 1) % m
            print 3, a + j, b + j, b + k; print 3, a + j, b + k, a + k } }'
}

@test "where elements were nearly inverted inside they stay valid, and the worst good" {
    for horn in "16 12 0" "20 8 .1" "24 12 .1"; do
        # shellcheck disable=SC2086 # three arguments
        make_horn $horn >horn.off
        octree-mesh -q -s 4 -o horn.tm horn.off
        run octree-repair -q --json report.json -o mended.tm horn.tm
        [ "$status" -le 1 ]
        [ "$(report invalid)" = 0 ]
        awk -v worst="$(report worst)" 'BEGIN { exit worst < 0.2 }'
        jens-stats --quiet --certify mended.tm
    done
}
