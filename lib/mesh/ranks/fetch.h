/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of other ranks' slices. */
#ifndef TM_MESH_RANKS_FETCH_H
#define TM_MESH_RANKS_FETCH_H

#include "../../base/extern_c.h"
#include "../../base/error.h"
#include "../../base/number_set.h"
#include "rows.h"

TM_EXTERN_C_BEGIN

/* All ranks: *got, to be freed, has the rows of the numbers in a set, in ascending order,
 * `size` bytes each. mine[rows->count] are the rows of this rank's slice. TM_ERROR_SYSTEM
 * where memory is out. */
tm_status tm_ranks_fetch(const tm_rows *rows, const void *mine, size_t size,
                         const tm_number_set *wanted, void **got, tm_error *error);

TM_EXTERN_C_END

#endif
