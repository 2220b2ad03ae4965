/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK's numbers of cell types (vtkCellType.h). */
#ifndef TM_ELEMENT_VTK_CELL_TYPE_H
#define TM_ELEMENT_VTK_CELL_TYPE_H

enum {
    VTK_VERTEX = 1,
    VTK_TRIANGLE = 5,
    VTK_TETRA = 10,
    VTK_HEXAHEDRON = 12,
    VTK_WEDGE = 13,
    VTK_PYRAMID = 14,
    VTK_POLYHEDRON = 42
};

#endif
