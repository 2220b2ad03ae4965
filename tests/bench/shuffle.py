# SPDX-License-Identifier: GPL-3.0-or-later
"""shuffle.py SEED STREAM OUTPUT: the same mesh with its nodes and its rows in another
order, and the corners of tetrahedra, faces and edges turned, in a way that keeps the
orientation."""
import random
import sys

import mesh_stream


def turned(corners):
    """An even permutation of the corners; of the two of an edge, any."""
    order = list(range(len(corners)))
    random.shuffle(order)
    inversions = sum(order[i] > order[j] for j in range(len(order)) for i in range(j))
    if inversions % 2 and len(order) > 2:
        order[0], order[1] = order[1], order[0]
    return [corners[i] for i in order]


def main():
    random.seed(int(sys.argv[1]))
    blocks = mesh_stream.read(sys.argv[2])
    nodes = blocks[".node"][1]
    number = list(range(len(nodes)))
    random.shuffle(number)
    moved = [None] * len(nodes)
    for old, new in enumerate(number):
        moved[new] = nodes[old]
    nodes[:] = moved
    for name, width in mesh_stream.NODES_PER_ROW.items():
        rows = blocks.get(name, ([], []))[1]
        random.shuffle(rows)
        for row in rows:
            row[:width] = turned([number[node] for node in row[:width]])
    mesh_stream.write(sys.argv[3], blocks)


main()
