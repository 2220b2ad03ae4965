/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_boundary.h"

#include "../../geom/vector.h"
#include "../../stream/slice.h"
#include "../layer/octree_mesh_stream.h"

#include <stdlib.h>
#include <string.h>

/* The curves at each node of the surface: a corner is in many, others in one or none. */
typedef struct {
    const tm_surface *surface;
    double near2;     /* the square of how far on is */
    size_t *start;    /* [nodes of the surface + 1] */
    uint32_t *curve;  /* of node n: curve[start[n]] … */
    uint32_t *corner; /* [nodes of the surface]: its number, or TM_NONE */
} finder;

static tm_status start_finder(finder *f, tm_error *error)
{
    const tm_surface *s = f->surface;
    const size_t items = s->curves > 0 ? s->curve_start[s->curves] : 0;
    f->start = calloc(s->nodes + 2, sizeof *f->start);
    f->curve = calloc(items + 1, sizeof *f->curve);
    f->corner = malloc((s->nodes + 1) * sizeof *f->corner);
    if (!f->start || !f->curve || !f->corner)
        return tm_fail_memory(error);
    memset(f->corner, 0xff, (s->nodes + 1) * sizeof *f->corner);
    for (size_t c = 0; c < s->corners; c++)
        f->corner[s->corner[c]] = (uint32_t)c;
    size_t *end = f->start + 1;
    for (size_t i = 0; i < items; i++)
        end[s->curve_node[i] + 1]++;
    for (size_t n = 0; n < s->nodes; n++)
        end[n + 1] += end[n];
    for (uint32_t c = 0; c < s->curves; c++)
        for (size_t i = s->curve_start[c]; i < s->curve_start[c + 1]; i++)
            f->curve[end[s->curve_node[i]]++] = c;
    double diagonal[3];
    tm_subtract(diagonal, s->high, s->low);
    f->near2 = TM_ON_SURFACE * TM_ON_SURFACE * tm_norm2(diagonal);
    return TM_OK;
}

/* What is closest so far. */
typedef struct {
    uint32_t what; /* TM_NONE: nothing yet */
    double distance2;
} closest;

static void try_corner(const finder *f, uint32_t corner, const double xyz[3],
                       closest *best)
{
    const tm_surface *s = f->surface;
    const double d = tm_distance2(s->xyz[s->corner[corner]], xyz);
    if (best->what == TM_NONE || d < best->distance2)
        *best = (closest){corner, d};
}

static void try_curve(const finder *f, uint32_t curve, const double xyz[3], closest *best)
{
    double point[3];
    size_t segment;
    tm_surface_closest_on_curve(f->surface, curve, xyz, point, &segment);
    const double d = tm_distance2(point, xyz);
    if (best->what == TM_NONE || d < best->distance2)
        *best = (closest){curve, d};
}

/* The corner closest to a point: of those at the triangle there, which is enough where
 * the point is on it, or of all. */
static closest find_corner(const finder *f, const double xyz[3], uint32_t triangle,
                           bool all)
{
    closest best = {.what = TM_NONE};
    for (size_t i = 0; !all && i < 3; i++) {
        const uint32_t corner = f->corner[f->surface->triangle[triangle][i]];
        if (corner != TM_NONE)
            try_corner(f, corner, xyz, &best);
    }
    for (uint32_t c = 0; all && c < f->surface->corners; c++)
        try_corner(f, c, xyz, &best);
    return best;
}

/* The same for curves. */
static closest find_curve(const finder *f, const double xyz[3], uint32_t triangle,
                          bool all)
{
    closest best = {.what = TM_NONE};
    for (size_t i = 0; !all && i < 3; i++) {
        const uint32_t n = f->surface->triangle[triangle][i];
        for (size_t j = f->start[n]; j < f->start[n + 1]; j++)
            try_curve(f, f->curve[j], xyz, &best);
    }
    for (uint32_t c = 0; all && c < f->surface->curves; c++)
        try_curve(f, c, xyz, &best);
    return best;
}

static tm_node_rule on_patch(const finder *f, const tm_surface_point *at, uint8_t *on)
{
    *on = TM_NODE_ON_PATCH;
    return (tm_node_rule){.where = f->surface->patch[at->triangle],
                          .freedom = TM_MOVES_ON_SURFACE,
                          .off_surface = at->distance2 > f->near2};
}

/* The rule of a node that is to be on a corner or a curve: that closest to it; of the
 * patch where there is none. */
static tm_node_rule rule_given(const finder *f, const double xyz[3],
                               const tm_surface_point *at, uint8_t *on)
{
    const bool corner = *on == TM_NODE_ON_CORNER;
    if (*on == TM_NODE_ON_PATCH)
        return on_patch(f, at, on);
    closest best = {.what = TM_NONE};
    for (int all = 0; all < 2 && (best.what == TM_NONE || best.distance2 > f->near2);
         all++)
        best = corner ? find_corner(f, xyz, at->triangle, all)
                      : find_curve(f, xyz, at->triangle, all);
    if (best.what == TM_NONE)
        return on_patch(f, at, on);
    const bool off_surface = best.distance2 > f->near2;
    if (corner && !off_surface)
        return (tm_node_rule){.where = TM_NONE, .freedom = TM_MOVES_NOT};
    return (tm_node_rule){.where = best.what,
                          .freedom = corner ? TM_MOVES_AT_CORNER : TM_MOVES_ON_CURVE,
                          .off_surface = off_surface};
}

/* The rule of a boundary node by its coordinates. */
static tm_node_rule rule_found(const finder *f, const double xyz[3],
                               const tm_surface_point *at, uint8_t *on)
{
    const closest corner = find_corner(f, xyz, at->triangle, false);
    const closest curve = find_curve(f, xyz, at->triangle, false);
    *on = TM_NODE_ON_PATCH;
    if (corner.what != TM_NONE && corner.distance2 <= f->near2)
        *on = TM_NODE_ON_CORNER;
    else if (curve.what != TM_NONE && curve.distance2 <= f->near2)
        *on = TM_NODE_ON_CURVE;
    return rule_given(f, xyz, at, on);
}

tm_status tm_repair_find_rules(const tm_surface *surface, size_t nodes,
                               const double (*xyz)[3], const double *given,
                               const bool *where, tm_node_rule *rule, uint8_t *on,
                               tm_error *error)
{
    finder f = {.surface = surface};
    const tm_status status = start_finder(&f, error);
    tm_surface_point at = {.triangle = TM_NONE};
    for (size_t v = 0; status == TM_OK && v < nodes; v++) {
        if (v % TM_SLICE_ROWS == 0) /* where a rank's nodes may begin */
            at.triangle = TM_NONE;
        on[v] = TM_NODE_INSIDE;
        rule[v] = (tm_node_rule){.where = TM_NONE, .freedom = TM_MOVES_FREELY};
        if (given ? given[v] == 0 : !where[v])
            continue;
        tm_surface_closest(surface, xyz[v], TM_NONE, &at);
        if (given)
            on[v] = (uint8_t)(given[v] < 0 ? -given[v] : given[v]);
        rule[v] = given ? rule_given(&f, xyz[v], &at, &on[v])
                        : rule_found(&f, xyz[v], &at, &on[v]);
    }
    free(f.start);
    free(f.curve);
    free(f.corner);
    return status;
}
