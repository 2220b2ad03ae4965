/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ViSF, the format of the mesh viewer Camarón (A. Infante Lombardo, Visualizador de
 * mallas de poliedros, Universidad de Chile, 2013), with what its descendants read:
 *
 *     order type        '0' big, '1' little endian, '2' text; 0 points, 1 polygons,
 *                       2 polyhedra
 *     points            then x y z of each
 *     polygons          then k v1 … vk of each
 *     flag              whether neighbours follow: of each polygon, k p1 … pk
 *     polyhedra         then k p1 … pk of each
 *
 * Types 1 and 2 have polygons and the flag, type 2 has polyhedra; all numbers are from 0.
 * In text each of these is a line. In binary files the order is one byte, that digit, or
 * in older files the number 0 or 1; then there are only integers and floats of 32 bits.
 */
#ifndef TM_FORMAT_VISF_H
#define TM_FORMAT_VISF_H

#include "../base/extern_c.h"
#include "../mesh/polyhedra.h"
#include "../stream/stream.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

typedef enum tm_visf_order { TM_VISF_BIG, TM_VISF_LITTLE, TM_VISF_TEXT } tm_visf_order;

typedef struct tm_visf_options {
    tm_visf_order order;
    bool neighbours; /* the flag is 1 and the neighbours follow */
    bool per_cell;   /* each cell has its own polygons */
} tm_visf_options;

enum { TM_VISF_DIGITS = 9 }; /* significant ones, of a coordinate in text */

/* Appends the main mesh of a stream, as tm_content_of() says, to *text. Coordinates have
 * TM_VISF_DIGITS, or are the nearest floats. Polygons are outward for the first
 * of their two cells, or per cell: then each is there once for each of its cells,
 * outward, cell by cell. Neighbours are the other polygons with an edge in common, per
 * cell those of the same cell. TM_ERROR_INPUT as tm_cell_faces_find(), or where a
 * coordinate is too large for a float or a number for 32 bits. O(size of the result). */
tm_status tm_visf_write(tm_text *text, const tm_stream *stream,
                        const tm_visf_options *options, tm_error *error);

/* Reads a file of any order, with or without the flag, into an empty stream of base 0:
 * .node alone; .node and .face; or .node, .facet and .cell. The facets keep the order and
 * the sense of the polygons but for the repairs above; their cells are those for which
 * they are outward and inward (see cell_orient.h). Neighbours are passed over.
 * In text a line may hold any number of numbers, and # begins a comment.
 * TM_ERROR_INPUT where the file is wrong or has what a stream cannot hold: a surface of
 * other polygons than triangles, a polyhedron of fewer than four, or one that is not
 * closed or has not two sides; a polygon of three polyhedra, or of two on its same side.
 * After an error the stream is empty. Expected O(size). */
tm_status tm_visf_read(tm_stream *stream, const char *bytes, size_t size,
                       const char *name, tm_polyhedra_repairs *repairs, tm_error *error);

TM_EXTERN_C_END

#endif
