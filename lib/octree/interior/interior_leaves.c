/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_leaves.h"
#include "interior_parts.h"
#include "region_leaves.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../base/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* After so many rounds of adding and taking away leaves are only taken away, which ends.
 */
enum { FREE_ROUNDS = 24 };

/* Whether two leaves' closed cubes have a point in common. */
static bool touch(const tm_octree *octree, const tm_leaf *a, const tm_leaf *b)
{
    const uint32_t side_a = (uint32_t)1 << (octree->finest - a->level);
    const uint32_t side_b = (uint32_t)1 << (octree->finest - b->level);
    for (int i = 0; i < 3; i++)
        if (a->anchor[i] > b->anchor[i] + side_b || b->anchor[i] > a->anchor[i] + side_a)
            return false;
    return true;
}

bool tm_leaf_is_as_before(const tm_octree *octree, size_t leaf)
{
    const tm_leaf *own = &octree->leaf[leaf];
    return !own->crossed && !own[-1].crossed && touch(octree, own, own - 1);
}

typedef struct {
    const tm_interior *interior; /* whose arrays are filled */
    const tm_octree *octree;
    const tm_surface *surface;
    size_t first; /* of the leaves that are asked for */
} chooser;

/* Asks of leaves that are not as the one before. */
static void ask_chunk(void *context, size_t first, size_t past)
{
    const chooser *c = context;
    for (size_t i = first; i < past; i++) {
        const size_t l = c->first + i;
        bool *chosen = &c->interior->chosen[l];
        if (i > 0 && tm_leaf_is_as_before(c->octree, l)) {
            *chosen = i > first && chosen[-1];
            continue;
        }
        double centre[3];
        tm_leaf_centre(c->octree, &c->octree->leaf[l], centre);
        *chosen = tm_surface_has_inside(c->surface, centre);
    }
}

/* The first leaves of a chunk may be as the last one of the chunk before it. */
void tm_interior_classify(const tm_interior *interior, const tm_octree *octree,
                          const tm_surface *surface, size_t first, size_t past)
{
    chooser c = {interior, octree, surface, first};
    tm_parallel_runs(octree->threads, past - first, TM_CHUNK, ask_chunk, &c);
    for (size_t chunk = first + TM_CHUNK; chunk < past; chunk += TM_CHUNK)
        for (size_t l = chunk;
             l < past && tm_leaf_is_as_before(octree, l) && l < chunk + TM_CHUNK; l++)
            interior->chosen[l] = interior->chosen[l - 1];
}

void tm_interior_put_in_masks(const tm_interior *interior, const tm_octree *octree,
                              size_t l)
{
    for (int p = 0; p < TM_LEAF_NODES; p++) {
        const uint32_t node = octree->node[l][p];
        if (node == TM_NONE)
            continue;
        if (interior->chosen[l])
            interior->mask[node] |= tm_point_octants[p];
        else
            interior->mask[node] &= (tm_octant_mask)~tm_point_octants[p];
    }
}

static void fill_chunk(void *context, size_t first, size_t past)
{
    const chooser *c = context;
    for (size_t l = first; l < past; l++)
        for (int p = 0; c->interior->chosen[l] && p < TM_LEAF_NODES; p++)
            if (c->octree->node[l][p] != TM_NONE)
                __atomic_fetch_or(&c->interior->mask[c->octree->node[l][p]],
                                  tm_point_octants[p], __ATOMIC_RELAXED);
}

void tm_interior_fill_masks(const tm_interior *interior, const tm_octree *octree)
{
    chooser c = {.interior = interior, .octree = octree};
    tm_parallel_runs(octree->threads, octree->leaves, TM_CHUNK, fill_chunk, &c);
}

void tm_interior_flip(tm_interior *interior, const tm_octree *octree, size_t leaf)
{
    interior->chosen[leaf] = !interior->chosen[leaf];
    if (interior->chosen[leaf])
        interior->filled++;
    else
        interior->removed++;
    tm_interior_put_in_masks(interior, octree, leaf);
}

void tm_interior_set_label(tm_interior *interior, const tm_octree *octree, size_t leaf,
                           uint32_t label)
{
    interior->label[leaf] = label;
    for (int p = 0; p < TM_LEAF_NODES; p++)
        if (octree->node[leaf][p] != TM_NONE)
            tm_octants_set(interior->octant[octree->node[leaf][p]], p, label);
}

typedef struct {
    const tm_octree *octree;
    const tm_surface *surface;
    tm_interior *interior;
    bool *bad; /* [nodes] */
    tm_contacts *contacts;
} cleaner;

static void mark_bad(void *context, size_t first, size_t past)
{
    const cleaner *c = context;
    for (size_t n = first; n < past; n++)
        c->bad[n] = !tm_octant_mask_is_good(c->interior->mask[n]);
}

/* Lists the leaves at nodes whose mask is bad. */
static tm_status find_contacts(cleaner *c, tm_error *error)
{
    tm_parallel_runs(c->octree->threads, c->octree->nodes, TM_CHUNK, mark_bad, c);
    return tm_contacts_find(c->contacts, c->octree, c->bad, error);
}

double tm_leaf_depth(const tm_octree *octree, const tm_surface *surface, size_t l)
{
    const tm_leaf *leaf = &octree->leaf[l];
    const double farther_than_crossed = 1;
    if (!leaf->crossed)
        return farther_than_crossed;
    double centre[3];
    tm_leaf_centre(octree, leaf, centre);
    tm_surface_point at = {.triangle = TM_NONE};
    tm_surface_closest(surface, centre, TM_NONE, &at);
    return sqrt(at.distance2) / tm_leaf_side(octree, leaf);
}

/* How many of a leaf's nodes would have a bad mask if it changed, less those that have
 * one now. */
static int harm(const cleaner *c, size_t l)
{
    int more = 0;
    for (int p = 0; p < TM_LEAF_NODES; p++) {
        const uint32_t node = c->octree->node[l][p];
        if (node == TM_NONE)
            continue;
        const tm_octant_mask now = c->interior->mask[node];
        const tm_octant_mask then = now ^ tm_point_octants[p];
        more += !tm_octant_mask_is_good(then) - !tm_octant_mask_is_good(now);
    }
    return more;
}

/* Changes one of the leaves contact[0 … count) around a node that is still bad: the one
 * that does most good, of these the one closest to the surface. */
static void mend(cleaner *c, const tm_contact *around, size_t count, bool only_remove)
{
    const double good = 1; /* a bad node less is worth a side of a leaf */
    size_t best = count;
    double least = INFINITY;
    for (size_t i = 0; i < count; i++) {
        const size_t l = around[i].leaf;
        if (only_remove && !c->interior->chosen[l])
            continue;
        const double cost = tm_leaf_depth(c->octree, c->surface, l) + good * harm(c, l);
        if (cost < least) {
            least = cost;
            best = i;
        }
    }
    if (best < count)
        tm_interior_flip(c->interior, c->octree, around[best].leaf);
}

tm_status tm_interior_clean_round(tm_interior *interior, const tm_octree *octree,
                                  const tm_surface *surface, int round,
                                  tm_contacts *contacts, bool *bad, tm_error *error)
{
    cleaner c = {octree, surface, interior, bad, contacts};
    const tm_status status = find_contacts(&c, error);
    for (size_t i = 0, next; status == TM_OK && i < contacts->count; i = next) {
        const tm_contact *around = &contacts->contact[i];
        next = tm_contacts_next(contacts, i);
        if (!tm_octant_mask_is_good(interior->mask[around->node]))
            mend(&c, around, next - i, round >= FREE_ROUNDS);
    }
    return status;
}

static tm_status clean(tm_interior *interior, const tm_octree *octree,
                       const tm_surface *surface, tm_error *error)
{
    tm_contacts contacts = {0};
    bool *bad = malloc(octree->nodes);
    tm_status status = bad ? TM_OK : tm_fail_memory(error);
    for (int round = 0; status == TM_OK; round++) {
        status = tm_interior_clean_round(interior, octree, surface, round, &contacts, bad,
                                         error);
        if (contacts.count == 0)
            break;
    }
    free(bad);
    free(contacts.contact);
    return status;
}

/* Marks nodes of chosen leaves. */
static void use_nodes(void *context, size_t first, size_t past)
{
    const chooser *c = context;
    for (size_t l = first; l < past; l++)
        for (int p = 0; c->interior->chosen[l] && p < TM_LEAF_EDGE; p++)
            tm_mark(&c->interior->used[c->octree->node[l][p]]);
}

/* Marks those in the middle of edges of divided faces; no centre of a face is one. */
static void use_middles(void *context, size_t first, size_t past)
{
    const chooser *c = context;
    const tm_octree *octree = c->octree;
    for (size_t l = first; l < past; l++) {
        for (int f = 0; c->interior->chosen[l] && f < 6; f++) {
            const uint32_t centre = octree->node[l][TM_LEAF_FACE + f];
            if (centre == TM_NONE || !c->interior->used[centre])
                continue;
            for (int i = 0; i < 4; i++)
                tm_mark(&c->interior
                             ->used[octree->node[l][TM_LEAF_EDGE + tm_face_edge[f][i]]]);
        }
    }
}

void tm_interior_use_nodes(const tm_interior *interior, const tm_octree *octree)
{
    chooser c = {.interior = interior, .octree = octree};
    memset(interior->used, false, octree->nodes);
    tm_parallel_runs(octree->threads, octree->leaves, TM_CHUNK, use_nodes, &c);
}

void tm_interior_use_middles(const tm_interior *interior, const tm_octree *octree)
{
    chooser c = {.interior = interior, .octree = octree};
    tm_parallel_runs(octree->threads, octree->leaves, TM_CHUNK, use_middles, &c);
}

/* The nodes that the mesh has. A face of which a part is shared with a smaller chosen
 * leaf has its centre, and is then divided in four. */
void tm_interior_find_used(tm_interior *interior, const tm_octree *octree)
{
    interior->count = 0;
    for (size_t l = 0; l < octree->leaves; l++)
        interior->count += interior->chosen[l];
    tm_interior_use_nodes(interior, octree);
    tm_interior_use_middles(interior, octree);
}

tm_status tm_interior_choose(tm_interior *interior, const tm_octree *octree,
                             const tm_surface *surface, tm_error *error)
{
    return tm_interior_choose_how(interior, octree, surface, true, error);
}

tm_status tm_interior_choose_how(tm_interior *interior, const tm_octree *octree,
                                 const tm_surface *surface, bool lay_out, tm_error *error)
{
    *interior = (tm_interior){
        .chosen = calloc(octree->leaves, sizeof *interior->chosen),
        .mask = calloc(octree->nodes, sizeof *interior->mask),
        .used = calloc(octree->nodes, sizeof *interior->used),
    };
    if (!interior->chosen || !interior->mask || !interior->used)
        return tm_fail_memory(error);
    if (surface->walls) {
        const tm_status labelled =
            tm_interior_label(interior, octree, surface, lay_out, error);
        if (labelled == TM_OK)
            tm_interior_find_used(interior, octree);
        return labelled;
    }
    tm_interior_classify(interior, octree, surface, 0, octree->leaves);
    tm_interior_fill_masks(interior, octree);
    const tm_status status = clean(interior, octree, surface, error);
    if (status == TM_OK)
        tm_interior_find_used(interior, octree);
    return status;
}

void tm_interior_free(tm_interior *interior)
{
    free(interior->chosen);
    free(interior->mask);
    free(interior->used);
    free(interior->label);
    free(interior->octant);
    *interior = (tm_interior){0};
}

static bool is_at_brick(const tm_octree *octree, const tm_leaf *leaf)
{
    const uint32_t side = (uint32_t)1 << (octree->finest - leaf->level);
    for (int i = 0; i < 3; i++)
        if (leaf->anchor[i] == 0 || leaf->anchor[i] + side == octree->roots[i]
                                                                  << octree->finest)
            return true;
    return false;
}

static bool has_point(const tm_octree *octree, const tm_leaf *leaf, const double point[3])
{
    const double unit = octree->side / (double)((uint32_t)1 << octree->finest);
    const double side = (double)((uint32_t)1 << (octree->finest - leaf->level));
    for (int i = 0; i < 3; i++) {
        const double at = (point[i] - octree->low[i]) / unit - leaf->anchor[i];
        if (!(at >= 0 && at < side))
            return false;
    }
    return true;
}

static bool has_hole(const tm_octree *octree, const tm_leaf *leaf,
                     const tm_surface *surface)
{
    for (size_t h = 0; h < surface->holes; h++)
        if (has_point(octree, leaf, surface->hole[h]))
            return true;
    return false;
}

bool tm_leaf_is_outside(const tm_octree *octree, const tm_leaf *leaf,
                        const tm_surface *surface)
{
    return is_at_brick(octree, leaf) || has_hole(octree, leaf, surface);
}

/* Leaves that are not chosen are joined through common nodes: where masks are good that
 * is through common faces, too. */
static bool choose_enclosed(tm_interior *enclosed, const tm_interior *interior,
                            const tm_octree *octree, const tm_surface *surface)
{
    uint32_t *parent = tm_new(octree->nodes, sizeof *parent);
    bool *outside = calloc(octree->nodes + 1, sizeof *outside);
    for (size_t n = 0; parent && n < octree->nodes; n++)
        parent[n] = (uint32_t)n;
    for (size_t l = 0; parent && l < octree->leaves; l++)
        for (int p = 1; !interior->chosen[l] && p < TM_LEAF_NODES; p++)
            if (octree->node[l][p] != TM_NONE)
                tm_set_unite(parent, octree->node[l][0], octree->node[l][p]);
    for (size_t l = 0; parent && outside && l < octree->leaves; l++)
        if (!interior->chosen[l] && tm_leaf_is_outside(octree, &octree->leaf[l], surface))
            outside[tm_set_root(parent, octree->node[l][0])] = true;
    for (size_t l = 0; parent && outside && l < octree->leaves; l++) {
        enclosed->chosen[l] =
            !interior->chosen[l] && !outside[tm_set_root(parent, octree->node[l][0])];
        enclosed->count += enclosed->chosen[l];
    }
    const bool done = parent && outside;
    free(parent);
    free(outside);
    return done;
}

/* Those that the mesh of both has. */
static void share_used(tm_interior *enclosed, tm_interior *interior,
                       const tm_octree *octree)
{
    const size_t count[2] = {enclosed->count, interior->count};
    for (size_t l = 0; l < octree->leaves; l++)
        enclosed->chosen[l] |= interior->chosen[l];
    tm_interior_find_used(enclosed, octree);
    for (size_t l = 0; l < octree->leaves; l++)
        enclosed->chosen[l] &= !interior->chosen[l];
    memcpy(interior->used, enclosed->used, octree->nodes * sizeof *interior->used);
    enclosed->count = count[0];
    interior->count = count[1];
}

tm_status tm_interior_find_enclosed(tm_interior *enclosed, tm_interior *interior,
                                    const tm_octree *octree, const tm_surface *surface,
                                    tm_error *error)
{
    *enclosed = (tm_interior){
        .chosen = calloc(octree->leaves, sizeof *enclosed->chosen),
        .mask = calloc(octree->nodes, sizeof *enclosed->mask),
        .used = calloc(octree->nodes, sizeof *enclosed->used),
    };
    if (!enclosed->chosen || !enclosed->mask || !enclosed->used ||
        !choose_enclosed(enclosed, interior, octree, surface))
        return tm_fail_memory(error);
    if (enclosed->count == 0) {
        tm_interior_free(enclosed);
        return TM_OK;
    }
    tm_interior_fill_masks(enclosed, octree);
    share_used(enclosed, interior, octree);
    return TM_OK;
}

/* Whether octants around a node are of several regions. */
static bool has_several(const uint32_t octant[8])
{
    bool several = false;
    for (int o = 1; o < 8; o++)
        several |= octant[o] != octant[0];
    return several;
}

typedef struct {
    chooser of;
    uint8_t *lost;
} loss_finder;

static void find_lost(void *context, size_t first, size_t past)
{
    const loss_finder *f = context;
    const tm_interior *interior = f->of.interior;
    const tm_octree *octree = f->of.octree;
    for (size_t l = first; l < past; l++) {
        bool near = !octree->leaf[l].crossed || f->of.surface->by_winding;
        for (int p = 0; !near && p < TM_LEAF_EDGE; p++) {
            const uint32_t node = octree->node[l][p];
            const tm_octant_mask mask = interior->mask[node];
            near = interior->octant ? has_several(interior->octant[node])
                                    : mask != 0 && mask != TM_ALL_OCTANTS;
        }
        f->lost[l] = !near;
    }
}

size_t tm_interior_find_lost(const tm_interior *interior, const tm_octree *octree,
                             const tm_surface *surface, uint8_t *lost)
{
    loss_finder f = {{interior, octree, surface, 0}, lost};
    size_t count = 0;
    tm_parallel_runs(octree->threads, octree->leaves, TM_CHUNK, find_lost, &f);
    for (size_t l = 0; l < octree->leaves; l++)
        count += lost[l];
    return count;
}
