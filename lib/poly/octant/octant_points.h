/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which nodes of an octree's mesh are at the points of its octants, wherever they have
 * moved: known from how octants are divided. */
#ifndef TM_POLY_OCTANT_POINTS_H
#define TM_POLY_OCTANT_POINTS_H

#include "../../base/error.h"
#include "../../base/hash.h"
#include "../../octree/forest/octree.h"
#include "../../stream/stream.h"

#include <stdbool.h>
#include <stdint.h>

enum { TM_OCTANT_POINTS = TM_LEAF_CENTRE + 1 };

typedef struct tm_octant_points {
    const tm_block *mix, *octant;
    uint32_t finest; /* the level of the grid that anchors are on */
    tm_hash_table table;
    uint32_t (*corner)[3]; /* of octants that have elements, in halves of the grid */
    size_t corners;
} tm_octant_points;

/* Of the blocks .mix, .octant and .root. TM_ERROR_SYSTEM where memory is out. *points is
 * to be freed, after an error too. Expected O(octants). */
tm_status tm_octant_points_make(tm_octant_points *points, const tm_block *mix,
                                const tm_block *octant, const tm_block *root,
                                tm_error *error);
void tm_octant_points_free(tm_octant_points *points);

/* Fills node[] with the nodes at the points of octant o (octree.h), TM_NONE where there
 * is none: false where its elements are not those into which octants are divided that
 * have such neighbours, as of those that have a cut face. Expected O(its elements). */
bool tm_octant_points_find(const tm_octant_points *points, size_t o,
                           uint32_t node[TM_OCTANT_POINTS]);

/* Whether element e of .mix has a node that is marked. */
static inline bool tm_element_has(const tm_block *mix, size_t e, const bool *marked)
{
    for (size_t i = mix->start[e]; i < mix->start[e + 1]; i++)
        if (marked[mix->item[i]])
            return true;
    return false;
}

/* The level of octant o, and whether it has elements. */
unsigned tm_octant_level(const tm_octant_points *points, size_t o);
bool tm_octant_is_filled(const tm_octant_points *points, size_t o);

#endif
