/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh on several ranks: each has the octree with its interior boundary and features
 * whole, makes the elements of its share, and gets those of all. */
#include "octree_mesh_parts.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    tm_octree_mesh *whole;
    const tm_octree *octree;
    tm_octree_share share;
    tm_octree_mesh local;
} worker;

/* What is chosen of local leaves, and at local nodes. */
static tm_status cut_interior(worker *w, tm_error *error)
{
    const tm_interior *from = w->whole->part;
    const tm_octree_share *s = &w->share;
    tm_interior *to = w->local.part = calloc(1, sizeof *to);
    if (!to)
        return tm_fail_memory(error);
    w->local.parts = 1;
    to->chosen = tm_new(s->octree.leaves, sizeof *to->chosen);
    to->mask = tm_new(s->octree.nodes, sizeof *to->mask);
    to->used = tm_new(s->octree.nodes, sizeof *to->used);
    if (!to->chosen || !to->mask || !to->used)
        return tm_fail_memory(error);
    for (size_t l = 0; l < s->octree.leaves; l++) {
        to->chosen[l] = from->chosen[s->leaf_number[l]];
        to->count += to->chosen[l];
    }
    for (size_t n = 0; n < s->octree.nodes; n++) {
        to->mask[n] = from->mask[s->node_number[n]];
        to->used[n] = from->used[s->node_number[n]];
    }
    return TM_OK;
}

/* The whole boundary's number of a local node of it, and the other way. */
static size_t whole_node(const worker *w, size_t s)
{
    const tm_interior_boundary *b = &w->whole->boundary;
    return tm_first_not_below(b->grid_node, b->nodes,
                              w->share.node_number[w->local.boundary.grid_node[s]]);
}

static uint32_t local_node(const worker *w, uint32_t s)
{
    const tm_interior_boundary *b = &w->local.boundary;
    if (s == TM_NONE)
        return s;
    const uint32_t number = w->whole->boundary.grid_node[s];
    const size_t n =
        tm_first_not_below(w->share.node_number, w->share.octree.nodes, number);
    if (n == w->share.octree.nodes || w->share.node_number[n] != number)
        return TM_NONE;
    const size_t here = tm_first_not_below(b->grid_node, b->nodes, (uint32_t)n);
    return here < b->nodes && b->grid_node[here] == n ? (uint32_t)here : TM_NONE;
}

static void cut_faces(worker *w)
{
    const tm_interior_boundary *from = &w->whole->boundary;
    const tm_interior_boundary *to = &w->local.boundary;
    for (size_t f = 0; f < to->faces; f++) {
        const uint32_t leaf = w->share.leaf_number[to->leaf[f]];
        size_t g = tm_first_not_below(from->leaf, from->faces, leaf);
        while (from->piece[g] != to->piece[f])
            g++;
        to->cut[f] = from->cut[g];
    }
}

static tm_status cut_features(worker *w, tm_error *error)
{
    const size_t nodes = w->local.boundary.nodes;
    tm_feature *to = &w->local.feature;
    const tm_feature *from = &w->whole->feature;
    to->kind = tm_new(nodes, sizeof *to->kind);
    to->of = tm_new(nodes, sizeof *to->of);
    to->along = tm_new(nodes, sizeof *to->along);
    w->local.at = tm_new(nodes, sizeof *w->local.at);
    w->local.off_surface = calloc(nodes + 1, sizeof *w->local.off_surface);
    if (!to->kind || !to->of || !to->along || !w->local.at || !w->local.off_surface)
        return tm_fail_memory(error);
    for (size_t s = 0; s < nodes; s++) {
        const size_t t = whole_node(w, s);
        to->kind[s] = from->kind[t];
        to->of[s] = from->of[t];
        w->local.at[s] = w->whole->at[t];
        for (int i = 0; i < 2; i++)
            to->along[s][i] = local_node(w, from->along[t][i]);
    }
    cut_faces(w);
    return TM_OK;
}

static tm_status cut(worker *w, tm_error *error)
{
    tm_status status =
        tm_octree_share_cut(&w->share, w->octree, tm_rank(), tm_ranks_count(), 1, error);
    w->share.octree.threads = w->octree->threads;
    if (status == TM_OK)
        status = cut_interior(w, error);
    if (status == TM_OK)
        status = tm_interior_boundary_find(&w->local.boundary, &w->share.octree,
                                           w->local.part, error);
    return status == TM_OK ? cut_features(w, error) : status;
}

/* The items of all ranks' own ranges. */
static tm_status share_own(tm_own_range own, const void *items, size_t size, void **all,
                           tm_error *error)
{
    return tm_ranks_share((const char *)items + own.first * size, own.past - own.first,
                          size, all, NULL, error);
}

static tm_status share_nodes(worker *w, tm_error *error)
{
    const tm_octree_mesh *l = &w->local;
    const tm_mesh_share *s = l->share;
    const double(*xyz)[3] = (const double(*)[3])l->assembly.mesh.xyz;
    const size_t begin[] = {0, l->assembly.outer,
                            l->assembly.mesh.nodes - l->assembly.middles};
    const tm_own_range own[] = {s->core, s->outer, s->middles};
    tm_assembly *to = &w->whole->assembly;
    to->mesh.nodes = s->nodes;
    to->outer = (uint32_t)s->core.all;
    to->core = s->core.all;
    to->middles = s->middles.all;
    to->mesh.xyz = tm_new(s->nodes, sizeof *to->mesh.xyz);
    tm_status status =
        tm_ranks_agree(to->mesh.xyz ? TM_OK : tm_fail_memory(error), error);
    size_t at = 0;
    for (int i = 0; i < 3 && status == TM_OK; i++) {
        void *all;
        status = share_own(own[i], xyz + begin[i], sizeof *xyz, &all, error);
        if (status == TM_OK && own[i].all > 0)
            memcpy(to->mesh.xyz + at, all, own[i].all * sizeof *xyz);
        at += own[i].all;
        free(all);
    }
    return status;
}

static tm_status share_elements(worker *w, tm_error *error)
{
    const tm_octree_mesh *l = &w->local;
    const tm_mesh_share *s = l->share;
    const tm_mixed_mesh *mesh = &l->assembly.mesh;
    tm_assembly *to = &w->whole->assembly;
    const size_t first = s->elements.first, count = s->elements.past - first;
    const size_t begin = mesh->start[first],
                 items = mesh->start[s->elements.past] - begin;
    uint32_t *item = tm_new(items, sizeof *item);
    uint32_t *size = tm_new(count, sizeof *size);
    uint32_t *from = tm_new(w->share.own_past - w->share.own_first, sizeof *from);
    void *all_items = NULL, *sizes = NULL, *all_first = NULL;
    to->mesh.elements = s->elements.all;
    to->mesh.threads = mesh->threads;
    to->mesh.start = tm_new(s->elements.all + 1, sizeof *to->mesh.start);
    to->first = tm_new(s->of->all_leaves + 1, sizeof *to->first);
    tm_status status = item && size && from && to->mesh.start && to->first
                           ? TM_OK
                           : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK) {
        for (size_t i = 0; i < items; i++)
            item[i] = s->number[mesh->item[begin + i]];
        for (size_t e = 0; e < count; e++)
            size[e] = (uint32_t)(mesh->start[first + e + 1] - mesh->start[first + e]);
        for (size_t i = w->share.own_first; i < w->share.own_past; i++)
            from[i - w->share.own_first] =
                (uint32_t)(l->assembly.first[i] - first + s->elements.number);
        status = tm_ranks_share(item, items, sizeof *item, &all_items, NULL, error);
    }
    if (status == TM_OK)
        status = tm_ranks_share(size, count, sizeof *size, &sizes, NULL, error);
    if (status == TM_OK)
        status = tm_ranks_share(from, w->share.own_past - w->share.own_first,
                                sizeof *from, &all_first, NULL, error);
    if (status == TM_OK) {
        to->mesh.item = all_items;
        all_items = NULL;
        to->mesh.start[0] = 0;
        for (size_t e = 0; e < s->elements.all; e++)
            to->mesh.start[e + 1] = to->mesh.start[e] + ((uint32_t *)sizes)[e];
        memcpy(to->first, all_first, s->of->all_leaves * sizeof *to->first);
        to->first[s->of->all_leaves] = (uint32_t)s->elements.all;
    }
    free(item);
    free(size);
    free(from);
    free(all_items);
    free(sizes);
    free(all_first);
    return status;
}

static tm_status share_boundary(worker *w, tm_error *error)
{
    tm_octree_mesh *l = &w->local;
    const tm_mesh_share *s = l->share;
    void *at = NULL, *off = NULL, *layer = NULL;
    for (size_t f = s->faces.first; f < s->faces.past; f++)
        l->assembly.layer[f] += (uint32_t)(s->elements.number - s->elements.first);
    tm_status status = share_own(s->outer, l->at, sizeof *l->at, &at, error);
    if (status == TM_OK)
        status = share_own(s->outer, l->off_surface, sizeof *l->off_surface, &off, error);
    if (status == TM_OK)
        status = share_own(s->faces, l->assembly.layer, sizeof *l->assembly.layer, &layer,
                           error);
    free(w->whole->at);
    free(w->whole->off_surface);
    w->whole->at = at;
    w->whole->off_surface = off;
    w->whole->assembly.layer = layer;
    return status;
}

static tm_status make(worker *w, const tm_surface *surface, const tm_progress *progress,
                      tm_error *error)
{
    tm_octree_mesh *l = &w->local;
    tm_status status = tm_ranks_agree(cut(w, error), error);
    if (status != TM_OK)
        return status;
    tm_progress_stage(progress, "assembling elements");
    status = tm_assemble(&l->assembly, &w->share.octree, l->part, 1, &l->boundary, error);
    l->share = calloc(1, sizeof *l->share);
    if (status == TM_OK && !l->share)
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status =
            tm_mesh_share_find(l->share, &w->share, &l->assembly, &l->boundary, error);
    tm_progress_stage(progress, "projecting the layer");
    if (status == TM_OK)
        status = tm_project_layer(&l->assembly, &l->boundary, &l->feature, surface, l->at,
                                  l->share, error);
    if (status == TM_OK)
        status = tm_untangle_layer(l, &w->share.octree, surface, progress, error);
    if (status == TM_OK)
        status = share_nodes(w, error);
    if (status == TM_OK)
        status = share_elements(w, error);
    if (status == TM_OK)
        status = share_boundary(w, error);
    w->whole->report.off_surface = l->report.off_surface;
    w->whole->report.invalid = l->report.invalid;
    return status;
}

tm_status tm_octree_mesh_make_on_ranks(tm_octree_mesh *mesh, const tm_octree *octree,
                                       const tm_surface *surface,
                                       const tm_progress *progress, tm_error *error)
{
    worker w = {.whole = mesh, .octree = octree};
    const tm_status status = make(&w, surface, progress, error);
    tm_octree_mesh_free(&w.local);
    tm_octree_share_free(&w.share);
    return status;
}
