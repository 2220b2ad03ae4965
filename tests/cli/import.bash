# SPDX-License-Identifier: GPL-3.0-or-later
# What the tests of importers need: meshes of every kind with all that a stream carries,
# and whether two streams are the same mesh.
# shellcheck shell=bash

# Prints a stream of N^3 boxes: meshes KIND [N]. KIND is tetrahedra (six of each box), mixed
# (hexahedra, wedges, pyramids and tetrahedra), hexahedra, surface or points. Nodes inside
# are moved, and all coordinates need 17 digits. There are two regions, and attributes 2
# and 3 of elements; two attributes and markers of nodes; markers of faces (of the boundary,
# and between the regions) and of edges; names of all.
meshes() {
    python3 - "$@" <<'END'
import random, sys
kind, n = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 3
random.seed(n)
m = n + 1
xyz = []
for k in range(m):
    for j in range(m):
        for i in range(m):
            move = .2 if all(0 < a < n for a in (i, j, k)) else 0
            xyz.append([(a + random.uniform(-move, move)) / 3 + 1e-7 / 3 for a in (i, j, k)])

def node(i, j, k):
    return i + m * (j + m * k)

def box(i, j, k):
    return [node(i + a, j + b, k + c) for a, b, c in
            ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]

faces_of = {4: [(0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)],
            5: [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
            6: [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
            8: [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)]}
tets = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
elements, region = [], []
for k in range(n):
    for j in range(n):
        for i in range(n):
            v, r = box(i, j, k), 7 if 2 * i < n else -3
            which = 0 if kind in ('tetrahedra', 'surface', 'points') else 1
            if kind == 'mixed':
                which = (i + j + k) % 4
            if which == 0:
                new = [[v[a] for a in t] for t in tets]
            elif which == 1:
                new = [v]
            elif which == 2:
                new = [[v[a] for a in w] for w in ((0, 2, 1, 4, 6, 5), (0, 3, 2, 4, 7, 6))]
            else:
                centre = len(xyz)
                xyz.append([sum(xyz[a][d] for a in v) / 8 for d in range(3)])
                new = [[v[a] for a in reversed(f)] + [centre] for f in faces_of[8]]
            elements += new
            region += [r] * len(new)
seen = {}
for e, v in enumerate(elements):
    for f in faces_of[len(v)]:
        nodes = [v[a] for a in f]
        seen.setdefault(frozenset(nodes), []).append((e, nodes))

def marker(nodes):
    p = [sum(xyz[v][d] for v in nodes) / len(nodes) for d in range(3)]
    if p[2] < 1e-6:
        return 11
    return 12 if p[2] > n / 3 else -4 if p[0] < 1e-6 else 0

rows = []
for sides in seen.values():
    inside = len(sides) == 2
    mark = 20 if inside else marker(sides[0][1])
    if inside and region[sides[0][0]] == region[sides[1][0]]:
        continue
    if kind != 'mixed' or len(sides) < 3:
        rows.append((sides[0][0], sides[1][0] if inside else -1, sides[0][1], mark))
out = ['termesh 1', '.node']
attributes = 2
used = sorted({v for _, _, f, _ in rows for v in f}) if kind == 'surface' else range(len(xyz))
number = {v: i for i, v in enumerate(used)}
out.append('%d 3 %d 1' % (len(used), attributes))
for v in used:
    out.append(' '.join(map(repr, [number[v]] + xyz[v] + [random.random(), v / 7, v % 5 - 1])))
if kind == 'tetrahedra':
    out += ['.ele', '%d 4 3' % len(elements)]
    for e, v in enumerate(elements):
        out.append('%d %s %d %r %d' % (e, ' '.join(map(str, v)), region[e], random.gauss(0, 1), e))
elif kind in ('mixed', 'hexahedra'):
    out += ['.mix', '%d 3' % len(elements)]
    for e, v in enumerate(elements):
        out.append('%d %d %s %d %r %d' % (e, len(v), ' '.join(map(str, v)), region[e],
                                          random.gauss(0, 1), e))
if kind in ('tetrahedra', 'surface'):
    out += ['.face', '%d 1' % len(rows)]
    for i, (_, _, f, mark) in enumerate(rows):
        out.append('%d %s %d' % (i, ' '.join(str(number[v]) for v in f), mark))
elif kind != 'points':
    out += ['.facet', '%d 1' % len(rows)]
    for i, (e, other, f, mark) in enumerate(rows):
        out.append('%d %d %d %d %s %d' % (i, e, other, len(f), ' '.join(map(str, f)), mark))
if kind != 'points':
    out += ['.edge', '2 1', '0 0 1 31', '1 1 2 32']
out += ['.group', '5 0', '0 0 3 spots of interest', '1 1 31 kante äußere', '2 2 11 inlet 100%',
        '3 2 20 "wall"', '4 3 7 solid']
print('\n'.join(out + ['.end']))
END
}

# Copies a stream of meshes() without what most formats have no place for: attributes of
# elements behind the region, and those of nodes, unless: without_attributes [elements].
without_attributes() {
    awk -v nodes="${1:-all}" '/^\./ { block = $1; print; if ((getline) <= 0) exit
            if (block == ".ele") $3 = 1
            if (block == ".mix") $2 = 1
            if (block == ".node" && nodes == "all") $3 = 0
            print; next }
        block == ".ele" { print $1, $2, $3, $4, $5, $6; next }
        block == ".mix" { NF = 3 + $2 }
        block == ".node" && nodes == "all" { print $1, $2, $3, $4, $7; next }
        { print }'
}

# Prints a stream of polyhedra of many facets, with regions, markers and names.
dual() {
    meshes tetrahedra | awk '/^\.ele/ { ele = 1 } /^\.face/ { ele = 0 }
        ele && $1 == "162" { $3 = 1 } ele && NF == 8 { NF = 6 } 1' | poly-dual -q
}

# same_mesh A B: whether two streams are the same mesh, however facets are numbered: the same
# nodes, elements, regions, markers, attributes and names, bit for bit and in the same
# order. Rows of .face, .facet and .edge without a marker are not looked at, nor is what is
# an option: --no-names, --no-attributes, --no-markers. With --rounded reals are compared to
# eleven digits.
same_mesh() {
    python3 - "$@" <<'END'
import sys

def blocks(path):
    lines = iter(open(path, encoding='utf-8').read().splitlines())
    found, name = {}, None
    for line in lines:
        if line.startswith(('.', 'surface.')):
            name = line
            if name != '.end':
                found[name] = (next(lines).split(), [])
        elif name and line and not line.startswith('#'):
            found[name][1].append(line.split(None, 3) if name == '.group' else line.split())
    return found

def cycle(nodes):
    at = nodes.index(min(nodes))
    return tuple(nodes[at:] + nodes[:at])

def mesh(path):
    b = blocks(path)
    base = int(b['.node'][1][0][0]) if b['.node'][1] else 0
    ids = lambda row: [int(x) - base for x in row]
    m = {}
    attributes = int(b['.node'][0][2])
    m['nodes'] = [tuple(map(float, r[1:4])) for r in b['.node'][1]]
    if not skip & {'--no-attributes'}:
        m['node attributes'] = [tuple(map(float, r[4:4 + attributes])) for r in b['.node'][1]]
    marks = int(b['.node'][0][3])
    m['node markers'] = [int(r[4 + attributes]) if marks else 0 for r in b['.node'][1]]
    for name, k in (('.ele', 4), ('.mix', 0), ('.cell', 0)):
        if name not in b:
            continue
        rows = []
        for r in b[name][1]:
            first = 1 if k else 2
            nodes = k or int(r[1])
            rows.append((ids(r[first:first + nodes]), tuple(map(float, r[first + nodes:]))))
        m[name + ' attributes'] = [a for _, a in rows]
        m[name] = [v for v, _ in rows]
    marked = lambda name: int(b[name][0][1])
    for name, k in (('.face', 3), ('.edge', 2)):
        if name in b:
            m[name] = [(ids(r[1:1 + k]), int(r[1 + k])) for r in b[name][1]
                       if marked(name) and int(r[1 + k]) != 0]
            if name == '.face' and '.ele' not in b:
                m['surface'] = [ids(r[1:1 + k]) for r in b[name][1]]
            if not m[name]:
                del m[name]
    if '.facet' in b:
        facets = []
        for r in b['.facet'][1]:
            k = int(r[3])
            side = [int(c) - base if int(c) != -1 else -1 for c in r[1:3]]
            facets.append((side, ids(r[4:4 + k]), int(r[4 + k]) if marked('.facet') else 0))
        if '.cell' in b:
            def seen(f, c):
                side, nodes, _ = facets[f]
                return cycle(nodes if side[0] == c else nodes[::-1])
            m['.cell'] = [sorted(seen(f, c) for f in fs) for c, fs in enumerate(m['.cell'])]
            m['facet markers'] = sorted(tuple(sorted(f[1])) + (f[2],) for f in facets
                                        if f[2] != 0)
        else:
            m['.facet'] = [(side, cycle(nodes), mark) for side, nodes, mark in facets if mark]
    if '.group' in b and not skip & {'--no-names'}:
        m['.group'] = [r[1:] for r in b['.group'][1]]
    if skip & {'--no-attributes'}:
        m = {k: v for k, v in m.items() if 'attributes' not in k}
    if skip & {'--no-markers'}:
        m = {k: v for k, v in m.items() if k not in ('.face', '.facet', '.edge', 'facet markers')}
    return m

skip = set(sys.argv[3:])
if '--rounded' in skip:
    exact, float = float, lambda text: exact('%.11g' % exact(text))
a, b = mesh(sys.argv[1]), mesh(sys.argv[2])
for key in sorted(set(a) | set(b)):
    if a.get(key) != b.get(key):
        x, y = a.get(key), b.get(key)
        at = next((i for i, (p, q) in enumerate(zip(x or [], y or [])) if p != q), 'end')
        print('%s differ: %s and %s, at %s' % (key, x and len(x), y and len(y), at))
        if x and y and at != 'end':
            print(x[at], y[at])
        sys.exit(1)
assert a['nodes']
END
}

# Writes a .vtu file by VTK in all its forms as FOLDER/….vtu: vtk_forms FILE FOLDER.
vtk_forms() {
    "${vtk_python:?}" - "$@" <<'END'
import sys, vtk
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
for mode in ('Ascii', 'Binary', 'Appended', 'AppendedBase64'):
    for compressor in ('None', 'ZLib'):
        for bits in ('32', '64'):
            for order in ('Little', 'Big'):
                w = vtk.vtkXMLUnstructuredGridWriter()
                w.SetInputData(reader.GetOutput())
                getattr(w, 'SetDataModeTo' + mode.replace('Base64', ''))()
                w.SetEncodeAppendedData(mode == 'AppendedBase64')
                getattr(w, 'SetCompressorTypeTo' + compressor)()
                getattr(w, 'SetHeaderTypeToUInt' + bits)()
                getattr(w, 'SetByteOrderTo%sEndian' % order)()
                w.SetBlockSize(800)
                w.SetFileName('%s/%s-%s-%s-%s.vtu' % (sys.argv[2], mode, compressor, bits, order))
                assert w.Write()
END
}

# damage FILTER FILE [CHANGES [WHOLE]]: cuts a file at 200 places and changes bytes of it in
# CHANGES (200) copies. What is cut must be refused, exit 3, with one line and no output, or
# may be read if it is cut behind the word WHOLE; what is changed refused or read; never a signal, more than 20 seconds, or more memory than 20
# times the file and what the filter takes at all.
damage() {
    python3 - "$@" <<'END'
import os, random, resource, subprocess, sys
tool, path = sys.argv[1:3]
changes = int(sys.argv[3]) if len(sys.argv) > 3 else 200
data = open(path, 'rb').read()
random.seed(len(data))
limit = None if '/san' in os.environ.get('TM_BUILD', '') else 20 * len(data) + (96 << 20)

def bound():
    if limit:
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

def run(bytes, allowed, what):
    with open('damaged', 'wb') as f:
        f.write(bytes)
    p = subprocess.run([tool, '-q', '--no-history', 'damaged'], stdout=subprocess.PIPE,
                       stderr=subprocess.PIPE, timeout=20, preexec_fn=bound)
    if p.returncode not in allowed or (p.returncode == 3 and (
            p.stdout or not p.stderr.startswith(tool.encode() + b': damaged') or
            p.stderr.count(b'\n') != 1)):
        sys.exit('%s: exit %d, %r' % (what, p.returncode, p.stderr))

end = len(data.rstrip()) - 1
whole = data.index(sys.argv[4].encode()) if len(sys.argv) > 4 else end
for at in sorted(random.sample(range(end), min(200, end))):
    run(data[:at], [3] if at < whole else [0, 3], 'cut at %d' % at)
for i in range(changes):
    changed = bytearray(data)
    for _ in range(random.randint(1, 4)):
        at = random.randrange(len(data))
        if random.random() < .5:
            at = random.randrange(min(4000, len(data)))
        changed[at] = random.choice(b'0123456789-.<>"= \0\xff') if random.random() < .7 else random.randrange(256)
    run(bytes(changed), [0, 3], 'change %d' % i)
END
}
