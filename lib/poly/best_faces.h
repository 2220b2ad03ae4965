/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions of tetrahedra joined across their best faces.
 *
 * The best face of a tetrahedron is the one with the largest metric, of equal ones that
 * with the largest nodes: faces are in a strict order, and along best faces they become
 * better and better until a *terminal face*, which is the best of both its tetrahedra. So
 * the best faces are the links of trees; a *terminal-face region* is such a tree. A
 * *barrier face* is one between two tetrahedra of a region that is best for none of
 * them. S. Salinas-Fernández, M. Alvarez, N. Hitschfeld-Kahler, Exploring polyhedral mesh
 * generation from Delaunay tetrahedral meshes (3D POLYLLA Face), arXiv 2310.03665, 2023.
 */
#ifndef TM_POLY_BEST_FACES_H
#define TM_POLY_BEST_FACES_H

#include "partition.h"

/* Labels tetrahedra by terminal-face regions, barrier faces as if they were none.
 * O(tetrahedra). */
tm_status tm_poly_terminal_faces(const tm_tet_mesh *mesh, const tm_poly_options *options,
                                 uint32_t *label, size_t *regions, tm_error *error);

/* The same, and then cuts regions until no barrier face is left: each at the middle of
 * the way in its tree from one side of the barrier to the other. Around the tip of a
 * barrier, an edge that no other face of the region's boundary has, this is the middle
 * face, where the paper cuts; it goes on where a barrier has no tip. O(tetrahedra) while
 * trees are not deep. */
tm_status tm_poly_faces(const tm_tet_mesh *mesh, const tm_poly_options *options,
                        uint32_t *label, size_t *regions, tm_error *error);

#endif
