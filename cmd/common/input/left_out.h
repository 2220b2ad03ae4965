/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What of a stream a foreign format cannot carry, by one table of what each can. */
#ifndef CMD_COMMON_LEFT_OUT_H
#define CMD_COMMON_LEFT_OUT_H

#include "../app/filter.h"

/* Says by filter_leave_out(), in one line, what the user gave and the format of the
 * exporter f->name does not have: attributes, markers, marked edges, regions, names,
 * cells of other blocks than the mesh, parts and unknown blocks. Nothing where there is
 * none of that.
 *
 * Markers that only say where the boundary is, as TetGen and octree-mesh set them where
 * there are no others, are not missed: those that are all 1 or all -1, of faces that are
 * closed, of the nodes of .face or .facet, of all rows of .edge. Nor is a region that all
 * cells have and that is 1, nor what octree-mesh keeps for itself: .octant, .root, and
 * beside them the part surface and the first attribute of nodes. */
void mesh_leave_out(const filter *f, const tm_stream *stream);

/* The same where it depends on options what the format has: its row of the table. */
void mesh_leave_out_of(const filter *f, const tm_stream *stream, const char *format);

/* Whether the markers of .node only say which nodes are on the boundary. O(n). */
bool mesh_marks_boundary_nodes(const tm_stream *stream);

#endif
