/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Items that go to the rank that each is for, and answers that come back. */
#ifndef TM_RANKS_MAIL_H
#define TM_RANKS_MAIL_H

#include "ranks.h"

#include <stdint.h>

TM_EXTERN_C_BEGIN

typedef struct tm_mail {
    size_t items;      /* that this rank sends */
    size_t *count;     /* [ranks]: of these, for each */
    size_t *place;     /* [items]: where each is among them, rank by rank */
    size_t got;        /* that came */
    size_t *got_count; /* [ranks]: of these, from each, in the order of ranks */
} tm_mail;

/* Item k goes to rank to[k]. All functions are called by all ranks, and fail on all of
 * them: TM_ERROR_SYSTEM where memory is out. tm_mail_free() in any case. O(items). */
tm_status tm_mail_address(tm_mail *mail, const unsigned *to, size_t items,
                          tm_error *error);
void tm_mail_free(tm_mail *mail);

/* Sends item[items] of `size` bytes. *got, to be freed, has those that came: of each rank
 * in the order in which it has them. May be called again, with other items. */
tm_status tm_mail_send(tm_mail *mail, const void *item, size_t size, void **got,
                       tm_error *error);

/* Sends an answer of `size` bytes to each item that came, and gets those to its own:
 * (*to)[items], to be freed. */
tm_status tm_mail_answer(const tm_mail *mail, const void *answer, size_t size, void **to,
                         tm_error *error);

/* Which rank has it. O(log ranks). */
unsigned tm_rank_of(const size_t *first, size_t item);

TM_EXTERN_C_END

#endif
