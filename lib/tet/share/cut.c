/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of a mesh that ranks have together: where the cuts are, and what goes where. */
#include "share.h"

#include "../../base/array.h"
#include "../../geom/space_order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The box around all nodes as the round sees them. */
static tm_space find_space(const tm_tet_share *share, unsigned round)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    double high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    double q[3];
    for (size_t v = 0; v < share->mesh.nodes; v++) {
        tm_tet_parts_turn(share->mesh.xyz[v], round, q);
        tm_box_extend(low, high, q);
    }
    for (size_t v = 0; v < share->loose; v++) {
        tm_tet_parts_turn(share->loose_nodes.xyz[v], round, q);
        tm_box_extend(low, high, q);
    }
    tm_ranks_least(low, 3);
    tm_ranks_largest(high, 3);
    return tm_space_of_box(low, high);
}

/* The rank's own tetrahedra along the curve. */
static tm_curve_point *find_order(const tm_tet_share *share, unsigned round,
                                  size_t *count)
{
    const tm_space space = find_space(share, round);
    const tm_tet_mesh *mesh = &share->mesh;
    tm_curve_point *placed = tm_new(mesh->slots, sizeof *placed);
    *count = 0;
    for (uint32_t t = 0; t < mesh->slots && placed; t++) {
        if (share->own && !share->own[t])
            continue;
        double q[3];
        tm_tet_parts_turn(mesh->xyz[mesh->tet[t][0]], round, q);
        placed[(*count)++] = (tm_curve_point){tm_space_position(&space, q), t};
    }
    if (placed && !tm_space_sort(placed, *count, 1)) {
        free(placed);
        placed = NULL;
    }
    return placed;
}

/* How many are before a position. */
static size_t count_before(const tm_curve_point *placed, size_t count, size_t position)
{
    size_t begin = 0, end = count;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (placed[middle].position < position)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

enum { POSITION_BITS = 30 };

/* position[r]: the last one before which there are not more than before[r] of all. */
static void find_positions(const tm_curve_point *placed, size_t count, size_t *position,
                           const size_t *before, size_t *sum, unsigned ranks)
{
    memset(position, 0, ranks * sizeof *position);
    for (int bit = POSITION_BITS - 1; bit >= 0; bit--) {
        for (unsigned r = 0; r < ranks; r++)
            sum[r] = count_before(placed, count, position[r] | (size_t)1 << bit);
        tm_ranks_sum(sum, ranks);
        for (unsigned r = 0; r < ranks; r++)
            if (sum[r] <= before[r])
                position[r] |= (size_t)1 << bit;
    }
    for (unsigned r = 0; r < ranks; r++)
        sum[r] = count_before(placed, count, position[r]);
    tm_ranks_sum(sum, ranks);
}

/* split[r]: how many of this rank's go to ranks before r, if before[r] of all do. What is
 * at one position goes in the order of ranks. Its room is for ranks + 1. */
static bool split(const tm_curve_point *placed, size_t count, const size_t *before,
                  size_t *split)
{
    const unsigned ranks = tm_ranks_count();
    size_t *position = tm_new(ranks, sizeof *position), *sum = tm_new(ranks, sizeof *sum);
    const bool done = !tm_ranks_any(!position || !sum);
    if (done && position)
        find_positions(placed, count, position, before, sum, ranks);
    for (unsigned r = 0; r < ranks && done; r++) {
        const size_t first = count_before(placed, count, position[r]);
        const size_t tied = count_before(placed, count, position[r] + 1) - first;
        const size_t tied_before = tm_ranks_before(tied, NULL);
        const size_t left = before[r] - sum[r]; /* of those that are tied */
        const size_t mine = left > tied_before ? left - tied_before : 0;
        split[r] = first + (mine < tied ? mine : tied);
    }
    if (done)
        split[ranks] = count;
    free(position);
    free(sum);
    return done;
}

/* The first of `count` parts that rank r has. */
static size_t first_part(size_t count, unsigned r)
{
    return count * r / tm_ranks_count();
}

static bool make_deal(tm_tet_deal *deal, const tm_tet_share *share, size_t parts,
                      unsigned round)
{
    const unsigned ranks = tm_ranks_count();
    size_t count, *before = tm_new(ranks, sizeof *before);
    size_t *cut = tm_new(ranks + (size_t)1, sizeof *cut);
    tm_curve_point *placed = find_order(share, round, &count);
    deal->tets = count;
    deal->count = calloc(ranks, sizeof *deal->count);
    deal->tet = tm_new(count, sizeof *deal->tet);
    deal->key = tm_new(count, sizeof *deal->key);
    bool done = before && cut && placed && deal->count && deal->tet && deal->key;
    done = !tm_ranks_any(!done);
    for (unsigned r = 0; r < ranks && done; r++)
        before[r] = share->all_tets * first_part(parts, r) / parts;
    done = done && split(placed, count, before, cut);
    for (unsigned r = 0; r < ranks && done; r++)
        deal->count[r] = cut[r + 1] - cut[r];
    for (size_t k = 0; k < count && done; k++) {
        deal->tet[k] = placed[k].item;
        deal->key[k] = placed[k].position;
    }
    free(before);
    free(cut);
    free(placed);
    return done;
}

/* The rank's parts of all, whose tetrahedra it has. */
static bool list_parts(tm_tet_parts *parts, const tm_tet_share *share, size_t all)
{
    const size_t tets = share->mesh.slots;
    const size_t first = first_part(all, tm_rank());
    const size_t begin = share->all_tets * first / all;
    *parts = (tm_tet_parts){.count = first_part(all, tm_rank() + 1) - first};
    parts->order = tm_new(tets, sizeof *parts->order);
    parts->place = tm_new(tets + 1, sizeof *parts->place);
    parts->part = calloc(parts->count + 1, sizeof *parts->part);
    if (!parts->order || !parts->place || !parts->part ||
        !tm_tet_parts_note_edges(parts, &share->mesh))
        return false;
    for (uint32_t t = 0; t < tets; t++)
        parts->order[t] = parts->place[t] = t;
    parts->place[share->beyond] = TM_NONE;
    for (size_t p = 0; p < parts->count; p++) {
        tm_tet_part *part = &parts->part[p];
        part->first = (uint32_t)(share->all_tets * (first + p) / all - begin);
        part->past = (uint32_t)(share->all_tets * (first + p + 1) / all - begin);
        part->mesh.first_dead = TM_NONE;
    }
    return true;
}

tm_status tm_tet_share_deal_along(tm_tet_share *share, size_t parts, unsigned round,
                                  tm_error *error)
{
    tm_tet_deal deal = {0};
    tm_status status =
        make_deal(&deal, share, parts, round) ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_tet_share_deal(share, &deal, share, error);
    free(share->own);
    share->own = NULL;
    tm_tet_deal_free(&deal);
    return status;
}

tm_status tm_tet_share_cut(tm_tet_share *share, tm_tet_parts *parts, size_t size,
                           unsigned round, tm_error *error)
{
    const size_t count = tm_tet_parts_count(share->all_tets, size);
    *parts = (tm_tet_parts){0};
    tm_status status = tm_tet_share_deal_along(share, count, round, error);
    if (status == TM_OK && !list_parts(parts, share, count))
        status = tm_fail_memory(error);
    return tm_ranks_agree(status, error);
}

/* A face whose other tetrahedron another rank has. */
typedef struct cut_face {
    uint32_t node[3]; /* ascending */
    bool stays;       /* whatever is beyond */
} cut_face;

static int compare(const void *a, const void *b)
{
    const cut_face *f = a, *g = b;
    for (int i = 0; i < 3; i++)
        if (f->node[i] != g->node[i])
            return f->node[i] < g->node[i] ? -1 : 1;
    return 0;
}

static cut_face *list_cut(const tm_tet_share *share, size_t *count)
{
    const tm_tet_mesh *mesh = &share->mesh;
    cut_face *list = NULL;
    size_t room = 0;
    *count = 0;
    for (uint32_t h = 0; h < 4 * mesh->slots; h++) {
        if (tm_tet_across(mesh, h / 4, h % 4) / 4 != share->beyond)
            continue;
        cut_face *moved = tm_grow(list, &room, *count + 1, sizeof *list);
        if (!moved) {
            free(list);
            return NULL;
        }
        list = moved;
        cut_face *face = &list[(*count)++];
        face->stays = mesh->neighbour[h / 4][h % 4] & TM_FACE_BIT;
        for (uint32_t i = 0, k = 0; i < 4; i++)
            if (i != h % 4)
                face->node[k++] = mesh->tet[h / 4][i];
        qsort(face->node, 3, sizeof *face->node, tm_compare_numbers);
    }
    if (!list)
        return tm_new(0, sizeof *list);
    qsort(list, *count, sizeof *list, compare);
    return list;
}

/* Faces of the list are no boundary. */
static void open_cut(tm_tet_share *share, const cut_face *list, size_t count)
{
    tm_tet_mesh *mesh = &share->mesh;
    const uint32_t across = 4 * share->beyond;
    for (size_t f = 0; f < mesh->faces && list && count > 0; f++) {
        tm_constrained_face *face = &mesh->face[f];
        const bool first = face->side[0] == TM_NONE;
        if (!first && face->side[1] != TM_NONE)
            continue;
        cut_face key;
        memcpy(key.node, face->node, sizeof key.node);
        qsort(key.node, 3, sizeof *key.node, tm_compare_numbers);
        const cut_face *found = bsearch(&key, list, count, sizeof *list, compare);
        if (!found)
            continue;
        const uint32_t h = face->side[first];
        face->side[!first] = across;
        if (!found->stays)
            mesh->neighbour[h / 4][h % 4] = across;
    }
}

/* Numbers of the nodes that the parts have made: behind all others, part by part. */
static tm_status number_nodes(tm_tet_share *share, size_t nodes, tm_error *error)
{
    const size_t all = share->mesh.nodes;
    uint32_t *number = realloc(share->number, (all + 1) * sizeof *number);
    if (number)
        share->number = number;
    size_t more, before = tm_ranks_before(all - nodes, &more);
    for (size_t v = nodes; v < all && number; v++)
        number[v] = (uint32_t)(share->all_nodes + before + v - nodes);
    share->all_nodes += more;
    if (share->all_nodes >= TM_NONE)
        return tm_fail(error, TM_ERROR_SYSTEM, "more than %u nodes", TM_NONE - 1);
    return number ? TM_OK : tm_fail_memory(error);
}

/* Homes of all nodes, as many for each rank. */
static void find_homes(tm_tet_share *share)
{
    const size_t ranks = tm_ranks_count();
    for (size_t r = 0; r <= ranks; r++)
        share->home[r] =
            share->all_nodes / ranks * r + share->all_nodes % ranks * r / ranks;
}

tm_status tm_tet_share_join(tm_tet_share *share, tm_tet_parts *parts, unsigned threads,
                            size_t *inner_faces, tm_error *error)
{
    const size_t nodes = share->mesh.nodes;
    size_t count;
    cut_face *list = list_cut(share, &count);
    tm_status status = list ? TM_OK : tm_fail_memory(error);
    *inner_faces = 0;
    for (size_t p = 0; p < parts->count; p++)
        for (size_t f = 0; f < parts->part[p].mesh.faces; f++) {
            const uint32_t *side = parts->part[p].mesh.face[f].side;
            *inner_faces += side[0] != TM_NONE && side[1] != TM_NONE;
        }
    free(share->index);
    free(share->own);
    share->index = NULL;
    share->own = NULL;
    if (status == TM_OK)
        status = tm_tet_parts_join(parts, &share->mesh, threads, error);
    if (status == TM_OK) {
        share->beyond = (uint32_t)share->mesh.slots;
        open_cut(share, list, count);
    }
    free(list);
    tm_error numbering;
    if (number_nodes(share, nodes, &numbering) != TM_OK && status == TM_OK)
        status = tm_fail_as(error, &numbering);
    find_homes(share);
    share->all_tets = share->mesh.tets;
    tm_ranks_sum(&share->all_tets, 1);
    return tm_ranks_agree(status, error);
}
