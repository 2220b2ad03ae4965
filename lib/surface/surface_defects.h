/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is wrong with a surface, as far as counting shows it: before a mesher is run on
 * it, or to explain why that failed. */
#ifndef TM_SURFACE_SURFACE_DEFECTS_H
#define TM_SURFACE_SURFACE_DEFECTS_H

#include "../base/extern_c.h"
#include "polygon_surface.h"

TM_EXTERN_C_BEGIN

enum { TM_EDGES_LISTED = 5 };

typedef struct tm_surface_defects {
    size_t duplicate_nodes;                 /* nodes where an earlier one is */
    size_t unused_nodes;                    /* points that no polygon has as a corner */
    size_t repeated_corners;                /* polygons with a point twice */
    size_t open_edges;                      /* with one polygon only */
    size_t crowded_edges;                   /* with more than two polygons */
    size_t odd_edges;                       /* with three polygons, five, … */
    uint32_t open_edge[TM_EDGES_LISTED][2]; /* the nodes of the first ones */
    bool flat;                              /* all nodes are in one plane, exactly */
} tm_surface_defects;

/* Counts them. Nodes with equal coordinates are taken as one node. Polygons of one node
 * or two have no edges. O(n log n) in the number of corners. */
tm_status tm_surface_find_defects(const tm_polygon_surface *surface,
                                  tm_surface_defects *defects, tm_error *error);

/* Takes facets out whose polygon has the points of an earlier facet's, in whatever order,
 * as where two solids touch that are closed each for itself; *dropped is how many. Facets
 * of several polygons, or with holes, stay. O(n log n) in the number of corners. */
tm_status tm_surface_drop_duplicates(tm_polygon_surface *surface, size_t *dropped,
                                     tm_error *error);

/* Takes corners out of polygons that are where the corner before is, and facets whose
 * only polygon has fewer than three corners left; polygons of one node or two stay.
 * *mended is how many polygons had such corners. O(n). */
tm_status tm_surface_drop_degenerate(tm_polygon_surface *surface, size_t *mended,
                                     tm_error *error);

/* Takes facets out whose only polygon has a point more than once, as where a face with
 * holes is slit open along bridges to them, and appends the triangles that tm_cut_ears()
 * makes of them, with their markers; those with a point twice are left out. *cut is how
 * many facets that were. Facets of several polygons, or with holes, stay.
 * O(n log n) in the number of corners, where such polygons are small. */
tm_status tm_surface_cut_slit(tm_polygon_surface *surface, size_t *cut, tm_error *error);

TM_EXTERN_C_END

#endif
