/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh of which ranks have slices of rows becomes shares, and is given back. */
#ifndef TM_TET_SHARE_TAKE_H
#define TM_TET_SHARE_TAKE_H

#include "../../stream/ranks/slices.h"
#include "share.h"

TM_EXTERN_C_BEGIN

/* What is said of a mesh that is taken: of all ranks. */
typedef struct tm_share_notes {
    size_t turned, flat, dropped_faces, locked;
} tm_share_notes;

/* Makes the share what a rank has of the first cut into so many parts, with the
 * tetrahedra around: connected as tm_tet_mesh_from_stream() does. The slices stay as they
 * are. *can is false on all ranks where that has more to say of the mesh than the notes
 * hold: it is wrong, a row of .face is no face of a tetrahedron, or one of .edge no edge.
 * The share is empty then. */
tm_status tm_tet_share_take(tm_tet_share *share, const tm_slices *slices, size_t size,
                            tm_share_notes *notes, bool *can, tm_error *error);

/* Makes the slices what tm_tet_mesh_to_stream() would give of the whole mesh; the first
 * inner_faces of this share's are inside of parts. The share is empty then. */
tm_status tm_tet_share_give(tm_tet_share *share, size_t inner_faces, tm_slices *slices,
                            tm_error *error);

TM_EXTERN_C_END

#endif
