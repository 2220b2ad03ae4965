/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_share.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../ranks/ranks.h"
#include "interior_parts.h"

#include <stdlib.h>
#include <string.h>

/* A leaf at a node whose mask is not good, with all that is asked of it. */
typedef struct {
    tm_leaf leaf;
    uint32_t number;
    uint32_t node[TM_LEAF_NODES]; /* by their numbers */
    tm_octant_mask mask[TM_LEAF_NODES];
    bool chosen;
} sent_leaf;

static bool start(tm_interior *interior, const tm_octree *octree)
{
    *interior = (tm_interior){
        .chosen = calloc(octree->leaves + 1, sizeof *interior->chosen),
        .mask = calloc(octree->nodes + 1, sizeof *interior->mask),
        .used = calloc(octree->nodes + 1, sizeof *interior->used),
    };
    return interior->chosen && interior->mask && interior->used;
}

static sent_leaf describe(const tm_interior *interior, const tm_octree_share *s, size_t l)
{
    sent_leaf sent = {.leaf = s->octree.leaf[l],
                      .number = s->leaf_number[l],
                      .chosen = interior->chosen[l]};
    for (int p = 0; p < TM_LEAF_NODES; p++) {
        const uint32_t v = s->octree.node[l][p];
        sent.node[p] = v == TM_NONE ? v : s->node_number[v];
        sent.mask[p] = v == TM_NONE ? 0 : interior->mask[v];
    }
    return sent;
}

/* Lists the leaves at own nodes whose mask is not good. */
static tm_status list_bad(const tm_interior *interior, const tm_octree_share *s,
                          sent_leaf **list, size_t *count, tm_error *error)
{
    tm_contacts contacts = {0};
    bool *bad = calloc(s->octree.nodes + 1, sizeof *bad);
    size_t own = s->own_node_first, n = 0;
    *list = NULL;
    *count = 0;
    if (!bad)
        return tm_fail_memory(error);
    for (; own < s->own_node_past; own++)
        bad[own] = !tm_octant_mask_is_good(interior->mask[own]);
    tm_status status = tm_contacts_find(&contacts, &s->octree, bad, error);
    if (status == TM_OK) {
        *list = tm_new(contacts.count, sizeof **list);
        status = *list ? TM_OK : tm_fail_memory(error);
    }
    for (size_t i = 0; status == TM_OK && i < contacts.count; i++)
        (*list)[n++] = describe(interior, s, contacts.contact[i].leaf);
    *count = n;
    free(bad);
    free(contacts.contact);
    return status;
}

static int compare_leaves(const void *a, const void *b)
{
    const sent_leaf *p = a, *q = b;
    return (p->number > q->number) - (p->number < q->number);
}

/* These leaves as an octree by themselves. */
typedef struct {
    tm_octree octree;
    tm_interior interior;
    uint32_t *number; /* [nodes] */
    sent_leaf *sent;  /* [leaves] */
} excerpt;

static void free_excerpt(excerpt *e)
{
    tm_octree_free(&e->octree);
    tm_interior_free(&e->interior);
    free(e->number);
    free(e->sent);
}

/* Each leaf once, in order. */
static size_t sort_leaves(sent_leaf *sent, size_t count)
{
    size_t once = 0;
    if (count > 0)
        qsort(sent, count, sizeof *sent, compare_leaves);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || sent[i].number != sent[once - 1].number)
            sent[once++] = sent[i];
    return once;
}

/* The numbers of their nodes, each once, ascending. */
static size_t sort_nodes(const sent_leaf *sent, size_t count, uint32_t *number)
{
    size_t nodes = 0, once = 0;
    for (size_t i = 0; i < count; i++)
        for (int p = 0; p < TM_LEAF_NODES; p++)
            if (sent[i].node[p] != TM_NONE)
                number[nodes++] = sent[i].node[p];
    if (nodes > 0)
        qsort(number, nodes, sizeof *number, tm_compare_numbers);
    for (size_t i = 0; i < nodes; i++)
        if (i == 0 || number[i] != number[once - 1])
            number[once++] = number[i];
    return once;
}

/* Nodes and leaves are in the order in which they are in the whole octree, so what is
 * done to them is, too. */
static bool fill_excerpt(excerpt *e, const tm_octree *of)
{
    tm_octree *o = &e->octree;
    o->leaves = sort_leaves(e->sent, o->leaves);
    memcpy(o->low, of->low, sizeof o->low);
    o->side = of->side;
    memcpy(o->roots, of->roots, sizeof o->roots);
    o->finest = of->finest;
    e->number = tm_new(o->leaves * TM_LEAF_NODES, sizeof *e->number);
    o->leaf = tm_new(o->leaves, sizeof *o->leaf);
    o->node = tm_new(o->leaves, sizeof *o->node);
    if (!e->number || !o->leaf || !o->node)
        return false;
    o->nodes = sort_nodes(e->sent, o->leaves, e->number);
    if (!start(&e->interior, o))
        return false;
    for (size_t l = 0; l < o->leaves; l++) {
        const sent_leaf *sent = &e->sent[l];
        o->leaf[l] = sent->leaf;
        e->interior.chosen[l] = sent->chosen;
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t v = sent->node[p];
            o->node[l][p] =
                v == TM_NONE ? v : (uint32_t)tm_first_not_below(e->number, o->nodes, v);
            if (v != TM_NONE)
                e->interior.mask[o->node[l][p]] = sent->mask[p];
        }
    }
    return true;
}

/* Changes local leaves as they were changed in the excerpt. */
static void take_changes(tm_interior *interior, const tm_octree_share *s,
                         const excerpt *e)
{
    for (size_t i = 0; i < e->octree.leaves; i++) {
        const uint32_t number = e->sent[i].number;
        const size_t l = tm_first_not_below(s->leaf_number, s->octree.leaves, number);
        if (e->interior.chosen[i] == e->sent[i].chosen || l == s->octree.leaves ||
            s->leaf_number[l] != number)
            continue;
        interior->chosen[l] = e->interior.chosen[i];
        tm_interior_put_in_masks(interior, &s->octree, l);
    }
    interior->filled += e->interior.filled;
    interior->removed += e->interior.removed;
}

/* A round of changes, that all ranks make alike; *count is the number of leaves at nodes
 * with a bad mask that there were. */
static tm_status clean_round(tm_interior *interior, const tm_octree_share *s,
                             const tm_surface *surface, int round, size_t *count,
                             tm_error *error)
{
    excerpt e = {.number = NULL};
    tm_contacts contacts = {0};
    sent_leaf *own;
    bool *bad = NULL;
    tm_status status = tm_ranks_agree(list_bad(interior, s, &own, count, error), error);
    if (status == TM_OK)
        status = tm_ranks_share(own, *count, sizeof *own, (void **)&e.sent, count, error);
    free(own);
    e.octree.leaves = *count;
    if (status == TM_OK && fill_excerpt(&e, &s->octree))
        bad = tm_new(e.octree.nodes, sizeof *bad);
    if (bad)
        status = tm_interior_clean_round(&e.interior, &e.octree, surface, round,
                                         &contacts, bad, error);
    else if (status == TM_OK)
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK) {
        take_changes(interior, s, &e);
        status = tm_share_fill_nodes(s, interior->mask, sizeof *interior->mask, error);
    }
    free(bad);
    free(contacts.contact);
    free_excerpt(&e);
    return status;
}

tm_status tm_interior_find_used_on_ranks(tm_interior *interior,
                                         const tm_octree_share *share, tm_error *error)
{
    interior->count = 0;
    for (size_t l = share->own_first; l < share->own_past; l++)
        interior->count += interior->chosen[l];
    tm_ranks_sum(&interior->count, 1);
    tm_interior_use_nodes(interior, &share->octree);
    tm_status status =
        tm_share_fill_nodes(share, interior->used, sizeof *interior->used, error);
    if (status != TM_OK)
        return status;
    tm_interior_use_middles(interior, &share->octree);
    return tm_share_fill_nodes(share, interior->used, sizeof *interior->used, error);
}

/* Masks at own nodes are those that the leaves around them give, which are all here. */
static tm_status fill_masks(const tm_interior *interior, const tm_octree_share *share,
                            tm_error *error)
{
    tm_interior_fill_masks(interior, &share->octree);
    return tm_share_fill_nodes(share, interior->mask, sizeof *interior->mask, error);
}

tm_status tm_interior_choose_on_ranks(tm_interior *interior, const tm_octree_share *share,
                                      const tm_surface *surface, tm_error *error)
{
    size_t bad = 1;
    tm_status status = start(interior, &share->octree) ? TM_OK : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status != TM_OK)
        return status;
    tm_interior_classify(interior, &share->octree, surface, share->own_first,
                         share->own_past);
    status =
        tm_share_fill_leaves(share, interior->chosen, sizeof *interior->chosen, error);
    if (status == TM_OK)
        status = fill_masks(interior, share, error);
    for (int round = 0; status == TM_OK && bad > 0; round++)
        status = clean_round(interior, share, surface, round, &bad, error);
    return status == TM_OK ? tm_interior_find_used_on_ranks(interior, share, error)
                           : status;
}

/* Joins the nodes of leaves that are not chosen, and lists the sets that reach the
 * outside; own leaves know all nodes that these have. */
static tm_status list_outside(const tm_interior *interior, const tm_octree_share *share,
                              const tm_surface *surface, uint32_t *parent,
                              uint32_t **outside, size_t *count, tm_error *error)
{
    const tm_octree *octree = &share->octree;
    uint32_t *own = NULL;
    size_t room = 0;
    *count = 0;
    for (size_t n = 0; n < octree->nodes; n++)
        parent[n] = (uint32_t)n;
    for (size_t l = share->own_first; l < share->own_past; l++)
        for (int p = 1; !interior->chosen[l] && p < TM_LEAF_NODES; p++)
            if (octree->node[l][p] != TM_NONE)
                tm_set_unite(parent, octree->node[l][0], octree->node[l][p]);
    tm_status status = tm_share_join_sets(share, parent, error);
    for (size_t l = share->own_first; status == TM_OK && l < share->own_past; l++) {
        const uint32_t set = parent[octree->node[l][0]];
        if (!interior->chosen[l] && (*count == 0 || own[*count - 1] != set) &&
            tm_leaf_is_outside(octree, &octree->leaf[l], surface) &&
            !tm_append(&own, count, &room, set))
            status = tm_fail_memory(error);
    }
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tm_ranks_share(own, *count, sizeof *own, (void **)outside, count, error);
    if (status == TM_OK && *count > 0)
        qsort(*outside, *count, sizeof **outside, tm_compare_numbers);
    free(own);
    return status;
}

static tm_status choose_enclosed(tm_interior *enclosed, const tm_interior *interior,
                                 const tm_octree_share *share, const tm_surface *surface,
                                 tm_error *error)
{
    uint32_t *parent = tm_new(share->octree.nodes, sizeof *parent), *outside = NULL;
    size_t count = 0;
    tm_status status = tm_ranks_enough(parent, error);
    if (status == TM_OK)
        status = list_outside(interior, share, surface, parent, &outside, &count, error);
    for (size_t l = share->own_first; status == TM_OK && l < share->own_past; l++) {
        const uint32_t set = parent[share->octree.node[l][0]];
        const size_t i = tm_first_not_below(outside, count, set);
        enclosed->chosen[l] = !interior->chosen[l] && (i == count || outside[i] != set);
        enclosed->count += enclosed->chosen[l];
    }
    tm_ranks_sum(&enclosed->count, 1);
    if (status == TM_OK)
        status = tm_share_fill_leaves(share, enclosed->chosen, sizeof *enclosed->chosen,
                                      error);
    free(parent);
    free(outside);
    return status;
}

tm_status tm_interior_find_enclosed_on_ranks(tm_interior *enclosed, tm_interior *interior,
                                             const tm_octree_share *share,
                                             const tm_surface *surface, tm_error *error)
{
    const tm_octree *octree = &share->octree;
    tm_status status = start(enclosed, octree) ? TM_OK : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = choose_enclosed(enclosed, interior, share, surface, error);
    if (status == TM_OK && enclosed->count == 0)
        tm_interior_free(enclosed);
    if (status != TM_OK || !enclosed->chosen)
        return status;
    const size_t count[2] = {enclosed->count, interior->count};
    status = fill_masks(enclosed, share, error);
    for (size_t l = 0; l < octree->leaves; l++)
        enclosed->chosen[l] |= interior->chosen[l];
    if (status == TM_OK)
        status = tm_interior_find_used_on_ranks(enclosed, share, error);
    for (size_t l = 0; l < octree->leaves; l++)
        enclosed->chosen[l] &= !interior->chosen[l];
    memcpy(interior->used, enclosed->used, octree->nodes * sizeof *interior->used);
    enclosed->count = count[0];
    interior->count = count[1];
    return status;
}
