/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Examines tetrahedra as they came, which may be wrong in any way: nothing is turned,
 * dropped or refused. */
#ifndef TM_EXAMINE_TET_EXAMINE_H
#define TM_EXAMINE_TET_EXAMINE_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "examination.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* A mesh as flat arrays; all indices are below `nodes`. Arrays of count 0 may be NULL. */
typedef struct tm_tet_arrays {
    size_t nodes;
    const double (*xyz)[3];
    size_t tets;
    const uint32_t (*tet)[4];
    size_t faces; /* rows of .face */
    const uint32_t (*face)[3];
    size_t edges; /* rows of .edge */
    const uint32_t (*edge)[2];
} tm_tet_arrays;

/* The blocks .node, .ele, .face and .edge of a stream; those that are not there are
 * empty. They belong to the stream. */
tm_tet_arrays tm_tet_arrays_of(const tm_stream *stream);

/* Fills *found. A tetrahedron that names a node twice is counted as degenerate and takes
 * no part in anything else: it has no faces and no edges. Two tetrahedra at a face
 * overlap if the exact signs of their volumes say that both are on the same side of it;
 * a flat one has no side. The edges and vertices that are examined for being open or not
 * manifold are those of the boundary faces; the fans at a vertex are the boundary faces
 * at it, connected through the edges that meet there. The volume's and the area's sums
 * are compensated. The result is the same for every number of threads. TM_ERROR_SYSTEM
 * where memory is out or there are more tetrahedra than 2^29.
 * Expected O(nodes + tets + faces + edges). */
tm_status tm_tet_examine(tm_examination *found, const tm_tet_arrays *mesh,
                         unsigned threads, tm_error *error);

TM_EXTERN_C_END

#endif
