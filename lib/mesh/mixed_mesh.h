/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tetrahedra, pyramids, wedges and hexahedra in one mesh, as .mix has them. */
#ifndef TM_MESH_MIXED_MESH_H
#define TM_MESH_MIXED_MESH_H

#include "../base/extern_c.h"
#include "../element/jens.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Element e has the nodes item[start[e]] … item[start[e + 1] - 1]: 4 of a tetrahedron, 5
 * of a pyramid, 6 of a wedge, 8 of a hexahedron, in the order of shape.h. */
typedef struct tm_mixed_mesh {
    size_t nodes;
    double (*xyz)[3];
    size_t elements;
    size_t *start;
    uint32_t *item;
    unsigned threads; /* for work on it: no result depends on it; 0: one */
} tm_mixed_mesh;

/* J_ENS of element e. */
static inline double tm_mixed_jens(const tm_mixed_mesh *mesh, size_t e)
{
    return tm_jens(mesh->start[e + 1] - mesh->start[e], (const double(*)[3])mesh->xyz,
                   mesh->item + mesh->start[e]);
}

/* Marks the nodes of element e. */
static inline void tm_mixed_mark_nodes(const tm_mixed_mesh *mesh, size_t e, bool *mark)
{
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        mark[mesh->item[i]] = true;
}

/* Whether a node of element e is marked. */
static inline bool tm_mixed_has_marked(const tm_mixed_mesh *mesh, size_t e,
                                       const bool *mark)
{
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        if (mark[mesh->item[i]])
            return true;
    return false;
}

TM_EXTERN_C_END

#endif
