/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A surface as the foreign formats know it: nodes and polygons, before anything is known
 * about its shape. Each reader of this folder fills one; it may be open, intersect
 * itself or hold degenerate polygons. */
#ifndef TM_SURFACE_POLYGON_SURFACE_H
#define TM_SURFACE_POLYGON_SURFACE_H

#include "../base/extern_c.h"
#include "../stream/group.h"
#include "../stream/stream.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* A region of a .poly or .smesh file: what the tetrahedra get that are joined to
 * `point` without crossing a facet. */
typedef struct tm_region {
    double point[3];
    double attribute;
    double max_volume; /* negative: no bound */
} tm_region;

/* Arrays are malloc'ed and belong to the surface. Node ids are 0-based here and always
 * below `nodes`. Polygons have k >= 3 nodes, except that those of .poly and .smesh files
 * may have 1 or 2 (an isolated node, a segment in the facet). */
typedef struct tm_polygon_surface {
    unsigned base; /* the first number in the text, 0 or 1; 1 where it has none */

    size_t nodes;
    double (*xyz)[3];     /* [nodes] */
    size_t attributes;    /* reals per node */
    double *attribute;    /* [nodes][attributes]; NULL where there are none */
    int32_t *node_marker; /* [nodes]; NULL where there are none */

    size_t polygons;
    size_t *start;  /* [polygons + 1]: polygon p is item[start[p] … start[p + 1]) */
    size_t corners; /* of all polygons: start[polygons] */
    uint32_t *item; /* [corners] */

    size_t facets;            /* one polygon each, except those of .poly files: */
    size_t *facet_start;      /* [facets + 1]: polygons facet_start[f] … of facet f */
    size_t *facet_hole_start; /* [facets + 1]: its holes, in the same way */
    int32_t *facet_marker;    /* [facets] */
    bool has_facet_markers;   /* else they are all 0 */
    int32_t next_marker;      /* of the faces that are added from here on */
    tm_block group;           /* the names of facet markers and regions: group.h */
    size_t facet_holes;       /* points in parts of a facet's plane that are no facet */
    double (*facet_hole)[3];  /* [facet_holes] */

    size_t holes; /* points in parts of the inside that are no part of the solid */
    double (*hole)[3];
    size_t regions;
    tm_region *region;

    size_t left_bytes; /* of a file, behind its last face, which were not read */

    size_t capacity[9]; /* of the arrays that grow; for polygon_surface.c */
} tm_polygon_surface;

/* An empty surface; then back to one. */
void tm_polygon_surface_init(tm_polygon_surface *surface);
void tm_polygon_surface_free(tm_polygon_surface *surface);

/* Appending. Nodes come with neither attributes nor marker. A polygon is its corners,
 * then tm_polygon_surface_end_polygon(); a facet its polygons and holes, then
 * _end_facet(). The arrays of offsets are NULL where there is no polygon or no facet.
 * TM_ERROR_SYSTEM where memory is out, TM_ERROR_INPUT where 32-bit ids are. */
tm_status tm_polygon_surface_add_node(tm_polygon_surface *surface, const double xyz[3],
                                      tm_error *error);
tm_status tm_polygon_surface_add_corner(tm_polygon_surface *surface, uint32_t node,
                                        tm_error *error);
tm_status tm_polygon_surface_end_polygon(tm_polygon_surface *surface, tm_error *error);
tm_status tm_polygon_surface_end_facet(tm_polygon_surface *surface, int32_t marker,
                                       tm_error *error);
/* Ends a polygon that is a facet of its own, with the marker next_marker. */
tm_status tm_polygon_surface_end_face(tm_polygon_surface *surface, tm_error *error);
/* A facet that is one polygon of k nodes. */
tm_status tm_polygon_surface_add_polygon(tm_polygon_surface *surface,
                                         const uint32_t *node, size_t k, tm_error *error);
tm_status tm_polygon_surface_add_facet_hole(tm_polygon_surface *surface,
                                            const double xyz[3], tm_error *error);
tm_status tm_polygon_surface_add_hole(tm_polygon_surface *surface, const double xyz[3],
                                      tm_error *error);
tm_status tm_polygon_surface_add_region(tm_polygon_surface *surface,
                                        const tm_region *region, tm_error *error);

/* The nodes of a .node block become those of the surface, which must have none. The
 * arrays of attributes and markers are taken from the block. Errors as above. */
tm_status tm_polygon_surface_nodes_from_stream(tm_polygon_surface *surface,
                                               tm_block *node, tm_error *error);

/* Appends the triangles of a .face block as facets with their markers. Errors as above.
 */
tm_status tm_polygon_surface_add_faces(tm_polygon_surface *surface, const tm_block *face,
                                       tm_error *error);

/* Adds the blocks `part`.node and `part`.face, which must not be there yet, and where
 * there are names `part`.group: all nodes of the surface and its polygons, those with
 * more than three corners as tm_cut_ears() cuts them, those with fewer left out.
 * Attributes and markers come with them. TM_ERROR_SYSTEM where memory or 32-bit ids are
 * out. O(n) where polygons are small. */
tm_status tm_polygon_surface_to_stream(const tm_polygon_surface *surface,
                                       tm_stream *stream, const char *part,
                                       tm_error *error);

TM_EXTERN_C_END

#endif
