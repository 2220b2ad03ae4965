# SPDX-License-Identifier: GPL-3.0-or-later
"""region_volumes.py TETS CELLS [OPTION]: whether the regions (attribute 1) of polyhedra
have the volumes of those of tetrahedra, to 1e-12 of the whole; else exit status 1. With
the option 10 facets are bent, and nothing is compared."""

import collections
import math
import sys


def read(path):
    """{name: (numbers of the header, rows of numbers)}."""
    blocks = {}
    with open(path, encoding="ascii") as stream:
        lines = (line.split() for line in stream if line.strip() and line[0] != "#")
        next(lines)
        for name, *_ in lines:
            if name != ".end":
                header = [int(word) for word in next(lines)]
                blocks[name] = header, [[float(w) for w in next(lines)] for _ in range(header[0])]
    return blocks


def volume(p, q, r, s):
    """Six times that of a tetrahedron, as a sum of few terms."""
    a, b, c = ([x - y for x, y in zip(v, p)] for v in (q, r, s))
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))


def of_tets(blocks):
    point = {int(row[0]): row[1:4] for row in blocks[".node"][1]}
    attributes = blocks[".ele"][0][2]
    parts = collections.defaultdict(list)
    for row in blocks[".ele"][1]:
        corners = [point[int(v)] for v in row[1:5]]
        parts[row[5] if attributes else 0].append(abs(volume(*corners)))
    return {region: math.fsum(some) for region, some in parts.items()}


def of_cells(blocks, regions):
    point = {int(row[0]): row[1:4] for row in blocks[".node"][1]}
    region = {}
    for row in blocks[".cell"][1]:
        facets = int(row[1])
        # behind the number of its tetrahedra
        region[int(row[0])] = row[3 + facets] if regions else 0
    parts = collections.defaultdict(list)
    origin = next(iter(point.values()))
    for row in blocks[".facet"][1]:
        k = int(row[3])
        node = [point[int(v)] for v in row[4:4 + k]]
        fan = [volume(origin, node[0], node[i], node[i + 1]) for i in range(1, k - 1)]
        for side, sign in ((int(row[1]), 1), (int(row[2]), -1)):
            if side in region:
                parts[region[side]] += [sign * v for v in fan]
    return {which: math.fsum(some) for which, some in parts.items()}


def main():
    if sys.argv[3:] == ["10"]:
        return
    tets = read(sys.argv[1])
    expected = of_tets(tets)
    found = of_cells(read(sys.argv[2]), tets[".ele"][0][2] > 0)
    whole = math.fsum(expected.values())
    for region in expected.keys() | found.keys():
        off = abs(found.get(region, 0)) - expected.get(region, 0)
        if not abs(off) <= 1e-12 * whole:
            sys.exit(f"region {region}: the volume is off by {off / whole:.2g} of the whole")


main()
