/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A brick of root cubes over a surface, cut into leaves that are balanced over faces and
 * edges, as flat arrays: p4est makes them. */
#ifndef TM_FOREST_OCTREE_H
#define TM_FOREST_OCTREE_H

#include "../../base/extern_c.h"
#include "../../base/error.h"
#include "../../surface/surface.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* The 27 points of a leaf where a node can be. Corner c is at bit 0 of c in x, bit 1 in
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

/* The grid that all nodes are on is that of level TM_OCTREE_FINEST, the deepest that
 * p4est has, whatever the leaves: so refinement does not change coordinates. Leaves go to
 * one level less, so that the centre of every leaf is a point of the grid. */
enum { TM_OCTREE_FINEST = 18, TM_OCTREE_LEVEL_MAX = TM_OCTREE_FINEST - 1 };

/* Where each of them is, in half sides of the leaf: 0, 1 or 2. */
extern const unsigned char tm_leaf_point[27][3];

typedef struct tm_leaf {
    uint32_t
        anchor[3]; /* its low corner, in units of the finest level, from the brick's */
    uint8_t level; /* its side is 2^(finest - level) units */
    bool crossed;  /* the surface meets the closed cube */
} tm_leaf;

typedef struct tm_octree {
    double low[3];     /* the low corner of the brick */
    double side;       /* of a root cube */
    uint32_t roots[3]; /* cubes along each axis */
    unsigned finest;   /* of the grid: TM_OCTREE_FINEST */
    size_t leaves;
    tm_leaf *leaf; /* root by root, in Z order within each */
    size_t nodes;
    uint32_t (*grid)[3]; /* [nodes], in units of the finest level; nodes are numbered in
                            the order in which the leaves have them */
    uint32_t (*node)[TM_LEAF_NODES]; /* [leaves]: corners, then the nodes that smaller
                                        neighbours have in the middle of its edges and
                                        faces, TM_NONE where there is none */
    unsigned threads; /* for work on it, those of the surface: no result depends on it */
} tm_octree;

/* The coordinates of a point of the grid. */
static inline void tm_octree_point(const tm_octree *octree, const uint32_t grid[3],
                                   double xyz[3])
{
    const double unit = octree->side / (double)((uint32_t)1 << octree->finest);
    for (int i = 0; i < 3; i++)
        xyz[i] = octree->low[i] + unit * (double)grid[i];
}

/* The side of a leaf, and its centre. */
static inline double tm_leaf_side(const tm_octree *octree, const tm_leaf *leaf)
{
    return octree->side / (double)((uint32_t)1 << leaf->level);
}

static inline void tm_leaf_centre(const tm_octree *octree, const tm_leaf *leaf,
                                  double centre[3])
{
    const uint32_t half = (uint32_t)1 << (octree->finest - leaf->level - 1);
    const uint32_t grid[3] = {leaf->anchor[0] + half, leaf->anchor[1] + half,
                              leaf->anchor[2] + half};
    tm_octree_point(octree, grid, centre);
}

/* The deepest level of a leaf. */
unsigned tm_octree_deepest(const tm_octree *octree);

/* What a leaf is split for, and to which level. */
typedef enum tm_octree_rule_kind {
    TM_RULE_EVERYTHING, /* it is there */
    TM_RULE_SURFACE,    /* the surface meets its closed cube */
    TM_RULE_BOX,        /* the box meets it */
    TM_RULE_REGION,     /* it meets or is in the solid of a closed surface */
    TM_RULE_LEAVES      /* it is in a list: split once, when all other rules are done */
} tm_octree_rule_kind;

typedef struct tm_octree_rule {
    tm_octree_rule_kind kind;
    unsigned level;        /* at most TM_OCTREE_LEVEL_MAX; unused for TM_RULE_LEAVES */
    double size;           /* above 0: the largest side of leaves, in place of a level */
    const double *largest; /* TM_RULE_SURFACE: [triangles of the surface]: the largest
                              side of leaves that they meet; NULL: as level says */
    unsigned deeper; /* TM_RULE_SURFACE: so many levels more where the surface is closer
                        to itself than two sides of the leaf */
    unsigned spread; /* such leaves are so many levels below it, at most */
    double low[3], high[3];   /* TM_RULE_BOX */
    const tm_surface *region; /* TM_RULE_REGION */
    const uint32_t *leaf;     /* TM_RULE_LEAVES: [leaves], numbers of leaves of the octree
                                 that the other rules and the balance give */
    size_t leaves;
} tm_octree_rule;

/* The same octree again, with arrays of its own. TM_ERROR_SYSTEM where memory is out; the
 * copy is then to be freed all the same. */
tm_status tm_octree_copy(tm_octree *copy, const tm_octree *octree, tm_error *error);

/* Frees the arrays; an octree of zeros is an empty one. */
void tm_octree_free(tm_octree *octree);

/* Whether the octree is what it should be, by means other than those that made it: leaves
 * in order that fill each root, balanced; every corner of a leaf a node where it is and
 * no other nodes, none twice, numbered as leaves have them; nodes in the middle of an
 * edge or a face just where something is smaller; `crossed` as tm_surface_meets_box()
 * says (where surface is not NULL). TM_ERROR_INTERNAL says what is wrong and where. For
 * tests: O(nodes log nodes), some 30 µs per leaf. */
tm_status tm_octree_check(const tm_octree *octree, const tm_surface *surface,
                          tm_error *error);

TM_EXTERN_C_END

#endif
