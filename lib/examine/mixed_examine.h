/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Examines mixed elements as they came, which may be wrong in any way. */
#ifndef TM_EXAMINE_MIXED_EXAMINE_H
#define TM_EXAMINE_MIXED_EXAMINE_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "examination.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* A mesh as flat arrays; all indices are below the counts. Arrays of count 0 may be NULL.
 * Nodes of elements are in the order of mixed_mesh.h; element e has 4, 5, 6 or 8 of them,
 * item[start[e]] … item[start[e + 1] - 1]. */
typedef struct tm_mixed_arrays {
    size_t nodes;
    const double (*xyz)[3];
    size_t elements;
    const size_t *start;
    const uint32_t *item;
    size_t faces; /* rows of .face */
    const uint32_t (*face)[3];
    size_t edges; /* rows of .edge */
    const uint32_t (*edge)[2];
    size_t facets;              /* rows of .facet: polygons of the elements */
    const uint32_t (*side)[2];  /* the element on either side; TM_NONE: the boundary */
    const size_t *facet_start;  /* [facets + 1]: the nodes of f are */
    const uint32_t *facet_node; /* facet_node[facet_start[f] … facet_start[f + 1]) */
} tm_mixed_arrays;

/* The blocks .node, .mix, .face, .edge and .facet of a stream; those that are not there
 * are empty. They belong to the stream. */
tm_mixed_arrays tm_mixed_arrays_of(const tm_stream *stream);

/* Fills *found, with `mixed` set. An element that names a node twice is counted as
 * degenerate and takes no part in anything else. An element is inverted if the
 * determinant of one of its corners is negative, else degenerate if one is zero, exactly;
 * see mixed_volume.h. It is turned if all that are not zero are negative, upright if they
 * are positive; else it has no side, as if it was flat.
 *
 * Faces are the same if they have the same nodes in the same cyclic order, from wherever
 * and in whichever sense. TM_UNMATCHED_FACE counts faces of more than two elements;
 * quadrilaterals with the nodes of another one in another cyclic order; and pairs of a
 * triangle and a quadrilateral that are faces of one element each and have three nodes in
 * common. Two elements at a face overlap if both have a side, and it is the same.
 *
 * A row of .facet is dangling unless it is a face of the elements that it names, and of
 * no others, and turns as termesh-stream(5) says (either way, where the first one has no
 * side). The edges and vertices that are examined for being open or not manifold are
 * those of the boundary faces, which belong to one element. Volumes: tm_mixed_volume().
 * The result is the same for every number of threads. TM_ERROR_SYSTEM where memory is
 * out, there are 2^28 elements, or 2^31 rows of .face and .facet. Expected O(nodes +
 * elements + rows). */
tm_status tm_mixed_examine(tm_examination *found, const tm_mixed_arrays *mesh,
                           unsigned threads, tm_error *error);

TM_EXTERN_C_END

#endif
