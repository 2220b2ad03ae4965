/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The dihedral quality and the longest edge of tetrahedra of a mesh. */
#ifndef TM_TET_MESH_MEASURE_H
#define TM_TET_MESH_MEASURE_H

#include "mesh.h"

/* So many are measured at a time. */
enum { TM_MEASURED_AT_ONCE = 4 };

/* tm_tet_sine2() and the longest edge, 0 … 5, of 1 … TM_MEASURED_AT_ONCE tetrahedra. Of
 * edges of the same length that with the larger tm_edge_key() is the longer. */
void tm_tet_mesh_measure(const tm_tet_mesh *mesh, const uint32_t *tet, size_t count,
                         double sine2[TM_MEASURED_AT_ONCE],
                         uint8_t longest[TM_MEASURED_AT_ONCE]);

#endif
