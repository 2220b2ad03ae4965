/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The elements: the chosen leaves, divided, and a layer between their boundary and the
 * surface. */
#ifndef TM_LAYER_ASSEMBLE_H
#define TM_LAYER_ASSEMBLE_H

#include "../../base/extern_c.h"
#include "../../mesh/mixed_mesh.h"
#include "../interior/interior_boundary.h"

TM_EXTERN_C_BEGIN

/* The triangles of a cut face, as its corners. Indexed by tm_cut. */
extern const uint8_t tm_cut_triangles[3][2][3];

/* Node s of the interior boundary is there twice: inner[0][s] belongs to the leaves,
 * outer + s to the boundary. Between a face of the interior boundary and its copy is a
 * wedge or a hexahedron, or, where the face is cut, two wedges. A leaf with a cut face is
 * divided from its centre. Where leaves are in several parts each of these has an inner
 * node of its own there, and a layer on its side of the same outer nodes. */
typedef struct tm_assembly {
    tm_mixed_mesh mesh;
    uint32_t *first; /* [leaves + 1]: leaf l has the elements first[l] … first[l + 1) */
    uint32_t *layer; /* [faces of the interior boundary]: the element under it; of a cut
                        face the first of the two */
    uint32_t *layer_across; /* [faces of the interior boundary]: the same beyond it,
                               TM_NONE where nothing is; NULL of one part */
    size_t parts;
    uint32_t **inner; /* [parts][nodes of the interior boundary]: TM_NONE where the part
                         is not there */
    uint32_t outer;
    size_t core; /* nodes of the octree come first, then the outer ones, then middles */
    size_t middles;
    uint32_t *middle_leaf; /* [middles]: the leaf that it is the centre of */
    uint32_t **core_node;  /* [parts][nodes of the octree]: of the mesh, or TM_NONE */
    uint32_t *grid_node;   /* [core]: of the octree */
} tm_assembly;

/* Makes them of the leaves of so many parts, whose interior boundary this is
 * (tm_interior_boundary_of_parts()). All nodes are on the lattice, where the layer has no
 * height yet; for positions at which every element is valid see lattice_points.c.
 * TM_ERROR_SYSTEM where memory or 32-bit ids are out. *assembly is to be freed, after an
 * error too. O(leaves + elements).
 */
tm_status tm_assemble(tm_assembly *assembly, const tm_octree *octree,
                      const tm_interior *part, size_t parts,
                      const tm_interior_boundary *boundary, tm_error *error);
void tm_assembly_free(tm_assembly *assembly);

TM_EXTERN_C_END

#endif
