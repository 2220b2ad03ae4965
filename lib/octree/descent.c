/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "descent.h"

#include "../base/array.h"
#include "scratch_meets.h"

#include <stdlib.h>

typedef enum side { UNKNOWN, INSIDE, OUTSIDE } side;

/* What of one surface meets an octant: a part of the source's stack of triangles. Where
 * it is empty, `where` says on which side of the surface the octant is. */
typedef struct part {
    size_t start;
    size_t count;
    side where;
} part;

typedef struct octant {
    uint32_t anchor[3];
    unsigned level;
    double low[3], high[3];
    part *part; /* [sources] */
} octant;

/* A surface that rules ask about: source 0 is the octree's, the others are regions. */
typedef struct source {
    const tm_surface *surface;
    size_t room;
    uint32_t
        *triangle; /* stack: of the octants on the way down, each behind its parent's */
} source;

typedef struct descent {
    const tm_octree *octree;
    const tm_octree_rule *rule;
    size_t rules;
    size_t *source_of; /* [rules] */
    size_t sources;
    source *source;
    unsigned deepest; /* level of a rule */
    part *part;       /* [TM_OCTREE_FINEST][sources] */
    tm_leaf_list *leaves;
    tm_error *error;
} descent;

/* The triangles that meet the octant, of those that meet its parent. */
static tm_status cull(descent *d, octant *o, size_t s, const part *parent)
{
    part *own = &o->part[s];
    *own = (part){.start = parent->start + parent->count, .where = parent->where};
    if (parent->count == 0)
        return TM_OK;
    source *from = &d->source[s];
    const size_t needed = own->start + parent->count;
    if (needed > from->room) {
        uint32_t *grown =
            tm_grow(from->triangle, &from->room, needed, sizeof *from->triangle);
        if (!grown)
            return tm_fail_memory(d->error);
        from->triangle = grown;
    }
    /* That some triangle is there is all that is asked of the deepest. */
    const size_t enough = o->level >= d->deepest ? 1 : parent->count;
    own->count =
        scratch_cull(from->surface, from->triangle + parent->start, parent->count, o->low,
                     o->high, enough, from->triangle + own->start);
    return TM_OK;
}

static bool meets_or_inside(const descent *d, octant *o, size_t s)
{
    part *own = &o->part[s];
    if (own->count > 0)
        return true;
    if (own->where == UNKNOWN) {
        double centre[3];
        for (int i = 0; i < 3; i++)
            centre[i] = (o->low[i] + o->high[i]) / 2;
        own->where =
            tm_surface_has_inside(d->source[s].surface, centre) ? INSIDE : OUTSIDE;
    }
    return own->where == INSIDE;
}

static bool meets_box(const octant *o, const tm_octree_rule *box)
{
    for (int i = 0; i < 3; i++)
        if (o->high[i] < box->low[i] || box->high[i] < o->low[i])
            return false;
    return true;
}

static bool holds(const descent *d, octant *o, size_t r)
{
    switch (d->rule[r].kind) {
    case TM_RULE_EVERYTHING:
        return true;
    case TM_RULE_SURFACE:
        return o->part[0].count > 0;
    case TM_RULE_BOX:
        return meets_box(o, &d->rule[r]);
    case TM_RULE_REGION:
        return meets_or_inside(d, o, d->source_of[r]);
    default:
        return false;
    }
}

static bool wants_split(const descent *d, octant *o)
{
    if (o->level >= d->deepest)
        return false;
    for (size_t r = 0; r < d->rules; r++)
        if (o->level < d->rule[r].level && holds(d, o, r))
            return meets_or_inside(d, o, 0);
    return false;
}

static tm_status visit(descent *d, octant *o)
{
    if (!wants_split(d, o))
        return tm_leaf_list_add(d->leaves, o->anchor, o->level, o->part[0].count > 0,
                                d->error);
    octant child = {.level = o->level + 1, .part = o->part + d->sources};
    tm_status status = TM_OK;
    for (unsigned c = 0; c < 8 && status == TM_OK; c++) {
        tm_octree_child(o->anchor, o->level, c, child.anchor);
        tm_octree_box(d->octree, child.anchor, child.level, child.low, child.high);
        for (size_t s = 0; s < d->sources && status == TM_OK; s++)
            status = cull(d, &child, s, &o->part[s]);
        if (status == TM_OK)
            status = visit(d, &child);
    }
    return status;
}

/* A root: the parent of its lists is the list of all triangles. */
static tm_status visit_root(descent *d, const uint32_t place[3])
{
    octant o = {.level = 0, .part = d->part};
    for (int i = 0; i < 3; i++)
        o.anchor[i] = place[i] << TM_OCTREE_FINEST;
    tm_octree_box(d->octree, o.anchor, 0, o.low, o.high);
    tm_status status = TM_OK;
    for (size_t s = 0; s < d->sources && status == TM_OK; s++) {
        const part all = {.count = d->source[s].surface->triangles};
        status = cull(d, &o, s, &all);
    }
    return status == TM_OK ? visit(d, &o) : status;
}

static tm_status start_source(descent *d, const tm_surface *surface, size_t *number)
{
    source *next = &d->source[d->sources];
    *number = d->sources++;
    *next = (source){.surface = surface, .room = surface->triangles};
    next->triangle = tm_new(surface->triangles, sizeof *next->triangle);
    if (!next->triangle)
        return tm_fail_memory(d->error);
    for (uint32_t t = 0; t < surface->triangles; t++)
        next->triangle[t] = t;
    return TM_OK;
}

static tm_status start(descent *d, const tm_surface *surface)
{
    d->source = calloc(d->rules + 1, sizeof *d->source);
    d->source_of = calloc(d->rules + 1, sizeof *d->source_of);
    if (!d->source || !d->source_of)
        return tm_fail_memory(d->error);
    size_t number = 0;
    tm_status status = start_source(d, surface, &number);
    for (size_t r = 0; r < d->rules && status == TM_OK; r++) {
        const tm_octree_rule *rule = &d->rule[r];
        if (rule->kind == TM_RULE_LEAVES)
            continue;
        if (rule->level > TM_OCTREE_LEVEL_MAX)
            return tm_fail(d->error, TM_ERROR_INPUT, "level %u is too deep (0..%d)",
                           rule->level, TM_OCTREE_LEVEL_MAX);
        if (rule->level > d->deepest)
            d->deepest = rule->level;
        if (rule->kind == TM_RULE_REGION)
            status = start_source(d, rule->region, &d->source_of[r]);
    }
    if (status != TM_OK)
        return status;
    d->part = tm_new((TM_OCTREE_FINEST + 1) * d->sources, sizeof *d->part);
    return d->part ? TM_OK : tm_fail_memory(d->error);
}

tm_status tm_octree_descend(tm_leaf_list *leaves, const tm_octree *octree,
                            const tm_brick *brick, const tm_surface *surface,
                            const tm_octree_rule *rule, size_t rules, tm_error *error)
{
    descent d = {
        .octree = octree, .rule = rule, .rules = rules, .leaves = leaves, .error = error};
    tm_status status = start(&d, surface);
    for (size_t r = 0; r < brick->count && status == TM_OK; r++)
        status = visit_root(&d, brick->root[r]);
    for (size_t s = 0; s < d.sources; s++)
        free(d.source[s].triangle);
    free(d.source);
    free(d.source_of);
    free(d.part);
    return status;
}
