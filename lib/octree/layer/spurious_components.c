/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pieces have the number of their smallest node in the octree as a label; what ranks have
 * of them is added up in short lists that all have. */
#include "octree_mesh_parts.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../ranks/ranks.h"
#include "../interior/interior_parts.h"
#include "../interior/interior_share.h"

#include <stdlib.h>
#include <string.h>

/* So many nodes of a piece are closest to a shell. */
typedef struct {
    uint32_t label, shell;
    size_t count;
} votes;

/* What a set of leaves has of pieces. */
typedef struct {
    uint32_t label;
    unsigned marks;
} leaf_set;

enum { TO_CHANGE = 1, TO_KEEP = 2 };

/* Gets all ranks' items, sorted; *list, to be freed, is this rank's before. */
static tm_status share_list(const tm_boundary_view *view, void **list, size_t *count,
                            size_t size, int (*compare)(const void *, const void *),
                            bool done, tm_error *error)
{
    void *all = NULL;
    tm_status status = tm_ranks_enough(done, error);
    if (view->share && status == TM_OK) {
        status = tm_ranks_share(*list, *count, size, &all, count, error);
        free(*list);
        *list = all;
    }
    if (status == TM_OK && *list && *count > 0)
        qsort(*list, *count, size, compare);
    return status;
}

/* Makes sets of the octree's nodes, of all ranks, and names them by their smallest ones.
 */
static tm_status name_sets(const tm_boundary_view *view, uint32_t *parent,
                           tm_error *error)
{
    if (view->share)
        return tm_share_join_sets(view->share, parent, error);
    for (size_t n = 0; n < view->octree->nodes; n++)
        parent[n] = tm_set_root(parent, (uint32_t)n);
    return TM_OK;
}

static void start_sets(const tm_boundary_view *view, uint32_t *parent)
{
    for (size_t n = 0; n < view->octree->nodes; n++)
        parent[n] = (uint32_t)n;
}

static uint32_t label_of(const tm_boundary_view *view, const uint32_t *label, uint32_t s)
{
    return label[view->boundary->grid_node[s]];
}

static tm_status label_pieces(const tm_boundary_view *view, uint32_t *label,
                              tm_error *error)
{
    const tm_interior_boundary *b = view->boundary;
    start_sets(view, label);
    for (size_t f = view->faces.first; f < view->faces.past; f++)
        for (unsigned c = 1; c < tm_boundary_face_corners(b, f); c++)
            tm_set_unite(label, b->grid_node[b->face[f][0]], b->grid_node[b->face[f][c]]);
    return name_sets(view, label, error);
}

/* Six times the volume between the origin and triangle ijk of boundary nodes. */
static tm_volume cone(const tm_interior_boundary *b, uint32_t i, uint32_t j, uint32_t k)
{
    const uint32_t *p = b->grid[i], *q = b->grid[j], *r = b->grid[k];
    const tm_volume px = p[0], py = p[1], pz = p[2];
    return px * ((tm_volume)q[1] * r[2] - (tm_volume)q[2] * r[1]) +
           py * ((tm_volume)q[2] * r[0] - (tm_volume)q[0] * r[2]) +
           pz * ((tm_volume)q[0] * r[1] - (tm_volume)q[1] * r[0]);
}

static int compare_pieces(const void *a, const void *b)
{
    const uint32_t p = ((const tm_boundary_piece *)a)->label,
                   q = ((const tm_boundary_piece *)b)->label;
    return (p > q) - (p < q);
}

static tm_boundary_piece *piece_of(const tm_boundary_pieces *pieces, uint32_t label)
{
    const tm_boundary_piece key = {.label = label};
    return bsearch(&key, pieces->piece, pieces->count, sizeof key, compare_pieces);
}

/* Adds up what is of the same piece in a sorted list. */
static void join_pieces(tm_boundary_pieces *pieces)
{
    size_t joined = 0;
    for (size_t i = 0; i < pieces->count; i++) {
        const tm_boundary_piece *p = &pieces->piece[i];
        tm_boundary_piece *last = &pieces->piece[joined - (joined > 0)];
        if (joined > 0 && last->label == p->label) {
            last->faces += p->faces;
            last->volume += p->volume;
        } else {
            pieces->piece[joined++] = *p;
        }
    }
    pieces->count = joined;
}

/* Lists own faces; those next to each other are mostly of one piece. */
static bool list_pieces(const tm_boundary_view *view, tm_boundary_pieces *pieces)
{
    const tm_interior_boundary *b = view->boundary;
    size_t room = 0;
    for (size_t f = view->faces.first; f < view->faces.past; f++) {
        const uint32_t *face = b->face[f];
        const uint32_t label = label_of(view, pieces->label, face[0]);
        tm_boundary_piece *p = pieces->piece;
        if (pieces->count == 0 || p[pieces->count - 1].label != label) {
            p = tm_grow(p, &room, pieces->count + 1, sizeof *p);
            if (!p)
                return false;
            pieces->piece = p;
            p[pieces->count++] = (tm_boundary_piece){.label = label};
        }
        p += pieces->count - 1;
        p->faces++;
        p->volume += cone(b, face[0], face[1], face[2]);
        if (tm_boundary_face_corners(b, f) == 4)
            p->volume += cone(b, face[0], face[2], face[3]);
    }
    if (pieces->count > 0)
        qsort(pieces->piece, pieces->count, sizeof *pieces->piece, compare_pieces);
    join_pieces(pieces);
    return true;
}

tm_status tm_boundary_pieces_find(tm_boundary_pieces *pieces,
                                  const tm_boundary_view *view, tm_error *error)
{
    *pieces =
        (tm_boundary_pieces){.label = tm_new(view->octree->nodes, sizeof(uint32_t))};
    void *list = NULL;
    tm_status status = tm_ranks_enough(pieces->label, error);
    if (status == TM_OK)
        status = label_pieces(view, pieces->label, error);
    if (status != TM_OK)
        return status;
    const bool done = list_pieces(view, pieces);
    list = pieces->piece;
    status = share_list(view, &list, &pieces->count, sizeof *pieces->piece,
                        compare_pieces, done, error);
    pieces->piece = list;
    if (status == TM_OK)
        join_pieces(pieces);
    return status;
}

void tm_boundary_pieces_free(tm_boundary_pieces *pieces)
{
    free(pieces->label);
    free(pieces->piece);
    *pieces = (tm_boundary_pieces){.count = 0};
}

typedef struct {
    tm_interior *interior;
    const tm_boundary_view *view;
    const tm_boundary_pieces *pieces;
    uint32_t *leaf_label; /* [nodes of the octree]: those joined by leaves of a kind */
    leaf_set *set;        /* [sets]: with boundary, by label */
    size_t sets;
} finder;

static int compare_votes(const void *a, const void *b)
{
    const votes *p = a, *q = b;
    if (p->label != q->label)
        return p->label < q->label ? -1 : 1;
    return (p->shell > q->shell) - (p->shell < q->shell);
}

/* Adds up what is for the same shell in a sorted list; how many are left. */
static size_t join_votes(votes *list, size_t count)
{
    size_t joined = 0;
    for (size_t i = 0; i < count; i++)
        if (joined > 0 && compare_votes(&list[joined - 1], &list[i]) == 0)
            list[joined - 1].count += list[i].count;
        else
            list[joined++] = list[i];
    return joined;
}

static bool list_votes(const finder *f, const tm_surface *surface,
                       const tm_surface_point *at, votes **list, size_t *count)
{
    size_t room = 0, n = 0;
    *list = NULL;
    for (size_t s = f->view->nodes.first; s < f->view->nodes.past; s++) {
        const votes own = {label_of(f->view, f->pieces->label, (uint32_t)s),
                           surface->shell[at[s].triangle], 1};
        if (n > 0 && compare_votes(&(*list)[n - 1], &own) == 0) {
            (*list)[n - 1].count++;
            continue;
        }
        votes *grown = tm_grow(*list, &room, n + 1, sizeof own);
        if (!grown)
            return false;
        *list = grown;
        grown[n++] = own;
    }
    if (n > 0)
        qsort(*list, n, sizeof **list, compare_votes);
    *count = join_votes(*list, n);
    return true;
}

/* Each piece is of the shell that most of its nodes are closest to, of several the first.
 */
static tm_status find_shells(const finder *f, const tm_surface *surface,
                             const tm_surface_point *at, tm_error *error)
{
    votes *own;
    size_t count = 0;
    const bool done = list_votes(f, surface, at, &own, &count);
    void *list = own;
    const tm_status status =
        share_list(f->view, &list, &count, sizeof *own, compare_votes, done, error);
    votes *all = list;
    if (status == TM_OK)
        count = join_votes(all, count);
    size_t best = 0;
    for (size_t i = 0; status == TM_OK && i < count; i++) {
        if (i == 0 || all[i].label != all[i - 1].label)
            best = 0;
        if (all[i].count > best) {
            piece_of(f->pieces, all[i].label)->shell = all[i].shell;
            best = all[i].count;
        }
    }
    free(all);
    return status;
}

/* Of each shell the piece with most faces stays. */
static tm_status choose(const finder *f, const tm_surface *surface, tm_error *error)
{
    tm_boundary_piece *piece = f->pieces->piece;
    uint32_t *largest = tm_new(surface->components, sizeof *largest);
    if (!largest)
        return tm_fail_memory(error);
    for (size_t i = 0; i < surface->components; i++)
        largest[i] = TM_NONE;
    for (uint32_t i = 0; i < f->pieces->count; i++) {
        uint32_t *best = &largest[piece[i].shell];
        if (*best == TM_NONE || piece[i].faces > piece[*best].faces)
            *best = i;
    }
    for (size_t i = 0; i < surface->components; i++)
        if (largest[i] != TM_NONE)
            piece[largest[i]].stays = true;
    free(largest);
    return TM_OK;
}

static int compare_sets(const void *a, const void *b)
{
    const uint32_t p = ((const leaf_set *)a)->label, q = ((const leaf_set *)b)->label;
    return (p > q) - (p < q);
}

/* Puts together the marks of the same set in a sorted list; how many are left. */
static size_t join_sets(leaf_set *list, size_t count)
{
    size_t joined = 0;
    for (size_t i = 0; i < count; i++)
        if (joined > 0 && list[joined - 1].label == list[i].label)
            list[joined - 1].marks |= list[i].marks;
        else
            list[joined++] = list[i];
    return joined;
}

/* Lists the sets of leaves at own boundary nodes, with marks by the pieces there. */
static bool list_sets(finder *f, bool chosen)
{
    size_t room = 0;
    f->set = NULL;
    f->sets = 0;
    for (size_t s = f->view->nodes.first; s < f->view->nodes.past; s++) {
        const tm_boundary_piece *p =
            piece_of(f->pieces, label_of(f->view, f->pieces->label, (uint32_t)s));
        const bool goes = !p->stays && (p->volume > 0) == chosen;
        const leaf_set own = {label_of(f->view, f->leaf_label, (uint32_t)s),
                              goes ? TO_CHANGE : TO_KEEP};
        if (f->sets > 0 && f->set[f->sets - 1].label == own.label) {
            f->set[f->sets - 1].marks |= own.marks;
            continue;
        }
        leaf_set *grown = tm_grow(f->set, &room, f->sets + 1, sizeof own);
        if (!grown)
            return false;
        f->set = grown;
        grown[f->sets++] = own;
    }
    if (f->sets > 0)
        qsort(f->set, f->sets, sizeof *f->set, compare_sets);
    f->sets = join_sets(f->set, f->sets);
    return true;
}

/* Joins the nodes of the chosen leaves, or of the others, to connected parts, and marks
 * those of pieces that go: interior ones, or hollows. */
static tm_status mark_leaves(finder *f, bool chosen, tm_error *error)
{
    const tm_octree *octree = f->view->octree;
    start_sets(f->view, f->leaf_label);
    for (size_t l = 0; l < octree->leaves; l++)
        for (int p = 1; f->interior->chosen[l] == chosen && p < TM_LEAF_NODES; p++)
            if (octree->node[l][p] != TM_NONE)
                tm_set_unite(f->leaf_label, octree->node[l][0], octree->node[l][p]);
    tm_status status = name_sets(f->view, f->leaf_label, error);
    if (status != TM_OK)
        return status;
    const bool done = list_sets(f, chosen);
    void *list = f->set;
    status =
        share_list(f->view, &list, &f->sets, sizeof *f->set, compare_sets, done, error);
    f->set = list;
    if (status == TM_OK)
        f->sets = join_sets(f->set, f->sets);
    return status;
}

/* Changes the leaves that go, own ones and ghosts. */
static tm_status change_leaves(finder *f, bool chosen, size_t *changed, tm_error *error)
{
    const tm_octree *octree = f->view->octree;
    const tm_octree_share *share = f->view->share;
    const tm_status status = mark_leaves(f, chosen, error);
    for (size_t l = 0; status == TM_OK && l < octree->leaves; l++) {
        const leaf_set key = {.label = f->leaf_label[octree->node[l][0]]};
        if (f->interior->chosen[l] != chosen)
            continue;
        const leaf_set *set =
            f->sets > 0 ? bsearch(&key, f->set, f->sets, sizeof key, compare_sets) : NULL;
        if (!set || set->marks != TO_CHANGE)
            continue;
        f->interior->chosen[l] = !chosen;
        tm_interior_put_in_masks(f->interior, octree, l);
        *changed += !share || (l >= share->own_first && l < share->own_past);
    }
    free(f->set);
    f->set = NULL;
    return status;
}

static tm_status change_all(finder *f, bool *changed, tm_error *error)
{
    const tm_octree_share *share = f->view->share;
    size_t count[2] = {0, 0};
    tm_status status = change_leaves(f, true, &count[0], error);
    if (status == TM_OK)
        status = change_leaves(f, false, &count[1], error);
    tm_ranks_sum(count, 2);
    f->interior->removed += count[0];
    f->interior->filled += count[1];
    *changed = count[0] + count[1] > 0;
    if (status != TM_OK || !*changed)
        return status;
    if (!share) {
        tm_interior_find_used(f->interior, f->view->octree);
        return status;
    }
    status =
        tm_share_fill_nodes(share, f->interior->mask, sizeof *f->interior->mask, error);
    return status == TM_OK ? tm_interior_find_used_on_ranks(f->interior, share, error)
                           : status;
}

tm_status
tm_spurious_components_remove(tm_interior *interior, const tm_boundary_view *view,
                              const tm_boundary_pieces *pieces, const tm_surface *surface,
                              const tm_surface_point *at, bool *changed, tm_error *error)
{
    finder f = {.interior = interior,
                .view = view,
                .pieces = pieces,
                .leaf_label = tm_new(view->octree->nodes, sizeof *f.leaf_label)};
    tm_status status = f.leaf_label ? TM_OK : tm_fail_memory(error);
    *changed = false;
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = find_shells(&f, surface, at, error);
    if (status == TM_OK)
        status = tm_ranks_agree(choose(&f, surface, error), error);
    if (status == TM_OK)
        status = change_all(&f, changed, error);
    free(f.leaf_label);
    return status;
}
