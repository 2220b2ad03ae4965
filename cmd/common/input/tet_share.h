/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh of tetrahedra that ranks share. All functions are called by all ranks and exit
 * on failure. */
#ifndef CMD_COMMON_TET_SHARE_H
#define CMD_COMMON_TET_SHARE_H

#include "../../../lib/tet/share/take.h"
#include "../app/filter.h"

/* tet_mesh_from_stream() of slices, cut for the first time into parts of `size`, with the
 * same notes; false where only one process can say what is to be said, or keep what a
 * block holds. The slices stay. */
bool tet_share_from_slices(const filter *f, const tm_slices *slices, size_t size,
                           tm_tet_share *share, tm_share_notes *notes);
void tet_share_note(const filter *f, const tm_share_notes *notes);

/* drop_unknown_blocks() of slices. */
void tet_share_drop_unknown(const filter *f, tm_slices *slices, const char *why);

#endif
