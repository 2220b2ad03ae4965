/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps by which a dual is made. */
#ifndef TM_POLY_DUAL_DUAL_STEPS_H
#define TM_POLY_DUAL_DUAL_STEPS_H

#include "../../mesh/poly_arrays.h"
#include "dual_parts.h"

/* Whether the face opposite a corner of a piece's tetrahedron is cut at the piece. */
bool tm_dual_is_cut(const tm_dual *d, uint32_t piece, uint32_t face);

/* The level after one; that to be cut stays until it is done. */
tm_dual_level tm_dual_next_level(tm_dual_level level);

/* Cuts the nodes that are to be cut, by paths of faces from each edge that is bent
 * inward to where the other side of the fan is; those that cannot be are TM_DUAL_PIECES.
 */
tm_status tm_dual_cut(tm_dual *d, tm_error *error);

/* Finds the cell of each piece; cuts where a face has one cell on both sides. O(n). */
tm_status tm_dual_find_cells(tm_dual *d, tm_error *error);

/* Finds walls, their edges and spokes, which quads continue each other, and the points.
 */
tm_status tm_dual_find_walls(tm_dual *d, tm_error *error);

/* The nodes of a half face, counter-clockwise seen from outside; and the two cells at
 * corner j of a wall, that of its half first; TM_NONE: the boundary. */
void tm_dual_half_nodes(const tm_tet_mesh *mesh, uint32_t half, uint32_t node[3]);
void tm_dual_wall_cells(const tm_dual *d, const tm_dual_wall *wall, int j,
                        uint32_t cell[2]);

/* The edge of the spoke that a quad begins or ends with, seen from outside of the smaller
 * one of its cells. */
uint32_t tm_dual_quad_edge(const tm_dual *d, uint32_t q, bool last);

/* Gives points their first places: those in tetrahedra, and then, where the dual is
 * built, the others, or where they were before if that was kept. */
void tm_dual_place_tets(tm_dual *d);
tm_status tm_dual_place_walls(tm_dual *d, tm_error *error);

/* Puts the point in a tetrahedron at its centroid: in tet_xyz. */
void tm_dual_put_at_centroid(tm_dual *d, size_t t);

/* Puts the points of cuts, for where those in tetrahedra are. */
void tm_dual_place_cuts(tm_dual *d);

/* Keeps walls, edges and their points, and makes them empty; frees what was kept. */
void tm_dual_keep(tm_dual *d);
void tm_dual_forget(tm_dual *d);

/* Fills d->facet. O(n). */
tm_status tm_dual_make_facets(tm_dual *d, tm_error *error);

/* Makes facets plane. O(n). */
tm_status tm_dual_flatten(tm_dual *d, tm_error *error);

/* Nodes with a cell that is no ball are to be taken apart. */
tm_status tm_dual_find_no_balls(tm_dual *d, const tm_poly_arrays *mesh, tm_error *error);

/* Moves points of bad facets, and counts what is bad then; or only looks. Then nodes with
 * a wrong pyramid are to be cut further, or where it only looked those that are whole. */
tm_status tm_dual_improve(tm_dual *d, bool move, tm_dual_report *report, tm_error *error);

#endif
