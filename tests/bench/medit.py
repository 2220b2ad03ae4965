# SPDX-License-Identifier: GPL-3.0-or-later
"""medit.py to STREAM FILE.mesh, or from FILE.mesh STREAM: nodes, tetrahedra with regions
and triangles with markers, for benchmarks beside Mmg."""
import sys

import mesh_stream


def write_medit(blocks, path):
    header, tets = blocks[".ele"]
    regions = int(header[1]) > 0
    with open(path, "w", encoding="ascii") as file:
        nodes = blocks[".node"][1]
        print("MeshVersionFormatted 2\nDimension 3\nVertices\n%d" % len(nodes), file=file)
        for row in nodes:
            print(*row[:3], 0, file=file)
        print("Tetrahedra\n%d" % len(tets), file=file)
        for row in tets:
            reference = int(float(row[4])) if regions else 0
            print(*(v + 1 for v in row[:4]), reference, file=file)
        marked, faces = blocks.get(".face", (["0"], []))
        print("Triangles\n%d" % len(faces), file=file)
        for row in faces:
            print(*(v + 1 for v in row[:3]), row[3] if int(marked[0]) else 1, file=file)
        print("End", file=file)


def read_medit(path):
    with open(path, encoding="ascii") as file:
        words = iter(file.read().split())
    found = {}
    width = {"Vertices": 4, "Tetrahedra": 5, "Triangles": 4}
    for word in words:
        if word in width:
            found[word] = [[next(words) for _ in range(width[word])]
                           for _ in range(int(next(words)))]
    return {".node": (["3", "0", "0"], [row[:3] for row in found["Vertices"]]),
            ".ele": (["4", "1"], [[int(v) - 1 for v in row[:4]] + row[4:]
                                  for row in found["Tetrahedra"]]),
            ".face": (["1"], [[int(v) - 1 for v in row[:3]] + row[3:]
                              for row in found.get("Triangles", [])])}


if sys.argv[1] == "to":
    write_medit(mesh_stream.read(sys.argv[2]), sys.argv[3])
else:
    mesh_stream.write(sys.argv[3], read_medit(sys.argv[2]))
