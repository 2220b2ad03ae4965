/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh of tetrahedra or of mixed elements as it came in a stream, which may be wrong in
 * any way. */
#ifndef TM_MESH_MESH_VIEW_H
#define TM_MESH_MESH_VIEW_H

#include "../base/extern_c.h"
#include "../element/shape.h"
#include "../stream/stream.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Flat arrays, which belong to somebody else; all indices are below the counts. Arrays of
 * count 0 may be NULL. The nodes of an element are in the order of shape.h. */
typedef struct tm_mesh_view {
    size_t nodes;
    const double (*xyz)[3];
    size_t elements;
    const size_t *start;  /* [elements + 1]: the nodes of e, 4, 5, 6 or 8, are */
    const uint32_t *item; /* item[start[e]] … item[start[e + 1] - 1]; or start is NULL:
                             only tetrahedra, item[4e] … item[4e + 3] */
    size_t faces;         /* rows of .face */
    const uint32_t (*face)[3];
    size_t edges; /* rows of .edge */
    const uint32_t (*edge)[2];
    size_t facets;              /* rows of .facet: polygons of the elements */
    const uint32_t (*side)[2];  /* the element on either side; TM_NONE: the boundary */
    const size_t *facet_start;  /* [facets + 1]: the nodes of f are */
    const uint32_t *facet_node; /* facet_node[facet_start[f] … facet_start[f + 1]) */
    unsigned threads;           /* for work on it: no result depends on it; 0: one */
} tm_mesh_view;

/* The blocks .node, .ele, .face and .edge of a stream; those that are not there are
 * empty. */
tm_mesh_view tm_mesh_view_of_tets(const tm_stream *stream);

/* The blocks .node, .mix, .face, .edge and .facet. */
tm_mesh_view tm_mesh_view_of_mixed(const tm_stream *stream);

/* The nodes of element e, and how many. */
static inline const uint32_t *tm_mesh_view_nodes(const tm_mesh_view *mesh, size_t e,
                                                 size_t *count)
{
    if (!mesh->start) {
        *count = TM_TET_NODES;
        return mesh->item + TM_TET_NODES * e;
    }
    *count = mesh->start[e + 1] - mesh->start[e];
    return mesh->item + mesh->start[e];
}

TM_EXTERN_C_END

#endif
