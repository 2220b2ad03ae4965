/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "slices.h"

#include "../../base/array.h"
#include "../../base/number_set.h"
#include "../../ranks/ranks.h"
#include "../coordinates.h"

#include <stdlib.h>
#include <string.h>

/* How many of the ascending numbers each rank has. */
static void count_owners(size_t total, const uint32_t *number, size_t count, size_t *of)
{
    const unsigned ranks = tm_ranks_count();
    size_t at = 0;
    for (unsigned r = 0; r < ranks; r++) {
        const size_t past = tm_slice_first(total, ranks, r + 1), begin = at;
        while (at < count && number[at] < past)
            at++;
        of[r] = at - begin;
    }
}

tm_status tm_slices_fetch(const void *own, size_t total, size_t size,
                          const uint32_t *number, size_t count, void *row,
                          tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    const size_t first = tm_slice_first(total, ranks, tm_rank());
    size_t *asked = tm_new(2 * (size_t)ranks, sizeof *asked), items = 0;
    void *wanted = NULL, *got = NULL;
    char *answer = NULL;
    if (tm_ranks_any(!asked)) {
        free(asked);
        return tm_fail_memory(error);
    }
    size_t *of = asked + ranks;
    count_owners(total, number, count, of);
    tm_status status =
        tm_ranks_exchange(number, of, sizeof *number, &wanted, asked, error);
    for (unsigned r = 0; r < ranks && status == TM_OK; r++)
        items += asked[r];
    if (status == TM_OK) {
        answer = tm_new(items, size);
        if (tm_ranks_any(!answer))
            status = tm_fail_memory(error);
    }
    const char *mine = own;
    for (size_t i = 0; i < items && mine && status == TM_OK; i++)
        memcpy(answer + i * size, mine + (((const uint32_t *)wanted)[i] - first) * size,
               size);
    free(wanted);
    if (status == TM_OK)
        status = tm_ranks_exchange(answer, asked, size, &got, of, error);
    if (status == TM_OK && got && count > 0)
        memcpy(row, got, count * size);
    free(answer);
    free(got);
    free(asked);
    return status;
}

tm_status tm_slices_localize(uint32_t *item, size_t items, uint32_t **number,
                             size_t *numbers, tm_error *error)
{
    tm_number_set set = {0};
    const bool made = tm_number_set_of(&set, item, items, TM_NONE);
    *number = made ? tm_new(set.count, sizeof **number) : NULL;
    *numbers = *number ? set.count : 0;
    if (*number)
        tm_number_set_list(&set, *number);
    for (size_t i = 0; i < items && *number; i++)
        if (item[i] != TM_NONE)
            item[i] = tm_number_set_below(&set, item[i]);
    tm_number_set_free(&set);
    return *number ? TM_OK : tm_fail_memory(error);
}

tm_status tm_slices_take_nodes(const tm_slices *slices, uint32_t *item, size_t items,
                               uint32_t **number, size_t *numbers, double (**xyz)[3],
                               tm_error *error)
{
    tm_slice slice = {0, 0};
    const tm_block *node = tm_slices_find(slices, ".node", &slice);
    tm_status status = tm_slices_localize(item, items, number, numbers, error);
    *xyz = status == TM_OK ? tm_new(*numbers, sizeof **xyz) : NULL;
    if (status == TM_OK && !*xyz)
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    return status == TM_OK ? tm_slices_fetch(node ? node->real : NULL, slice.total,
                                             sizeof **xyz, *number, *numbers, *xyz, error)
                           : status;
}

tm_status tm_slices_check_coordinates(const tm_slices *slices, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t b = 0; b < slices->stream.blocks && status == TM_OK; b++) {
        const tm_block *block = &slices->stream.block[b];
        double largest = 0;
        if (block->kind != TM_NODE && block->kind != TM_ROOT)
            continue;
        status = tm_block_check_coordinates(
            block, slices->slice[b].before + slices->stream.base, &largest, error);
        status = tm_ranks_agree(status, error);
        tm_ranks_largest(&largest, 1);
        if (status == TM_OK)
            status = tm_largest_coordinate_check(largest, block->name, error);
    }
    return status;
}
