/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What keeps finite volume methods from converging on cells that their centroids see: the
 * correction for non-orthogonality is made from the last iteration's gradients, and may
 * be more than what it corrects.
 *
 * By the over-relaxed approach (H. Jasak, Error analysis and estimation for the finite
 * volume method, 1996, section 3.3.1.3; OpenFOAM's scheme `corrected`) the flux through
 * a face of area vector S, between centroids that are d apart, is that of the part
 * Δ = d |S|² / (d·S), which is solved for, and of k = S - Δ, by the gradients of Gauss'
 * theorem. The *gain* of a cell is what an error of it comes back as to itself in one
 * iteration; above 1 it grows. In meshes of tetrahedra that converge it is up to 0.4.
 * Values at the boundary are taken as fixed. */
#ifndef TM_POLY_CORRECTION_H
#define TM_POLY_CORRECTION_H

#include "../tet/mesh.h"

/* Takes cells apart into tetrahedra, until those have no large gain that are of more than
 * one, or have cells beside them that are. cell[slots] are 0 … *cells-1, each of one
 * tetrahedron at least; so they are afterwards. Those with flat tetrahedra stay. O(slots)
 * for each of some rounds. */
tm_status tm_calm_cells(const tm_tet_mesh *mesh, uint32_t *cell, size_t *cells,
                        tm_error *error);

#endif
