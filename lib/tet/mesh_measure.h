/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is measured in a mesh: the dihedral quality and the longest edge of tetrahedra,
 * and which constrained faces lie in one flat facet. */
#ifndef TM_TET_MESH_MEASURE_H
#define TM_TET_MESH_MEASURE_H

#include "../base/extern_c.h"
#include "../geom/vector.h"
#include "mesh.h"
#include "star.h"

TM_EXTERN_C_BEGIN

/* Edges are compared by (squared length, larger node, smaller node), so that of two edges
 * one is always the longer. */
typedef struct tm_edge_rank {
    double length2;
    uint64_t key;
} tm_edge_rank;

static inline bool tm_edge_is_longer(const tm_edge_rank *e, const tm_edge_rank *f)
{
    return e->length2 > f->length2 || (e->length2 == f->length2 && e->key > f->key);
}

/* The longest edge of t, 0 … 5 as in tm_edge_corner. */
static inline unsigned tm_longest_edge(const tm_tet_mesh *mesh, uint32_t t,
                                       tm_edge_rank *rank)
{
    const uint32_t *n = mesh->tet[t];
    unsigned longest = 0;
    rank->length2 = -1;
    rank->key = 0;
    for (unsigned e = 0; e < 6; e++) {
        uint32_t a = n[tm_edge_corner[e][0]], b = n[tm_edge_corner[e][1]];
        tm_edge_rank other = {tm_distance2(mesh->xyz[a], mesh->xyz[b]),
                              tm_edge_key(a, b)};
        if (!tm_edge_is_longer(&other, rank))
            continue;
        *rank = other;
        longest = e;
    }
    return longest;
}

/* So many are measured at a time. */
enum { TM_MEASURED_AT_ONCE = 4 };

/* tm_tet_sine2() and the longest edge, 0 … 5, of 1 … TM_MEASURED_AT_ONCE tetrahedra. */
void tm_tet_mesh_measure(const tm_tet_mesh *mesh, const uint32_t *tet, size_t count,
                         double sine2[TM_MEASURED_AT_ONCE],
                         uint8_t longest[TM_MEASURED_AT_ONCE]);

/* A flat facet of the surface of a mesh: constrained faces side by side in one plane and
 * alike in all that is known of them, so that only their union has to stay. */

/* Points that are this near to a plane are in it: the rounding of midpoints moves a point
 * by some ulps of its largest coordinate. O(nodes). */
double tm_facet_flatness(const tm_tet_mesh *mesh);
double tm_flatness(const double (*xyz)[3], size_t count);

/* Whether constrained face g continues constrained face f in one facet beyond the edge
 * ab: both have the same marker and number of sides, the edge has no marker and the mesh
 * does not only touch itself there, and the triangles abc (f) and bad (g) lie flat beside
 * each other. The caller knows that no third constrained face is at the edge. O(1). */
bool tm_facet_continues(const tm_tet_mesh *mesh, uint32_t f, uint32_t g, uint32_t a,
                        uint32_t b, uint32_t c, uint32_t d, double flatness);

TM_EXTERN_C_END

#endif
