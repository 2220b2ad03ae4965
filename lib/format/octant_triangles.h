/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which triangles of a surface meet which octants. */
#ifndef TM_FORMAT_OCTANT_TRIANGLES_H
#define TM_FORMAT_OCTANT_TRIANGLES_H

#include "../base/error.h"

#include <stddef.h>
#include <stdint.h>

/* Coordinates of octants have so many bits: a tree is less than 2^21 units long. */
enum { TM_OCTANT_BITS = 21 };

/* An octant: its low corner, and its side as a power of two, in units. */
typedef struct tm_octant_box {
    uint32_t anchor[3];
    unsigned log_side;
} tm_octant_box;

/* Octant o meets the triangles item[start[o]] … in rising order, count[o] of them. */
typedef struct tm_octant_triangles {
    size_t *start;
    uint32_t *count;
    uint32_t *item;
} tm_octant_triangles;

/* Finds them. `triangle` are the corners of each, in units. Octants are closed, and a
 * touch counts, within 1e-6 units. Each anchor is a multiple of the octant's side, and
 * with it inside the tree. TM_ERROR_INPUT where octants overlap: `base` is added to their
 * numbers in the message. *found is to be freed, after an error too.
 * Down the tree, to each octant with the triangles that meet its parent:
 * O(octants log octants + the pairs of a triangle and a cube of any level that meet). */
tm_status tm_octant_triangles_find(tm_octant_triangles *found,
                                   const tm_octant_box *octant, size_t octants,
                                   const double (*triangle)[3][3], size_t triangles,
                                   unsigned base, tm_error *error);
void tm_octant_triangles_free(tm_octant_triangles *found);

#endif
