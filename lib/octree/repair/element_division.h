/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An element divided from a node in its middle. */
#ifndef TM_REPAIR_ELEMENT_DIVISION_H
#define TM_REPAIR_ELEMENT_DIVISION_H

#include "../../base/error.h"
#include "../../mesh/mixed_mesh.h"

#include <stdint.h>

/* At most: a hexahedron whose faces are cut. */
enum { TM_DIVISION_PARTS = 12, TM_DIVISION_ITEMS = 48 };

/* Its parts, as elements of .mix: a pyramid or a tetrahedron for each face, or two
 * tetrahedra where a quadrilateral is cut. Nodes are those of the mesh; TM_NONE is the
 * middle. */
typedef struct tm_division {
    size_t parts;
    size_t start[TM_DIVISION_PARTS + 1];
    uint32_t item[TM_DIVISION_ITEMS];
    double middle[3];
    double worst; /* J_ENS */
    size_t low;   /* parts below the threshold */
} tm_division;

/* The best division of element e: quadrilaterals whose bit is set in `open` may be cut;
 * the middle is moved so that the parts reach the threshold. TM_ERROR_SYSTEM where memory
 * is out. In the order of a millisecond. */
tm_status tm_division_find(tm_division *parts, const tm_mixed_mesh *mesh, size_t e,
                           unsigned open, double threshold, tm_error *error);

#endif
