/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK's numbers of cell types (vtkCellType.h). */
#ifndef TM_ELEMENT_VTK_CELL_TYPE_H
#define TM_ELEMENT_VTK_CELL_TYPE_H

#include <stddef.h>

enum {
    VTK_VERTEX = 1,
    VTK_TRIANGLE = 5,
    VTK_TETRA = 10,
    VTK_HEXAHEDRON = 12,
    VTK_WEDGE = 13,
    VTK_PYRAMID = 14,
    VTK_POLYHEDRON = 42
};

/* That of a vertex, triangle, tetrahedron, pyramid, wedge or hexahedron, by how many
 * nodes it has. */
static inline unsigned char tm_vtk_cell_type(size_t nodes)
{
    static const unsigned char type[] = {
        0,           VTK_VERTEX, 0, VTK_TRIANGLE,  VTK_TETRA,
        VTK_PYRAMID, VTK_WEDGE,  0, VTK_HEXAHEDRON};
    return type[nodes];
}

#endif
