/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the reader and the writer know of each kind of block; for lib/stream/ only. */
#ifndef TM_STREAM_BLOCK_H
#define TM_STREAM_BLOCK_H

#include "stream.h"

enum { TM_HEADER_ATTRIBUTES = -1, TM_HEADER_MARKERS = -2, TM_HEADER_ZERO = -3 };

/* Of the six integers of an octant the first four are no indices: level x y z. */
enum { TM_OCTANT_PLAIN = 4 };

/* The header is the count, then `headers` numbers: fixed ones, or how many attributes,
 * or whether there are markers, or 0. A row is its number, `reals` reals, `integers`
 * integers, k and k items where there is a list, the attributes, the marker. */
typedef struct tm_block_shape {
    const char *suffix;
    int header[3];
    size_t headers;
    size_t reals;
    size_t integers;
    bool list;
} tm_block_shape;

const tm_block_shape *tm_block_shape_of(tm_block_kind kind);

/* Makes room for `rows` rows in all arrays but item. The first min(old, new) rows keep
 * their contents. False where memory is out; the block is then still consistent. */
bool tm_block_resize(tm_block *block, size_t rows);

#endif
