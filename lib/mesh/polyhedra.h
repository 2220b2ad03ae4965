/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polyhedra of a stream from lists of polygons, as formats have them that do not say who
 * is on which side of one. */
#ifndef TM_MESH_POLYHEDRA_H
#define TM_MESH_POLYHEDRA_H

#include "../base/error.h"
#include "../base/extern_c.h"
#include "../stream/stream.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Lists of numbers, one after another: list l is item[start[l]] … item[start[l + 1] - 1].
 */
typedef struct tm_lists {
    size_t count;
    size_t *start; /* [count + 1] */
    uint32_t *item;
    size_t start_room, item_room;
} tm_lists;

/* Frees what there is and makes room for lists: none yet. False where memory is out. */
bool tm_lists_begin(tm_lists *lists);

/* Room for k more items, which may be written behind the last one; NULL where memory is
 * out. tm_lists_end() makes them the next list. */
uint32_t *tm_lists_room(tm_lists *lists, size_t k);
bool tm_lists_end(tm_lists *lists, size_t k);

void tm_lists_free(tm_lists *lists);

/* What had to be done. */
typedef struct tm_polyhedra_repairs {
    size_t joined;  /* polygons that were there before, and became one with those */
    size_t dropped; /* polygons that no polyhedron has */
    size_t turned;  /* polygons at the boundary that were inward */
} tm_polyhedra_repairs;

/* Adds .facet and .cell, without attributes and markers, to a stream with .node: facets
 * are the polygons (lists of nodes) in their order, and turn as they do, but for the
 * repairs; cells are the polyhedra (lists of polygons). Which cell is on which side of a
 * facet follows from cell_orient.h. The lists are changed, and are to be freed.
 * TM_ERROR_INPUT, with `file`, for a polyhedron that has a polygon twice, a polygon of
 * three of them, and as tm_cells_orient(). Expected O(size). */
tm_status tm_polyhedra_to_stream(tm_stream *stream, tm_lists *polygons,
                                 tm_lists *polyhedra, const char *file,
                                 tm_polyhedra_repairs *repairs, tm_error *error);

TM_EXTERN_C_END

#endif
