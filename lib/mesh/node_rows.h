/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What elements give to their nodes, on several threads without locks: nodes have rows,
 * these are cut into parts, and a part's work goes over the elements that have a row of
 * it. So each row meets its elements in their order, however many threads there are. */
#ifndef TM_MESH_NODE_ROWS_H
#define TM_MESH_NODE_ROWS_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "mixed_mesh.h"

#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Rows of a part: from `first` on, before `past`. */
typedef struct tm_row_range {
    uint32_t first, past;
} tm_row_range;

static inline bool tm_row_is_in(tm_row_range range, uint32_t row)
{
    return row - range.first < range.past - range.first;
}

typedef struct tm_node_rows {
    const tm_mixed_mesh *mesh;
    const uint32_t *row; /* [nodes], TM_NONE where it has none */
    size_t rows;
    unsigned shift; /* a part has 2^shift rows */
    uint64_t *met;  /* [chunks of elements]: a bit for each part that it has a row of */
} tm_node_rows;

/* Finds which parts elements have rows of. The arrays stay the caller's. TM_ERROR_SYSTEM
 * where memory is out; to be freed, after an error too. O(elements). */
tm_status tm_node_rows_find(tm_node_rows *rows, const tm_mixed_mesh *mesh,
                            const uint32_t *row, size_t count, tm_error *error);
void tm_node_rows_free(tm_node_rows *rows);

/* Calls visit(context, element, range) for all elements that have rows in the range, in
 * ascending order, and for all ranges at the same time. It may change what belongs to
 * rows of the range. */
void tm_node_rows_visit(const tm_node_rows *rows,
                        void (*visit)(void *context, size_t e, tm_row_range range),
                        void *context);

TM_EXTERN_C_END

#endif
