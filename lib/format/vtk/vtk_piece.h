/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh in pieces: a rank's slice of the cells as a stream of its own, and the file that
 * says which files the pieces are in (.pvtu). */
#ifndef TM_FORMAT_VTK_PIECE_H
#define TM_FORMAT_VTK_PIECE_H

#include "../../base/extern_c.h"
#include "../../stream/ranks/slices.h"
#include "vtk.h"

TM_EXTERN_C_BEGIN

/* Makes a stream of this rank's cells, with their nodes, and of the marked rows of .face,
 * .facet and .edge that the first cell of which they are a part is among; rank 0 gets
 * those without a cell. What tm_vtu_write() writes of all pieces is what it writes of the
 * whole, but that nodes between pieces are in each. Called by all ranks, with the same
 * status on all: TM_ERROR_SYSTEM where memory is out. *piece is empty before and after an
 * error; the slices lose their arrays. Marked rows are on all ranks for a while. */
tm_status tm_vtk_piece_make(tm_stream *piece, tm_slices *slices,
                            const tm_vtk_options *options, tm_error *error);

/* Appends a .pvtu file of `pieces` files source[i], whose arrays are those of `vtu`, the
 * text of one of them. */
tm_status tm_pvtu_write(tm_text *text, const tm_text *vtu, const char *const *source,
                        size_t pieces, tm_error *error);

TM_EXTERN_C_END

#endif
