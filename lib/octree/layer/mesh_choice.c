/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_choice.h"

#include "../forest/octree_build.h"
#include "../forest/octree_estimate.h"
#include "../interior/wall_sectors.h"
#include "adaptive_refinement.h"
#include "octree_mesh_parts.h"

#include <inttypes.h>
#include <math.h>

/* An element that was above does not fall below. */
static const double flat = 0.02;

void tm_mesh_plan_set_levels(tm_mesh_plan *plan, unsigned levels)
{
    plan->levels = levels;
    for (size_t r = 0; r < plan->rules; r++)
        plan->rule[r].deeper =
            plan->deeper && plan->rule[r].kind == TM_RULE_SURFACE ? levels : 0;
}

unsigned tm_mesh_plan_level(const tm_mesh_plan *plan, unsigned deepest, double side,
                            const tm_surface *surface)
{
    unsigned asked = 0;
    for (size_t r = 0; r < plan->rules; r++) {
        const tm_octree_rule *rule = &plan->rule[r];
        const unsigned level = tm_octree_rule_level(rule, side);
        if (level > asked && tm_octree_rule_reaches(rule, surface))
            asked = level;
    }
    return plan->deeper && plan->levels > 0 && asked < deepest ? asked : deepest;
}

/* Makes a mesh by the plan; *is_deeper: no plan of no levels would make it. */
static tm_status make(tm_octree_mesh *mesh, tm_octree *octree, tm_surface *surface,
                      const tm_mesh_plan *plan, bool *is_deeper, tm_error *error)
{
    *mesh = (tm_octree_mesh){0};
    *octree = (tm_octree){.leaves = 0};
    tm_progress_stage(plan->progress, "splitting octants");
    tm_status status = tm_octree_build(octree, surface, plan->rule, plan->rules, error);
    if (status != TM_OK)
        return status;
    const unsigned level =
        tm_mesh_plan_level(plan, tm_octree_deepest(octree), octree->side, surface);
    status = tm_octree_mesh_refine_lost(mesh, octree, surface, level, plan->levels,
                                        plan->laid_out, plan->progress, error);
    *is_deeper = status != TM_OK || tm_octree_deepest(octree) > level;
    return status;
}

/* In how many places a mesh is not where the surface is. */
static size_t missing(const tm_octree_mesh_report *r)
{
    return r->off_surface + r->lost + r->rounded;
}

/* Whether a mesh has fewer nodes off the surface than another one, is in fewer places
 * not where the surface is, and nothing else is worse. */
static bool is_better(const tm_octree_mesh_report *a, const tm_octree_mesh_report *b,
                      const tm_surface *surface)
{
    const int64_t euler = surface->euler;
    return a->off_surface < b->off_surface && missing(a) < missing(b) &&
           a->invalid <= b->invalid &&
           a->worst >= fmin(b->worst, fmax(b->worst / 2, flat)) &&
           a->dropped <= b->dropped && a->corners_lost <= b->corners_lost &&
           a->curves_lost <= b->curves_lost && a->regions_lost <= b->regions_lost &&
           a->components <= b->components &&
           imaxabs(a->euler - euler) <= imaxabs(b->euler - euler);
}

/* Makes another mesh and keeps the better one; a plan by which there is none is not
 * better. */
static tm_status try_plan(tm_octree_mesh *mesh, tm_octree *octree, tm_surface *surface,
                          const tm_mesh_plan *plan, tm_mesh_plan *best, bool *is_deeper,
                          tm_error *error)
{
    tm_octree_mesh made;
    tm_octree other;
    const tm_status status = make(&made, &other, surface, plan, is_deeper, error);
    if (status == TM_OK && is_better(&made.report, &mesh->report, surface)) {
        tm_octree_mesh_exchange(mesh, octree, &made, &other);
        *best = *plan;
    }
    tm_octree_mesh_free(&made);
    tm_octree_free(&other);
    return status == TM_ERROR_INPUT ? TM_OK : status;
}

tm_status tm_octree_mesh_choose(tm_octree_mesh *mesh, tm_octree *octree,
                                tm_surface *surface, tm_mesh_plan *plan, tm_error *error)
{
    bool sharp = false, is_deeper[2] = {true, true}; /* of what was made each way */
    plan->laid_out = true;
    tm_mesh_plan best = *plan;
    tm_status status = make(mesh, octree, surface, plan, &is_deeper[0], error);
    if (status == TM_OK && surface->walls && mesh->report.off_surface > 0)
        status = tm_walls_are_sharp(surface, &sharp, error);
    for (unsigned n = plan->levels + 1; surface->walls && n-- > 0;)
        for (int way = 0; way < (sharp ? 2 : 1); way++) {
            const bool laid_out = way == 0;
            if (status != TM_OK || mesh->report.off_surface == 0)
                break;
            if ((laid_out && n == best.levels && best.laid_out) ||
                (n == 0 && !is_deeper[way]))
                continue; /* that was there */
            tm_mesh_plan_set_levels(plan, n);
            plan->laid_out = laid_out;
            status = try_plan(mesh, octree, surface, plan, &best, &is_deeper[way], error);
        }
    *plan = best;
    tm_mesh_plan_set_levels(plan, best.levels);
    return status;
}
