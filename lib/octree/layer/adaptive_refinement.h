/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Smaller leaves where the surface needs them: nobody knows of every thin part of a
 * surface that is to be meshed. */
#ifndef TM_LAYER_ADAPTIVE_REFINEMENT_H
#define TM_LAYER_ADAPTIVE_REFINEMENT_H

#include "../../base/extern_c.h"
#include "octree_mesh.h"

TM_EXTERN_C_BEGIN

/* Makes the mesh, of an octree in which leaves are split while there are some (1) where a
 * part of the surface is lost (tm_interior_find_lost()), (2) at boundary nodes that had
 * to be off the surface, as long as that makes them fewer, in meshes of up to 5 000 000
 * elements; to at most `levels` more than `level`, the deepest that is asked for else.
 * Where walls meet, `lay_out` says whether their corners and curves are laid out
 * (../interior/region_layout.h). `progress` may be NULL. Errors and cost as of
 * tm_octree_mesh_make(); *mesh is to be freed. */
tm_status tm_octree_mesh_refine_lost(tm_octree_mesh *mesh, tm_octree *octree,
                                     tm_surface *surface, unsigned level, unsigned levels,
                                     bool lay_out, const tm_progress *progress,
                                     tm_error *error);

TM_EXTERN_C_END

#endif
