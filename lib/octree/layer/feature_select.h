/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which curves of a surface are worth a path: on a rough surface sharp edges come singly
 * and in small groups that are not edges of the shape. */
#ifndef TM_LAYER_FEATURE_SELECT_H
#define TM_LAYER_FEATURE_SELECT_H

#include "../../surface/surface.h"

/* What becomes of a curve or a corner. */
typedef struct tm_feature_choice {
    bool *curve;         /* [curves]: it gets a path */
    bool *corner;        /* [corners]: it gets a node */
    uint32_t *corner_of; /* [nodes of the surface]: the corner there, or TM_NONE */
} tm_feature_choice;

/* Leaves out curves that hang together with none of the others over more than a few
 * sides of a leaf (or half of the surface), then, again and again, curves of less than
 * two sides that end freely; and the corners that have lost all their curves. Corners
 * without curves, the tips of cones, stay. size[c] is the side of the leaves near curve
 * c. TM_ERROR_SYSTEM where memory is out. *choice is to be freed, after an error too.
 * O(n). */
tm_status tm_feature_choose(tm_feature_choice *choice, const tm_surface *surface,
                            const double *size, tm_error *error);
void tm_feature_choice_free(tm_feature_choice *choice);

#endif
