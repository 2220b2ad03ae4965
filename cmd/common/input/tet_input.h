/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What filters that work on tetrahedra with neighbours do alike. */
#ifndef CMD_COMMON_TET_INPUT_H
#define CMD_COMMON_TET_INPUT_H

#include "../../../lib/tet/mesh.h"
#include "../app/filter.h"

/* Takes the mesh out of the stream (tm_tet_mesh_from_stream()), with a note about what is
 * worth one. Exits where the tetrahedra are no mesh. */
void tet_mesh_from_stream(const filter *f, tm_stream *stream, tm_tet_mesh *mesh);

/* The notes alone. */
void tet_mesh_note(const filter *f, const tm_tet_mesh *mesh);

/* Drops the main mesh's blocks that are not known, with a note that says why: they may
 * refer to the tetrahedra, which are others now. */
void drop_unknown_blocks(const filter *f, tm_stream *stream, const char *why);

#endif
