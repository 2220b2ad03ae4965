/* SPDX-License-Identifier: GPL-3.0-or-later */
/* adaptive_refinement.c on several ranks. */
#include "octree_mesh_ranks.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../ranks/ranks.h"
#include "../interior/interior_share.h"
#include "adaptive_refinement.h"
#include "octree_mesh_parts.h"
#include "skin.h"

#include <stdlib.h>
#include <string.h>

enum { RINGS = 1 };

typedef struct {
    tm_octree_mesh *mesh;
    tm_octree_share *share;
    tm_surface *surface;
    const tm_mesh_plan *plan;
    unsigned level, deepest; /* that is asked for, and that leaves may have */
    bool *alone;
} maker;

/* Unmarks leaves that are as deep as they may be, and ghosts; how many are left. */
static size_t keep_own(const maker *m, uint8_t *split)
{
    const tm_octree_share *s = m->share;
    size_t count = 0;
    for (size_t l = 0; l < s->octree.leaves; l++) {
        const bool own = l >= s->own_first && l < s->own_past;
        split[l] = split[l] && own && s->octree.leaf[l].level < m->deepest;
        count += split[l];
    }
    tm_ranks_sum(&count, 1);
    return count;
}

/* A set of nodes, and leaves at it. */
typedef struct {
    uint32_t label, count;
} leaf_set;

static int compare_sets(const void *a, const void *b)
{
    const leaf_set *s = a, *t = b;
    return (s->label > t->label) - (s->label < t->label);
}

/* The sets of all ranks' marked own leaves, by label, with how many these are. */
static tm_status count_sets(const maker *m, const bool *marked, const uint32_t *label,
                            leaf_set **sets, size_t *count, tm_error *error)
{
    const tm_octree_share *s = m->share;
    leaf_set *own = tm_new(s->own_past - s->own_first, sizeof *own);
    size_t listed = 0, joined = 0;
    void *got = NULL;
    tm_status status = tm_ranks_enough(own, error);
    for (size_t l = s->own_first; status == TM_OK && l < s->own_past; l++)
        if (marked[l])
            own[listed++] = (leaf_set){label[s->octree.node[l][0]], 1};
    if (status == TM_OK)
        status = tm_ranks_share(own, listed, sizeof *own, &got, &listed, error);
    leaf_set *all = *sets = got;
    if (status == TM_OK && listed > 0)
        qsort(all, listed, sizeof *all, compare_sets);
    for (size_t i = 0; status == TM_OK && i < listed; i++)
        if (joined > 0 && all[joined - 1].label == all[i].label)
            all[joined - 1].count++;
        else
            all[joined++] = all[i];
    *count = joined;
    free(own);
    return status;
}

static tm_status split_sets(const maker *m, const bool *marked, const uint32_t *label,
                            uint8_t *split, tm_error *error)
{
    const tm_octree_share *s = m->share;
    leaf_set *sets;
    size_t count;
    const tm_status status = count_sets(m, marked, label, &sets, &count, error);
    for (size_t l = s->own_first; status == TM_OK && l < s->own_past; l++) {
        const leaf_set key = {.label = label[s->octree.node[l][0]]};
        const leaf_set *of =
            marked[l] ? bsearch(&key, sets, count, sizeof *sets, compare_sets) : NULL;
        split[l] |= of && of->count >= TM_BEHIND_MANY;
    }
    free(sets);
    return status;
}

/* Marks those of the leaves behind a boundary of smaller ones where many touch. */
static tm_status mark_many(const maker *m, const bool *behind, uint8_t *split,
                           tm_error *error)
{
    const tm_octree *octree = &m->share->octree;
    uint32_t *parent = tm_new(octree->nodes, sizeof *parent);
    tm_status status = tm_ranks_enough(parent, error);
    for (size_t n = 0; status == TM_OK && n < octree->nodes; n++)
        parent[n] = (uint32_t)n;
    for (size_t l = 0; status == TM_OK && l < octree->leaves; l++)
        for (int p = 1; behind[l] && p < TM_LEAF_EDGE; p++)
            tm_set_unite(parent, octree->node[l][0], octree->node[l][p]);
    if (status == TM_OK)
        status = tm_share_join_sets(m->share, parent, error);
    if (status == TM_OK)
        status = split_sets(m, behind, parent, split, error);
    free(parent);
    return status;
}

static tm_status mark_behind(const maker *m, const tm_interior *interior, uint8_t *split,
                             tm_error *error)
{
    const tm_octree *octree = &m->share->octree;
    bool any = false, *behind = tm_new(octree->leaves, sizeof *behind);
    tm_status status = tm_ranks_enough(behind, error);
    if (status == TM_OK)
        any = tm_ranks_any(tm_interior_find_behind(interior, octree, m->level, behind));
    if (any)
        status = mark_many(m, behind, split, error);
    free(behind);
    return status;
}

/* What is to be split of a choice of leaves; *more says whether anything is. */
static tm_status mark_lost(const maker *m, const tm_interior *interior, uint8_t *split,
                           bool *more, tm_error *error)
{
    if (m->deepest > m->level)
        tm_interior_find_lost(interior, &m->share->octree, m->surface, split);
    const tm_status status = mark_behind(m, interior, split, error);
    *more = status == TM_OK && keep_own(m, split) > 0;
    return status;
}

static tm_status refine(const maker *m, const uint8_t *split, tm_error *error)
{
    tm_progress_stage(m->plan->progress, "splitting octants");
    return tm_octree_share_refine(m->share, m->surface, split, RINGS, error);
}

/* As make_without_loss() there. */
static tm_status make_without_loss(const maker *m, tm_error *error)
{
    const tm_progress *progress = m->plan->progress;
    tm_interior interior = {0};
    tm_status status = TM_OK;
    for (bool more = true; status == TM_OK && more;) {
        uint8_t *split = calloc(m->share->octree.leaves + 1, sizeof *split);
        tm_interior_free(&interior);
        tm_progress_stage(progress, "choosing octants");
        status = tm_ranks_enough(split, error);
        if (status == TM_OK)
            status = tm_interior_choose_on_ranks(&interior, m->share, m->surface, error);
        if (status == TM_OK)
            status = mark_lost(m, &interior, split, &more, error);
        if (status == TM_OK && more)
            status = refine(m, split, error);
        free(split);
    }
    if (status == TM_OK)
        status = tm_octree_mesh_make_on_ranks(m->mesh, m->share, &interior, m->surface,
                                              progress, m->alone, error);
    tm_interior_free(&interior);
    return status;
}

/* The leaves at boundary nodes that are off the surface, and their neighbours; *any says
 * whether there are some. */
static tm_status mark_off_surface(const maker *m, bool *near, uint8_t *split, bool *any,
                                  tm_error *error)
{
    const tm_octree_mesh *mesh = m->mesh;
    const tm_octree *octree = &m->share->octree;
    uint32_t *self = tm_new(octree->nodes, sizeof *self);
    tm_mesh_ghosts ghosts = {0};
    tm_status status = tm_ranks_enough(self, error);
    for (size_t n = 0; status == TM_OK && n < octree->nodes; n++)
        self[n] = (uint32_t)n;
    const uint32_t *const of_node[] = {self};
    if (status == TM_OK)
        status = tm_mesh_ghosts_find(&ghosts, m->share, of_node, 1, NULL, error);
    for (size_t s = 0; status == TM_OK && s < mesh->boundary.nodes; s++)
        near[mesh->boundary.grid_node[s]] = mesh->off_surface[s];
    for (int ring = 0; status == TM_OK && ring < 2; ring++) {
        tm_octree_mark_ring(octree, near, split);
        tm_mesh_ghosts_mark(&ghosts, near);
    }
    *any = status == TM_OK && keep_own(m, split) > 0;
    free(self);
    tm_mesh_ghosts_free(&ghosts);
    return status;
}

/* By how much pieces and Euler number of the boundary differ from the surface's. */
static uint64_t topology_missing(const maker *m)
{
    return tm_topology_missing(&m->mesh->report, m->surface);
}

/* As try_split() there: with a copy of the share. */
static tm_status try_split(maker *m, const uint8_t *split, bool *better, tm_error *error)
{
    tm_octree_mesh old = *m->mesh;
    const uint64_t missing = topology_missing(m);
    tm_octree_share before = {0};
    *m->mesh = (tm_octree_mesh){0};
    tm_status status =
        tm_ranks_agree(tm_octree_share_copy(&before, m->share, error), error);
    if (status == TM_OK)
        status = refine(m, split, error);
    if (status == TM_OK)
        status = make_without_loss(m, error);
    *better = status == TM_OK && !*m->alone &&
              m->mesh->report.off_surface < old.report.off_surface &&
              topology_missing(m) <= missing;
    if (status == TM_OK && !*m->alone && !*better) {
        const tm_octree_share finer = *m->share;
        const tm_octree_mesh worse = *m->mesh;
        *m->share = before;
        *m->mesh = old;
        before = finer;
        old = worse;
    }
    tm_octree_mesh_free(&old);
    tm_octree_share_free(&before);
    return status;
}

/* Splits where nodes are off the surface, if that makes them fewer. */
static tm_status split_off_surface(maker *m, bool *better, tm_error *error)
{
    bool *near = calloc(m->share->octree.nodes + 1, sizeof *near), any = false;
    uint8_t *split = tm_new(m->share->octree.leaves, sizeof *split);
    tm_status status = tm_ranks_enough(near && split, error);
    if (status == TM_OK)
        status = mark_off_surface(m, near, split, &any, error);
    free(near);
    *better = false;
    if (status == TM_OK && any)
        status = try_split(m, split, better, error);
    free(split);
    return status;
}

/* What of its ghosts a rank needs for that, and later, is as it became. */
static tm_status find_losses(const maker *m, tm_error *error)
{
    tm_octree_mesh *mesh = m->mesh;
    double(*outer)[3] = mesh->assembly.mesh.xyz + mesh->assembly.outer;
    tm_boundary_share b;
    tm_status status = tm_boundary_share_find(&b, m->share, &mesh->boundary, error);
    if (status == TM_OK) {
        tm_mesh_ghosts_fill(&b.ghosts, mesh->at, sizeof *mesh->at);
        tm_mesh_ghosts_fill(&b.ghosts, outer, sizeof *outer);
    }
    const tm_mesh_own own = {m->share->own_first, m->share->own_past, b.faces.first,
                             b.faces.past};
    if (status == TM_OK)
        status = tm_octree_mesh_find_losses(mesh, &m->share->octree, m->surface, m->level,
                                            &own, error);
    tm_boundary_share_free(&b);
    return status;
}

static tm_status make(maker *m, tm_error *error)
{
    tm_status status = make_without_loss(m, error);
    for (bool better = m->plan->levels > 0; status == TM_OK && better && !*m->alone;) {
        better = m->mesh->report.off_surface > 0 &&
                 tm_octree_mesh_elements(m->mesh) <= TM_MOST_TO_SPLIT;
        if (better)
            status = split_off_surface(m, &better, error);
    }
    if (status != TM_OK || *m->alone)
        return status;
    tm_progress_stage(m->plan->progress, "looking for losses");
    return find_losses(m, error);
}

unsigned tm_octree_share_deepest(const tm_octree_share *share)
{
    double deepest = tm_octree_deepest(&share->octree);
    tm_ranks_largest(&deepest, 1);
    return (unsigned)deepest;
}

tm_status tm_octree_mesh_choose_on_ranks(tm_octree_mesh *mesh, tm_octree_share *share,
                                         tm_surface *surface, const tm_mesh_plan *plan,
                                         bool *alone, tm_error *error)
{
    maker m = {mesh, share, surface, plan, 0, 0, alone};
    *mesh = (tm_octree_mesh){0};
    *alone = false;
    tm_progress_stage(plan->progress, "splitting octants");
    tm_status status =
        tm_octree_share_build(share, surface, plan->rule, plan->rules, RINGS, error);
    status = tm_ranks_agree(status, error);
    if (status != TM_OK)
        return status;
    m.level = tm_mesh_plan_level(plan, tm_octree_share_deepest(share), share->octree.side,
                                 surface);
    m.deepest = m.level + plan->levels;
    if (m.deepest > TM_OCTREE_LEVEL_MAX)
        m.deepest = TM_OCTREE_LEVEL_MAX;
    return make(&m, error);
}
