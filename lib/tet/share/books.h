/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which ranks have a node: its home knows. */
#ifndef TM_TET_SHARE_BOOKS_H
#define TM_TET_SHARE_BOOKS_H

#include "share.h"

/* Of node home[rank] + v, the ranks that have it are rank[start[v]] … rank[start[v + 1]),
 * ascending. */
typedef struct tm_share_book {
    size_t *start;
    unsigned *rank;
} tm_share_book;

/* Fills this rank's book by the nodes of all ranks; the mail and the numbers that came
 * by it are to be freed. */
tm_status tm_share_book_make(tm_share_book *book, const tm_tet_share *share,
                             tm_mail *mail, uint32_t **number, tm_error *error);
void tm_share_book_free(tm_share_book *book);

/* tm_tet_share_widen() by a book that is made, and what came then. */
tm_status tm_share_widen_by(tm_tet_share *share, const tm_share_book *book,
                            const uint32_t *number, const tm_mail *mail,
                            const uint32_t *key, tm_tet_share *to, tm_error *error);

#endif
