# SPDX-License-Identifier: GPL-3.0-or-later
# What the tests of gmsh-import and gmsh-export need: meshes by Gmsh, and looks at them.
# shellcheck shell=bash

need_gmsh() {
    [ -x "$TM_BUILD/bin/gmsh-import" ] || skip "there is no libgmsh"
    command -v gmsh >/dev/null || skip "there is no gmsh"
}

# Writes two.geo: two boxes with a face between them and names of all dimensions; their
# mesh depends on nothing but Gmsh.
two_geo() {
    cat >two.geo <<'END'
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 1, 1, 1};
Coherence;
Physical Volume("left half", 10) = {1};
Physical Volume("right", 20) = {2};
Physical Surface("wall", 5) = {1};
Physical Surface("between", 6) = {2};
Physical Curve("rim", 3) = {1};
Physical Point("corner", 2) = {1};
Mesh.CharacteristicLengthMax = 0.6;
END
}

# by_gmsh OUT OPTION… : the mesh of two.geo.
by_gmsh() {
    gmsh -3 two.geo -v 0 -nt 1 -o "$1" "${@:2}" >/dev/null 2>&1
}

# A stream without its history.
blocks() {
    sed '/^#/d' "$1"
}

# same_mesh A B [TOLERANCE]: the same cells, faces and edges between nodes in the same
# places, with the same markers and regions, in any order and numbered in any way.
same_mesh() {
    python3 - "$@" <<'END'
import sys

def read(path):
    block, blocks = None, {}
    for line in open(path):
        if line[0] == '.' and not line.startswith('.end'):
            block = blocks.setdefault(line.strip(), [])
        elif line[0] != '#' and block is not None and line[0] != '.':
            block.append(line.split())
    return blocks

tolerance = float(sys.argv[3]) if len(sys.argv) > 3 else 0
def place(row):
    x = [float(c) for c in row[1:4]]
    return tuple(round(c / tolerance) for c in x) if tolerance else tuple(x)

def mesh(path):
    b = read(path)
    head, rows = b['.node'][0], b['.node'][1:]
    at = {r[0]: place(r) for r in rows}
    marked = sorted((place(r), r[4]) for r in rows if int(head[3]) and r[4] != '0')
    made = {'.node': sorted(at.values()), 'marked': marked}
    for name in ('.ele', '.face', '.edge', '.mix', '.facet'):
        head, rows = b.get(name, [[]])[0], b.get(name, [[]])[1:]
        all = []
        for r in rows:
            skip = {'.mix': 2, '.facet': 4}.get(name, 1)
            k = {'.ele': 4, '.face': 3, '.edge': 2}.get(name) or int(r[skip - 1])
            nodes = [at[v] for v in r[skip:skip + k]]
            # which way it turns: by how many exchanges sort its nodes
            order = sorted(range(k), key=lambda i: nodes[i])
            odd = sum(order[i] > order[j] for j in range(k) for i in range(j)) % 2
            if name in ('.face', '.edge', '.facet') or k != 4:
                odd = 0
            all.append((sorted(nodes), odd, [float(c) for c in r[skip + k:]]))
        made[name] = sorted(all)
    return made

a, b = mesh(sys.argv[1]), mesh(sys.argv[2])
for name in a:
    if a[name] != b[name]:
        wrong = [(p, q) for p, q in zip(a[name], b[name]) if p != q]
        sys.exit('%s: %d and %d rows, first %s' % (name, len(a[name]), len(b[name]), wrong[:1]))
END
}

# names FILE: the rows of .group but for their numbers, sorted.
names() {
    rows .group "$1" | grep -v '^\.' | cut -d ' ' -f 2- | sort
}

# gmsh_sees FILE EXPRESSION: prints it of what Gmsh itself reads: groups, {(dimension,
# name): [elements, size]}, where size is the length, area or volume.
gmsh_sees() {
    /usr/bin/python3 - "$@" <<'END'
import sys, gmsh
import numpy as np
gmsh.initialize()
gmsh.option.setNumber('General.Terminal', 0)
gmsh.open(sys.argv[1])
tags, xyz, _ = gmsh.model.mesh.getNodes()
at = dict(zip(tags, np.array(xyz).reshape(-1, 3)))
def size(type, nodes):
    x = [at[v] for v in nodes]
    if type == 4:
        return np.linalg.det([x[1] - x[0], x[2] - x[0], x[3] - x[0]]) / 6
    if type == 2:
        return np.linalg.norm(np.cross(x[1] - x[0], x[2] - x[0])) / 2
    if type == 1:
        return np.linalg.norm(x[1] - x[0])
    return 0
groups = {}
for dim, tag in gmsh.model.getPhysicalGroups():
    count, total = 0, 0.
    for entity in gmsh.model.getEntitiesForPhysicalGroup(dim, tag):
        for type, elements, nodes in zip(*gmsh.model.mesh.getElements(dim, entity)):
            k = len(nodes) // len(elements)
            count += len(elements)
            total += sum(size(type, nodes[i * k:i * k + k]) for i in range(len(elements)))
    groups[dim, gmsh.model.getPhysicalName(dim, tag) or tag] = [count, float(total)]
print(eval(sys.argv[2]))
END
}
