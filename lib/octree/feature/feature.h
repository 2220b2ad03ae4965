/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which nodes of the interior boundary stand for the corners and curves of the surface,
 * and which patch each of the others belongs to. */
#ifndef TM_LAYER_FEATURE_H
#define TM_LAYER_FEATURE_H

#include "../../base/extern_c.h"
#include "../interior/interior_boundary.h"

TM_EXTERN_C_BEGIN

typedef enum tm_feature_kind { TM_ON_PATCH, TM_ON_CURVE, TM_ON_CORNER } tm_feature_kind;

/* Node s of the interior boundary, of kind[s], is on patch, curve or corner of[s]; of a
 * patch TM_NONE: on any. A curve node has its neighbours on the curve, interior boundary
 * nodes, in along[s]. */
typedef struct tm_feature {
    uint8_t *kind;
    uint32_t *of;
    uint32_t (*along)[2];
    size_t corners_lost; /* that no node was left for */
    size_t curves_lost;  /* that no path was found for; their patches are merged */
    uint32_t lost;       /* a surface node on one of these */
} tm_feature;

/* Interior boundary nodes are given to corners, the closest ones; then each curve gets a
 * path of edges and diagonals of the interior boundary that runs along it, from corner to
 * corner or around, and quadrilaterals are cut where it takes their diagonal; last, what
 * the paths enclose gets the patch that most of its nodes are closest to. at[s] is the
 * point of the surface that is closest to interior boundary node s. Patches on both sides
 * of a lost curve become one in the surface. TM_ERROR_SYSTEM where memory is out.
 * *feature is to be freed, after an error too. O(n log n). */
tm_status tm_feature_find(tm_feature *feature, tm_interior_boundary *boundary,
                          tm_surface *surface, const tm_surface_point *at,
                          tm_error *error);
void tm_feature_free(tm_feature *feature);

TM_EXTERN_C_END

#endif
