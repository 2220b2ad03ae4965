# SPDX-License-Identifier: GPL-3.0-or-later
"""agglomerate.py --metis N | --kmeans N [--label] STREAM: joins the tetrahedra of a stream to about
N polyhedra as others do, and writes these as a stream; for the benchmarks, without the
library, and nothing is repaired.

--metis   parts of the graph of faces, by METIS' gpmetis with -contig
--kmeans  Lloyd's algorithm on the tetrahedra's centroids, by volume (needs numpy); what is
          not connected is split
--label   the tetrahedra are written, with their part as an attribute"""
import argparse
import collections
import os
import subprocess
import tempfile

import mesh_stream

ROUNDS = 30
BLOCK = 4096


def faces_of(tets):
    """{sorted nodes: [(tetrahedron, nodes outward)…]}"""
    faces = collections.defaultdict(list)
    for t, (a, b, c, d) in enumerate(tets):
        for face in ((b, c, d), (a, d, c), (a, b, d), (a, c, b)):
            faces[tuple(sorted(face))].append((t, face))
    return faces


def neighbours_of(faces, tets):
    neighbours = [[] for _ in tets]
    for sides in faces.values():
        if len(sides) == 2:
            (t, _), (u, _) = sides
            neighbours[t].append(u)
            neighbours[u].append(t)
    return neighbours


def metis(neighbours, parts):
    with tempfile.TemporaryDirectory() as folder:
        graph = os.path.join(folder, "graph")
        with open(graph, "w", encoding="ascii") as stream:
            print(len(neighbours), sum(map(len, neighbours)) // 2, file=stream)
            for row in neighbours:
                print(*[t + 1 for t in row], file=stream)
        subprocess.run(["gpmetis", "-contig", graph, str(parts)], check=True,
                       stdout=subprocess.DEVNULL)
        with open(f"{graph}.part.{parts}", encoding="ascii") as stream:
            return [int(line) for line in stream]


def kmeans(points, tets, parts):
    import numpy
    corner = numpy.array(points, float)[numpy.array(tets)]
    middle = corner.mean(axis=1)
    edge = corner[:, 1:] - corner[:, :1]
    volume = abs(numpy.linalg.det(edge)) / 6
    random = numpy.random.default_rng(1)
    centre = middle[random.choice(len(tets), parts, replace=False)]
    for _ in range(ROUNDS):
        # The nearest of |x - c|^2 = |x|^2 - 2 x.c + |c|^2.
        square = (centre ** 2).sum(axis=1)
        label = numpy.concatenate([(square - 2 * middle[i:i + BLOCK] @ centre.T).argmin(axis=1)
                                   for i in range(0, len(tets), BLOCK)])
        weight = numpy.bincount(label, volume, parts)
        for axis in range(3):
            sums = numpy.bincount(label, volume * middle[:, axis], parts)
            centre[weight > 0, axis] = sums[weight > 0] / weight[weight > 0]
    return label.tolist()


def connected(label, neighbours):
    """The same parts, split where they are not connected, numbered as they come."""
    part, count = [None] * len(label), 0
    for start in range(len(label)):
        if part[start] is not None:
            continue
        part[start], todo = count, [start]
        while todo:
            t = todo.pop()
            for u in neighbours[t]:
                if part[u] is None and label[u] == label[t]:
                    part[u] = count
                    todo.append(u)
        count += 1
    return part, count


def write(points, faces, part, count, tets):
    facets, of = [], [[] for _ in range(count)]
    for sides in faces.values():
        cells = [part[t] for t, _ in sides]
        if len(cells) == 2 and cells[0] == cells[1]:
            continue
        for c in cells:
            of[c].append(len(facets) + 1)
        facets.append((cells[0] + 1, cells[1] + 1 if len(cells) == 2 else -1, sides[0][1]))
    sizes = collections.Counter(part)
    print("termesh 1\n.node\n%d 3 0 0" % len(points))
    for i, point in enumerate(points, 1):
        print(i, *point)
    print(".facet\n%d 0" % len(facets))
    for i, (c1, c2, nodes) in enumerate(facets, 1):
        print(i, c1, c2, 3, *[v + 1 for v in nodes])
    print(".cell\n%d 1" % count)
    for c, list_ in enumerate(of):
        print(c + 1, len(list_), *list_, sizes[c])
    print(".end")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--metis", type=int)
    parser.add_argument("--kmeans", type=int)
    parser.add_argument("--label", action="store_true")
    parser.add_argument("stream")
    arguments = parser.parse_args()
    blocks = mesh_stream.read(arguments.stream)
    points = [row[:3] for row in blocks[".node"][1]]
    tets = [row[:4] for row in blocks[".ele"][1]]
    faces = faces_of(tets)
    neighbours = neighbours_of(faces, tets)
    if arguments.metis:
        label = metis(neighbours, arguments.metis)
    else:
        label = kmeans(points, tets, arguments.kmeans)
    if arguments.label:
        rows = [tet + [part + 1] for tet, part in zip(tets, label)]
        mesh_stream.write("/dev/stdout", {".node": (["3", "0", "0"], points),
                                          ".ele": (["4", "1"], rows)})
        return
    part, count = connected(label, neighbours)
    write(points, faces, part, count, tets)


main()
