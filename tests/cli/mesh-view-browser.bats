# SPDX-License-Identifier: GPL-3.0-or-later
# mesh-view: what a browser makes of the page. Chromium draws by software here.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers
load view

setup() {
    need_browser
    cd "$BATS_TEST_TMPDIR" || exit
}

@test "every kind is shown, without an error, with the counts of the stream" {
    grid 3 0.2 >tets.tm
    mixed >mixed.tm
    boxes 3 0.2 >boxes.tm
    surface sphere stream | sed 's/^surface//' >surface.tm
    sed '/^.face/,$d' surface.tm >points.tm
    echo .end >>points.tm
    many 2000 >wrong.tm # of which many share a face
    grid 8 >many.tm
    for mesh in tets mixed boxes surface points wrong; do mesh-view -q -o $mesh.html $mesh.tm; done
    mesh-view -q --most 100 -o part.html many.tm
    look <<'END'
with Browser() as browser:
    def check(name, counts, triangles):
        browser.open(name + '.html')
        assert browser.run('document.getElementById("counts").textContent') == counts
        assert browser.run('document.getElementById("message").textContent') == ''
        drawn = browser.run('meshView.view.meshes[0].solid.count / 3')
        assert triangles in (None, drawn), (name, drawn)
        # in the middle of the picture there is something
        at = browser.run('(() => { const [x, y] = meshView.pixelsOf(0, 0); '
                         'return meshView.elementAt(x, y).element })()')
        assert at >= 0, (name, at)
        # all colours
        for key in browser.run('[...meshView.view.fields.keys()]'):
            browser.run(f'meshView.setField("{key}"), meshView.update()')
    space = '\u202f'
    check('tets', '162 tetrahedra, 64 nodes', 6 * 9 * 2)
    check('mixed', '1 tetrahedron, 1 pyramid, 1 wedge, 1 hexahedron, 12 nodes', None)
    check('boxes', '27 polyhedra, 64 nodes', 6 * 9 * 2)
    check('surface', '360 triangles, 182 nodes', 360)
    check('points', '182 points', None)
    check('wrong', f'2{space}000 tetrahedra, 3{space}000 nodes', None)
    browser.open('part.html')
    head = Page('part.html').header['meshes'][0]
    assert f'this page holds {head["shown"]}' in browser.run('document.getElementById("note").textContent')
    assert browser.run('meshView.view.meshes[0].ghost.count') == 0
    browser.run('meshView.setCut("whole"), meshView.setOffset(-9), meshView.update()')
    assert browser.run('meshView.view.meshes[0].ghost.count / 3') == 6 * 64 * 2
    assert browser.errors == [] and browser.requests == [], (browser.errors, browser.requests)
END
}

@test "cuts, layers and selections show the elements that they should" {
    grid 6 0.25 >grid.tm
    mesh-view -q -o grid.html grid.tm
    tet-stats -q --list grid.tm >list
    look <<'END'
stream, head = Stream('grid.tm'), Page('grid.html').header
xyz = [[float(x) for x in row[1:4]] for row in stream.rows('.node')]
tets = [row[1:5] for row in stream.rows('.ele')]
centre = [[sum(xyz[v][a] for v in t) / 4 for a in range(3)] for t in tets]
angle = [float(line.split()[1]) for line in open('list')]

def facesof(elements):
    """The faces between these and all others."""
    count = {}
    for e in elements:
        for i in range(4):
            f = frozenset(tets[e][:i] + tets[e][i + 1:])
            count[f] = count.get(f, 0) + 1
    return [f for f, n in count.items() if n == 1]

with Browser() as browser:
    browser.open('grid.html')

    def same(elements, what):
        browser.run('meshView.update()')
        shown = browser.run('meshView.shown(0)')
        assert shown == sorted(elements), (what, len(shown), len(elements))
        drawn = browser.run('meshView.view.meshes[0].solid.count / 3')
        assert drawn == len(facesof(elements)), (what, drawn)

    same(range(len(tets)), 'all')
    # a plane through the middle, turned
    normal, offset = [0.6, 0.48, 0.64], 0.0123
    browser.run(f'meshView.setCut("whole"), meshView.setNormal({normal}), meshView.setOffset({offset})')
    below = [e for e, c in enumerate(centre) if sum(
        n * (x - o) / head['scale'] for n, x, o in zip(normal, c, head['centre'])) <= offset]
    assert 300 < len(below) < 1000
    same(below, 'cut')
    # the worst of them, by number and by range
    browser.run('meshView.setCut("none"), meshView.selectWorst(100)')
    same(sorted(range(len(tets)), key=lambda e: angle[e])[:100], 'worst 100')
    low, high = sorted(angle)[200] + 1e-3, sorted(angle)[400] + 1e-3
    browser.run(f'meshView.select({low}, {high})')
    clear = [a for a in angle if min(abs(a - low), abs(a - high)) > 1e-3]
    assert len(clear) >= len(angle) - 10
    shown = browser.run('(meshView.update(), meshView.shown(0))')
    for e, a in enumerate(angle):
        if min(abs(a - low), abs(a - high)) > 1e-3:
            assert (e in shown) == (low <= a <= high), (e, a)
    # dragged over
    browser.run('meshView.selectAll()')
    box = browser.run('(r => [r.left, r.top, r.width, r.height])'
                      '(document.getElementById("histogram").getBoundingClientRect())')
    y = box[1] + box[3] / 2
    browser.drag([(box[0] + 1, y), (box[0] + 20, y), (box[0] + box[2] * 0.3, y)])
    low, high = browser.run('meshView.state.select')
    least, most = min(angle), max(angle)
    assert abs(low - least) < 0.01 * most and abs(high - least - 0.3 * (most - least)) < 0.02 * most
    shown = browser.run('(meshView.update(), meshView.shown(0))')
    assert set(shown) ^ {e for e, a in enumerate(angle) if low <= a <= high} <= {
        e for e, a in enumerate(angle) if min(abs(a - low), abs(a - high)) < 1e-3}
    # layers: those of the first one have a face on the boundary
    outside = {e for e in range(len(tets)) for f in [None] if any(
        all(xyz[v][a] == w for v in tets[e][:i] + tets[e][i + 1:])
        for i in range(4) for a in range(3) for w in (0, 6))}
    browser.run('meshView.selectAll(), meshView.set({peel: 1})')
    same(set(range(len(tets))) - outside, 'peel')
    # a category switched off
    browser.run('meshView.set({peel: 0}), meshView.setField("region")')
    browser.run('document.querySelectorAll("#categories input")[1].click()')
    same([e for e, t in enumerate(stream.rows('.ele')) if t[5] == 1], 'region')
    # the plain section: as large as the cube's, and of the elements that it meets
    browser.run('meshView.setField("plain"), meshView.setCut("plain"), meshView.setNormal([0, 0, 1]), '
                'meshView.setOffset(0.01), meshView.update()')
    z = head['centre'][2] + 0.01 * head['scale']
    met = {e for e, t in enumerate(tets) if min(xyz[v][2] for v in t) < z < max(xyz[v][2] for v in t)}
    assert set(browser.run('meshView.view.meshes[0].cap.elementOf')) == met
    area = browser.run('''(() => {
        const {position: p, count} = meshView.view.meshes[0].cap;
        let area = 0;
        for (let i = 0; i < 3 * count; i += 9)
            area += Math.abs((p[i + 3] - p[i]) * (p[i + 7] - p[i + 1]) -
                             (p[i + 6] - p[i]) * (p[i + 4] - p[i + 1])) / 2;
        return area })()''')
    assert abs(area * head['scale'] ** 2 - 36) < 1e-3, area
    # pulled apart: all faces of all elements
    browser.run('meshView.setCut("none"), meshView.setExplode(0.5), meshView.update()')
    assert browser.run('meshView.view.meshes[0].solid.count / 3') == 4 * len(tets)
    assert browser.errors == [] and browser.requests == [], browser.errors
END
}

@test "sections of polyhedra that are not convex" {
    # an L of three cubes' cross section, one high
    cat >l.tm <<'END'
termesh 1
.node
12 3 0 0
0 0 0 0
1 2 0 0
2 2 1 0
3 1 1 0
4 1 2 0
5 0 2 0
6 0 0 1
7 2 0 1
8 2 1 1
9 1 1 1
10 1 2 1
11 0 2 1
.facet
8 0
0 0 -1 6 5 4 3 2 1 0
1 0 -1 6 6 7 8 9 10 11
2 0 -1 4 0 1 7 6
3 0 -1 4 1 2 8 7
4 0 -1 4 2 3 9 8
5 0 -1 4 3 4 10 9
6 0 -1 4 4 5 11 10
7 0 -1 4 5 0 6 11
.cell
1 0
0 8 0 1 2 3 4 5 6 7
.end
END
    mesh-view -q -o l.html l.tm
    look <<'END'
AREA = '''(t => { let area = 0; const p = t.position;
    for (let i = 0; i < 3 * t.count; i += 9) {
        const u = [0, 1, 2].map(a => p[i + 3 + a] - p[i + a]);
        const v = [0, 1, 2].map(a => p[i + 6 + a] - p[i + a]);
        area += Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                           u[0] * v[1] - u[1] * v[0]) / 2;
    } return area })'''
with Browser() as browser:
    browser.open('l.html')
    scale = Page('l.html').header['scale'] ** 2
    def area(what):
        return browser.run(f'{AREA}(meshView.view.meshes[0].{what})') * scale
    assert abs(area('solid') - (3 + 3 + 8)) < 1e-5, area('solid')
    browser.run('meshView.setCut("plain"), meshView.setNormal([0, 0, 1]), meshView.setOffset(0.1), meshView.update()')
    assert abs(area('cap') - 3) < 1e-5, area('cap')
    # across both arms: two polygons of one element
    browser.run('meshView.setNormal([1, 1, 0]), meshView.setOffset(0.3), meshView.update()')
    assert browser.run('new Set(meshView.view.meshes[0].cap.elementOf).size') == 1
    # x + y = c from (2, c - 2) to (1, c - 1), and as long on the other arm
    c = 2 + 0.3 * 2 ** 0.5
    expected = 2 * (3 - c if c > 2 else c / 2) * 2 ** 0.5
    assert abs(area('cap') - expected) < 1e-5, (area('cap'), expected)
    assert browser.errors == [], browser.errors
END
}

@test "picking, hiding, the keyboard, links" {
    grid 3 0.2 | awk '/^\./ { block = $1; row = 0 } { row++ }
        block != ".group" && row > 2 { # numbered from 1
            $1++
            for (i = 2; block == ".ele" && i < 6 || block == ".face" && i < 5; i++) $i++ }
        block == ".group" && row > 2 { $1++ } { print }' >grid.tm
    mesh-view -q -o grid.html grid.tm
    tet-stats -q --list grid.tm | sort -k 2,2g | head -n 1 >worst
    look <<'END'
import time
number, angle = open('worst').read().split()[:2]
text = 'document.getElementById("words").textContent'
with Browser() as browser:
    browser.open('grid.html')
    browser.run('meshView.selectWorst(1), meshView.update()')
    assert browser.run('meshView.shown(0)') == [int(number)]
    x, y = browser.run(f'meshView.pixelsOf(0, {int(number) - 1})')
    browser.click(x, y)
    words = browser.run('[...document.querySelectorAll("#words tr")].map(r => '
                        '[...r.children].map(c => c.textContent))')
    words = {row[0]: row[1] for row in words}
    assert words['tetrahedron'] == number, words
    assert abs(float(words['smallest dihedral angle'].rstrip('°')) - float(angle)) < 2e-3
    row = Stream('grid.tm').rows('.ele')[int(number) - 1]
    assert row[0] == int(number)
    nodes = {row[0]: row for row in Stream('grid.tm').rows('.node')}
    for v in row[1:5]:
        there = [float(c) for c in words[f'node {v}'].split()]
        assert max(abs(a - float(b)) for a, b in zip(there, nodes[v][1:4])) < 1e-4
    shared = [t[0] for t in Stream('grid.tm').rows('.ele')
              if t[0] != row[0] and len(set(t[1:5]) & set(row[1:5])) == 3]
    assert sorted(map(int, words['neighbours'].split())) == shared
    names = {1: '1 left', 2: '2 right'}
    assert words['region'] == names[row[5]]
    browser.key('h')
    assert browser.run('(meshView.update(), meshView.shown(0))') == []
    browser.key('u')
    assert browser.run('(meshView.update(), meshView.shown(0))') == [int(number)]
    browser.click(5, 5)
    assert browser.run('document.getElementById("picked").hidden')
    browser.key('a')
    # keys, the sheet
    browser.key('?')
    assert browser.run('document.getElementById("sheet").open')
    browser.run('document.querySelector("#sheet button").click()')
    browser.key('c')
    browser.key(']')
    browser.key('Z')
    assert browser.run('meshView.state.cut') == 'whole'
    assert browser.run('meshView.state.offset') > 0
    # the wheel keeps what is under the pointer
    where = '(() => { const {camera} = meshView.state; return camera.distance })()'
    far = browser.run(where)
    before = browser.run('meshView.pixelsOf(0, 7)')
    browser.mouse('mouseWheel', *before, deltaX=0, deltaY=-200)
    browser.run('new Promise(r => requestAnimationFrame(r))')
    assert browser.run(where) < far
    after = browser.run('meshView.pixelsOf(0, 7)')
    assert max(abs(a - b) for a, b in zip(before, after)) < 60, (before, after)
    # dragged: turned; with Shift: the plane
    turn, offset = browser.run('[meshView.state.camera.turn, meshView.state.offset]')
    browser.drag([(300, 300), (340, 310), (380, 330)])
    assert browser.run('meshView.state.camera.turn') != turn
    browser.drag([(300, 300), (340, 250), (380, 200)], modifiers=8)
    assert browser.run('meshView.state.offset') != offset
    # a link shows the same
    browser.run('meshView.setField("jens"), meshView.select(0.2, 0.5), meshView.set({explode: 0.25, edges: false})')
    time.sleep(0.5)
    shown, link = browser.run('(meshView.update(), [meshView.shown(0), location.hash])')
    camera = browser.run('meshView.state.camera')
    assert link.startswith('#f=jens&')
    browser.open('grid.html', '#')
    browser.call('Page.navigate', url='about:blank')
    browser.open('grid.html', link)
    assert browser.run('meshView.shown(0)') == shown
    again = browser.run('meshView.state.camera')
    assert all(abs(again[k] - camera[k]) < 1e-4 for k in ('turn', 'lift', 'distance'))
    assert browser.run('[meshView.state.edges, meshView.state.explode]') == [False, 0.25]
    # and a wrong one does no harm
    browser.call('Page.navigate', url='about:blank')
    browser.open('grid.html', '#f=no&r=1&s=a,b&k=whole,0,0,0,0&c=1,2&p=x&%&v=both&m=%E0')
    assert len(browser.run('meshView.shown(0)')) == 162
    assert browser.errors == [] and browser.requests == [], browser.errors
END
}

@test "marked edges: lines with the names of their markers, cut with the mesh" {
    { grid 2 0 | sed '/^.group/,$d'; printf '%s\n' .edge '3 1' '0 1 2 5' '1 2 3 5' '2 1 4 -3' .group \
        '1 0' '0 1 5 <ridge>' .end; } >edges.tm
    mesh-view -o edges.html edges.tm
    { grid 2 0 | sed '$d'; printf '%s\n' .edge '1 1' '0 1 2 1' .end; } >one.tm
    mesh-view -o one.html one.tm
    look <<'END'
LINES = '(o => [o.visible, o.geometry.attributes.position.count])(meshView.view.meshes[0].lines.object)'
NAMES = '[...document.querySelectorAll("#lineNames li")].map(e => e.textContent)'
with Browser() as browser:
    browser.open('edges.html')
    assert browser.run('meshView.update(), ' + LINES) == [True, 6]
    assert browser.run(NAMES) == ['-31', '5 <ridge>2']
    browser.key('m')
    assert browser.run('meshView.update(), ' + LINES) == [False, 6]
    assert 'l=0' in browser.run('meshView.hashOfState()')
    browser.run('meshView.set({lines: true}), meshView.setCut("whole"), meshView.setNormal([1, 0, 0]), meshView.setOffset(-0.5)')
    assert browser.run('meshView.update(), (p => [p.normal.x, p.constant])(meshView.view.meshes[0].lines.plane)') == [-1, -0.5]
    # those that TetGen gives to all are there, but not at first
    browser.open('one.html')
    assert browser.run('meshView.update(), ' + LINES) == [False, 2]
    assert browser.run('document.getElementById("lining").hidden') == False
    assert not browser.errors and not browser.requests
END
}

@test "two meshes, both themes, a narrow window, labels, text that is text" {
    grid 3 0.2 >a.tm
    boxes 3 >'<b>&.tm'
    mesh-view -q --title '<script>x</script> "two"' -o two.html a.tm '<b>&.tm'
    look <<'END'
PIXEL = '''(() => { meshView.update(); const gl = document.getElementById("canvas").getContext("webgl2");
    const p = new Uint8Array(4); gl.readPixels(2, 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, p); return [...p] })()'''
with Browser() as browser:
    browser.open('two.html')
    assert browser.run('document.title') == '<script>x</script> "two"'
    assert browser.run('document.getElementById("title").textContent') == '<script>x</script> "two"'
    assert browser.run('[...document.querySelectorAll("#labels span")].map(s => s.textContent)') == ['a.tm', '<b>&.tm']
    assert browser.run('document.querySelectorAll("main b").length') == 0
    assert browser.run('meshView.state.show') == 'both'
    # what the second mesh has not is said
    LACKING = '(e => e.hidden ? "" : e.textContent)(document.getElementById("lacking"))'
    browser.run('meshView.setField("dihedral")')
    assert browser.run(LACKING) == '<b>&.tm has no smallest dihedral angle: it has the colours of outside and inside.'
    browser.run('meshView.setField("plain")')
    assert browser.run(LACKING) == ''
    browser.run('meshView.setCut("whole"), meshView.setNormal([0, 0, 1]), meshView.setOffset(-0.5), meshView.update()')
    assert len(browser.run('meshView.shown(0)')) == 54 and len(browser.run('meshView.shown(1)')) == 9
    left, right = (browser.run(f'meshView.pixelsOf({i}, 0)') for i in range(2))
    assert left[0] < right[0]
    browser.key('b')
    assert browser.run('meshView.state.show') == 'b'
    assert browser.run('(meshView.update(), document.getElementById("canvas").dataset.shown)') == '9'
    browser.run('meshView.set({show: "both"})')
    light = browser.run(PIXEL)
    browser.theme(True)
    dark = browser.run(PIXEL)
    assert sum(light[:3]) > 600 and sum(dark[:3]) < 200, (light, dark)
    browser.resize((390, 844))
    browser.run('new Promise(r => setTimeout(r, 100))')
    assert browser.run('document.documentElement.scrollWidth') <= 390
    box = browser.run('(r => [r.left, r.top, r.width, r.height])(document.getElementById("canvas").getBoundingClientRect())')
    assert box[2] == 390 and box[3] > 300, box
    inside = browser.run('''[...document.querySelectorAll("#panel button, #panel select, #panel input")]
        .filter(e => e.offsetParent).every(e => { const r = e.getBoundingClientRect();
                                                  return r.left >= 0 && r.right <= 390 })''')
    assert inside
    # one finger turns, two zoom, a tap picks
    browser.call('Emulation.setTouchEmulationEnabled', enabled=True, maxTouchPoints=2)
    browser.run('meshView.set({show: "a"}), meshView.setCut("none"), meshView.update()')
    def touch(kind, *points):
        browser.call('Input.dispatchTouchEvent', type=kind, touchPoints=[
            {'x': x, 'y': y, 'id': i} for i, (x, y) in enumerate(points)])
    turn, distance = browser.run('[meshView.state.camera.turn, meshView.state.camera.distance]')
    touch('touchStart', (200, 200))
    touch('touchMove', (240, 210))
    touch('touchMove', (260, 210))
    touch('touchEnd')
    assert browser.run('meshView.state.camera.turn') < turn
    assert browser.run('meshView.state.camera.distance') == distance
    touch('touchStart', (150, 200))
    touch('touchStart', (150, 200), (250, 200))
    touch('touchMove', (130, 200), (270, 200))
    touch('touchMove', (100, 200), (300, 200))
    touch('touchEnd')
    assert abs(browser.run('meshView.state.camera.distance') - distance / 2) < 0.2 * distance
    assert browser.run('meshView.view.meshes[0].picked') == -1
    touch('touchStart', tuple(round(x) for x in browser.run('meshView.pixelsOf(0, 0)')))
    touch('touchEnd')
    assert browser.run('meshView.view.meshes[0].picked') >= 0
    browser.run('document.getElementById("fold").click()')
    browser.run('new Promise(r => setTimeout(r, 100))')
    assert browser.run('document.getElementById("canvas").clientHeight') > box[3] + 100
    nameless = browser.run('''[...document.querySelectorAll("button, select, input, canvas")].filter(e =>
        !(e.getAttribute("aria-label") || e.textContent.trim() && e.tagName === "BUTTON" ||
          e.labels && e.labels.length && e.labels[0].textContent.trim())).map(e => e.id)''')
    assert nameless == [], nameless
    assert browser.errors == [] and browser.requests == [], browser.errors
END
}
