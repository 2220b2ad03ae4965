/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the surface lets each node do. */
#ifndef TM_REPAIR_REPAIR_BOUNDARY_H
#define TM_REPAIR_REPAIR_BOUNDARY_H

#include "../../optimise/optimise.h"
#include "../../surface/surface.h"

/* How far a node may be from a point and still be on it, as a part of the diagonal of the
 * surface's bounding box. */
#define TM_ON_SURFACE 1e-9

/* Fills rule[v] and on[v] (tm_node_class) of all nodes of a mesh: nodes inside move
 * freely, those of the boundary as the surface says. given[v] says where a node is,
 * negative where it is off the surface; it is looked for nearby where it should be. With
 * given NULL, where[v] says which nodes are on the boundary: a node of it is on the
 * corner, or else on the curve that its coordinates are on, or else on the patch of the
 * closest triangle, and it is off the surface where it is not there yet. O(boundary nodes
 * log triangles); TM_ERROR_SYSTEM where memory is out. */
tm_status tm_repair_find_rules(const tm_surface *surface, size_t nodes,
                               const double (*xyz)[3], const double *given,
                               const bool *where, tm_node_rule *rule, uint8_t *on,
                               tm_error *error);

#endif
