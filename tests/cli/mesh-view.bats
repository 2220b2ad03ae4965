# SPDX-License-Identifier: GPL-3.0-or-later
# mesh-view: what is in the page.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers
load view

setup() {
    need_view
    cd "$BATS_TEST_TMPDIR" || exit
}

@test "the page holds nodes, elements, regions, markers and names of the stream" {
    grid 3 >grid.tm
    mesh-view -o page.html grid.tm
    look <<'END'
page, stream = Page('page.html'), Stream('grid.tm')
head = page.header['meshes'][0]
assert head['kinds'] == {'tetrahedra': 162} and head['nodes'] == 64 and head['base'] == 0
assert page.array(head['arrays']['item']) == [v for t in stream.rows('.ele') for v in t[1:5]]
xyz = page.xyz(0)
assert max(abs(a - float(b)) for row, at in zip(stream.rows('.node'), xyz)
           for a, b in zip(at, row[1:4])) < 1e-6
fields = page.fields(0)
assert fields['region'] == [float(t[5]) for t in stream.rows('.ele')]
marked = head['marked'][0]
assert page.array(marked['marker']) == [int(f[4]) for f in stream.rows('.face')]
assert page.array(marked['item']) == [int(v) for f in stream.rows('.face') for v in f[1:4]]
assert sorted(head['names']) == [[2, 5, 'floor'], [3, 1, 'left'], [3, 2, 'right']]
assert head['history'] == ['made by a test']
END
}

@test "edges of the stream, none, one or more, with markers or without" {
    for edges in 0 1 2; do
        for markers in 0 1; do
            {
                printf 'termesh 1\n.node\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n'
                printf '.ele\n1 4 0\n1 1 2 3 4\n.edge\n%d %d\n' "$edges" "$markers"
                [ "$markers" = 1 ] && marker=' 7' || marker=
                printf "1 2 4$marker\n2 3 1$marker\n" | head -n "$edges"
                echo .end
            } >"$edges$markers.tm"
            mesh-view -o "$edges$markers.html" "$edges$markers.tm"
        done
    done
    look <<'END'
for edges in range(3):
    for markers in range(2):
        page = Page('%d%d.html' % (edges, markers))
        arrays = page.header['meshes'][0]['arrays']
        assert ('edge' in arrays) == (edges > 0)
        assert ('edgeMarker' in arrays) == (edges > 0 and markers > 0)
        if 'edge' in arrays:
            assert page.array(arrays['edge']) == [1, 3, 2, 0][:2 * edges]
        if 'edgeMarker' in arrays:
            assert page.array(arrays['edgeMarker']) == [7] * edges
END
}

@test "measures are those of tet-stats and jens-stats, to five digits" {
    many 300 >many.tm
    mesh-view -q many.tm >page.html
    tet-stats -q --list many.tm >list
    jens-stats -q -e many.tm >jens || true
    look <<'END'
fields = Page('page.html').fields(0)
rows = [line.split() for line in open('list')]
assert len(rows) == 300 and len(fields['dihedral']) == 300
for row, dihedral, quality in zip(rows, fields['dihedral'], fields['volume-quality']):
    assert abs(float(row[1]) - dihedral) < 2e-5 * max(1, dihedral)
    assert abs(float(row[3]) - abs(quality)) < 2e-5 # left-handed ones are not turned here
assert min(fields['jens']) < 0 < max(fields['jens'])
END
}

@test "every kind of mesh: how many there are, and what they are coloured by" {
    mixed >mixed.tm
    boxes 2 0.1 >boxes.tm
    surface sphere stream | sed 's/^surface//' >surface.tm
    sed '/^.face/,$d; $!b' surface.tm >points.tm
    echo .end >>points.tm
    for kind in mixed boxes surface points; do mesh-view -o $kind.html $kind.tm; done
    look <<'END'
def check(name, content, kinds, fields):
    head = Page(name).header['meshes'][0]
    assert head['content'] == content and head['kinds'] == kinds, head
    assert [f['key'] for f in head['fields']] == fields, head['fields']
check('mixed.html', 'mixed',
      {'tetrahedra': 1, 'pyramids': 1, 'wedges': 1, 'hexahedra': 1}, ['jens', 'aspect', 'region'])
check('boxes.html', 'polyhedra', {'polyhedra': 8}, ['kernel', 'volume', 'tetrahedra'])
faces = int(Stream('surface.tm').header('.face')[0])
check('surface.html', 'surface', {'triangles': faces}, ['angle'])
check('points.html', 'points', {'points': int(Stream('surface.tm').header('.node')[0])}, [])
page, stream = Page('boxes.html'), Stream('boxes.tm')
arrays = page.header['meshes'][0]['arrays']
rows = stream.rows('.facet')
assert page.array(arrays['facetItem']) == [int(v) for r in rows for v in r[4:]]
sides = page.array(arrays['side'])
for i, r in enumerate(rows):
    given = sorted(int(c) % 2 ** 32 for c in r[1:3])
    assert sorted(sides[2 * i:2 * i + 2]) == given, (r, sides[2 * i:2 * i + 2])
END
}

@test "large coordinates far away keep their digits" {
    grid 2 | awk '/^\./ { block = $1; row = 0 }
        block == ".node" && row++ > 1 { $2 = sprintf("%.17g", 1e9 + $2 / 1024) } { print }' >far.tm
    mesh-view -o page.html far.tm
    look <<'END'
xyz, rows = Page('page.html').xyz(0), Stream('far.tm').rows('.node')
assert max(abs(p[0] - float(r[1])) for p, r in zip(xyz, rows)) < 1e-6
END
}

@test "titles and names with tags, quotes and control characters are text" {
    title=$'</script><script>alert("1")</script> & \x01 \xff'
    grid 1 | sed 's/floor/<\/SCRIPT><b onclick="x">\&"'"'"'/' >'<i>.tm'
    mesh-view --title "$title" -o page.html '<i>.tm'
    look <<'END'
page = Page('page.html')
assert page.header['title'] == '</script><script>alert("1")</script> & \\x01 ÿ', page.header['title']
head = page.header['meshes'][0]
assert head['names'][0][2] == '</SCRIPT><b onclick="x">&"\'', head
inside = page.text[page.text.index('id="header"'):page.text.index('id="array-0"')]
assert inside.lower().count('</script') == 1
assert '<title>\n&#60;/script&#62;' in page.text
END
}

@test "nothing is asked of the network, and the policy of the page forbids it" {
    grid 1 | mesh-view -o page.html
    run -1 grep -nE '<(link|img|iframe|script)[^>]*(src|href)=' page.html
    grep -q "default-src 'none'; script-src 'unsafe-inline'" page.html
}

@test "the same bytes for every number of threads" {
    many 20000 >many.tm
    for threads in 1 2 5; do mesh-view -q -j $threads -o $threads.html many.tm; done
    cmp 1.html 2.html
    cmp 1.html 5.html
}

@test "--most: the boundary and the worst, with a note; --strict refuses" {
    grid 8 0.3 >grid.tm
    run -0 --separate-stderr mesh-view --most 1000 --json report.json -o page.html grid.tm
    [[ "$stderr" =~ ^mesh-view:\ grid.tm:\ [0-9]+\ of\ 3072\ elements,.*\(--most\):\ left\ out$ ]]
    tet-stats -q --list grid.tm >list
    look <<'END'
page, stream = Page('page.html'), Stream('grid.tm')
head = page.header['meshes'][0]
number = page.array(head['arrays']['number'])
assert head['shown'] == len(number) and head['elements'] == 3072
faces = {}
tets = [list(map(int, t[1:5])) for t in stream.rows('.ele')]
for e, t in enumerate(tets):
    for i in range(4):
        faces.setdefault(frozenset(t[:i] + t[i + 1:]), []).append(e)
outside = {e[0] for e in faces.values() if len(e) == 1}
angle = [float(line.split()[1]) for line in open('list')]
worst = set(sorted(range(3072), key=lambda e: angle[e])[:30])
assert set(number) == outside | worst, len(number)
item = page.array(head['arrays']['item'])
assert [item[4 * i:4 * i + 4] for i in range(len(number))] == [tets[e] for e in number]
outer = page.array(head['arrays']['outer'])
assert sum(bin(b).count('1') for b in outer) == sum(len(e) == 1 for e in faces.values())
import json
assert json.load(open('report.json')) == {'meshes': [
    {'nodes': 729, 'elements': 3072, 'shown': len(number)}]}
END
    # All are alike: of the worst hundredth the first.
    grid 8 0 >alike.tm
    mesh-view -q --most 1000 -o alike.html alike.tm
    look <<'END'
page, stream = Page('alike.html'), Stream('alike.tm')
faces = {}
for e, t in enumerate(stream.rows('.ele')):
    for i in range(1, 5):
        faces.setdefault(frozenset(t[1:i] + t[i + 1:5]), []).append(e)
outside = {e[0] for e in faces.values() if len(e) == 1}
number = page.array(page.header['meshes'][0]['arrays']['number'])
assert set(number) == outside | set(range(30)), len(number)
END
    run -3 --separate-stderr mesh-view --strict --most 1000 -o none.html grid.tm
    [ ! -e none.html ]
    run -0 --separate-stderr mesh-view --strict --most 3072 -o page.html grid.tm
    [ "$stderr" = "" ]
    boxes 5 >boxes.tm
    mesh-view -q --most 100 -o page.html boxes.tm
    look <<'END'
page = Page('page.html')
head = page.header['meshes'][0]
assert head['elements'] == 125 and 98 <= head['shown'] < 125
assert 2 ** 32 - 2 in page.array(head['arrays']['side'])
END
}

@test "two meshes; of one of them standard input" {
    grid 2 >a.tm
    boxes 2 >b.tm
    mesh-view a.tm b.tm >both.html
    mesh-view a.tm - <b.tm >standard.html
    look <<'END'
both = Page('both.html').header['meshes']
assert [m['content'] for m in both] == ['tetrahedra', 'polyhedra']
assert [m['name'] for m in both] == ['a.tm', 'b.tm']
assert [m['name'] for m in Page('standard.html').header['meshes']] == ['a.tm', 'standard input']
END
    # of a pipe the name is what made it
    lepp-improve -q a.tm | mesh-view -o pipe.html
    look <<'END'
page = Page('pipe.html')
assert page.header['title'] == page.header['meshes'][0]['name']
assert page.header['title'].startswith('lepp-improve ') and ': ' not in page.header['title']
END
}

@test "wrong command lines and wrong input" {
    grid 1 >grid.tm
    run -2 --separate-stderr mesh-view grid.tm grid.tm grid.tm
    [[ "$stderr" == *"two files at most, but there is also 'grid.tm'"* ]]
    run -2 --separate-stderr mesh-view - - <grid.tm
    [[ "$stderr" == *'only one of the two files can be standard input'* ]]
    run -2 mesh-view --most -1 grid.tm
    run -2 mesh-view --most many grid.tm
    sed '$d' grid.tm >cut.tm
    run -3 --separate-stderr mesh-view -o none.html grid.tm cut.tm
    [[ "$stderr" == 'mesh-view: cut.tm:'* ]]
    [ ! -e none.html ]
    printf 'termesh 1\n.end\n' >nothing.tm
    run -3 --separate-stderr mesh-view nothing.tm
    [ "$output" = "" ]
    [[ "$stderr" == 'mesh-view: nothing.tm: holds nothing, but mesh-view takes points'* ]]
}

@test "a mesh of nodes with a block without elements, flat ones, and nodes named twice" {
    grid 1 | awk '/^\./ { block = $1; row = 0 }
        { row++ } block == ".ele" && row == 2 { $1 = 0 } block == ".ele" && row > 2 { next }
        { print }' >none.tm
    grid 1 | awk '/^\./ { block = $1; row = 0 }
        { row++ } block == ".ele" && row == 3 { $4 = $3 } block == ".node" && row > 2 { $4 = 0 }
        { print }' >flat.tm
    for mesh in none flat; do mesh-view -q -o $mesh.html $mesh.tm; done
    look <<'END'
assert Page('none.html').header['meshes'][0]['content'] == 'surface'
flat = Page('flat.html')
assert flat.header['meshes'][0]['kinds'] == {'tetrahedra': 6}
assert max(abs(q) for q in flat.fields(0)['volume-quality']) == 0
END
    printf 'termesh 1\n.node\n0 3 0 0\n.ele\n0 4 0\n.end\n' >empty.tm
    run -3 mesh-view empty.tm
}

@test "without three.js it is left out, and that is said" {
    run -0 --separate-stderr make -n -C "$root" BUILD="$PWD/build" THREE=/nonexistent all
    [[ "$output" != *"bin/mesh-view"* ]]
    [[ "$output" == *"There is no /nonexistent: mesh-view is left out."* ]]
    [[ "$output" == *"bin/mesh-check"* ]]
}
