/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A brick of root cubes over a surface, cut into leaves that are balanced over faces and
 * edges, as flat arrays: p4est makes them. */
#ifndef TM_OCTREE_OCTREE_H
#define TM_OCTREE_OCTREE_H

#include "../base/error.h"
#include "../surface/surface.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The 27 places of a leaf where a node can be. Corner c is at bit 0 of c in x, bit 1 in
 * y, bit 2 in z. Edges 0 … 3 run along x, 4 … 7 along y, 8 … 11 along z, and of each four
 * the first is at the low side of both other axes, the second at the high side of the
 * lower axis. Faces are -x +x -y +y -z +z. (The numbering of p4est.) */
enum {
    TM_LEAF_CORNER = 0,
    TM_LEAF_EDGE = 8,
    TM_LEAF_FACE = 20,
    TM_LEAF_NODES = 26,
    TM_LEAF_CENTRE = 26
};

/* Where each of them is, in half sides of the leaf: 0, 1 or 2. */
extern const unsigned char tm_leaf_place[27][3];

typedef struct tm_leaf {
    uint32_t anchor[3]; /* its low corner, in units of the finest level, from the brick's */
    uint8_t level;      /* its side is 2^(finest - level) units */
    bool crossed;       /* the surface meets the closed cube */
} tm_leaf;

typedef struct tm_octree {
    double low[3];     /* the low corner of the brick */
    double side;       /* of a root cube */
    uint32_t roots[3]; /* cubes along each axis */
    unsigned finest;   /* the deepest level that a leaf has or may get */
    size_t leaves;
    tm_leaf *leaf; /* root by root, in Z order within each */
    size_t nodes;
    uint32_t (*grid)[3]; /* [nodes], in units of the finest level */
    uint32_t (*node)[TM_LEAF_NODES]; /* [leaves]: corners, then the nodes that smaller
                                        neighbours have in the middle of its edges and
                                        faces, TM_NONE where there is none */
    struct p8est *forest;
} tm_octree;

/* The place of a point of the grid. */
static inline void tm_octree_point(const tm_octree *octree, const uint32_t grid[3],
                                   double xyz[3])
{
    const double unit = octree->side / (double)((uint32_t)1 << octree->finest);
    for (int i = 0; i < 3; i++)
        xyz[i] = octree->low[i] + unit * (double)grid[i];
}

#endif
