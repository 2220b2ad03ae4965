/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_notes.h"

#include "../../../lib/octree/forest/octree_estimate.h"

#include <stdio.h>

void octree_note_outside(const filter *f, const octree_rules *rules, const tm_surface *s)
{
    for (size_t r = 0; r < rules->rules.count; r++) {
        const tm_octree_rule *rule = &rules->rules.rule[r];
        if (tm_octree_rule_reaches(rule, s))
            continue;
        const bool box = rule->kind == TM_RULE_BOX;
        const double *low = box ? rule->low : rule->region->low;
        const double *high = box ? rule->high : rule->region->high;
        filter_note(f,
                    "the %s from (%g, %g, %g) to (%g, %g, %g) is wholly outside of the "
                    "surface: no octant is split for it",
                    box ? "box" : "region", low[0], low[1], low[2], high[0], high[1],
                    high[2]);
    }
}

/* The boundary is not what the surface is: a handle or a piece is lost, or one too much.
 */
static void note_topology(const filter *f, const tm_surface *s,
                          const tm_octree_mesh_report *r, double leaf_side)
{
    double at[3];
    char place[128] = "";
    if (tm_surface_find_thin(s, 2 * leaf_side, at))
        snprintf(place, sizeof place, ", as near (%g, %g, %g)", at[0], at[1], at[2]);
    filter_note(f,
                "the boundary has %zu components and Euler number %lld, the surface %zu "
                "and %lld: %sa part or a gap of it is too thin for this level%s",
                r->components, (long long)r->euler, s->components, (long long)s->euler,
                s->touching ? "parts that touch are joined, or " : "", place);
}

void octree_note_losses(const filter *f, const tm_surface *s,
                        const tm_octree_mesh_report *r, double leaf_side)
{
    if (r->lost)
        filter_note(f,
                    "%zu octants with surface are too large for it: a thin part or a gap "
                    "is lost near (%g, %g, %g); a finer level there, or --resolve, may "
                    "keep it",
                    r->lost, r->lost_at[0], r->lost_at[1], r->lost_at[2]);
    if (r->rounded)
        filter_note(
            f,
            "%zu tips or thin parts of the surface are rounded off, or missed, by up "
            "to %.3g, near (%g, %g, %g)",
            r->rounded, r->rounded_by, r->rounded_at[0], r->rounded_at[1],
            r->rounded_at[2]);
    if (r->dropped)
        filter_note(
            f,
            "%zu pieces of the surface bound nothing and have no part in the mesh, "
            "as near (%g, %g, %g)",
            r->dropped, r->dropped_at[0], r->dropped_at[1], r->dropped_at[2]);
    if (r->regions_lost)
        filter_note(f,
                    "%zu of %zu regions%s are not in the mesh: they, or "
                    "a wall around them, are too thin for this level",
                    r->regions_lost, s->walls ? s->cells : s->components,
                    s->walls ? "" : ", one within another,");
    if (!s->by_winding && (r->components != s->components || r->euler != s->euler))
        note_topology(f, s, r, leaf_side);
    if (r->corners_lost + r->curves_lost)
        filter_note(f,
                    "%zu corners and %zu sharp edges of the surface are too close "
                    "together for this level%s, as near (%g, %g, %g)",
                    r->corners_lost, r->curves_lost,
                    s->walls ? ", or more regions meet there than octants can follow"
                             : "",
                    r->feature_lost_at[0], r->feature_lost_at[1], r->feature_lost_at[2]);
    if (r->off_surface)
        filter_note(f,
                    "%zu boundary nodes are not on the surface yet: there they would "
                    "invert an element (octree-repair takes %s there)",
                    r->off_surface, s->walls ? "some of them" : "them");
    if (r->invalid)
        filter_note(f, "%zu elements are inverted", r->invalid);
    if (r->not_positive)
        filter_note(f,
                    "%zu elements are inverted inside, though not at a corner, where "
                    "walls meet (octree-repair mends them)",
                    r->not_positive);
}
