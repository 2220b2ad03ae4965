/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh of an octree as polyhedra: one for each octant, fit for finite volumes. */
#ifndef TM_POLY_JOIN_OCTANTS_H
#define TM_POLY_JOIN_OCTANTS_H

#include "../../base/extern_c.h"
#include "../../stream/stream.h"
#include "../fit/fit.h"

TM_EXTERN_C_BEGIN

typedef struct tm_octant_join {
    size_t elements, polyhedra, facets;
    size_t joined;   /* how many facets are less, since they are parts of others */
    size_t levelled; /* nodes put back to edges and faces of octants */
    tm_fit_report fit;
} tm_octant_join;

/* Replaces .mix, .face, .facet, .octant and .root by .facet and .cell. The elements of
 * one row of .octant that have no node on the surface become one polyhedron, those of the
 * layer there one each, in the order of their first elements. On the surface are the
 * nodes of the boundary, and where the attribute of .node says where nodes are, those
 * between regions. Facets between the same two polyhedra are one; on the boundary those
 * are that are in one plane. Cells have how many elements they are of, then the
 * attributes of .mix. Inner nodes move: to the edges and faces of octants that they
 * divide (octant_faces.h), and then as tm_polyhedra_fit() says. Needs .node, .mix and
 * .octant; without .root nothing is put back. TM_ERROR_INPUT as tm_cell_faces_find()
 * says, TM_ERROR_SYSTEM where memory is out; the stream is then to be freed. O(elements).
 */
tm_status tm_join_octants(tm_stream *stream, tm_octant_join *report, tm_error *error);

TM_EXTERN_C_END

#endif
