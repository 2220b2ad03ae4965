/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where walls meet, octants are given to regions before all others: around a node for
 * each corner, then along a line of edges for each curve. There each region has as many
 * octants as it needs, however sharp the angle is in which it ends; what the leaves'
 * centres say would only be right where the angles are those of octants. */
#ifndef TM_INTERIOR_REGION_LAYOUT_H
#define TM_INTERIOR_REGION_LAYOUT_H

#include "interior_leaves.h"
#include "line_states.h"
#include "node_lattice.h"
#include "region_sets.h"
#include "wall_sectors.h"

/* The line of a curve that was found last, and the nodes that the search for it saw: it
 * is found again where all is as it was at these. */
typedef struct tm_laid_line {
    uint64_t seen; /* a hash of what was there; two are the same once in 2^64 times */
    size_t nodes, node_room, states, state_room;
    uint32_t *node;
    tm_line_state *state; /* the last one first; none where there was no line */
} tm_laid_line;

typedef struct tm_region_layout {
    const tm_surface *surface;
    tm_interior *interior;
    tm_node_lattice lattice;
    tm_walls walls;
    tm_wall_sectors sectors;
    tm_line_patterns patterns[2]; /* of 3 and of 4 sectors */
    uint32_t *corner_at;          /* [nodes of the surface]: the corner, or TM_NONE */
    float *history;     /* [nodes]: what it costs more to go by it; 0 at first */
    tm_laid_line *line; /* [curves] */
    /* What is laid out: */
    bool *fixed;           /* [leaves]: it has its label */
    bool *taken;           /* [nodes]: it stands for a corner, or is on a line */
    bool *sharp;           /* [nodes]: it is on a line where regions end sharply */
    size_t lost;           /* corners and curves that could not be laid out */
    uint32_t *corner_node; /* [corners]: the node that stands for it, or TM_NONE */
} tm_region_layout;

/* Finds what does not depend on labels: nothing is laid out yet. TM_ERROR_SYSTEM where
 * memory is out; to be freed, after an error too. O(leaves), O(n log n) in the surface.
 */
tm_status tm_region_layout_make(tm_region_layout *layout, const tm_octree *octree,
                                const tm_surface *surface, tm_interior *interior,
                                tm_error *error);
void tm_region_layout_free(tm_region_layout *layout);

/* Lays out all corners and curves that can be, anew; lines are looked for only where
 * something is not as it was the last time. The leaves of *interior have labels
 * (region_leaves.h), and some of them get another. TM_ERROR_SYSTEM where memory is out.
 * O(leaves), and O(n log n) in the nodes near curves. */
tm_status tm_region_lay_out(tm_region_layout *layout, tm_error *error);

/* Its steps. region_corners.c: a node for each corner, the one that is cheapest by its
 * distance and by how far octants and edges are from the regions and curves they are for;
 * of those at which all curves at the corner can begin. */
tm_status tm_region_lay_corners(tm_region_layout *layout, tm_error *error);

/* region_lines.c: a line for each curve. */
tm_status tm_region_lay_lines(tm_region_layout *layout, tm_error *error);

/* region_layout.c. Gives a leaf a label, for good. */
void tm_region_lay(tm_region_layout *layout, uint32_t leaf, uint32_t label);

#endif
