/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "adaptive_refinement.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../base/parallel.h"
#include "../forest/octree_build.h"
#include "../interior/wall_refinement.h"
#include "octree_mesh_parts.h"

#include <stdlib.h>
#include <string.h>

/* How deep leaves may be, the deepest that is asked for, and how walls are treated. */
typedef struct {
    unsigned level, deepest;
    bool lay_out;
} depth;

/* A stage. */
static const char splitting[] = "splitting octants";

/* Unmarks leaves that are as deep as they may be; returns how many are left. */
static size_t keep_shallow(const tm_octree *octree, unsigned deepest, uint8_t *split)
{
    size_t count = 0;
    for (size_t l = 0; l < octree->leaves; l++) {
        split[l] = split[l] && octree->leaf[l].level < deepest;
        count += split[l];
    }
    return count;
}

/* Whether not all octants around a node are of the region of a chosen leaf. */
static bool is_at_boundary(const tm_interior *interior, uint32_t node, size_t leaf)
{
    if (!interior->octant)
        return interior->mask[node] != TM_ALL_OCTANTS;
    for (int o = 0; o < 8; o++)
        if (interior->octant[node][o] != interior->label[leaf])
            return true;
    return false;
}

/* Whether smaller leaves that are not chosen are at a face of a chosen leaf above a
 * level: the surface is in these, but their centres are outside. */
static bool is_behind_boundary(const tm_interior *interior, const tm_octree *octree,
                               unsigned level, size_t l)
{
    for (int f = 0; interior->chosen[l] && octree->leaf[l].level < level && f < 6; f++) {
        const uint32_t centre = octree->node[l][TM_LEAF_FACE + f];
        if (centre != TM_NONE && is_at_boundary(interior, centre, l))
            return true;
    }
    return false;
}

typedef struct {
    const tm_interior *interior;
    const tm_octree *octree;
    unsigned level;
    bool *behind; /* [leaves] */
    bool any;
} behind_finder;

static void find_behind(void *context, size_t first, size_t past)
{
    behind_finder *f = context;
    bool any = false;
    for (size_t l = first; l < past; l++) {
        f->behind[l] = is_behind_boundary(f->interior, f->octree, f->level, l);
        any |= f->behind[l];
    }
    if (any)
        tm_mark(&f->any);
}

/* Marks those of the leaves where many touch. */
static bool mark_many(const behind_finder *f, uint8_t *split)
{
    const tm_octree *octree = f->octree;
    uint32_t *parent = tm_new(octree->nodes, sizeof *parent);
    uint32_t *count = calloc(octree->nodes + 1, sizeof *count);
    const bool ok = parent && count;
    for (size_t n = 0; ok && n < octree->nodes; n++)
        parent[n] = (uint32_t)n;
    for (size_t l = 0; ok && l < octree->leaves; l++)
        for (int p = 1; f->behind[l] && p < TM_LEAF_EDGE; p++)
            tm_set_unite(parent, octree->node[l][0], octree->node[l][p]);
    for (int round = 0; ok && round < 2; round++)
        for (size_t l = 0; l < octree->leaves; l++) {
            if (!f->behind[l])
                continue;
            uint32_t *of = &count[tm_set_root(parent, octree->node[l][0])];
            if (round == 0)
                ++*of;
            else
                split[l] |= *of >= TM_BEHIND_MANY;
        }
    free(parent);
    free(count);
    return ok;
}

bool tm_interior_find_behind(const tm_interior *interior, const tm_octree *octree,
                             unsigned level, bool *behind)
{
    behind_finder f = {
        .interior = interior, .octree = octree, .level = level, .behind = behind};
    tm_parallel_runs(octree->threads, octree->leaves, TM_CHUNK, find_behind, &f);
    return f.any;
}

/* Marks such leaves where many touch, as along a plane: the boundary has large faces
 * there. A few only are everywhere. */
static tm_status mark_behind_boundary(const tm_interior *interior,
                                      const tm_octree *octree, unsigned level,
                                      uint8_t *split, tm_error *error)
{
    behind_finder f = {.interior = interior,
                       .octree = octree,
                       .level = level,
                       .behind = tm_new(octree->leaves, sizeof *f.behind)};
    bool ok = f.behind != NULL;
    if (ok && tm_interior_find_behind(interior, octree, level, f.behind))
        ok = mark_many(&f, split);
    free(f.behind);
    return ok ? TM_OK : tm_fail_memory(error);
}

/* Splits leaves with surface but no boundary close by, and those behind a boundary of
 * smaller ones, until there are none; then makes the mesh. */
static tm_status make_without_loss(tm_octree_mesh *mesh, tm_octree *octree,
                                   tm_surface *surface, const depth *to,
                                   const tm_progress *progress, tm_error *error)
{
    tm_interior interior = {0};
    tm_status status = TM_OK;
    for (bool more = true; status == TM_OK && more;) {
        uint8_t *lost = calloc(octree->leaves + 1, sizeof *lost);
        tm_interior_free(&interior);
        tm_progress_stage(progress, "choosing octants");
        status =
            lost ? tm_interior_choose_how(&interior, octree, surface, to->lay_out, error)
                 : tm_fail_memory(error);
        if (status == TM_OK) {
            if (to->deepest > to->level)
                tm_interior_find_lost(&interior, octree, surface, lost);
            status = mark_behind_boundary(&interior, octree, to->level, lost, error);
            more = keep_shallow(octree, to->deepest, lost) > 0;
        }
        if (status == TM_OK && more) {
            tm_progress_stage(progress, splitting);
            status = tm_octree_refine(octree, surface, lost, error);
        }
        free(lost);
    }
    if (status == TM_OK)
        return tm_octree_mesh_make_of(mesh, octree, &interior, surface, progress, error);
    tm_interior_free(&interior);
    return status;
}

void tm_octree_mark_ring(const tm_octree *octree, bool *near, uint8_t *split)
{
    for (size_t l = 0; l < octree->leaves; l++) {
        split[l] = 0;
        for (int p = 0; octree->leaf[l].crossed && p < TM_LEAF_EDGE; p++)
            split[l] |= near[octree->node[l][p]];
    }
    for (size_t l = 0; l < octree->leaves; l++)
        for (int p = 0; split[l] && p < TM_LEAF_EDGE; p++)
            near[octree->node[l][p]] = true;
}

/* The leaves at boundary nodes that are off the surface, and their neighbours that the
 * surface crosses. NULL where memory is out or there is none. */
static uint8_t *mark_off_surface(const tm_octree_mesh *mesh, const tm_octree *octree,
                                 unsigned deepest)
{
    uint8_t *split = tm_new(octree->leaves, sizeof *split);
    bool *near = calloc(octree->nodes + 1, sizeof *near);
    for (size_t s = 0; near && s < mesh->boundary.nodes; s++)
        near[mesh->boundary.grid_node[s]] = mesh->off_surface[s];
    for (int ring = 0; split && near && ring < 2; ring++)
        tm_octree_mark_ring(octree, near, split);
    const bool any = split && near && keep_shallow(octree, deepest, split) > 0;
    free(near);
    if (!any)
        free(split);
    return any ? split : NULL;
}

uint64_t tm_topology_missing(const tm_octree_mesh_report *r, const tm_surface *surface)
{
    const int64_t pieces = (int64_t)r->components - (int64_t)surface->components;
    const int64_t euler = r->euler - surface->euler;
    if (surface->by_winding)
        return 0;
    return (uint64_t)(pieces < 0 ? -pieces : pieces) +
           (uint64_t)(euler < 0 ? -euler : euler);
}

/* The mesh of a copy of the octree with leaves split; both become these if fewer nodes
 * are off the surface and its topology is as good. */
static tm_status try_split(tm_octree_mesh *mesh, tm_octree *octree, tm_surface *surface,
                           const depth *to, const uint8_t *split, bool *better,
                           const tm_progress *progress, tm_error *error)
{
    tm_octree finer;
    tm_octree_mesh made = {0};
    tm_progress_stage(progress, splitting);
    tm_status status = tm_octree_copy(&finer, octree, error);
    if (status == TM_OK)
        status = tm_octree_refine(&finer, surface, split, error);
    if (status == TM_OK)
        status = make_without_loss(&made, &finer, surface, to, progress, error);
    *better = status == TM_OK && made.report.off_surface < mesh->report.off_surface &&
              tm_topology_missing(&made.report, surface) <=
                  tm_topology_missing(&mesh->report, surface);
    if (*better)
        tm_octree_mesh_exchange(mesh, octree, &made, &finer);
    tm_octree_mesh_free(&made);
    tm_octree_free(&finer);
    return status;
}

tm_status tm_octree_mesh_refine_lost(tm_octree_mesh *mesh, tm_octree *octree,
                                     tm_surface *surface, unsigned level, unsigned levels,
                                     bool lay_out, const tm_progress *progress,
                                     tm_error *error)
{
    const unsigned deepest = level + levels;
    const depth to = {
        level, deepest > TM_OCTREE_LEVEL_MAX ? TM_OCTREE_LEVEL_MAX : deepest, lay_out};
    *mesh = (tm_octree_mesh){0};
    tm_status status =
        surface->walls ? tm_octree_refine_walls(octree, surface, error) : TM_OK;
    if (status != TM_OK)
        return status;
    status = make_without_loss(mesh, octree, surface, &to, progress, error);
    for (bool better = levels > 0; status == TM_OK && better;) {
        const bool tries = mesh->report.off_surface > 0 &&
                           mesh->assembly.mesh.elements <= TM_MOST_TO_SPLIT;
        uint8_t *split = tries ? mark_off_surface(mesh, octree, to.deepest) : NULL;
        if (!split)
            break;
        status = try_split(mesh, octree, surface, &to, split, &better, progress, error);
        free(split);
    }
    tm_progress_stage(progress, "looking for losses");
    const tm_mesh_own own = {0, octree->leaves, 0, mesh->boundary.faces};
    return status == TM_OK
               ? tm_octree_mesh_find_losses(mesh, octree, surface, level, &own, error)
               : status;
}
