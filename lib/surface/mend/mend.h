/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles as scans and CAD systems write them, made a closed surface: corners that are
 * nearly one, triangles without area or there twice, edges with a node in their middle,
 * shells turned the wrong way, holes, splinters. */
#ifndef TM_SURFACE_MEND_H
#define TM_SURFACE_MEND_H

#include "../../base/extern_c.h"
#include "../../stream/stream.h"
#include "../surface.h"

#include <stdbool.h>

TM_EXTERN_C_BEGIN

/* The things that are done, in their order. */
typedef enum tm_mend_step {
    TM_MEND_WELDED,     /* nodes that were joined to another one */
    TM_MEND_DEGENERATE, /* triangles with a node twice, dropped */
    TM_MEND_DOUBLE,     /* triangles with the nodes of an earlier one, dropped */
    TM_MEND_FLAT,    /* triangles without area, in whose place a neighbour is divided */
    TM_MEND_SPLIT,   /* nodes in the middle of an edge, which is divided there */
    TM_MEND_FILLED,  /* holes that were closed */
    TM_MEND_ISLANDS, /* pieces of surface that were dropped */
    TM_MEND_TURNED,  /* pieces of which triangles were turned */
    TM_MEND_STEPS
} tm_mend_step;

typedef struct tm_mend_options {
    double weld;      /* nodes of open edges so close are one; negative: 1e-9 of the
                         diagonal of the box; with weld_auto it is looked for */
    bool weld_auto;   /* the distance, up to 1e-2 of the diagonal, that leaves the fewest
                         open edges, the least of these */
    double fill;      /* holes whose box has a diagonal so long or less are closed; 0 */
    double islands;   /* pieces whose box has such a diagonal are dropped; 0 */
    bool all_doubles; /* of two triangles that are turned to each other both go, as of
                         the wall of two bodies that become one */
} tm_mend_options;

typedef struct tm_mended {
    size_t count;
    double place[3]; /* of the first one */
} tm_mended;

typedef struct tm_mend_report {
    tm_mended step[TM_MEND_STEPS];
    double weld;                    /* the distance that was taken */
    size_t open_before, open_edges; /* edges of one triangle */
    bool manifold;                  /* each edge has two triangles, which turn alike */
} tm_mend_report;

/* Mends the triangles of .face, whose nodes are in .node. A step that leaves more open or
 * crowded edges than there were is taken back. Markers stay; triangles that fill a hole
 * have that of one beside it. Nodes are never moved, and none is made; those that none
 * has any more after the first three steps are dropped, and the others numbered anew.
 * Where nothing is to be done the stream stays as it is. TM_ERROR_SYSTEM where memory is
 * out. Expected O(n) but for the nodes near open edges. */
tm_status tm_mend(tm_stream *stream, const tm_mend_options *options,
                  tm_mend_report *report, tm_error *error);

/* Turns the triangles of .face that bound the outside outward, of a surface with walls
 * that was built of them as `polygons`: tm_mend() cannot, where pieces end at walls. Adds
 * to *turned. O(n). */
void tm_mend_turn_outward(tm_block *face, const tm_surface *surface,
                          const tm_polygon_surface *polygons, tm_mended *turned);

TM_EXTERN_C_END

#endif
