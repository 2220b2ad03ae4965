/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The elements: the chosen leaves, divided, and a layer between their boundary and the
 * surface. */
#ifndef TM_OCTREE_ASSEMBLE_H
#define TM_OCTREE_ASSEMBLE_H

#include "../mixed/mixed_mesh.h"
#include "skin.h"

/* A cut face is the triangles triangle[0] and triangle[1] of its corners. */
typedef struct tm_cut_face {
    uint8_t triangle[2][3];
} tm_cut_face;

/* Indexed by tm_cut. The last two elements under the face have them, in that order. */
extern const tm_cut_face tm_cut_faces[3];
enum { TM_CUT_ELEMENTS = 7 };

/* Node s of the skin is there twice: inner[s] belongs to the leaves, outer + s to the
 * boundary. Between a face of the skin and its copy is a wedge or a hexahedron, or, where
 * the face is cut, pyramids and tetrahedra around a node in the middle. */
typedef struct tm_assembly {
    tm_mixed_mesh mesh;
    size_t *first;   /* [leaves + 1]: leaf l has the elements first[l] … first[l + 1) */
    uint32_t *layer; /* [faces of the skin]: the element under it; of a cut face the first of
                        seven, the last two of which have the face's triangles */
    uint32_t *inner; /* [nodes of the skin] */
    uint32_t outer;
    size_t core; /* nodes of the octree come first, then the outer ones, then middles */
    uint32_t *grid_node; /* [core]: of the octree */
} tm_assembly;

/* Makes them. All nodes are at their places on the lattice, but the inner ones a quarter
 * of the smallest leaf around them inside, and there every element is valid.
 * TM_ERROR_SYSTEM where memory or 32-bit ids are out. *assembly is to be freed, after an
 * error too. O(leaves + elements). */
tm_status tm_assemble(tm_assembly *assembly, const tm_octree *octree,
                      const tm_solid *solid, const tm_skin *skin, tm_error *error);
void tm_assembly_free(tm_assembly *assembly);

#endif
