/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The attributes of nodes that TetGen put in: it leaves them 0. */
#ifndef CMD_COMMON_TETGEN_ATTRIBUTES_H
#define CMD_COMMON_TETGEN_ATTRIBUTES_H

#include "tetgen.h"

/* On the polygons, which are a surface, they become linear in its triangles, inside
 * linear in the tetrahedra that its own nodes have, for which TetGen is run once more.
 * Exits on failure; where TetGen fails, a note says how many stay 0. */
void tetgen_interpolate(const filter *f, const tetgen_request *r,
                        const tm_polygon_surface *polygons, tm_stream *mesh);

/* Where tetrahedra were refined they become linear in these; the blocks of *tets are
 * empty then. */
void tetgen_interpolate_refined(const filter *f, tm_stream *tets, tm_stream *mesh);

#endif
