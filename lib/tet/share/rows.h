/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of .face and .edge for those ranks that have what they name. */
#ifndef TM_TET_SHARE_ROWS_H
#define TM_TET_SHARE_ROWS_H

#include "../../stream/ranks/slices.h"
#include "books.h"

/* Gives the share, which has the tetrahedra around its own ones and is not connected, the
 * rows that are faces and edges of its own ones. The book is that of all ranks' own ones.
 * *faces is the number of rows of .face. *can becomes false, on some rank, where a row is
 * none of any tetrahedron, names a node twice, or is there twice. */
tm_status tm_share_take_rows(tm_tet_share *share, const tm_slices *slices,
                             const tm_share_book *book, size_t *faces, bool *can,
                             tm_error *error);

/* How many edges are locked on any rank. */
tm_status tm_share_count_locked(const tm_tet_share *share, size_t *locked,
                                tm_error *error);

#endif
