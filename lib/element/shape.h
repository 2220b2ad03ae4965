/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Faces, edges and corners of a tetrahedron, a pyramid, a wedge and a hexahedron, with
 * the nodes in the order of mixed_mesh.h. */
#ifndef TM_ELEMENT_SHAPE_H
#define TM_ELEMENT_SHAPE_H

#include <stddef.h>
#include <stdint.h>

enum {
    TM_MIXED_NODES = 8, /* at most */
    TM_MIXED_FACES = 6,
    TM_MIXED_EDGES = 12
};

/* Numbers are those of the element's nodes. In a positive element the nodes of a face
 * turn counter-clockwise seen from outside. What is left of an array is 0. */
typedef struct tm_mixed_shape {
    uint8_t faces, edges;
    /* How many of the corners of tm_element_shapes (jens.h), from the first on, have
     * determinants of their own. One of a tetrahedron: those of all four are the same.
     * Four of a pyramid: at its apex, any three consecutive edges make the determinant of
     * the corner of the base that the middle one leads to. */
    uint8_t corners;
    uint8_t face[TM_MIXED_FACES][4]; /* of a triangle the fourth is the first again */
    uint8_t edge[TM_MIXED_EDGES][2];
    uint8_t edge_face[TM_MIXED_EDGES][2]; /* the two faces at an edge */
} tm_mixed_shape;

/* By the number of nodes: 4, 5, 6, 8; the others have no faces. */
extern const tm_mixed_shape tm_mixed_shapes[TM_MIXED_NODES + 1];

/* 3 or 4. */
static inline size_t tm_mixed_face_nodes(const uint8_t face[4])
{
    return face[3] == face[0] ? 3 : 4;
}

/* least[i] = the smallest node of face i of an element with the nodes n. */
static inline void tm_mixed_least(const tm_mixed_shape *shape, const uint32_t *n,
                                  uint32_t least[TM_MIXED_FACES])
{
    for (size_t i = 0; i < shape->faces; i++) {
        const uint8_t *f = shape->face[i];
        const uint32_t a = n[f[0]] < n[f[1]] ? n[f[0]] : n[f[1]];
        const uint32_t b = n[f[2]] < n[f[3]] ? n[f[2]] : n[f[3]];
        least[i] = a < b ? a : b;
    }
}

#endif
