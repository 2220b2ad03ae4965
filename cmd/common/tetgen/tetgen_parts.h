/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of space that a surface closes in, for TetGen: which are regions with numbers
 * of their own, and which are left empty. */
#ifndef CMD_COMMON_TETGEN_PARTS_H
#define CMD_COMMON_TETGEN_PARTS_H

#include "../../../lib/surface/polygon_surface.h"
#include "../app/filter.h"

typedef struct tetgen_parts {
    bool regions;  /* each part is numbered */
    bool cavities; /* what a shell that looks inward has within is left empty */
    tm_polygon_surface given; /* points: its holes, to leave empty, and its regions, of
                                 which an attribute that is NaN is the next whole one */
} tetgen_parts;

/* Adds to the holes and regions of the surface what *parts asks for. Says on stderr what
 * shells within others become. Leaves out regions that are in one with another before.
 * Exits where a given point is outside, where a region has a number that TetGen has no
 * place for, and where cavities cannot be told as the surface is not closed or crosses
 * itself; *why becomes what is wrong with it, as octree-mesh would say it, with status
 * TM_OK where nothing is. */
void tetgen_find_parts(const filter *f, const tetgen_parts *parts,
                       tm_polygon_surface *surface, tm_error *why);

#endif
