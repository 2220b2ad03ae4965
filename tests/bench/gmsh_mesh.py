# SPDX-License-Identifier: GPL-3.0-or-later
"""How the benchmarks begin and end with Gmsh: one thread, and tetrahedra to a stream."""
import gmsh

import mesh_stream

ERRORS = 1
TETRAHEDRON = 4


def start():
    """Starts Gmsh with one thread."""
    gmsh.initialize(["gmsh", "-nt", "1"])
    gmsh.option.setNumber("General.Verbosity", ERRORS)


def finish(path):
    """Writes the tetrahedra to a termesh stream unless path is None, ends Gmsh, and
    returns how many there are."""
    corners = gmsh.model.mesh.getElementsByType(TETRAHEDRON)[1]
    if path:
        tags, xyz, _ = gmsh.model.mesh.getNodes()
        index = {tag: i for i, tag in enumerate(tags)}
        points = [[float(x) for x in xyz[3 * i : 3 * i + 3]] for i in range(len(tags))]
        tets = [[index[tag] for tag in corners[i : i + 4]] for i in range(0, len(corners), 4)]
        mesh_stream.write(path, mesh_stream.mesh(points, tets))
    gmsh.finalize()
    return len(corners) // 4
