/* SPDX-License-Identifier: GPL-3.0-or-later */
/* TetGen's .node, .ele, .face and .edge files, as they are in the wild: numbered from 0
 * or 1, with comments anywhere, attributes, markers, CR LF, header fields left out.
 * What such a file holds is what a block of the stream holds. */
#ifndef TM_FORMAT_TETGEN_ROWS_H
#define TM_FORMAT_TETGEN_ROWS_H

#include "../stream/stream.h"
#include "scan.h"

/* Reads a header and its rows at scan into *block, whose name and kind are set and which
 * is otherwise empty. Of kind TM_NODE, the first row tells *base (it stays as it was
 * where there are no rows); other kinds need it: their indices must be in
 * *base … *base + nodes - 1. Rows must be numbered without a gap. The two tetrahedra
 * that `tetgen -nn` adds to rows of .face, and the one to rows of .edge, are skipped.
 * Second-order elements (-o2) are refused. After an error the block's arrays are
 * freed. O(bytes). */
tm_status tm_tetgen_read_rows(tm_block *block, tm_scan *scan, unsigned *base,
                              size_t nodes, tm_error *error);

/* A scan over a whole file with TetGen's comment sign. */
void tm_tetgen_begin(tm_scan *scan, const char *bytes, size_t size, const char *name);

#endif
