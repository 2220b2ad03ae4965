# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and writes the blocks .node, .ele, .face and .edge of a termesh stream, for the
benchmarks: the rows of a block are lists of strings, without the row's own number."""

NODES_PER_ROW = {".ele": 4, ".face": 3, ".edge": 2}


def read(path):
    """The blocks as {name: (header, rows)}; the header is without the count."""
    blocks = {}
    with open(path, encoding="ascii") as stream:
        lines = (line.split() for line in stream if line.strip() and line[0] != "#")
        if next(lines) != ["termesh", "1"]:
            raise ValueError(path + " is no termesh stream")
        for name, *_ in lines:
            if name == ".end":
                break
            if name != ".node" and name not in NODES_PER_ROW:
                raise ValueError(path + ": what is " + name + "?")
            count, *header = next(lines)
            rows = [next(lines) for _ in range(int(count))]
            if name == ".node":
                base = int(rows[0][0]) if rows else 1
            blocks[name] = header, [row[1:] for row in rows]
    for name, width in NODES_PER_ROW.items():
        for row in blocks.get(name, ([], []))[1]:
            row[:width] = [int(node) - base for node in row[:width]]
    return blocks


def write(path, blocks):
    """Writes the blocks, with nodes numbered from 1."""
    with open(path, "w", encoding="ascii") as stream:
        print("termesh 1", file=stream)
        for name, (header, rows) in blocks.items():
            print(name, file=stream)
            print(len(rows), *header, file=stream)
            width = NODES_PER_ROW.get(name, 0)
            for i, row in enumerate(rows, 1):
                print(i, *[node + 1 for node in row[:width]], *row[width:], file=stream)
        print(".end", file=stream)


def mesh(points, tets):
    """The blocks of a mesh of points, lists of 3, and tetrahedra, lists of 4 indices."""
    return {".node": (["3", "0", "0"], points), ".ele": (["4", "0"], tets)}
