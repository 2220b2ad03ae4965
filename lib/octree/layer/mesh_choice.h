/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An octree by rules and its mesh; where walls meet, the best of several. */
#ifndef TM_LAYER_MESH_CHOICE_H
#define TM_LAYER_MESH_CHOICE_H

#include "../../base/extern_c.h"
#include "octree_mesh.h"

TM_EXTERN_C_BEGIN

typedef struct tm_mesh_plan {
    tm_octree_rule *rule; /* [rules] */
    size_t rules;
    unsigned levels; /* more than the rules ask for, where that is needed, at most */
    bool deeper;     /* it is needed also where the surface is close to itself */
    bool laid_out;   /* of what was made: tm_octree_mesh_refine_lost() */
    const tm_progress *progress; /* may be NULL */
} tm_mesh_plan;

/* Sets plan->levels, and what the rules for the surface say of it. */
void tm_mesh_plan_set_levels(tm_mesh_plan *plan, unsigned levels);

/* The deepest level that rules ask for, without what `deeper` adds, of an octree with
 * roots of that side and leaves of that level. */
unsigned tm_mesh_plan_level(const tm_mesh_plan *plan, unsigned deepest, double side,
                            const tm_surface *surface);

/* Makes octree and mesh by the plan. Where walls meet and nodes are off the surface it is
 * tried with fewer levels, and, if walls are sharp (wall_sectors.h), for each without
 * laying them out, as long as nodes are: a mesh is better that has fewer of them if
 * it is in fewer places not where the surface is, and nothing else of its report is
 * worse, the worst J_ENS but by half and not below 0.02.
 * The plan is then that of what was kept. Errors as of tm_octree_build() and
 * tm_octree_mesh_make(); both are to be freed, after an error too. */
tm_status tm_octree_mesh_choose(tm_octree_mesh *mesh, tm_octree *octree,
                                tm_surface *surface, tm_mesh_plan *plan, tm_error *error);

TM_EXTERN_C_END

#endif
