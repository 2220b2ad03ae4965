/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flat facets of the surface of a mesh: faces that stay, side by side in one plane and
 * alike in all that is known of them, so that only their union has to stay. */
#ifndef TM_TET_FACET_H
#define TM_TET_FACET_H

#include "mesh.h"

/* Points that are this near to a plane are in it: the rounding of midpoints moves a point
 * by some ulps of its largest coordinate. O(nodes). */
double tm_facet_flatness(const tm_tet_mesh *mesh);

/* Whether constrained face g continues constrained face f in one facet beyond the edge
 * ab: both have the same marker and number of sides, the edge has no marker and the mesh
 * does not only touch itself there, and the triangles abc (f) and bad (g) lie flat beside
 * each other. The caller knows that no third constrained face is at the edge. O(1). */
bool tm_facet_continues(const tm_tet_mesh *mesh, uint32_t f, uint32_t g, uint32_t a,
                        uint32_t b, uint32_t c, uint32_t d, double flatness);

#endif
