# SPDX-License-Identifier: GPL-3.0-or-later
# What several command line tests need: input of their own making, and looks at streams.
# shellcheck shell=bash

# Prints a closed surface: surface SHAPE FORMAT. SHAPE is cube (12 triangles, side 1),
# box (6 quadrilaterals) or sphere (radius 1, about 400 triangles); FORMAT off, coff,
# obj, ply, ply-little, ply-big, stl, stl-binary, mdl, node, poly, smesh or stream.
# Coordinates are multiples of 1/1024, so that 32-bit floats hold them, and nodes are
# numbered as they come first in the faces, so that all formats number them alike.
surface() {
    python3 - "$@" <<'END'
import math, struct, sys

def cube(square):
    v = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4),
             (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    if square:
        return [[v[i] for i in q] for q in quads]
    return [[v[i] for i in t] for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]

def sphere(around=20, rings=10):
    def point(r, a):
        if r in (0, rings):
            return (0.0, 0.0, 1.0 if r == 0 else -1.0)
        u, w = math.pi * r / rings, 2 * math.pi * (a % around) / around
        p = (math.sin(u) * math.cos(w), math.sin(u) * math.sin(w), math.cos(u))
        return tuple(round(c * 1024) / 1024 + 0.0 for c in p)
    faces = []
    for r in range(rings):
        for a in range(around):
            p, q = point(r, a), point(r + 1, a)
            s, t = point(r + 1, a + 1), point(r, a + 1)
            faces += [f for f in ([p, q, s], [p, s, t]) if len(set(f)) == 3]
    return faces

shape, form = sys.argv[1:3]
faces = {'cube': lambda: cube(False), 'box': lambda: cube(True), 'sphere': sphere}[shape]()
number = {}
for f in faces:
    for p in f:
        number.setdefault(p, len(number))
nodes = list(number)
ids = [[number[p] for p in f] for f in faces]
text = lambda p: ' '.join('%.10g' % c for c in p)
out = sys.stdout

def off(word, more):
    print(word)
    print(len(nodes), len(faces), 0)
    for p in nodes:
        print(text(p) + more)
    for f in ids:
        print(len(f), *f)

def ply(encoding, order):
    out.write('ply\nformat %s 1.0\nelement vertex %d\n' % (encoding, len(nodes)))
    out.write('property float x\nproperty float y\nproperty float z\n')
    out.write('element face %d\nproperty list uchar int vertex_indices\nend_header\n'
              % len(ids))
    if not order:
        for p in nodes:
            print(text(p))
        for f in ids:
            print(len(f), *f)
        return
    out.flush()
    for p in nodes:
        out.buffer.write(struct.pack(order + '3f', *p))
    for f in ids:
        out.buffer.write(struct.pack(order + 'B%di' % len(f), len(f), *f))

def node_rows():
    for i, p in enumerate(nodes):
        print(i + 1, text(p))

if form == 'off':
    off('OFF', '')
elif form == 'coff':
    off('COFF', ' 255 0 0 255')
elif form == 'obj':
    for p in nodes:
        print('v', text(p))
    for f in ids:
        print('f', *('%d//1' % (i + 1) for i in f))
elif form == 'ply':
    ply('ascii', '')
elif form == 'ply-little':
    ply('binary_little_endian', '<')
elif form == 'ply-big':
    ply('binary_big_endian', '>')
elif form == 'stl':
    print('solid')
    for f in faces:
        print('facet normal 0 0 0\nouter loop')
        for p in f:
            print('vertex', text(p))
        print('endloop\nendfacet')
    print('endsolid')
elif form == 'stl-binary':
    out.buffer.write(b'solid, but binary'.ljust(80) + struct.pack('<I', len(faces)))
    for f in faces:
        out.buffer.write(struct.pack('<12fH', 0, 0, 0, *(c for p in f for c in p), 0))
elif form == 'mdl':
    print('[Vertices, ARRAY1<POINT3D>]\n%d\n' % len(nodes))
    for p in nodes:
        print(text(p))
    print('[Triangles, ARRAY1<STRING>]\n%d\n' % len(ids))
    for f in ids:
        print(*f, 0, 0, 0)
elif form in ('node', 'poly', 'smesh'):
    print(len(nodes), 3, 0, 0)
    node_rows()
    if form != 'node':
        print(len(ids), 0)
        for f in ids:
            print(('1 0\n' if form == 'poly' else '') + str(len(f)), *(i + 1 for i in f))
        print('0\n0')
elif form == 'stream':
    print('termesh 1\n# made by hand\nsurface.node')
    print(len(nodes), 3, 0, 0)
    node_rows()
    print('surface.face')
    print(len(ids), 0)
    for i, f in enumerate(ids):
        print(i + 1, *(n + 1 for n in f))
    print('.end')
else:
    sys.exit('surface: no format ' + form)
END
}

# Prints the rows of a block: rows BLOCK FILE.
rows() {
    awk -v block="$1" '
        $0 ~ /^[a-z]*\./ { inside = ($1 == block); header = inside; next }
        inside && header { header = 0; next }
        inside' "$2"
}

# Prints a block's header: header BLOCK FILE.
header() {
    awk -v block="$1" '$1 == block { getline; print; exit }' "$2"
}

# Prints for each tetrahedron of a stream its volume, with the sign of its orientation.
volumes() {
    { rows .node "$1"; echo; rows .ele "$1"; } | awk '
        NF == 0 { elements = 1; next }
        !elements { x[$1] = $2; y[$1] = $3; z[$1] = $4; next }
        { a = $2; b = $3; c = $4; d = $5
          px = x[b] - x[a]; py = y[b] - y[a]; pz = z[b] - z[a]
          qx = x[c] - x[a]; qy = y[c] - y[a]; qz = z[c] - z[a]
          rx = x[d] - x[a]; ry = y[d] - y[a]; rz = z[d] - z[a]
          printf "%.12g\n", ((py * qz - pz * qy) * rx + (pz * qx - px * qz) * ry + \
              (px * qy - py * qx) * rz) / 6 }'
}

# Succeeds where all tetrahedra of a stream have positive volume and they add up to
# within 1e-9 of a number: fills FILE VOLUME.
fills() {
    volumes "$1" | awk -v right="$2" '
        $1 <= 0 { print "volume", $1; wrong = 1 }
        { sum += $1 }
        END {
            print NR, "tetrahedra of volume", sum
            exit wrong || NR == 0 || sum - right > 1e-9 || right - sum > 1e-9
        }'
}

# Makes a locale whose decimal sign is a comma and prints the folder for LOCPATH.
comma_locale() {
    localedef -i de_DE -f UTF-8 "$BATS_TEST_TMPDIR/comma" >&2
    echo "$BATS_TEST_TMPDIR"
}

# Prints the value at a path of keys in JSON: json FILE key…
json() {
    python3 -c '
import json, sys
value = json.load(open(sys.argv[1]))
for key in sys.argv[2:]:
    value = value[int(key) if isinstance(value, list) else key]
print(json.dumps(value))' "$@"
}

# Prints a stream of random-looking tetrahedra, wrong in many ways, for more than one
# chunk of work: many [TETRAHEDRA].
many() {
    awk -v tets="${1:-20000}" 'BEGIN {
        nodes = 3000; seed = 7
        print "termesh 1\n.node\n" nodes " 3 0 0"
        for (v = 0; v < nodes; v++) {
            line = v
            for (i = 0; i < 3; i++) {
                seed = (seed * 16807) % 2147483647
                line = line " " seed % 10007 / 10007
            }
            print line
        }
        print ".ele\n" tets " 4 0"
        for (t = 0; t < tets; t++) {
            line = t
            first = (t * 7919) % nodes
            for (i = 0; i < 4; i++)
                line = line " " (first + i * (1 + t % 700)) % nodes
            print line
        }
        print ".end"
    }'
}

# Two unit cubes, one on the other; facet i has marker 10 + i, the one between them 20;
# the upper one is region 7, the lower one region 3.
two_boxes() {
    awk 'BEGIN {
        print 12, 3, 0, 1
        for (z = 0; z < 3; z++) for (y = 0; y < 2; y++) for (x = 0; x < 2; x++)
            print ++n, x, y, z, 100 + z
        print 11, 1
        split("1 2 4 3 5 6 8 7 9 10 12 11", v)
        m[1] = 11; m[2] = 20; m[3] = 12
        for (i = 0; i < 3; i++)
            print "1 0", m[i + 1] "\n4", v[4*i+1], v[4*i+2], v[4*i+3], v[4*i+4]
        split("1 2 6 5 2 4 8 6 4 3 7 8 3 1 5 7 5 6 10 9 6 8 12 10 8 7 11 12 7 5 9 11", w)
        for (i = 0; i < 8; i++)
            print "1 0", 13 + i % 4 "\n4", w[4*i+1], w[4*i+2], w[4*i+3], w[4*i+4]
        print 0
        print 2
        print 1, 0.5, 0.5, 0.5, 3
        print 2, 0.5, 0.5, 1.5, 7
    }'
}

# Prints a stream of N^3 boxes as polyhedra: boxes N [JITTER]. Planes are at uneven
# distances; the whole measures N by N by N. With JITTER the nodes inside are moved by up
# to so much and all facets are cut into triangles. The attribute says 6 tetrahedra.
boxes() {
    python3 - "$@" <<'END'
import random, sys

n = int(sys.argv[1])
jitter = float(sys.argv[2]) if len(sys.argv) > 2 else 0
m = n + 1
random.seed(n)
plane = [[0] + [i + random.uniform(-.3, .3) for i in range(1, n)] + [n] for _ in range(3)]
places = [(i, j, k) for k in range(m) for j in range(m) for i in range(m)]

def node(p):
    return p[0] + m * (p[1] + m * p[2])

def cell(p):
    return p[0] + n * (p[1] + n * p[2]) if 0 <= min(p) and max(p) < n else -1

def step(p, axis, by=1):
    return tuple(c + by * (x == axis) for x, c in enumerate(p))

facets, cells = [], [[] for _ in range(n ** 3)]
for axis in range(3):
    u, v = (axis + 1) % 3, (axis + 2) % 3
    for p in places:
        if p[u] == n or p[v] == n:
            continue
        sides = [cell(step(p, axis, -1)), cell(p)]
        nodes = [node(q) for q in (p, step(p, u), step(step(p, u), v), step(p, v))]
        if sides[0] < 0:
            sides.reverse()
            nodes.reverse()
        for f in [nodes] if not jitter else [nodes[:3], nodes[2:] + nodes[:1]]:
            for c in sides:
                if c >= 0:
                    cells[c].append(len(facets))
            facets.append(sides + [len(f)] + f)

print('termesh 1\n.node\n%d 3 0 0' % m ** 3)
for p in places:
    x = [plane[axis][c] for axis, c in enumerate(p)]
    if jitter and 0 < min(p) and max(p) < n:
        x = [c + random.uniform(-jitter, jitter) for c in x]
    print(node(p), *x)
print('.facet\n%d 0' % len(facets))
for f, row in enumerate(facets):
    print(f, *row)
print('.cell\n%d 1' % n ** 3)
for c, f in enumerate(cells):
    print(c, len(f), *f, 6)
print('.end')
END
}

# Prints a stream of n^3 boxes as polyhedra with 6 quadrilaterals each: sheared_boxes N [BASE]. The
# planes between them are where they like, the whole is sheared: its volume is N^3, all
# quadrilaterals are plane, facets inside have marker 0, those of the six sides 1 to 6.
sheared_boxes() {
    python3 - "$@" <<'END'
import random, sys
n = int(sys.argv[1])
base = int(sys.argv[2]) if len(sys.argv) > 2 else 1
m = n + 1
random.seed(3)
at = [[c if c in (0, n) else c + round(random.random() * 0.8 - 0.4, 3)
       for c in range(m)] for axis in range(3)]

def node(i, j, k):
    return i + m * (j + m * k)

def cell(i, j, k):
    return i + n * (j + n * k)

def quadrilateral(corner, axis, side):
    """The side 0 or 1 of a box; its normal is along the axis."""
    nodes = []
    for u, w in ((0, 0), (1, 0), (1, 1), (0, 1)):
        p = list(corner)
        p[axis] += side
        p[(axis + 1) % 3] += u
        p[(axis + 2) % 3] += w
        nodes.append(node(*p))
    return nodes

print('termesh 1\n.node\n%d 3 1 1' % m ** 3)
for k in range(m):
    for j in range(m):
        for i in range(m):
            x, y, z = at[0][i], at[1][j], at[2][k]
            print(node(i, j, k) + base, '%.6g %.6g %.6g' % (x + 0.25 * y, y - 0.5 * z, z),
                  i / 2, j)
facets, cells = [], [[] for c in range(n ** 3)]

def add(c1, c2, nodes, marker):
    for c in (c1, c2):
        if c is not None:
            cells[c].append(len(facets))
    facets.append((c1, c2, nodes, marker))

for k in range(n):
    for j in range(n):
        for i in range(n):
            for axis in range(3):
                p, q = (i, j, k), [i, j, k]
                q[axis] += 1
                if p[axis] == 0:
                    add(cell(*p), None, quadrilateral(p, axis, 0)[::-1], axis + 1)
                inside = q[axis] < n
                add(cell(*p), cell(*q) if inside else None, quadrilateral(p, axis, 1),
                    0 if inside else axis + 4)
print('.facet\n%d 1' % len(facets))
for f, (c1, c2, nodes, marker) in enumerate(facets):
    print(f + base, c1 + base, -1 if c2 is None else c2 + base, len(nodes),
          *(v + base for v in nodes), marker)
print('.cell\n%d 1' % len(cells))
for c, fs in enumerate(cells):
    print(c + base, len(fs), *(f + base for f in fs), c % 2 + 0.5)
print('.end')
END
}

# Prints a unit cube as a polyhedron, and one beside it: cubes [BASE].
cubes() {
    awk -v base="${1:-1}" 'BEGIN {
            print "termesh 1\n.node\n12 3 0 0"
            for (v = 0; v < 12; v++)
                print v + base, v % 3, int(v / 3) % 2, int(v / 6)
            print ".facet\n11 1"
            # c1 c2 marker and four nodes, all from 0
            n = split("0 -1 1 0 6 9 3,0 -1 2 0 1 7 6,0 -1 2 3 9 10 4,0 -1 3 0 3 4 1," \
                      "0 -1 4 6 7 10 9,0 1 0 1 4 10 7,1 -1 2 1 2 8 7,1 -1 2 4 10 11 5," \
                      "1 -1 3 1 4 5 2,1 -1 4 7 8 11 10,1 -1 5 2 5 11 8", facet, ",")
            for (f = 1; f <= n; f++) {
                split(facet[f], x, " ")
                print f - 1 + base, x[1] + base, x[2] == -1 ? -1 : x[2] + base, 4,
                    x[4] + base, x[5] + base, x[6] + base, x[7] + base, x[3]
            }
            print ".cell\n2 1"
            print base, 6, base, base + 1, base + 2, base + 3, base + 4, base + 5, 1
            print base + 1, 6, base + 5, base + 6, base + 7, base + 8, base + 9, base + 10, 2
            print ".end"
        }'
}

# Prints a hexahedron, a pyramid on top, a wedge beside it and a tetrahedron on the
# pyramid; the volume is 1 + 1/3 + 1/2 + 1/12.
mixed() {
    cat <<'END'
termesh 1
.node
12 3 0 0
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
9 0.5 0.5 2
10 2 0 0
11 2 0 1
12 1 0.5 2
.mix
4 1
1 8 1 2 3 4 5 6 7 8 1
2 5 5 6 7 8 9 1
3 6 2 3 10 6 7 11 2
4 4 6 7 9 12 3
.end
END
}

# Debian's python has VTK and meshio.
# shellcheck disable=SC2034 # for the tests
vtk_python=/usr/bin/python3

need_vtk() {
    "$vtk_python" -c 'import vtk' 2>/dev/null || skip "there is no python3-vtk9"
}

need_meshio() {
    "$vtk_python" -c 'import meshio' 2>/dev/null || skip "there is no python3-meshio"
}

# vtk FILE EXPRESSION: prints it, of g, the grid that VTK reads of a .vtk or .vtu file,
# volume and area of its cells by vtkCellSizeFilter, point and cell, the arrays by their
# names, within(ARRAY, A, B), the cells with values A to B by vtkThreshold: their types,
# volume and area, and names, the strings of the field data.
vtk() {
    "$vtk_python" - "$@" <<'END'
import sys, vtk
from vtk.util.numpy_support import vtk_to_numpy

def arrays(data):
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
            for i in range(data.GetNumberOfArrays())}

if sys.argv[1].endswith('.vtu'):
    reader = vtk.vtkXMLUnstructuredGridReader()
else:
    reader = vtk.vtkUnstructuredGridReader()
    reader.ReadAllScalarsOn()
reader.SetFileName(sys.argv[1])
reader.Update()
g = reader.GetOutput()
size = vtk.vtkCellSizeFilter()
size.SetInputData(g)
size.Update()
point, cell = arrays(g.GetPointData()), arrays(g.GetCellData())
sizes = arrays(size.GetOutput().GetCellData())
volume, area = sizes.get('Volume'), sizes.get('Area')
types = [g.GetCellType(c) for c in range(g.GetNumberOfCells())]
group_names = g.GetFieldData().GetAbstractArray('group_names')
names = group_names and [group_names.GetValue(i) for i in range(group_names.GetNumberOfValues())]

def within(name, low, high):
    threshold = vtk.vtkThreshold()
    threshold.SetInputConnection(size.GetOutputPort())
    threshold.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, name)
    threshold.SetLowerThreshold(low)
    threshold.SetUpperThreshold(high)
    threshold.SetThresholdFunction(threshold.THRESHOLD_BETWEEN)
    threshold.Update()
    part = threshold.GetOutput()
    data = arrays(part.GetCellData())
    return (sorted({part.GetCellType(c) for c in range(part.GetNumberOfCells())}),
            round(float(data['Volume'].sum()), 9), round(float(data['Area'].sum()), 9))
print(eval(sys.argv[2]))
END
}

# Prints a cube of N³ cells of six tetrahedra, whose longest edges are all alike: tet_grid N
tet_grid() {
    python3 - "$1" <<'END'
import itertools, sys
n = int(sys.argv[1])
m = n + 1
print('termesh 1\n.node\n%d 3 0 0' % m ** 3)
for v, (z, y, x) in enumerate(itertools.product(range(m), repeat=3)):
    print(v, x, y, z)
print('.ele\n%d 4 0' % (6 * n ** 3))
t = itertools.count()
for z, y, x in itertools.product(range(n), repeat=3):
    first = (z * m + y) * m + x
    for a, b in (1, m + 1), (m + 1, m), (m, m * m + m), (m * m + m, m * m), (m * m, m * m + 1), (m * m + 1, 1):
        print(next(t), first, first + a, first + b, first + m * m + m + 1)
print('.end')
END
}
