/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "parts.h"

#include "../../base/array.h"
#include "../../base/hash.h"
#include "../../ranks/post.h"

#include <stdlib.h>
#include <string.h>

void tm_rename_places(tm_defect_list *list, size_t numbers, const uint32_t *name)
{
    for (size_t i = 0; i < list->count && i < TM_DEFECTS_LISTED; i++)
        for (size_t n = 0; n < numbers; n++)
            if (list->place[i][n] != TM_NONE)
                list->place[i][n] = name[list->place[i][n]];
}

/* Nodes of all --------------------------------------------------------------------- */

/* A node with its coordinates, as it is sent. */
enum { NODE_WORDS = 1 + 3 * sizeof(double) / sizeof(uint32_t) };

/* Sends each node to a rank by where it is. */
static void send_nodes(tm_post *post, const tm_rows *rows, const double (*own)[3])
{
    for (size_t v = 0; v < rows->count; v++) {
        uint32_t letter[NODE_WORDS] = {(uint32_t)(rows->first + v)};
        double x[3];
        uint64_t bits[3], h = 0;
        for (size_t i = 0; i < 3; i++)
            x[i] = own[v][i] + 0.0; /* -0 becomes 0 */
        memcpy(bits, x, sizeof bits);
        memcpy(letter + 1, x, sizeof x);
        for (size_t i = 0; i < 3; i++)
            h = tm_hash(h, bits[i]);
        tm_post_put(post, (unsigned)((h >> 32) % tm_ranks_count()), letter, NODE_WORDS);
    }
}

tm_status tm_examine_nodes_ranks(tm_examination *found, const tm_rows *rows,
                                 const double (*own)[3], tm_error *error)
{
    tm_post post = {0};
    uint32_t *got;
    size_t words;
    send_nodes(&post, rows, own);
    tm_status status = tm_post_deliver(&post, &got, &words, error);
    if (status != TM_OK)
        return status;
    const size_t count = words / NODE_WORDS; /* in ascending order */
    double(*xyz)[3] = tm_new(count, sizeof *xyz);
    uint32_t *number = tm_new(count, sizeof *number);
    bool enough = xyz && number;
    for (size_t v = 0; enough && v < count; v++) {
        number[v] = got[v * NODE_WORDS];
        memcpy(xyz[v], got + v * NODE_WORDS + 1, sizeof *xyz);
    }
    free(got);
    if (enough) {
        enough = tm_examine_nodes(found, (const double(*)[3])xyz, count, error) == TM_OK;
        tm_rename_places(&found->defect[TM_DUPLICATE_NODE], 2, number);
    }
    free(xyz);
    free(number);
    return tm_ranks_enough(enough, error);
}

tm_status tm_count_used_nodes(const tm_rows *rows, const uint32_t *node, size_t count,
                              size_t *used, tm_error *error)
{
    tm_post post = {0};
    uint32_t *got;
    size_t words;
    for (size_t i = 0; i < count; i++)
        tm_post_put(&post, tm_rows_owner(rows, node[i]), &node[i], 1);
    tm_status status = tm_post_deliver(&post, &got, &words, error);
    if (status != TM_OK)
        return status;
    tm_number_set set = {0};
    status = tm_ranks_enough(tm_number_set_of(&set, got, words, TM_NONE), error);
    *used = set.count;
    tm_ranks_sum(used, 1);
    tm_number_set_free(&set);
    free(got);
    return status;
}

/* Sums ----------------------------------------------------------------------------- */

void tm_sum_in_turn(void *sum, size_t size, void (*add)(const void *context, void *sum),
                    const void *context)
{
    const unsigned rank = tm_rank(), last = tm_ranks_count() - 1;
    size_t got;
    if (rank > 0)
        tm_ranks_receive(rank - 1, sum, size, &got);
    add(context, sum);
    if (last == 0)
        return;
    tm_ranks_send(rank < last ? rank + 1 : 0, sum, size);
    if (rank == 0)
        tm_ranks_receive(last, sum, size, &got);
    tm_ranks_broadcast(sum, size);
}

tm_status tm_sum_of_chunks(const tm_sum *chunk, size_t chunks, double *sum,
                           tm_error *error)
{
    tm_sum *all;
    size_t count;
    const tm_status status =
        tm_ranks_share(chunk, chunks, sizeof *chunk, (void **)&all, &count, error);
    if (status == TM_OK)
        *sum = tm_sum_all(all, count);
    free(all);
    return status;
}

/* All together --------------------------------------------------------------------- */

tm_status tm_examination_join(tm_examination *found, tm_error *error)
{
    size_t count[] = {found->boundary_faces, found->components, found->unused_nodes,
                      (size_t)found->euler};
    tm_defect_list(*all)[TM_DEFECTS];
    size_t ranks;
    tm_ranks_sum(count, sizeof count / sizeof *count);
    tm_ranks_sum(found->kind, TM_ELEMENT_KINDS);
    found->boundary_faces = count[0];
    found->components = count[1];
    found->unused_nodes = count[2];
    found->euler = (int64_t)count[3];
    const tm_status status = tm_ranks_share(found->defect, 1, sizeof found->defect,
                                            (void **)&all, &ranks, error);
    if (status != TM_OK)
        return status;
    memset(found->defect, 0, sizeof found->defect);
    for (size_t r = 0; r < ranks; r++)
        for (size_t d = 0; d < TM_DEFECTS; d++)
            tm_defect_add_list(&found->defect[d], &all[r][d]);
    free(all);
    return TM_OK;
}
