/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of the tetrahedra in memory. */
#ifndef TM_TET_MESH_ORDER_H
#define TM_TET_MESH_ORDER_H

#include "mesh.h"

/* Puts the tetrahedra of a mesh without dead slots in the order of a space-filling curve,
 * so that what is near comes near: for work that goes over the mesh more than once and
 * whose result does not depend on their numbers. O(n). The mesh cannot be given back
 * after an error, only freed. */
tm_status tm_tet_mesh_sort(tm_tet_mesh *mesh, tm_error *error);

#endif
