/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Z order (G. M. Morton, A computer oriented geodetic data base, 1966) of the cells of a
 * root cube's finest grid. */
#ifndef TM_FOREST_Z_ORDER_H
#define TM_FOREST_Z_ORDER_H

#include "octree.h"

/* How many cells a leaf of that level has. */
static inline uint64_t tm_z_cells(unsigned level)
{
    return (uint64_t)1 << (3 * (TM_OCTREE_FINEST - level));
}

/* The position in its root of the cell at a point of the grid. */
static inline uint64_t tm_z_index(const uint32_t point[3])
{
    uint64_t index = 0;
    for (unsigned bit = 0; bit < TM_OCTREE_FINEST; bit++)
        for (unsigned i = 0; i < 3; i++)
            index |= (uint64_t)(point[i] >> bit & 1) << (3 * bit + i);
    return index;
}

/* The low corner of the cell at a position in its root. */
static inline void tm_z_point(uint64_t index, uint32_t point[3])
{
    for (unsigned i = 0; i < 3; i++) {
        point[i] = 0;
        for (unsigned bit = 0; bit < TM_OCTREE_FINEST; bit++)
            point[i] |= (uint32_t)(index >> (3 * bit + i) & 1) << bit;
    }
}

/* Whether two cells are in the same root. */
static inline bool tm_z_same_root(const uint32_t a[3], const uint32_t b[3])
{
    for (int i = 0; i < 3; i++)
        if (a[i] >> TM_OCTREE_FINEST != b[i] >> TM_OCTREE_FINEST)
            return false;
    return true;
}

#endif
