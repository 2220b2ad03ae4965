# SPDX-License-Identifier: GPL-3.0-or-later
"""awkward_tets.py FOLDER: 18 meshes of tetrahedra there that nobody tunes for: cubes cut
in five or six, thin ones, with regions, and cubes that only touch."""

import random
import sys

SIX = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]
FIVE = [(0, 3, 6, 5), (0, 1, 3, 5), (0, 3, 2, 6), (0, 5, 6, 4), (3, 6, 5, 7)]


def cubes(cells, cut=SIX, scale=(1, 1, 1), region=None, jitter=0.0):
    """A mesh of cubes at whole places; region(cell, number of the tetrahedron)."""
    random.seed(1)
    number, points, rows = {}, [], []
    for x, y, z in cells:
        for k, tet in enumerate(cut):
            corners = []
            for c in tet:
                i, j, l = c & 1, c >> 1 & 1, c >> 2
                if cut is FIVE:  # mirrored, to fit its neighbours
                    i, j, l = (i ^ x & 1, j ^ y & 1, l ^ z & 1)
                place = x + i, y + j, z + l
                if place not in number:
                    number[place] = len(points) + 1
                    points.append([(p + jitter * random.uniform(-1, 1)) * s
                                   for p, s in zip(place, scale)])
                corners.append(number[place])
            if cut is FIVE and (x + y + z) % 2:
                corners[:2] = corners[1::-1]
            rows.append(corners + ([region((x, y, z), k)] if region else []))
    return points, rows, region is not None


def write(path, mesh):
    points, rows, regions = mesh
    with open(path, "w", encoding="ascii") as stream:
        print("termesh 1\n.node\n%d 3 0 0" % len(points), file=stream)
        for i, point in enumerate(points, 1):
            print(i, *map(repr, point), file=stream)
        print(".ele\n%d 4 %d" % (len(rows), regions), file=stream)
        for i, row in enumerate(rows, 1):
            print(i, *row, file=stream)
        print(".end", file=stream)


def block(*size):
    return [(x, y, z) for z in range(size[2]) for y in range(size[1]) for x in range(size[0])]


MESHES = {
    "kuhn-2": cubes(block(2, 2, 2)),
    "kuhn-6": cubes(block(6, 6, 6)),
    "five-2": cubes(block(2, 2, 2), FIVE),
    "five-6": cubes(block(6, 6, 6), FIVE),
    "moved-6": cubes(block(6, 6, 6), jitter=0.15),
    "slab": cubes(block(12, 12, 1), scale=(1, 1, 0.01)),
    "needles": cubes(block(2, 2, 10), scale=(0.01, 0.01, 1)),
    "sheet": cubes(block(8, 8, 2), FIVE, scale=(1, 1, 1e-6)),
    "tiny": cubes(block(4, 4, 4), scale=(1e-40, 1e-40, 1e-40), jitter=0.1),
    "halves": cubes(block(4, 4, 4), region=lambda cell, k: 1 + cell[0] // 2),
    "layers": cubes(block(5, 5, 5), FIVE, region=lambda cell, k: cell[2]),
    "checks": cubes(block(4, 4, 4), region=lambda cell, k: sum(cell) % 2),
    "confetti": cubes(block(4, 4, 4), jitter=0.1, region=lambda cell, k: random.randrange(3)),
    "each": cubes(block(3, 3, 3), region=lambda cell, k: k),
    "edge": cubes(block(2, 2, 2) + [(2, 2, 0), (3, 2, 0)]),
    "corner": cubes(block(2, 2, 2) + [(2, 2, 2), (3, 3, 3)]),
    "apart": cubes(block(2, 2, 2) + [(5, 5, 5), (5, 5, 6), (9, 0, 0)]),
    "holes": cubes([cell for cell in block(5, 5, 5) if sum(cell) % 2]),
}

for name, made in MESHES.items():
    write(f"{sys.argv[1]}/{name}.tm", made)
