/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh of polyhedra as it came in a stream, which may be wrong in any way. */
#ifndef TM_MESH_POLY_ARRAYS_H
#define TM_MESH_POLY_ARRAYS_H

#include "../base/extern_c.h"
#include "../stream/stream.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* All indices are below the counts. Arrays of count 0 may be NULL; they belong to the
 * stream. The nodes of a facet turn counter-clockwise seen from its first cell, around
 * the normal that points to its second one. */
typedef struct tm_poly_arrays {
    size_t nodes;
    const double (*xyz)[3];
    size_t facets;
    const uint32_t (*side)[2];  /* the two cells of a facet; TM_NONE: the boundary */
    const size_t *facet_start;  /* [facets + 1]: the nodes of f are */
    const uint32_t *facet_node; /* facet_node[facet_start[f] … facet_start[f + 1]) */
    size_t cells;
    const size_t *cell_start;   /* [cells + 1]: the facets of c are */
    const uint32_t *cell_facet; /* cell_facet[cell_start[c] … cell_start[c + 1]) */
    size_t attributes;          /* per cell; the first: its tetrahedra */
    const double *attribute;    /* [cells][attributes], or NULL */
} tm_poly_arrays;

/* The blocks .node, .facet and .cell of a stream; those that are not there are empty. */
tm_poly_arrays tm_poly_arrays_of(const tm_stream *stream);

TM_EXTERN_C_END

#endif
