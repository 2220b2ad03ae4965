/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers that rows of a file have, from 0 or 1 on, and the rows in their order. */
#ifndef TM_FORMAT_ROW_ORDER_H
#define TM_FORMAT_ROW_ORDER_H

#include "../stream/stream.h"

/* Begins as {0}. */
typedef struct tm_row_order {
    int64_t first;    /* the least number, once it is known */
    uint32_t *number; /* [rows so far] where they are not in order, else NULL */
    size_t room;
} tm_row_order;

typedef enum tm_row_numbered {
    TM_ROW_NUMBERED,
    TM_ROW_WRONG, /* below 0, or above the number of rows */
    TM_ROW_NO_MEMORY
} tm_row_numbered;

/* Row `row` of `rows` has this number. O(1), but for the first one that is not the next.
 */
tm_row_numbered tm_row_order_add(tm_row_order *order, size_t rows, size_t row,
                                 int64_t number);

/* After the last of `rows` > 0: false where a number lacks, which is *number then, so
 * that another one is there twice. O(rows). */
bool tm_row_order_finish(tm_row_order *order, size_t rows, int64_t *number);

/* Puts the rows of a block of .node, .ele, .face or .edge in the order of their numbers.
 * False where memory is out. O(rows). */
bool tm_row_order_apply(const tm_row_order *order, tm_block *block);

void tm_row_order_free(tm_row_order *order);

#endif
