/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elements that are as good as a sharp angle of the surface lets any element be. */
#ifndef TM_REPAIR_REPAIR_FORCED_H
#define TM_REPAIR_REPAIR_FORCED_H

#include "../../base/extern_c.h"
#include "repair_state.h"

TM_EXTERN_C_BEGIN

/* Marks, in forced[elements], valid ones below the threshold that no element there could
 * reach, and that have half of what is possible at least; *count counts. An element has
 * all of an angle where two of its faces at an edge are on the surface, and are on either
 * side of a sharp edge of it: with an angle of α, J_ENS is at most √2 sin α (that of a
 * tetrahedron). It has all of a tip where all of its faces at a corner of the surface are
 * on it, and all of its edges there on sharp edges: its J_ENS there is what it is.
 * O(elements). */
tm_status tm_repair_find_forced(const tm_repair_state *state, double threshold,
                                bool *forced, size_t *count, tm_error *error);

TM_EXTERN_C_END

#endif
