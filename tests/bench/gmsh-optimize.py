# SPDX-License-Identifier: GPL-3.0-or-later
"""gmsh-optimize.py STREAM: reads the tetrahedra of a termesh stream, runs Gmsh's default
optimiser on them (which by itself leaves meshes without geometry alone: force), and
prints how many there are then and the CPU seconds of the optimiser alone."""
import sys
import time

import gmsh


def rows(stream, block):
    """The rows of a block as lists of strings."""
    lines = iter(stream)
    for line in lines:
        if line.strip() == block:
            break
    else:
        return []
    count = int(next(lines).split()[0])
    return [next(lines).split() for _ in range(count)]


def main():
    with open(sys.argv[1], encoding="ascii") as stream:
        lines = stream.readlines()
    nodes, tets = rows(lines, ".node"), rows(lines, ".ele")
    base = int(nodes[0][0])
    gmsh.initialize(["gmsh", "-nt", "1"])
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.model.addDiscreteEntity(3, 1)
    xyz = [float(x) for row in nodes for x in row[1:4]]
    tags = [int(row[0]) + 1 - base for row in nodes]
    corners = [int(n) + 1 - base for row in tets for n in row[1:5]]
    gmsh.model.mesh.addNodes(3, 1, tags, xyz)
    gmsh.model.mesh.addElementsByType(1, 4, [], corners)
    start = time.process_time()
    gmsh.model.mesh.optimize("", force=True)
    seconds = time.process_time() - start
    count = len(gmsh.model.mesh.getElementsByType(4)[0])
    gmsh.finalize()
    print(count, "%.4f" % seconds)


main()
