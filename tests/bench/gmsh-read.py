# SPDX-License-Identifier: GPL-3.0-or-later
"""gmsh-read.py MSH STREAM: writes the tetrahedra of a mesh file of Gmsh's as a stream."""
import sys

import gmsh

import gmsh_mesh

gmsh_mesh.start()
gmsh.open(sys.argv[1])
gmsh_mesh.finish(sys.argv[2])
