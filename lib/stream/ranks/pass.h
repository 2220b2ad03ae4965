/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text that rank 0 writes for the others, in their order. */
#ifndef TM_STREAM_RANKS_PASS_H
#define TM_STREAM_RANKS_PASS_H

#include "../../base/extern_c.h"
#include "../../base/error.h"

#include <stddef.h>

TM_EXTERN_C_BEGIN

/* Another rank: some of it, and that there is no more. */
void tm_pass_text(const char *bytes, size_t size);
void tm_pass_end(void);

/* Rank 0: writes to fd what comes from each other rank, one after the other, to the end
 * of each; after an error, as `before` may be one, what comes is lost. */
tm_status tm_pass_on(int fd, tm_status before, tm_error *error);

TM_EXTERN_C_END

#endif
