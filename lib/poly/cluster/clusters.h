/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polyhedra joined to fewer polyhedra: compact clusters (compact.h), which are then taken
 * apart into balls, as partitions of tetrahedra are (partition.h); and the hierarchies of
 * these that multigrid methods want. */
#ifndef TM_POLY_CLUSTERS_H
#define TM_POLY_CLUSTERS_H

#include "../../base/extern_c.h"
#include "../../mesh/cell_faces.h"
#include "../partition.h"

TM_EXTERN_C_BEGIN

/* How many cells become one, where nothing says how large the new ones are: twice the
 * size. */
enum { TM_CLUSTER_CELLS = 8 };

/* What is joined. Facets are kept whose marker is not 0, if faces->marker, and those
 * between cells whose attributes differ, but for the first one. */
typedef struct tm_cluster_mesh {
    const tm_cell_faces *faces;
    size_t nodes;
    const double (*xyz)[3];
    size_t attributes;
    const double *attribute; /* [cells][attributes] */
    bool ignore_markers;
} tm_cluster_mesh;

/* Labels cells 0 … *clusters-1 in the order of their first ones, by options->cells or
 * size, or TM_CLUSTER_CELLS. With options->repair each cluster is a ball, if cells are;
 * by options->star one whose kernel holds a ball, unless it is one cell. Clusters of less
 * than a third of the mean volume join others where that stays so. report has regions,
 * taken_apart, absorbed (cells), single, cells, tets (cells that were). Expected
 * O(corners) while clusters are small. */
tm_status tm_cluster_cells(const tm_cluster_mesh *mesh, const tm_poly_options *options,
                           uint32_t *label, tm_poly_report *report, tm_error *error);

/* Fills the empty blocks .facet, with markers if faces->marker, and .cell: facets are
 * those between clusters, as they are, ordered by the lesser one; cells have the sum of
 * the first attributes, or how many they are of, then the others of the first one. O(n).
 */
tm_status tm_cluster_blocks(const tm_cluster_mesh *mesh, const uint32_t *label,
                            size_t clusters, tm_block *facet, tm_block *cell,
                            tm_error *error);

/* Adds levels to a stream of polyhedra, until there are so many or nothing is joined any
 * more: level k as the blocks of the part `levelk`, with the nodes that its facets have.
 * The last attribute of each cell of the mesh and of all levels but the last one becomes
 * the number of its parent in the next one, after that for regions, which is 0 if there
 * was none. Levels that there were are forgotten. `options` are those of
 * tm_cluster_cells(), without sizes. *levels is how many there are. */
tm_status tm_cluster_levels(tm_stream *stream, size_t most,
                            const tm_poly_options *options, bool ignore_markers,
                            size_t *levels, tm_error *error);

/* Takes levels out of a stream, and the parents of its cells. */
void tm_cluster_forget_levels(tm_stream *stream);

TM_EXTERN_C_END

#endif
