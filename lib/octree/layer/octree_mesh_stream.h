/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh with its octants and its surface as the blocks of a stream. */
#ifndef TM_LAYER_OCTREE_MESH_STREAM_H
#define TM_LAYER_OCTREE_MESH_STREAM_H

#include "../../base/extern_c.h"
#include "../../stream/stream.h"
#include "../../stream/ranks/slices.h"
#include "../share/octree_share.h"
#include "octree_mesh.h"

TM_EXTERN_C_BEGIN

/* The attribute of a node in .node: where it is. Negative where it should be there, but
 * is off the surface. */
typedef enum tm_node_class {
    TM_NODE_INSIDE,
    TM_NODE_ON_PATCH,
    TM_NODE_ON_CURVE,
    TM_NODE_ON_CORNER
} tm_node_class;

/* Appends .node .mix .octant .root surface.node surface.face, and, where the surface has
 * markers, .facet with the faces of the boundary and between regions and the marker of
 * the closest triangle, and with its names .group. Elements have their region, where
 * there are some, and with `levels` the level of their octant as attributes. Arrays of
 * mesh and surface are taken; both are to be freed still. *stream must be empty.
 * TM_ERROR_SYSTEM where memory is out. */
tm_status tm_octree_mesh_to_stream(tm_octree_mesh *mesh, const tm_octree *octree,
                                   tm_surface *surface, bool levels, tm_stream *stream,
                                   tm_error *error);

/* The same of a mesh that ranks have parts of; `finest` is the deepest level of all.
 * slices->stream must be empty; *slices is to be freed, after an error too. All
 * ranks call it. */
tm_status tm_octree_mesh_to_slices(tm_octree_mesh *mesh, const tm_octree_share *share,
                                   unsigned finest, tm_surface *surface, bool levels,
                                   tm_slices *slices, tm_error *error);

/* For these: the attributes of nodes, to be freed, NULL where memory is out; and the rows
 * of what is a rank's own, but for those of nodes. */
double *tm_octree_mesh_classes(const tm_octree_mesh *mesh);
tm_status tm_octree_mesh_rows(tm_octree_mesh *mesh, const tm_octree_share *share,
                              unsigned finest, tm_surface *surface, bool levels,
                              tm_stream *stream, tm_error *error);

TM_EXTERN_C_END

#endif
