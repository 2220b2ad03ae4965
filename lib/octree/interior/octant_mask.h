/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The eight octants around a node, as bits, and the points of a leaf in terms of them. */
#ifndef TM_LAYER_OCTANT_MASK_H
#define TM_LAYER_OCTANT_MASK_H

#include "../../base/extern_c.h"

#include <stdbool.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Octant o lies in the positive direction of axis i where bit i of o is set. A mask has
 * bit o set where octant o is filled. */
typedef uint8_t tm_octant_mask;

enum { TM_ALL_OCTANTS = 0xff };

/* The octants that a leaf fills around the node at each of its points (octree.h): one at
 * a corner, two at the middle of an edge, four at the centre of a face. */
extern const tm_octant_mask tm_point_octants[26];

/* Gives the octants that a leaf fills around the node at one of its points a value. */
static inline void tm_octants_set(uint32_t octant[8], int point, uint32_t value)
{
    for (unsigned o = 0; o < 8; o++)
        if (tm_point_octants[point] >> o & 1)
            octant[o] = value;
}

/* The edges (0 … 11) of each face. */
extern const uint8_t tm_face_edge[6][4];

/* Whether the boundary of the filled octants is (1) one fan of faces, and (2) no two of
 * them look in opposite directions; so there is a direction away from all of them. The
 * empty and the full mask, which have no boundary, are good. O(1). */
bool tm_octant_mask_is_good(tm_octant_mask mask);

/* Whether there are octants of each of the labels 0 … labels - 1, and they are a good
 * mask.
 */
bool tm_octants_are_good(const unsigned label[8], unsigned labels);

/* The sum of the directions in which the boundary faces look, each once: every component
 * is -1, 0 or 1. Of a good mask it looks away from all of them. */
void tm_octant_mask_outward(tm_octant_mask mask, int direction[3]);

TM_EXTERN_C_END

#endif
