/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes every element of an octree's mesh valid, and none worse than asked, and brings
 * nodes to the surface that were off the surface. */
#ifndef TM_REPAIR_REPAIR_H
#define TM_REPAIR_REPAIR_H

#include "../../base/extern_c.h"
#include "../../surface/surface.h"
#include "repair_state.h"

TM_EXTERN_C_BEGIN

typedef enum tm_repair_method {
    TM_REPAIR_REFINE, /* octants that hold a bad element are split, and all is meshed
                         again, until there are none (S. Donoso, 2022) */
    TM_REPAIR_FULL    /* nodes are moved; elements divided; octants split last */
} tm_repair_method;

typedef struct tm_repair_options {
    tm_repair_method method;
    double threshold;    /* an element is bad if its J_ENS is below, or it is not valid */
    unsigned iterations; /* meshes that are made from split octants, at most */
    /* Rows of .octant, ascending, that are split once, and all is meshed again, before
     * the method begins: the first of the iterations. NULL: none. */
    const uint32_t *octant;
    size_t octants;
    double growth; /* of the number of elements, at most; TM_REPAIR_FULL */
    /* Called with each state, the first one too, and with bad octants; `bad` are rows of
     * .octant, ascending. May be NULL. A status other than TM_OK ends the repair. */
    tm_status (*visit)(void *context, unsigned iteration, const tm_repair_state *state,
                       const uint32_t *bad, size_t count, tm_error *error);
    void *context;
    const tm_progress *progress;
    const tm_stop *stop; /* the state that is best until then counts */
} tm_repair_options;

typedef struct tm_repair_report {
    tm_repair_score before, after;
    unsigned iterations;
    size_t corners; /* that were made anew, also in states that were not kept */
    size_t divided; /* elements, also there */
} tm_repair_report;

/* Repairs *state. TM_REPAIR_REFINE, and octants to split, need its octree; without it
 * TM_REPAIR_FULL does not refine. What TM_REPAIR_FULL leaves is never worse than what it
 * began with
 * (tm_repair_better()), and a step that does not make it better is taken back: so the
 * worst J_ENS ends at or above the floor of report->before, whatever is gained elsewhere.
 * Where elements are left that are invalid all is tried once more, and kept if fewer are
 * then, with the worst at or above its old value or TM_REPAIR_FLAT.
 *
 * 1. Nodes move (../../optimise/optimise.h), with more and more effort, until no element
 * is bad and no node off the surface. 2. Elements that stay bad are divided
 *    (repair_divide.c). 3. Octants that hold a bad element, or one at a node that is held
 *    back, are split once, balanced, and all is meshed again and repaired as before,
 *    while that makes it better and there are not more elements than allowed.
 *
 * The surface's patches may be joined for a while. TM_ERROR_SYSTEM where memory is out;
 * *state is then to be freed. */
tm_status tm_repair(tm_repair_state *state, tm_surface *surface,
                    const tm_repair_options *options, tm_repair_report *report,
                    tm_error *error);

TM_EXTERN_C_END

#endif
