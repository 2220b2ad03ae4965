/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of a block that come through a pipe: rank 0 deals them; for lib/stream/ranks/
 * only.
 */
#ifndef TM_STREAM_RANKS_DEAL_H
#define TM_STREAM_RANKS_DEAL_H

#include "../reader.h"

/* Rank 0 is at the rows of a block; it keeps those of its slice and sends the others
 * theirs, as text. The same status on all ranks. */
tm_status tm_deal_rows(tm_reader *reader, tm_block *block, size_t rows, size_t limit,
                       tm_error *error);

#endif
