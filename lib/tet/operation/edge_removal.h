/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Removal of an edge (edge swap): the n tetrahedra of its closed star become 2n - 4, two
 * on each triangle of a triangulation of the ring. The best of the Catalan many
 * triangulations is found by dynamic programming: G. T. Klincsek, Minimal triangulations
 * of polygonal domains, Annals of Discrete Mathematics 9 (1980); for edge removal:
 * J. R. Shewchuk, Two discrete optimization algorithms for the topological improvement
 * of tetrahedral meshes (2002). */
#ifndef TM_OPERATION_EDGE_REMOVAL_H
#define TM_OPERATION_EDGE_REMOVAL_H

#include "../../element/tet_measure.h"
#include "../star.h"
#include "replacement.h"

/* Larger stars are not tried: the thesis saw 14, the programme costs O(n³). */
enum { TM_REMOVAL_MAX = 64 };

typedef struct tm_edge_removal {
    double quality;                               /* of the worst tetrahedron made */
    uint8_t apex[TM_REMOVAL_MAX][TM_REMOVAL_MAX]; /* of the triangle on chord i j */
    double best[TM_REMOVAL_MAX][TM_REMOVAL_MAX];  /* of the polygon i … j */
} tm_edge_removal;

/* Whether the edge of a star that tm_star_is_free() and tm_star_is_simple() may be
 * removed: 3 … TM_REMOVAL_MAX tetrahedra. */
static inline bool tm_edge_is_removable(const tm_star *star)
{
    return star->size >= 3 && star->size <= TM_REMOVAL_MAX;
}

/* Finds the best triangulation whose tetrahedra are all at least `least` (> 0) good and
 * exactly positive. False where there is none. O(n³) for n tetrahedra. */
bool tm_edge_removal_plan(const tm_tet_mesh *mesh, const tm_star *star,
                          tm_tet_measure measure, double least, tm_edge_removal *plan);

/* The same for a sum: finds the triangulation whose tetrahedra have the least
 * tm_cost_of() in all, below `most`, while each is at least `least` good and exactly
 * positive. plan->quality is that sum. The star may be open: its ring is triangulated
 * with the chord between its ends. */
bool tm_edge_removal_plan_cheapest(const tm_tet_mesh *mesh, const tm_star *star,
                                   const tm_cost *cost, double least, double most,
                                   tm_edge_removal *plan);

/* The tetrahedra that a plan makes, 2n - 4 for n nodes of the ring: their nodes. */
size_t tm_edge_removal_list(const tm_star *star, const tm_edge_removal *plan,
                            uint32_t (*node)[4]);

/* The constrained faces at the two ends of an open star, abr and abs: in a flat facet
 * they become rsb and ras. Of the stars on the two sides of a facet only the first one
 * renames them; the other one finds them so. */
void tm_edge_removal_renewals(const tm_tet_mesh *mesh, const tm_star *star, bool first,
                              tm_face_renewal renewal[2]);

/* Does what was planned. created[0 … 2n-4) are the tetrahedra made; created has room for
 * them. TM_ERROR_SYSTEM, with nothing changed, where memory is out. O(n). */
tm_status tm_edge_removal_apply(tm_tet_mesh *mesh, const tm_star *star,
                                const tm_edge_removal *plan, uint32_t *created,
                                tm_error *error);

#endif
