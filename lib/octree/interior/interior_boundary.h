/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The boundary of the chosen leaves as a mesh of triangles and quadrilaterals on the
 * octree's lattice: it becomes the surface's. Once found it needs the octree no more. */
#ifndef TM_LAYER_INTERIOR_BOUNDARY_H
#define TM_LAYER_INTERIOR_BOUNDARY_H

#include "../../base/extern_c.h"
#include "interior_leaves.h"
#include "../transition/transition.h"

TM_EXTERN_C_BEGIN

/* How a quadrilateral is cut into triangles, by the diagonal from its corner 0 or 1. */
typedef enum tm_cut { TM_UNCUT, TM_CUT_02, TM_CUT_13 } tm_cut;

typedef struct tm_interior_boundary {
    double low[3], side; /* the lattice: where it begins, the side of a root cube */
    unsigned finest;     /* and the level of its points */
    unsigned coarsest;   /* level of the largest leaf at the boundary */
    size_t nodes;
    uint32_t *grid_node; /* [nodes]: the octree's */
    uint32_t (*grid)[3]; /* [nodes]: on the lattice */
    double *size;        /* [nodes]: side of the smallest leaf with a face there */
    size_t faces;
    uint32_t (*face)[4]; /* interior boundary nodes; counter-clockwise seen from outside;
                            TM_NONE as  the fourth of a triangle */
    uint32_t *leaf;      /* [faces]: the chosen one that it is of, ascending */
    uint8_t *piece;      /* [faces]: it is piece i of the leaf's face f (tm_face_pieces):
                            TM_FACE_PIECES * f + i, ascending for each leaf */
    uint32_t (*region)[2]; /* [faces]: of its leaf, and of what is beyond it; NULL where
                              leaves have none (interior_leaves.h) */
    uint8_t *cut;          /* [faces]: tm_cut; TM_UNCUT at first */
    size_t *around_start;  /* [nodes + 1] */
    uint32_t *around;      /* the faces at node n: around[around_start[n]] … */
} tm_interior_boundary;

/* The corners of a face: 3 or 4. */
static inline unsigned tm_boundary_face_corners(const tm_interior_boundary *boundary,
                                                size_t f)
{
    return boundary->face[f][3] == TM_NONE ? 3 : 4;
}

/* The corner of a face that node s is, which it must have. */
static inline unsigned tm_boundary_face_corner(const tm_interior_boundary *boundary,
                                               size_t f, uint32_t s)
{
    unsigned i = 0;
    while (boundary->face[f][i] != s)
        i++;
    return i;
}

/* The side of the lattice's smallest cubes. */
static inline double tm_boundary_unit(const tm_interior_boundary *boundary)
{
    return boundary->side / (double)((uint32_t)1 << boundary->finest);
}

/* The point of the lattice where node s is. */
static inline void tm_boundary_node_point(const tm_interior_boundary *boundary, size_t s,
                                          double xyz[3])
{
    const double unit = tm_boundary_unit(boundary);
    for (int i = 0; i < 3; i++)
        xyz[i] = boundary->low[i] + unit * (double)boundary->grid[s][i];
}

/* The state of a chosen leaf: the middles that the mesh has. */
tm_leaf_state tm_interior_leaf_state(const tm_interior *interior, const tm_octree *octree,
                                     size_t leaf);

/* Finds it. Nodes are numbered in the octree's order, faces leaf by leaf.
 * TM_ERROR_SYSTEM where memory is out. *boundary is to be freed, after an error too. */
tm_status tm_interior_boundary_find(tm_interior_boundary *boundary,
                                    const tm_octree *octree, const tm_interior *interior,
                                    tm_error *error);
/* Finds the boundary of leaves in parts, which have the same nodes `used`: the faces that
 * nothing is beyond, and those between two parts, once, as faces of the part that comes
 * first. Nodes are numbered in the octree's order, faces part by part, leaf by leaf. */
tm_status tm_interior_boundary_of_parts(tm_interior_boundary *boundary,
                                        const tm_octree *octree, const tm_interior *part,
                                        size_t parts, tm_error *error);
/* Finds around_start and around, of a boundary that has its faces. */
tm_status tm_interior_boundary_find_around(tm_interior_boundary *boundary,
                                           tm_error *error);
void tm_interior_boundary_free(tm_interior_boundary *boundary);

TM_EXTERN_C_END

#endif
