/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Attributes of nodes as a field that is linear in each tetrahedron. */
#ifndef TM_OPERATION_INTERPOLATION_H
#define TM_OPERATION_INTERPOLATION_H

#include "../mesh.h"

/* Writes the field's values at p to value[0 … node_attributes): by the tetrahedron of
 * the `count` ones in tet that p is deepest in. O(count). */
void tm_tet_interpolate(const tm_tet_mesh *mesh, const uint32_t *tet, size_t count,
                        const double p[3], double *value);

#endif
