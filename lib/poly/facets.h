/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The faces between the polyhedra of a partition, as blocks of a stream. */
#ifndef TM_POLY_FACETS_H
#define TM_POLY_FACETS_H

#include "../base/extern_c.h"
#include "../stream/stream.h"
#include "partition.h"

TM_EXTERN_C_BEGIN

/* Fills the empty blocks .facet and .cell. Facets are triangles, ordered by their first
 * cell, which is the one with the smaller number; from there their nodes turn
 * counter-clockwise around the outward normal. With facet->markers each has that of the
 * face of .face. Cells have how many tetrahedra they are of, then the attributes of the
 * first one; their facets ascend. Faces that are kept but have one polyhedron on both
 * sides, as partitions without repair may have, are left out; *lost is how many. O(n), by
 * several threads. */
tm_status tm_partition_facets(const tm_partition *partition, const tm_tet_mesh *mesh,
                              tm_block *facet, tm_block *cell, size_t *lost,
                              unsigned threads, tm_error *error);

/* Fills the facets of the cells from those that the facets name. */
tm_status tm_cells_from_facets(const tm_block *facet, tm_block *cell, size_t cells,
                               tm_error *error);

/* Gives cells, whose 1 + width attributes are 0, the attributes that
 * tm_partition_facets() says: of elements with the cells cell_of[elements] and the
 * attributes attribute[elements][width]. O(elements). */
void tm_cells_count_elements(tm_block *cell, const uint32_t *cell_of, size_t elements,
                             const double *attribute, size_t width);

/* Which neighbouring facets are of one plane. */
typedef struct tm_coplanar {
    double degrees;  /* their normals differ by so much at most, or, with 0: */
    double flatness; /* their nodes are so near to the plane of the first one */
    double radius;   /* cells with such a kernel keep it, by their diameter; 0: any */
    bool centroid;   /* those that their centroids see whole keep that */
} tm_coplanar;

/* Joins triangles to polygons where they have the same two cells and marker and are in
 * one plane. Each polygon is simple: its nodes are those on its border, all of them, so
 * that it still fits its neighbours; an edge with a marker in .edge stays. *joined is how
 * many facets are less. Expected O(n). */
tm_status tm_merge_coplanar(const tm_tet_mesh *mesh, const tm_coplanar *plane,
                            tm_block *facet, tm_block *cell, size_t *joined,
                            tm_error *error);

TM_EXTERN_C_END

#endif
