/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "post.h"

#include "../base/array.h"
#include "ranks.h"

#include <stdlib.h>
#include <string.h>

void tm_post_put(tm_post *post, unsigned rank, const uint32_t *word, size_t count)
{
    if (!post->to)
        post->to = calloc(tm_ranks_count(), sizeof *post->to);
    if (!post->to) {
        post->failed = true;
        return;
    }
    struct tm_post_box *box = &post->to[rank];
    uint32_t *moved = tm_grow(box->word, &box->room, box->count + count, sizeof *moved);
    if (!moved) {
        post->failed = true;
        return;
    }
    box->word = moved;
    memcpy(moved + box->count, word, count * sizeof *moved);
    box->count += count;
}

/* All words one after the other; each box is emptied. NULL where memory is out, as it may
 * be for counts. */
static uint32_t *empty_boxes(tm_post *post, size_t *counts)
{
    const unsigned ranks = tm_ranks_count();
    size_t count = 0;
    for (unsigned r = 0; post->to && r < ranks; r++)
        count += post->to[r].count;
    uint32_t *all = post->failed || !counts ? NULL : tm_new(count, sizeof *all);
    count = 0;
    for (unsigned r = 0; post->to && r < ranks; r++) {
        const struct tm_post_box *box = &post->to[r];
        if (all && box->count > 0)
            memcpy(all + count, box->word, box->count * sizeof *all);
        if (all)
            counts[r] = box->count;
        count += box->count;
        free(box->word);
    }
    free(post->to);
    *post = (tm_post){0};
    return all;
}

tm_status tm_post_deliver(tm_post *post, uint32_t **got, size_t *count, tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    size_t *counts = calloc(ranks, sizeof *counts);
    uint32_t *all = empty_boxes(post, counts);
    *got = NULL;
    *count = 0;
    tm_status status = tm_ranks_enough(all, error);
    if (status == TM_OK)
        status = tm_ranks_exchange(all, counts, sizeof *all, (void **)got, counts, error);
    for (unsigned r = 0; status == TM_OK && r < ranks; r++)
        *count += counts[r];
    free(all);
    free(counts);
    return status;
}
