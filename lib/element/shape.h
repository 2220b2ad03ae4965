/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The one table of tetrahedra, pyramids, wedges and hexahedra: their names, faces, edges
 * and corners.
 *
 * The nodes of an element are in the order of .mix, which is VTK's: the base 0 1 2 3 of a
 * hexahedron turns counter-clockwise seen from the top 4 5 6 7, that of a pyramid seen
 * from its apex 4, the triangle 0 1 2 of a tetrahedron seen from 3, but that of a wedge
 * seen from outside, away from the triangle 3 4 5, where 3 is over 0. */
#ifndef TM_ELEMENT_SHAPE_H
#define TM_ELEMENT_SHAPE_H

#include "../base/extern_c.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* The number of nodes tells which one it is. */
enum {
    TM_TET_NODES = 4,
    TM_PYRAMID_NODES = 5,
    TM_WEDGE_NODES = 6,
    TM_HEX_NODES = 8,
    TM_TET_EDGES = 6
};

/* At most. */
enum {
    TM_ELEMENT_NODES = 8,
    TM_ELEMENT_FACES = 6,
    TM_ELEMENT_EDGES = 12,
    TM_ELEMENT_CORNERS = 8
};

typedef enum tm_element_kind {
    TM_TETRAHEDRON,
    TM_PYRAMID,
    TM_WEDGE,
    TM_HEXAHEDRON,
    TM_ELEMENT_KINDS
} tm_element_kind;

/* VTK's numbers of cell types (vtkCellType.h). */
enum {
    TM_VTK_VERTEX = 1,
    TM_VTK_LINE = 3,
    TM_VTK_TRIANGLE = 5,
    TM_VTK_POLYGON = 7,
    TM_VTK_QUADRILATERAL = 9,
    TM_VTK_TETRA = 10,
    TM_VTK_HEXAHEDRON = 12,
    TM_VTK_WEDGE = 13,
    TM_VTK_PYRAMID = 14,
    TM_VTK_POLYHEDRON = 42
};

/* The constants K: J_S (jens.h) at a corner of the regular element. That of the apex is
 * J_S at the apex of the pyramid whose base corners have √6/3: a square base, and as high
 * as the base is wide. */
#define TM_SQRT_2 1.41421356237309504880
#define TM_SQRT_3 1.73205080756887729353
#define TM_SQRT_6 2.44948974278317809820

#define TM_K_TETRAHEDRON  (TM_SQRT_2 / 2)
#define TM_K_PYRAMID_BASE (TM_SQRT_6 / 3)
#define TM_K_PYRAMID_APEX (2 * TM_SQRT_6 / 9)
#define TM_K_WEDGE        (TM_SQRT_3 / 2)
#define TM_K_HEXAHEDRON   1.0

/* Numbers are those of the element's nodes. What is left of an array is 0. */
typedef struct tm_element_shape {
    const char *name;   /* "tet", "pyramid", "wedge", "hex" */
    const char *plural; /* "tetrahedra", … */
    uint8_t kind;       /* tm_element_kind */
    uint8_t vtk_type;
    uint8_t faces, edges, corners;
    /* How many of the corners, from the first on, have determinants of their own. One of
     * a tetrahedron: those of all four are the same. Four of a pyramid: at its apex, any
     * three consecutive edges make the determinant of the corner of the base that the
     * middle one leads to. */
    uint8_t determinants;
    /* In a positive element the nodes of a face turn counter-clockwise seen from outside;
     * of a triangle the fourth is the first again. In VTK's order of faces. */
    uint8_t face[TM_ELEMENT_FACES][4];
    uint8_t edge[TM_ELEMENT_EDGES][2];      /* the lower number first */
    uint8_t edge_face[TM_ELEMENT_EDGES][2]; /* the two faces at an edge */
    /* Corner i is at corner[i][0], and its three neighbours, in positive order, are
     * corner[i][1 … 3], the last of which decides how J_S is rounded (jens.h). A pyramid
     * has eight: those of its base, and at its apex each three lateral edges that follow
     * each other. */
    uint8_t corner[TM_ELEMENT_CORNERS][4];
    /* The three edges of a corner, in such an order that their determinant, each taken in
     * its own direction, is positive where that of the edges that leave the corner is. */
    uint8_t corner_edge[TM_ELEMENT_CORNERS][3];
    /* The nodes of the mirrored element: its base, and its top, turn the other way. */
    uint8_t mirror[TM_ELEMENT_NODES];
    double k[TM_ELEMENT_CORNERS];
} tm_element_shape;

/* By the number of nodes: 4, 5, 6, 8; the others have no faces, edges and corners. */
extern const tm_element_shape tm_element_shapes[TM_ELEMENT_NODES + 1];

/* The number of nodes of each kind. */
extern const uint8_t tm_element_kind_nodes[TM_ELEMENT_KINDS];

/* What meshes of tetrahedra alone go by. Face i is opposite to corner i, and turns
 * counter-clockwise seen from outside of a positive one. */
extern const uint8_t tm_face_corner[4][3];

/* Its edges ab ac ad bc bd cd: edge e is opposite to edge 5 - e. The ends, then the other
 * two corners, such that the four are an even permutation of 0 1 2 3. */
extern const uint8_t tm_edge_corner[TM_TET_EDGES][4];

/* VTK's number for a vertex, a triangle or an element, by how many nodes it has. */
static inline uint8_t tm_vtk_cell_type(size_t nodes)
{
    if (nodes == 1)
        return TM_VTK_VERTEX;
    return nodes == 3 ? (uint8_t)TM_VTK_TRIANGLE : tm_element_shapes[nodes].vtk_type;
}

/* 3 or 4. */
static inline size_t tm_mixed_face_nodes(const uint8_t face[4])
{
    return face[3] == face[0] ? 3 : 4;
}

/* Whether an element or a face names a node twice. */
static inline bool tm_has_node_twice(const uint32_t *node, size_t k)
{
    for (size_t i = 1; i < k; i++)
        for (size_t j = 0; j < i; j++)
            if (node[i] == node[j])
                return true;
    return false;
}

/* Turns an element of k nodes into the mirrored one. */
static inline void tm_mixed_mirror(uint32_t *node, size_t k)
{
    uint32_t old[TM_ELEMENT_NODES];
    for (size_t i = 0; i < k; i++)
        old[i] = node[i];
    for (size_t i = 0; i < k; i++)
        node[i] = old[tm_element_shapes[k].mirror[i]];
}

/* least[i] = the smallest node of face i of an element with the nodes n. */
static inline void tm_mixed_least(const tm_element_shape *shape, const uint32_t *n,
                                  uint32_t least[TM_ELEMENT_FACES])
{
    for (size_t i = 0; i < shape->faces; i++) {
        const uint8_t *f = shape->face[i];
        const uint32_t a = n[f[0]] < n[f[1]] ? n[f[0]] : n[f[1]];
        const uint32_t b = n[f[2]] < n[f[3]] ? n[f[2]] : n[f[3]];
        least[i] = a < b ? a : b;
    }
}

TM_EXTERN_C_END

#endif
