/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_estimate.h"

#include "../../base/array.h"
#include "../../geom/vector.h"
#include "brick.h"
#include "octree_parts.h"

#include <math.h>
#include <stdlib.h>

/* Points of the surface, and of the box along each axis. */
enum { SURFACE_POINTS = 8192, BOX_POINTS = 32 };

/* Of a surface over leaves of side h, with the areas A that it has along the three axes,
 * and of a solid with the volume V: A / h² elements are in the layer, and 5.6 times as
 * many times t / (t + 2), with t = V / (A h), behind it, where leaves become larger.
 * Fitted to the meshes of 16 surfaces, levels 3 to 7. */
static const double behind_layer = 5.6, half_of_that = 2;

typedef struct {
    const tm_surface *surface;
    const tm_octree_rule *rule; /* with levels */
    size_t rules;
    double side;                  /* of root cubes */
    double coarser;               /* times larger are leaves to be */
    double area;                  /* of the surface, along the three axes together */
    double volume;                /* of the solid */
    double layer, behind, filled; /* elements */
    double smallest;
} estimator;

double tm_octree_least_size(const tm_octree_rule *rule, size_t rules)
{
    double least = 0;
    for (size_t r = 0; r < rules; r++)
        if (rule[r].size > 0 && (least == 0 || rule[r].size < least))
            least = rule[r].size;
    return least;
}

unsigned tm_octree_rule_level(const tm_octree_rule *rule, double side)
{
    const double rounding = 1e-9;
    if (!(rule->size > 0))
        return rule->level;
    const double halved = log2(side / rule->size) - rounding;
    return halved > 0 ? (unsigned)fmin(ceil(halved), TM_OCTREE_FINEST) : 0;
}

tm_status tm_octree_set_levels(const tm_octree_rule *rule, size_t rules, double side,
                               tm_octree_rule *out, tm_error *error)
{
    for (size_t r = 0; r < rules; r++) {
        out[r] = rule[r];
        out[r].level = tm_octree_rule_level(&rule[r], side);
        if (rule[r].size > 0 && out[r].level > TM_OCTREE_LEVEL_MAX)
            return tm_fail(error, TM_ERROR_INPUT,
                           "leaves of %g are too small for the surface (%g is the "
                           "least for it)",
                           rule[r].size, ldexp(side, -TM_OCTREE_LEVEL_MAX));
    }
    return TM_OK;
}

/* Whether a rule that is not for the surface holds at a point. */
static bool holds(const tm_octree_rule *rule, const double point[3])
{
    switch (rule->kind) {
    case TM_RULE_EVERYTHING:
        return true;
    case TM_RULE_BOX:
        for (int i = 0; i < 3; i++)
            if (point[i] < rule->low[i] || point[i] > rule->high[i])
                return false;
        return true;
    case TM_RULE_REGION:
        return tm_surface_has_inside(rule->region, point);
    default:
        return false;
    }
}

/* The level that a rule for the surface asks for at a point of a triangle of it. Where it
 * has larger leaves for what bends less, thin parts have none, as in descent.c. */
static unsigned level_at(const estimator *e, const tm_octree_rule *rule, size_t t,
                         const double point[3])
{
    if (!rule->largest)
        return rule->level;
    const unsigned spread = rule->spread + TM_CROWDED_LEVELS - 1;
    unsigned crowded = 0, level = rule->level > spread ? rule->level - spread : 0;
    for (; level < rule->level; level++) {
        const double side = ldexp(e->side, -(int)level);
        if (tm_octant_is_thin_at(e->surface, (uint32_t)t, point, e->coarser * side))
            crowded = TM_CROWDED_LEVELS;
        if (crowded == 0 && level + rule->spread >= rule->level &&
            side <= rule->largest[t])
            break;
        crowded -= crowded > 0;
    }
    return level;
}

/* The side of the leaves at a point, on triangle t of the surface or, for TM_NONE, not.
 */
static double side_at(estimator *e, const double point[3], size_t t)
{
    unsigned level = 0;
    for (size_t r = 0; r < e->rules; r++) {
        const tm_octree_rule *rule = &e->rule[r];
        if (rule->level <= level)
            continue;
        if (rule->kind == TM_RULE_SURFACE && t != TM_NONE) {
            const unsigned at = level_at(e, rule, t, point);
            level = at > level ? at : level;
        } else if (holds(rule, point))
            level = rule->level;
    }
    const double side = ldexp(e->side, -(int)level);
    e->smallest = fmin(e->smallest, side);
    return side;
}

/* The area of a triangle along each axis, all together. */
static double area_of(const tm_surface *s, size_t t)
{
    double normal[3];
    const uint32_t *v = s->triangle[t];
    tm_triangle_normal(normal, s->xyz[v[0]], s->xyz[v[1]], s->xyz[v[2]]);
    return (fabs(normal[0]) + fabs(normal[1]) + fabs(normal[2])) / 2;
}

static void measure(estimator *e)
{
    const tm_surface *s = e->surface;
    double six_volumes = 0;
    for (size_t t = 0; t < s->triangles; t++) {
        double p[3][3];
        for (int c = 0; c < 3; c++)
            tm_subtract(p[c], s->xyz[s->triangle[t][c]], s->low);
        double cross[3];
        tm_cross(cross, p[1], p[2]);
        if (!s->walls || s->side[t][0] == 0) /* others are inside */
            six_volumes += tm_dot(p[0], cross);
        e->area += area_of(s, t);
    }
    e->volume = fabs(six_volumes) / 6;
}

/* The point of a triangle that is number k of a sequence that fills it evenly. */
static void point_of(const tm_surface *s, size_t t, size_t k, double point[3])
{
    /* M. Roberts, The unreasonable effectiveness of quasirandom sequences, 2018. */
    const double step[2] = {0.7548776662466927, 0.5698402909980532};
    double u = fmod(0.5 + step[0] * (double)k, 1), v = fmod(0.5 + step[1] * (double)k, 1);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    const uint32_t *n = s->triangle[t];
    for (int i = 0; i < 3; i++)
        point[i] = s->xyz[n[0]][i] + u * (s->xyz[n[1]][i] - s->xyz[n[0]][i]) +
                   v * (s->xyz[n[2]][i] - s->xyz[n[0]][i]);
}

static void count_surface(estimator *e)
{
    for (size_t t = 0; t < e->surface->triangles; t++) {
        const double area = area_of(e->surface, t);
        const double share = SURFACE_POINTS * area / e->area;
        const size_t points = share > 1 ? (size_t)share : 1;
        for (size_t k = 0; k < points && area > 0; k++) {
            double point[3];
            point_of(e->surface, t, k, point);
            const double side = e->coarser * side_at(e, point, t);
            const double in_layer = area / (double)points / (side * side);
            const double thickness = e->volume / (e->area * side);
            e->layer += in_layer;
            e->behind += in_layer * behind_layer * thickness / (thickness + half_of_that);
        }
    }
}

static bool has_part(const estimator *e)
{
    for (size_t r = 0; r < e->rules; r++)
        if (e->rule[r].kind == TM_RULE_BOX || e->rule[r].kind == TM_RULE_REGION)
            return true;
    return false;
}

/* What rules that are not for the surface make of the solid: points of its box that are
 * inside stand for equal parts of the volume. */
static void count_volume(estimator *e)
{
    const tm_surface *s = e->surface;
    const unsigned along = has_part(e) ? BOX_POINTS : 1;
    size_t points = 0;
    double filled = 0;
    for (size_t k = 0; k < (size_t)along * along * along; k++) {
        const size_t at[3] = {k % along, k / along % along, k / along / along};
        double point[3];
        for (int i = 0; i < 3; i++)
            point[i] = s->low[i] +
                       (s->high[i] - s->low[i]) * ((double)at[i] + 0.5) / (double)along;
        if (along > 1 && !tm_surface_has_mesh(s, point))
            continue;
        const double side = e->coarser * side_at(e, point, TM_NONE);
        points++;
        filled += 1 / (side * side * side);
    }
    e->filled = points > 0 ? filled * e->volume / (double)points : 0;
}

tm_status tm_octree_estimate(const tm_surface *surface, const tm_octree_rule *rule,
                             size_t rules, double coarser, double *elements, double *side,
                             tm_error *error)
{
    estimator e = {.surface = surface, .rules = rules, .coarser = coarser};
    tm_octree_rule *levels = tm_new(rules, sizeof *levels);
    if (!levels)
        return tm_fail_memory(error);
    e.side = e.smallest =
        tm_brick_side(surface->low, surface->high, tm_octree_least_size(rule, rules));
    const tm_status status = tm_octree_set_levels(rule, rules, e.side, levels, error);
    if (status == TM_OK) {
        e.rule = levels;
        measure(&e);
        count_surface(&e);
        count_volume(&e);
        *elements = e.layer + fmax(e.behind, e.filled);
        *side = coarser * e.smallest;
    }
    free(levels);
    return status;
}

/* Whether a box around one of the triangles of the first surface meets the second. */
static bool come_close(const tm_surface *first, const tm_surface *second)
{
    for (size_t t = 0; t < first->triangles; t++) {
        double low[3], high[3];
        const uint32_t *v = first->triangle[t];
        for (int i = 0; i < 3; i++) {
            const double a = first->xyz[v[0]][i], b = first->xyz[v[1]][i],
                         c = first->xyz[v[2]][i];
            low[i] = fmin(a, fmin(b, c));
            high[i] = fmax(a, fmax(b, c));
        }
        if (tm_surface_meets_box(second, low, high))
            return true;
    }
    return false;
}

/* Whether a shell of the first surface, which does not meet the second, is in that. */
static bool has_shell_in(const tm_surface *first, const tm_surface *second)
{
    uint32_t shells = 0; /* their first triangles come in order */
    for (size_t t = 0; t < first->triangles; t++) {
        if (first->shell[t] < shells)
            continue;
        shells = first->shell[t] + 1;
        if (tm_surface_has_mesh(second, first->xyz[first->triangle[t][0]]))
            return true;
    }
    return false;
}

bool tm_octree_rule_reaches(const tm_octree_rule *rule, const tm_surface *surface)
{
    if (rule->kind == TM_RULE_BOX)
        return tm_surface_meets_box(surface, rule->low, rule->high) ||
               tm_surface_has_mesh(surface, rule->low);
    if (rule->kind == TM_RULE_REGION)
        return come_close(rule->region, surface) || has_shell_in(rule->region, surface) ||
               has_shell_in(surface, rule->region);
    return true;
}
