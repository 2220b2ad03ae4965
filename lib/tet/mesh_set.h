/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A set of tetrahedra that stays with a mesh while this is changed: which ones are to be
 * worked on. It is one more attribute of tetrahedra, the last, so that copies of the mesh
 * and all operations carry it on: what is cut in parts is in the set with all its parts,
 * and of tetrahedra that are replaced together all that come are in it if one was. */
#ifndef TM_TET_MESH_SET_H
#define TM_TET_MESH_SET_H

#include "mesh.h"

TM_EXTERN_C_BEGIN

/* Gives a mesh that has none a set: tetrahedra t with in_set[t], of mesh->slots.
 * TM_ERROR_SYSTEM, with the mesh as it was, where memory is out. O(n). */
tm_status tm_tet_mesh_add_set(tm_tet_mesh *mesh, const bool *in_set, tm_error *error);

/* Takes it away, if there is one, before the mesh is given back. O(n). */
void tm_tet_mesh_remove_set(tm_tet_mesh *mesh);

/* Whether t is in the set; without a set all are. */
static inline bool tm_tet_is_in_set(const tm_tet_mesh *mesh, uint32_t t)
{
    return !mesh->has_set || mesh->region[(t + (size_t)1) * mesh->regions - 1] != 0;
}

/* How many living tetrahedra are in the set. O(n). */
size_t tm_tet_mesh_count_set(const tm_tet_mesh *mesh);

/* For operations that are about to replace some tetrahedra by others: all of them come
 * into the set if one is in it. */
void tm_tet_mesh_spread_set(tm_tet_mesh *mesh, const uint32_t *tet, size_t count);

TM_EXTERN_C_END

#endif
