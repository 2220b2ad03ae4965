/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "feature_parts.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In sides of leaves: the largest extent of a group that is left out, and of one that is
 * most of a shell; and the length of a free end that is. */
static const double small_group = 3, small_shell = 2, short_end = 2;

/* A group of this part of the extent of the surface stays all the same; one of this part
 * of the extent of its shell is most of that. */
static const double large_group = 0.5;

typedef struct {
    const tm_surface *surface;
    const double *size;
    tm_feature_choice *choice;
    uint32_t *parent;       /* [corners]: those joined by curves as sets */
    double (*box)[6];       /* [corners]: of the group at its root: low, high */
    uint32_t *degree;       /* [corners]: chosen curves that end there */
    double (*shell_box)[6]; /* [shells] */
    uint32_t *shell_of;     /* [nodes]: one of those that have it */
} chooser;

/* The corner where a curve begins or ends; TM_NONE of a closed one. */
static uint32_t end_of(const chooser *c, size_t curve, int end)
{
    const tm_surface *s = c->surface;
    const size_t at = end ? s->curve_start[curve + 1] - 1 : s->curve_start[curve];
    return c->choice->corner_of[s->curve_node[at]];
}

static void stretch(double box[6], const double point[3])
{
    for (int i = 0; i < 3; i++) {
        box[i] = fmin(box[i], point[i]);
        box[3 + i] = fmax(box[3 + i], point[i]);
    }
}

static double extent(const double box[6])
{
    return fmax(box[3] - box[0], fmax(box[4] - box[1], box[5] - box[2]));
}

static const double nothing[6] = {INFINITY,  INFINITY,  INFINITY,
                                  -INFINITY, -INFINITY, -INFINITY};

static void curve_box(const tm_surface *s, size_t curve, double box[6])
{
    memcpy(box, nothing, sizeof nothing);
    for (size_t i = s->curve_start[curve]; i < s->curve_start[curve + 1]; i++)
        stretch(box, s->xyz[s->curve_node[i]]);
}

static void find_shells(chooser *c)
{
    const tm_surface *s = c->surface;
    for (size_t k = 0; k < s->components; k++)
        memcpy(c->shell_box[k], nothing, sizeof nothing);
    for (size_t t = 0; t < s->triangles; t++)
        for (int i = 0; i < 3; i++) {
            c->shell_of[s->triangle[t][i]] = s->shell[t];
            stretch(c->shell_box[s->shell[t]], s->xyz[s->triangle[t][i]]);
        }
}

/* Below which extent a group is left out; one that has the curve. */
static double least_extent(const chooser *c, size_t curve, double extent_of_all)
{
    const tm_surface *s = c->surface;
    const uint32_t shell = c->shell_of[s->curve_node[s->curve_start[curve]]];
    const double own = large_group * extent(c->shell_box[shell]);
    const double least = fmin(small_group * c->size[curve], large_group * extent_of_all);
    return fmin(least, fmax(own, small_shell * c->size[curve]));
}

/* Leaves out what is small as a whole. */
static void drop_groups(chooser *c)
{
    const tm_surface *s = c->surface;
    for (size_t k = 0; k < s->corners; k++) {
        c->parent[k] = (uint32_t)k;
        for (int i = 0; i < 3; i++)
            c->box[k][i] = c->box[k][3 + i] = s->xyz[s->corner[k]][i];
    }
    for (size_t curve = 0; curve < s->curves; curve++) {
        const uint32_t from = end_of(c, curve, 0), to = end_of(c, curve, 1);
        if (from == TM_NONE || to == TM_NONE)
            continue;
        double box[6];
        const uint32_t a = tm_set_root(c->parent, from), b = tm_set_root(c->parent, to);
        curve_box(s, curve, box);
        stretch(c->box[a], box);
        stretch(c->box[a], box + 3);
        stretch(c->box[a], c->box[b]);
        stretch(c->box[a], c->box[b] + 3);
        c->parent[b] = a;
    }
    const double whole[6] = {s->low[0],  s->low[1],  s->low[2],
                             s->high[0], s->high[1], s->high[2]};
    for (size_t curve = 0; curve < s->curves; curve++) {
        const uint32_t from = end_of(c, curve, 0);
        double box[6];
        if (from == TM_NONE)
            curve_box(s, curve, box);
        else
            memcpy(box, c->box[tm_set_root(c->parent, from)], sizeof box);
        c->choice->curve[curve] = tm_curve_is_of_walls(s, curve) ||
                                  extent(box) >= least_extent(c, curve, extent(whole));
    }
}

/* Leaves out short curves with a free end; that may free the next one's. */
static void drop_ends(chooser *c)
{
    const tm_surface *s = c->surface;
    for (size_t curve = 0; curve < s->curves; curve++)
        for (int end = 0; c->choice->curve[curve] && end < 2; end++)
            if (end_of(c, curve, end) != TM_NONE)
                c->degree[end_of(c, curve, end)]++;
    for (bool more = true; more;) {
        more = false;
        for (size_t curve = 0; curve < s->curves; curve++) {
            const uint32_t from = end_of(c, curve, 0), to = end_of(c, curve, 1);
            if (tm_curve_is_of_walls(s, curve) || !c->choice->curve[curve] ||
                from == TM_NONE || to == TM_NONE ||
                (c->degree[from] > 1 && c->degree[to] > 1) ||
                s->curve_length[curve] >= short_end * c->size[curve])
                continue;
            c->choice->curve[curve] = false;
            c->degree[from]--;
            c->degree[to]--;
            more = true;
        }
    }
}

/* A corner without any curve is a tip. */
static void choose_corners(chooser *c)
{
    const tm_surface *s = c->surface;
    for (size_t k = 0; k < s->corners; k++)
        c->choice->corner[k] = true;
    for (size_t curve = 0; curve < s->curves; curve++)
        for (int end = 0; end < 2; end++) {
            const uint32_t corner = end_of(c, curve, end);
            if (corner != TM_NONE && c->degree[corner] == 0)
                c->choice->corner[corner] = false;
        }
}

tm_status tm_feature_choose(tm_feature_choice *choice, const tm_surface *surface,
                            const double *size, tm_error *error)
{
    *choice = (tm_feature_choice){.curve = calloc(surface->curves + 1, 1),
                                  .corner = calloc(surface->corners + 1, 1),
                                  .corner_of = tm_new(surface->nodes, sizeof(uint32_t))};
    chooser c = {surface,
                 size,
                 choice,
                 tm_new(surface->corners, sizeof *c.parent),
                 tm_new(surface->corners, sizeof *c.box),
                 calloc(surface->corners + 1, sizeof *c.degree),
                 tm_new(surface->components, sizeof *c.shell_box),
                 tm_new(surface->nodes, sizeof *c.shell_of)};
    const bool ok = choice->curve && choice->corner && choice->corner_of && c.parent &&
                    c.box && c.degree && c.shell_box && c.shell_of;
    if (ok) {
        for (size_t n = 0; n < surface->nodes; n++)
            choice->corner_of[n] = TM_NONE;
        for (size_t k = 0; k < surface->corners; k++)
            choice->corner_of[surface->corner[k]] = (uint32_t)k;
        find_shells(&c);
        drop_groups(&c);
        drop_ends(&c);
        choose_corners(&c);
    }
    free(c.parent);
    free(c.box);
    free(c.degree);
    free(c.shell_box);
    free(c.shell_of);
    return ok ? TM_OK : tm_fail_memory(error);
}

void tm_feature_choice_free(tm_feature_choice *choice)
{
    free(choice->curve);
    free(choice->corner);
    free(choice->corner_of);
    *choice = (tm_feature_choice){0};
}
