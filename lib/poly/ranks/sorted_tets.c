/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Samples of all ranks cut the curve; each rank gets the tetrahedra of its piece and
 * sorts them, then all move a little, so that each has its slice. */
#include "parts.h"

#include "../../base/array.h"
#include "../../geom/place_order.h"
#include "../../geom/predicates.h"
#include "../../element/shape.h"
#include "../../ranks/post.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Each rank says so many positions of its tetrahedra. */
enum { SAMPLES = 1024 };

/* The box around all nodes. */
static void find_box(tm_sorted_tets *s, const tm_tet_slices *slices)
{
    for (int x = 0; x < 3; x++) {
        s->box[0][x] = HUGE_VAL;
        s->box[1][x] = -HUGE_VAL;
    }
    for (size_t v = 0; v < slices->nodes.count; v++)
        for (int x = 0; x < 3; x++) {
            s->box[0][x] = fmin(s->box[0][x], slices->node->real[3 * v + (size_t)x]);
            s->box[1][x] = fmax(s->box[1][x], slices->node->real[3 * v + (size_t)x]);
        }
    tm_ranks_least(s->box[0], 3);
    tm_ranks_largest(s->box[1], 3);
    s->space =
        tm_space_around((const double(*)[3])s->box, slices->nodes.total > 0 ? 2 : 0);
}

/* A tetrahedron, whose nodes are numbered by their places here, as a record with right
 * nodes. False where it is flat or names a node twice. */
static bool take_tet(tm_sorted_tets *s, const tm_part_nodes *nodes, const uint32_t *rank,
                     uint32_t n[4], uint32_t *record)
{
    const double(*x)[3] = (const double(*)[3])nodes->xyz;
    uint8_t corner[4];
    if (tm_has_node_twice(n, 4))
        return false;
    const int sign = tm_orient3d(x[n[0]], x[n[1]], x[n[2]], x[n[3]]);
    if (sign < 0) {
        const uint32_t third = n[2];
        n[2] = n[3];
        n[3] = third;
        s->turned++;
    }
    tm_tet_sort_corners((uint32_t[]){rank[n[0]], rank[n[1]], rank[n[2]], rank[n[3]]},
                        corner);
    for (int i = 0; i < 4; i++)
        record[i] = nodes->number[n[corner[i]]];
    return sign != 0;
}

/* Makes records of this rank's rows, and their positions. */
static tm_status take_rows(tm_sorted_tets *s, const tm_tet_slices *slices,
                           uint32_t *record, uint32_t *position, bool *odd,
                           tm_error *error)
{
    const size_t count = slices->tets.count, width = slices->width;
    uint32_t *list = tm_new(count, 4 * sizeof *list), *rank = NULL;
    tm_part_nodes nodes = {0};
    tm_status status = tm_ranks_enough(list, error);
    if (status == TM_OK && list && count > 0)
        memcpy(list, slices->ele->integer, 4 * count * sizeof *list);
    if (status == TM_OK)
        status = tm_part_nodes_make(&nodes, list, 4 * count, &slices->nodes,
                                    (const double(*)[3])slices->node->real, error);
    if (status == TM_OK) {
        rank = tm_new(nodes.set.count, sizeof *rank);
        status = tm_ranks_enough(rank && tm_place_rank((const double(*)[3])nodes.xyz,
                                                       nodes.set.count, 1, rank),
                                 error);
    }
    for (size_t t = 0; status == TM_OK && list && record && t < count && !*odd; t++) {
        uint32_t *to = record + t * s->words;
        *odd |= !take_tet(s, &nodes, rank, list + 4 * t, to);
        if (width > 0)
            memcpy(to + 4, slices->ele->attribute + t * width, width * sizeof(double));
        if (!*odd)
            position[t] = tm_space_position(
                &s->space, nodes.xyz[tm_number_set_below(&nodes.set, to[0])]);
    }
    tm_part_nodes_free(&nodes);
    free(list);
    free(rank);
    *odd = tm_ranks_any(*odd);
    tm_ranks_sum(&s->turned, 1);
    return status;
}

/* Cuts the curve by samples. */
static tm_status cut_curve(tm_sorted_tets *s, const uint32_t *position, size_t count,
                           tm_error *error)
{
    uint32_t sample[SAMPLES], *all;
    const unsigned ranks = tm_ranks_count();
    const size_t samples = count < SAMPLES ? count : SAMPLES;
    size_t total;
    for (size_t i = 0; i < samples; i++)
        sample[i] = position[count * i / samples];
    tm_status status =
        tm_ranks_share(sample, samples, sizeof *sample, (void **)&all, &total, error);
    s->cut = calloc(ranks, sizeof *s->cut);
    if (status == TM_OK)
        status = tm_ranks_enough(s->cut, error);
    if (status == TM_OK && total > 0) {
        qsort(all, total, sizeof *all, tm_compare_numbers);
        for (unsigned r = 1; r < ranks; r++)
            s->cut[r - 1] = all[total * r / ranks];
    }
    free(all);
    return status;
}

static unsigned rank_at(const tm_sorted_tets *s, uint32_t position)
{
    unsigned first = 0, past = tm_ranks_count() - 1;
    while (first < past) {
        const unsigned middle = first + (past - first) / 2;
        if (s->cut[middle] <= position)
            first = middle + 1;
        else
            past = middle;
    }
    return first;
}

unsigned tm_sorted_home(const tm_sorted_tets *sorted, const double place[3])
{
    return rank_at(sorted, tm_space_position(&sorted->space, place));
}

/* What the order goes by. */
typedef struct sorted_tet {
    uint32_t position, rank[4], item;
} sorted_tet;

static int compare(const void *a, const void *b)
{
    const sorted_tet *p = a, *q = b;
    if (p->position != q->position)
        return p->position < q->position ? -1 : 1;
    for (int i = 0; i < 4; i++)
        if (p->rank[i] != q->rank[i])
            return p->rank[i] < q->rank[i] ? -1 : 1;
    return (p->item > q->item) - (p->item < q->item);
}

/* Takes the nodes of the records that this rank has. */
static tm_status take_nodes(tm_part_nodes *nodes, const tm_sorted_tets *s, size_t count,
                            const uint32_t *record, const tm_tet_slices *slices,
                            uint32_t **list, tm_error *error)
{
    *list = tm_new(count, 4 * sizeof **list);
    tm_status status = tm_ranks_enough(*list, error);
    for (size_t t = 0; status == TM_OK && *list && t < count; t++)
        memcpy(*list + 4 * t, record + t * s->words, 4 * sizeof **list);
    if (status == TM_OK)
        status = tm_part_nodes_make(nodes, *list, 4 * count, &slices->nodes,
                                    (const double(*)[3])slices->node->real, error);
    return status;
}

/* Sorts the records of this rank's piece of the curve; they came in the order of rows. */
static tm_status sort_piece(const tm_sorted_tets *s, uint32_t **record, size_t count,
                            const tm_tet_slices *slices, tm_error *error)
{
    tm_part_nodes nodes = {0};
    uint32_t *list, *rank = NULL, *made = tm_new(count, s->words * sizeof *made);
    sorted_tet *order = tm_new(count, sizeof *order);
    tm_status status = take_nodes(&nodes, s, count, *record, slices, &list, error);
    if (status == TM_OK) {
        rank = tm_new(nodes.set.count, sizeof *rank);
        status = tm_ranks_enough(
            rank && made && order &&
                tm_place_rank((const double(*)[3])nodes.xyz, nodes.set.count, 1, rank),
            error);
    }
    if (status == TM_OK && order && made) {
        for (size_t t = 0; t < count; t++) {
            order[t].item = (uint32_t)t;
            order[t].position = tm_space_position(&s->space, nodes.xyz[list[4 * t]]);
            for (size_t i = 0; i < 4; i++)
                order[t].rank[i] = rank[list[4 * t + i]];
        }
        qsort(order, count, sizeof *order, compare);
        for (size_t t = 0; t < count; t++)
            memcpy(made + t * s->words, *record + order[t].item * s->words,
                   s->words * sizeof *made);
        free(*record);
        *record = made;
        made = NULL;
    }
    tm_part_nodes_free(&nodes);
    free(list);
    free(rank);
    free(made);
    free(order);
    return status;
}

/* Gives each rank its slice of the records that ranks have in order. */
static tm_status even_out(tm_sorted_tets *s, uint32_t *record, size_t count,
                          tm_error *error)
{
    tm_post post = {0};
    size_t total, words;
    const size_t before = tm_ranks_before(count, &total);
    s->rows = tm_rows_of(total);
    for (size_t t = 0; t < count; t++)
        tm_post_put(&post, tm_rows_owner(&s->rows, before + t), record + t * s->words,
                    s->words);
    return tm_post_deliver(&post, &s->record, &words, error);
}

static tm_status find_homes(tm_sorted_tets *s, tm_error *error)
{
    s->home = tm_new(s->nodes.set.count, sizeof *s->home);
    for (size_t v = 0; s->home && v < s->nodes.set.count; v++)
        s->home[v] = tm_sorted_home(s, s->nodes.xyz[v]);
    return tm_ranks_enough(s->home, error);
}

tm_status tm_sorted_tets_make(tm_sorted_tets *sorted, const tm_tet_slices *slices,
                              bool *odd, tm_error *error)
{
    const size_t count = slices->tets.count;
    const size_t words = 4 + slices->width * (sizeof(double) / sizeof(uint32_t));
    uint32_t *record = tm_new(count, words * sizeof *record), *piece = NULL, *list = NULL;
    uint32_t *position = tm_new(count, sizeof *position);
    tm_post post = {0};
    size_t got = 0;
    *sorted = (tm_sorted_tets){.words = words};
    find_box(sorted, slices);
    tm_status status = tm_ranks_enough(record && position, error);
    if (status == TM_OK)
        status = take_rows(sorted, slices, record, position, odd, error);
    if (status == TM_OK && !*odd)
        status = cut_curve(sorted, position, count, error);
    if (status == TM_OK && !*odd) {
        for (size_t t = 0; t < count; t++)
            tm_post_put(&post, rank_at(sorted, position[t]), record + t * words, words);
        status = tm_post_deliver(&post, &piece, &got, error);
    }
    free(record);
    free(position);
    got /= words;
    if (status == TM_OK && !*odd)
        status = sort_piece(sorted, &piece, got, slices, error);
    if (status == TM_OK && !*odd)
        status = even_out(sorted, piece, got, error);
    if (status == TM_OK && !*odd)
        status = take_nodes(&sorted->nodes, sorted, sorted->rows.count, sorted->record,
                            slices, &list, error);
    free(piece);
    free(list);
    return status == TM_OK && !*odd ? find_homes(sorted, error) : status;
}

void tm_sorted_tets_free(tm_sorted_tets *sorted)
{
    free(sorted->record);
    free(sorted->cut);
    free(sorted->home);
    tm_part_nodes_free(&sorted->nodes);
}
