/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_parts.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

enum { CHILDREN = 8, BATCH = 4, SHIFTS = 32 };

typedef enum side { UNKNOWN, INSIDE, OUTSIDE } side;

/* What of one surface meets an octant: a part of the source's stack of triangles. Where
 * it is empty, `where` says on which side of the surface the octant is. */
typedef struct part {
    size_t start;
    size_t count;
    side where;
} part;

/* A cube of 2^shift units: of the octree, or of several roots. */
typedef struct octant {
    uint32_t anchor[3];
    unsigned shift;
    double low[3], high[3];
    unsigned crowded; /* levels that are still to come because it, or what it is in, is:
                         see is_large() */
    part *part;       /* [sources] */
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
    bool *is_corner;      /* [nodes of the octree's surface] */
    unsigned shift;       /* of the deepest octants that may be */
    part *part;           /* [SHIFTS][sources]: of the octants on the way down */
    tm_leaf_list *leaves; /* that are made, or NULL: */
    tm_leaf *given;       /* the leaves that are there, from the next one on */
    bool together;        /* ranks share the tasks */
    bool cuts;            /* octants of some depth become tasks */
    size_t tasks, task_room;
    struct task *task;
    size_t found; /* leaves of tasks that are done: none is begun where they are many */
    tm_error *error;
} descent;

/* An octant that is visited by itself, at the same time as others, with what it needs of
 * the one that it is in; and the leaves that it has. */
typedef struct task {
    octant octant;
    uint32_t **triangle; /* [sources] */
    tm_leaf_list leaves;
    tm_leaf *given;
    bool own; /* this rank does it, if not all do all */
    tm_status status;
    tm_error error;
} task;

/* Octants of tasks are so many levels below the cube that has all roots. */
enum { TASK_DEPTH = 4 };

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
    const uint32_t *given = from->triangle + parent->start;
    uint32_t *kept = from->triangle + own->start;
    /* Of the deepest all that is asked is whether there are any. */
    const size_t batch = o->shift <= d->shift ? (size_t)BATCH : parent->count;
    for (size_t i = 0; i < parent->count && own->count == 0; i += batch)
        own->count = tm_surface_cull(
            from->surface, given + i,
            batch < parent->count - i ? batch : parent->count - i, o->low, o->high, kept);
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
        own->where = tm_surface_has_mesh(d->source[s].surface, centre) ? INSIDE : OUTSIDE;
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

/* Whether an octant has more of the surface than it can hold; what is in one that has
 * gets more levels, as far as those of its rule go. */
static bool is_crowded(const descent *d, octant *o, bool deep)
{
    const part *own = &o->part[0];
    const source *from = &d->source[0];
    if (tm_octant_is_crowded(from->surface, d->is_corner, from->triangle + own->start,
                             own->count, o->low, o->high[0] - o->low[0]))
        o->crowded = deep ? 1 : TM_CROWDED_LEVELS;
    return o->crowded > 0;
}

/* Whether an octant is too large for a triangle that it meets, or for all together. */
static bool is_large(const descent *d, octant *o, const tm_octree_rule *rule)
{
    const part *own = &o->part[0];
    const unsigned level = TM_OCTREE_FINEST - o->shift;
    if (own->count == 0)
        return false;
    if (level >= rule->level)
        return is_crowded(d, o, true);
    if (!rule->largest)
        return true;
    if ((level + rule->spread + TM_CROWDED_LEVELS > rule->level &&
         is_crowded(d, o, false)) ||
        level + rule->spread < rule->level)
        return true;
    for (size_t i = 0; i < own->count; i++)
        if (o->high[0] - o->low[0] > rule->largest[d->source[0].triangle[own->start + i]])
            return true;
    return false;
}

static bool holds(const descent *d, octant *o, size_t r)
{
    switch (d->rule[r].kind) {
    case TM_RULE_EVERYTHING:
        return true;
    case TM_RULE_SURFACE:
        return is_large(d, o, &d->rule[r]);
    case TM_RULE_BOX:
        return meets_box(o, &d->rule[r]);
    case TM_RULE_REGION:
        return meets_or_inside(d, o, d->source_of[r]);
    default:
        return false;
    }
}

static bool rules_split(const descent *d, octant *o)
{
    if (o->shift <= d->shift)
        return false;
    const unsigned level = TM_OCTREE_FINEST - o->shift;
    for (size_t r = 0; r < d->rules; r++)
        if (level < d->rule[r].level + d->rule[r].deeper && holds(d, o, r))
            return meets_or_inside(d, o, 0);
    return false;
}

static bool is_split(const descent *d, octant *o)
{
    if (o->shift > TM_OCTREE_FINEST)
        return true;
    return d->leaves ? rules_split(d, o) : o->shift > tm_leaf_shift(d->given);
}

static tm_status take_leaf(descent *d, const octant *o)
{
    const bool crossed = o->part[0].count > 0;
    if (d->leaves)
        return tm_leaf_list_add(d->leaves, o->anchor, TM_OCTREE_FINEST - o->shift,
                                crossed, d->error);
    d->given->crossed = crossed;
    d->given++;
    return TM_OK;
}

static bool outside_brick(const descent *d, const octant *o)
{
    for (int i = 0; i < 3; i++)
        if (o->anchor[i] >> TM_OCTREE_FINEST >= d->octree->roots[i])
            return true;
    return false;
}

static tm_status add_task(descent *d, const octant *o);

static tm_status visit(descent *d, octant *o)
{
    if (d->cuts && o->shift + TASK_DEPTH <= tm_octree_shift(d->octree))
        return add_task(d, o);
    if (!is_split(d, o))
        return d->cuts ? add_task(d, o) : take_leaf(d, o);
    octant child = {.shift = o->shift - 1, .part = o->part + d->sources};
    tm_status status = TM_OK;
    for (unsigned c = 0; c < CHILDREN && status == TM_OK; c++) {
        tm_octree_child(o->anchor, o->shift, c, child.anchor);
        if (outside_brick(d, &child))
            continue;
        tm_octree_box(d->octree, child.anchor, child.shift, child.low, child.high);
        child.crowded = o->crowded > 0 ? o->crowded - 1 : 0;
        for (size_t s = 0; s < d->sources && status == TM_OK; s++)
            status = cull(d, &child, s, &o->part[s]);
        if (status == TM_OK)
            status = visit(d, &child);
    }
    return status;
}

/* Leaves that are in an octant; they are in order. */
static size_t count_within(const descent *d, const octant *o)
{
    const tm_leaf *end = d->octree->leaf + d->octree->leaves;
    size_t count = 0;
    for (const tm_leaf *leaf = d->given; leaf < end; leaf++, count++)
        for (int i = 0; i < 3; i++)
            if (leaf->anchor[i] >> o->shift != o->anchor[i] >> o->shift)
                return count;
    return count;
}

/* Notes an octant; the leaves that are given go on behind those that it has. */
static tm_status add_task(descent *d, const octant *o)
{
    task *grown = tm_grow(d->task, &d->task_room, d->tasks + 1, sizeof *grown);
    if (!grown)
        return tm_fail_memory(d->error);
    d->task = grown;
    task *t = &grown[d->tasks++];
    *t = (task){.octant = *o, .given = d->given};
    t->octant.part = tm_new(SHIFTS * d->sources, sizeof *t->octant.part);
    t->triangle = calloc(d->sources, sizeof *t->triangle);
    if (!t->octant.part || !t->triangle)
        return tm_fail_memory(d->error);
    for (size_t s = 0; s < d->sources; s++) {
        const part *of = &o->part[s];
        t->octant.part[s] = (part){.count = of->count, .where = of->where};
        t->triangle[s] = tm_new(of->count, sizeof **t->triangle);
        if (!t->triangle[s])
            return tm_fail_memory(d->error);
        memcpy(t->triangle[s], d->source[s].triangle + of->start,
               of->count * sizeof **t->triangle);
    }
    if (!d->leaves)
        d->given += count_within(d, o);
    return TM_OK;
}

static void make_task(void *context, size_t i)
{
    descent *all = context;
    task *t = &all->task[i];
    if (all->together && !t->own)
        return;
    descent d = {.octree = all->octree,
                 .rule = all->rule,
                 .rules = all->rules,
                 .source_of = all->source_of,
                 .sources = all->sources,
                 .is_corner = all->is_corner,
                 .shift = all->shift,
                 .part = t->octant.part,
                 .leaves = all->leaves ? &t->leaves : NULL,
                 .given = t->given,
                 .error = &t->error};
    t->status =
        tm_leaf_list_check(__atomic_load_n(&all->found, __ATOMIC_RELAXED), d.error);
    d.source = t->status == TM_OK ? tm_new(d.sources, sizeof *d.source) : NULL;
    if (!d.source) {
        t->status = t->status == TM_OK ? tm_fail_memory(d.error) : t->status;
        return;
    }
    for (size_t s = 0; s < d.sources; s++)
        d.source[s] = (source){.surface = all->source[s].surface,
                               .room = t->octant.part[s].count,
                               .triangle = t->triangle[s]};
    t->status = visit(&d, &t->octant);
    for (size_t s = 0; s < d.sources; s++)
        t->triangle[s] = d.source[s].triangle;
    free(d.source);
    __atomic_fetch_add(&all->found, t->leaves.count, __ATOMIC_RELAXED);
}

/* Appends the leaves of a task. */
static tm_status join_task(const descent *d, const task *t)
{
    tm_status status = t->status;
    if (status != TM_OK)
        return tm_fail_as(d->error, &t->error);
    return d->leaves ? tm_leaf_list_append(d->leaves, &t->leaves, d->error) : TM_OK;
}

static void free_tasks(const descent *d)
{
    for (size_t i = 0; i < d->tasks; i++) {
        task *t = &d->task[i];
        for (size_t s = 0; t->triangle && s < d->sources; s++)
            free(t->triangle[s]);
        free(t->triangle);
        free(t->octant.part);
        free(t->leaves.leaf);
    }
    free(d->task);
}

static tm_status join_tasks(const descent *d)
{
    tm_status status = TM_OK;
    for (size_t i = 0; status == TM_OK && i < d->tasks; i++)
        status = join_task(d, &d->task[i]);
    return status;
}

/* The work that a task may be: those with surface are as large as each other, too. */
static size_t task_weight(const task *t)
{
    const size_t crossed = 64, other = 4, triangles = t->octant.part[0].count;
    return triangles > 0 ? crossed + triangles : other;
}

/* Of ranks each keeps those that are next to each other of the tasks. */
static void keep_own_tasks(descent *d)
{
    size_t all = 0, before = 0;
    for (size_t i = 0; i < d->tasks; i++)
        all += task_weight(&d->task[i]);
    for (size_t i = 0; i < d->tasks; i++) {
        task *t = &d->task[i];
        t->own = tm_rank_of_weight(before, all, tm_ranks_count()) == tm_rank();
        before += task_weight(t);
    }
}

/* A cube that has all roots is met by all triangles. p4est has the roots in Z order too.
 * Large octants are visited one after the other, what is in those at the same time. */
static tm_status visit_brick(descent *d)
{
    octant o = {.shift = tm_octree_shift(d->octree), .part = d->part};
    tm_octree_box(d->octree, o.anchor, o.shift, o.low, o.high);
    for (size_t s = 0; s < d->sources; s++)
        o.part[s] = (part){.count = d->source[s].surface->triangles};
    d->cuts = true;
    tm_status status = visit(d, &o);
    if (d->together)
        status = tm_ranks_agree(status, d->error);
    if (status == TM_OK && d->together)
        keep_own_tasks(d);
    if (status == TM_OK)
        tm_parallel(d->octree->threads, d->tasks, make_task, d);
    if (status == TM_OK)
        status = join_tasks(d);
    if (d->together)
        status = tm_ranks_agree(status, d->error);
    free_tasks(d);
    return status;
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

static tm_status start_rule(descent *d, size_t r)
{
    const tm_octree_rule *rule = &d->rule[r];
    if (rule->kind == TM_RULE_LEAVES)
        return TM_OK;
    if (rule->level > TM_OCTREE_LEVEL_MAX)
        return tm_fail(d->error, TM_ERROR_INPUT, "level %u is too deep (0..%d)",
                       rule->level, TM_OCTREE_LEVEL_MAX);
    const unsigned deepest = rule->level + rule->deeper < TM_OCTREE_LEVEL_MAX
                                 ? rule->level + rule->deeper
                                 : TM_OCTREE_LEVEL_MAX;
    if (TM_OCTREE_FINEST - deepest < d->shift)
        d->shift = TM_OCTREE_FINEST - deepest;
    if (rule->kind != TM_RULE_REGION)
        return TM_OK;
    return start_source(d, rule->region, &d->source_of[r]);
}

static tm_status start(descent *d, const tm_surface *surface)
{
    d->source = calloc(d->rules + 1, sizeof *d->source);
    d->source_of = calloc(d->rules + 1, sizeof *d->source_of);
    d->part = tm_new(SHIFTS * (d->rules + 1), sizeof *d->part);
    d->is_corner = calloc(surface->nodes + 1, sizeof *d->is_corner);
    if (!d->source || !d->source_of || !d->part || !d->is_corner)
        return tm_fail_memory(d->error);
    for (size_t k = 0; k < surface->corners; k++)
        d->is_corner[surface->corner[k]] = true;
    size_t number = 0;
    tm_status status = start_source(d, surface, &number);
    for (size_t r = 0; r < d->rules && status == TM_OK; r++)
        status = start_rule(d, r);
    return status;
}

static tm_status descend(descent *d, const tm_surface *surface)
{
    tm_status status = start(d, surface);
    if (d->together)
        status = tm_ranks_agree(status, d->error);
    if (status == TM_OK)
        status = visit_brick(d);
    for (size_t s = 0; s < d->sources; s++)
        free(d->source[s].triangle);
    free(d->source);
    free(d->source_of);
    free(d->part);
    free(d->is_corner);
    return status;
}

tm_status tm_octree_descend(tm_leaf_list *leaves, const tm_octree *octree,
                            const tm_surface *surface, const tm_octree_rule *rule,
                            size_t rules, bool together, tm_error *error)
{
    descent d = {.octree = octree,
                 .together = together,
                 .rule = rule,
                 .rules = rules,
                 .shift = TM_OCTREE_FINEST,
                 .leaves = leaves,
                 .error = error};
    return descend(&d, surface);
}

tm_status tm_octree_cross(tm_octree *octree, const tm_surface *surface, tm_error *error)
{
    descent d = {.octree = octree, .given = octree->leaf, .error = error};
    return descend(&d, surface);
}
