# SPDX-License-Identifier: GPL-3.0-or-later
"""gmsh-optimize.py [--threshold QUALITY] [--times N] [--output STREAM] STREAM: reads the
tetrahedra of a termesh stream, runs Gmsh's default optimiser on them N times (which by
itself leaves meshes without geometry alone: force), and prints how many there are then
and the CPU seconds of the optimiser alone. The threshold is Mesh.OptimizeThreshold: it
works on the tetrahedra whose quality is below that, and by itself that is 0.3."""
import argparse
import time

import gmsh

import gmsh_mesh
import mesh_stream


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--threshold", type=float, default=0.3)
    parser.add_argument("--times", type=int, default=1)
    parser.add_argument("--output")
    parser.add_argument("stream")
    options = parser.parse_args()

    blocks = mesh_stream.read(options.stream)
    nodes, tets = blocks[".node"][1], blocks[".ele"][1]
    gmsh_mesh.start()
    gmsh.option.setNumber("Mesh.OptimizeThreshold", options.threshold)
    gmsh.model.addDiscreteEntity(3, 1)
    xyz = [float(x) for node in nodes for x in node[:3]]
    corners = [node + 1 for tet in tets for node in tet[:4]]
    gmsh.model.mesh.addNodes(3, 1, list(range(1, len(nodes) + 1)), xyz)
    gmsh.model.mesh.addElementsByType(1, 4, [], corners)
    start = time.process_time()
    for _ in range(options.times):
        gmsh.model.mesh.optimize("", force=True)
    seconds = time.process_time() - start
    count = gmsh_mesh.finish(options.output)
    print(count, "%.4f" % seconds)


main()
