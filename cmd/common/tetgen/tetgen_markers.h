/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Markers of faces that are below 0. TetGen hands them on with a surface, but where it
 * refines tetrahedra it takes such faces for ones without a marker. */
#ifndef CMD_COMMON_TETGEN_MARKERS_H
#define CMD_COMMON_TETGEN_MARKERS_H

#include "tetgen.h"

/* marker[i] stands as alias[i], which nothing else has; both ascend. */
typedef struct tetgen_aliases {
    size_t count;
    int32_t *marker, *alias;
} tetgen_aliases;

/* Before TetGen: the faces get aliases above 0. Exits where memory is out. O(n log n). */
void tetgen_hide_markers(const filter *f, tm_stream *tets, tetgen_aliases *aliases);

/* After it: what has an alias, also a node that was put on such a face, gets the marker
 * that it stands for. The aliases are freed. O(n log n). */
void tetgen_restore_markers(tm_stream *mesh, tetgen_aliases *aliases);

#endif
