# SPDX-License-Identifier: GPL-3.0-or-later
"""polyhedra.py [FILE]: counts the polyhedra of a termesh stream, for the benchmarks,
without the library. Prints how many there are, tetrahedra and faces for each, how many
are not simple, and for how many of these Euler's formula V - E + F = 2 does not hold.

Simple: each edge has two faces that go along it in opposite directions, the faces around
a node are one fan, all faces are connected, and Euler's formula holds."""
import fileinput


def read(lines):
    """The nodes of each facet, its first cell, and cells as (facets, tetrahedra)."""
    facets, first, cells = [], [], []
    for line in lines:
        name = line.strip()
        if name not in (".node", ".facet", ".cell"):
            continue
        rows = [next(lines) for _ in range(int(next(lines).split()[0]))]
        if name == ".node":
            base = int(rows[0].split()[0])
        for row in (row.split() for row in rows):
            if name == ".facet":
                first.append(int(row[1]) - base)
                facets.append([int(v) for v in row[4:4 + int(row[3])]])
            elif name == ".cell":
                last = 2 + int(row[1])
                cells.append(([int(f) - base for f in row[2:last]], float(row[last])))
    return facets, first, cells


def whole(steps, start):
    """Whether all steps {from: {to…}} are reached from the start."""
    reached, todo = {start}, [start]
    while todo:
        for item in steps[todo.pop()] - reached:
            reached.add(item)
            todo.append(item)
    return len(reached) == len(steps)


def judge(loops):
    """(simple, Euler's formula holds) for the faces of a polyhedron."""
    along, around, edges = {}, {}, {}
    for loop in loops:
        for a, b, c in zip(loop, loop[1:] + loop[:1], loop[2:] + loop[:2]):
            along[a, b] = along.get((a, b), 0) + 1
            edges.setdefault(a, set()).add(b)
            edges.setdefault(b, set()).add(a)
            fan = around.setdefault(b, {})
            fan.setdefault(a, set()).add(c)
            fan.setdefault(c, set()).add(a)
    count = len({frozenset(edge) for edge in along})
    euler = len(edges) - count + len(loops) == 2
    pairs = all(n == 1 and (b, a) in along for (a, b), n in along.items())
    fans = all(whole(fan, next(iter(fan))) for fan in around.values())
    return euler and pairs and fans and whole(edges, next(iter(edges))), euler


def main():
    facets, first, cells = read(fileinput.input())
    faces = tets = bad = euler_failures = 0
    for c, (of, size) in enumerate(cells):
        simple, euler = judge([facets[f][::1 if first[f] == c else -1] for f in of])
        faces += len(of)
        tets += size
        bad += not simple
        euler_failures += not euler
    n = len(cells)
    print(n, "%.2f" % (tets / n), "%.2f" % (faces / n), bad, euler_failures)


main()
