/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Letters of a few words to other ranks, of any length, which are delivered together. */
#ifndef TM_RANKS_POST_H
#define TM_RANKS_POST_H

#include "../base/extern_c.h"
#include "../base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* {0} is empty. */
typedef struct tm_post {
    struct tm_post_box {
        uint32_t *word;
        size_t count, room;
    } * to;      /* [tm_ranks_count()] */
    bool failed; /* memory is out: tm_post_deliver() says so */
} tm_post;

/* Adds a letter to a rank. */
void tm_post_put(tm_post *post, unsigned rank, const uint32_t *word, size_t count);

/* All ranks: *got, to be freed, has the words that came, in the order of ranks and, of
 * each, in the order in which they were put; *count of them. The post is empty then, also
 * after an error, which is TM_ERROR_SYSTEM, on all ranks. */
tm_status tm_post_deliver(tm_post *post, uint32_t **got, size_t *count, tm_error *error);

TM_EXTERN_C_END

#endif
