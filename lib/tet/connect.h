/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TM_TET_CONNECT_H
#define TM_TET_CONNECT_H

#include "mesh.h"

/* For tm_tet_mesh_from_stream(): from tet, region and the listed faces (all of
 * mesh->face, with node and marker) finds neighbour, the faces' sides and the faces that
 * are not listed. Messages give numbers from `base`. Expected O(n), on threads >= 1. */
tm_status tm_tet_mesh_connect(tm_tet_mesh *mesh, unsigned base, unsigned threads,
                              tm_error *error);

/* Locks the edges with more than two boundary faces: there the mesh touches itself, and
 * a star walk sees only a part of the tetrahedra. Looks for edges of .edge inside. */
tm_status tm_tet_mesh_find_edges(tm_tet_mesh *mesh, tm_error *error);

#endif
