/* SPDX-License-Identifier: GPL-3.0-or-later */
/* TetGen accepts tetrahedra of either orientation; a stream has right-hand positive ones.
 */
#ifndef TM_FORMAT_TETGEN_ORIENT_H
#define TM_FORMAT_TETGEN_ORIENT_H

#include "../stream/stream.h"

typedef struct tm_turned {
    size_t turned; /* negative tetrahedra, whose last two nodes were exchanged */
    size_t flat;   /* without volume, exactly: left as they are */
} tm_turned;

/* Makes the tetrahedra of an .ele block right-hand positive; .node holds their nodes.
 * The signs are exact. O(n). */
tm_turned tm_tetgen_orient(const tm_block *node, tm_block *ele);

#endif
