/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions of several attributes: where TetGen refines tetrahedra it keeps apart those of
 * which the last attribute differs. */
#ifndef CMD_COMMON_TETGEN_REGIONS_H
#define CMD_COMMON_TETGEN_REGIONS_H

#include "tetgen.h"

/* last[r] is the last attribute of region r. NULL where the number is not needed. */
typedef struct tetgen_regions {
    double *last;
} tetgen_regions;

/* Before TetGen: the number of the region, from 0, stands for the last attribute. Exits
 * where memory is out. Expected O(n). */
void tetgen_hide_regions(const filter *f, tm_stream *tets, tetgen_regions *regions);

/* After it: the last attribute is there again. The regions are freed. O(n). */
void tetgen_restore_regions(tm_stream *mesh, tetgen_regions *regions);

#endif
