/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rank_cuts.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    uint32_t begin[3];
} corner;

tm_status tm_rank_cuts_make(tm_rank_cuts *cuts, const tm_leaf_list *own, tm_error *error)
{
    corner first = {{UINT32_MAX, UINT32_MAX, UINT32_MAX}}, *all;
    *cuts = (tm_rank_cuts){.rank = tm_rank(), .ranks = tm_ranks_count()};
    if (own->count > 0)
        memcpy(first.begin, own->leaf[0].anchor, sizeof first.begin);
    const tm_status status =
        tm_ranks_share(&first, 1, sizeof first, (void **)&all, NULL, error);
    if (status != TM_OK)
        return status;
    for (unsigned r = cuts->ranks - 1; r-- > 0;)
        if (all[r].begin[0] == UINT32_MAX)
            all[r] = all[r + 1];
    cuts->begin = (uint32_t(*)[3])all;
    return TM_OK;
}

void tm_rank_cuts_free(tm_rank_cuts *cuts)
{
    free(cuts->begin);
    *cuts = (tm_rank_cuts){.ranks = 0};
}

unsigned tm_rank_cuts_at(const tm_rank_cuts *cuts, const uint32_t point[3])
{
    unsigned begin = 0,
             end = cuts->ranks; /* the last one that does not begin behind it */
    while (end - begin > 1) {
        const unsigned middle = begin + (end - begin) / 2;
        if (tm_z_is_before(point, cuts->begin[middle]))
            end = middle;
        else
            begin = middle;
    }
    return begin;
}

tm_status tm_leaf_list_spread(tm_leaf_list *list, tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    size_t weight = 0, all, all_leaves;
    for (size_t l = 0; l < list->count; l++)
        weight += tm_leaf_weight(&list->leaf[l]);
    size_t before = tm_ranks_before(weight, &all);
    tm_ranks_before(list->count, &all_leaves);
    tm_status status = TM_OK;
    if (all_leaves > TM_LEAVES_MAX)
        status = tm_leaf_list_check(all_leaves, error);
    size_t *count = calloc(ranks, sizeof *count);
    if (status == TM_OK && !count)
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    for (size_t l = 0; status == TM_OK && l < list->count; l++) {
        count[tm_rank_of_weight(before, all, ranks)]++;
        before += tm_leaf_weight(&list->leaf[l]);
    }
    void *got = NULL;
    if (status == TM_OK)
        status =
            tm_ranks_exchange(list->leaf, count, sizeof *list->leaf, &got, count, error);
    if (status == TM_OK) {
        free(list->leaf);
        *list = (tm_leaf_list){.leaf = got};
        for (unsigned r = 0; r < ranks; r++)
            list->count += count[r];
        list->room = list->count;
    }
    free(count);
    return status;
}
