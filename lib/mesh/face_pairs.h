/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The quick way to find neighbours: faces are matched as they come, in a bucket for each
 * smallest node. It knows that something is wrong with a mesh, but not what, nor in which
 * order it is to be reported: face_order.h is for that. */
#ifndef TM_MESH_FACE_PAIRS_H
#define TM_MESH_FACE_PAIRS_H

#include "../tet/mesh.h"

typedef struct tm_face_pairs {
    bool whole;     /* no face of three tetrahedra, and none listed twice; else the rest,
                       and what was done to the mesh, is to be forgotten */
    bool folded;    /* two tetrahedra are on the same side of a face */
    uint32_t *open; /* half faces without partner, or at another region, that no row of
                       .face names, by their nodes in ascending order */
    size_t opens, room;
} tm_face_pairs;

/* Joins the tetrahedra at all faces; a half face of mesh->neighbour without partner is
 * TM_NONE. Faces listed[f], which are mesh->face[f], stay as tm_tet_mesh_from_stream()
 * says. All tetrahedra are of four nodes. Expected O(n). */
tm_status tm_face_pairs_find(tm_face_pairs *pairs, tm_tet_mesh *mesh,
                             const uint32_t (*listed)[3], size_t listed_count,
                             tm_error *error);
void tm_face_pairs_free(tm_face_pairs *pairs);

#endif
