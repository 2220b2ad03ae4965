/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Coordinates that can be computed with. What computes looks at them first; a stream may
 * hold any finite number, and converters pass it on. */
#ifndef TM_STREAM_COORDINATES_H
#define TM_STREAM_COORDINATES_H

#include "../base/extern_c.h"
#include "stream.h"

TM_EXTERN_C_BEGIN

/* The square of a volume, the longest product that is formed, is the sixth power of a
 * length: within these it is a double, and so are sums of many, and parts that are some
 * powers of ten smaller than the whole. */
#define TM_COORDINATE_MAX 1e45
#define TM_COORDINATE_MIN 1e-45

/* TM_ERROR_INPUT, with the node's number from `base`, where a coordinate is not finite or
 * beyond TM_COORDINATE_MAX, or where all are below TM_COORDINATE_MIN, but not all 0.
 * O(n). */
tm_status tm_coordinates_check(const double (*xyz)[3], size_t count, unsigned base,
                               tm_error *error);

/* The same of each .node block of a stream, of the main mesh and the parts, and of .root;
 * the error names the block. */
tm_status tm_stream_check_coordinates(const tm_stream *stream, tm_error *error);

/* Its parts, of one block .node or .root, whose first row has that number: the error of a
 * coordinate that is not finite or too large; *largest grows to the largest there is. And
 * the error where that is too small. */
tm_status tm_block_check_coordinates(const tm_block *block, size_t first, double *largest,
                                     tm_error *error);
tm_status tm_largest_coordinate_check(double largest, const char *block, tm_error *error);

TM_EXTERN_C_END

#endif
