/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Types of elements of Abaqus and CalculiX, and how their faces are numbered. */
#ifndef TM_FORMAT_ABAQUS_INP_TYPES_H
#define TM_FORMAT_ABAQUS_INP_TYPES_H

#include "../scan.h"

#include <stddef.h>
#include <stdint.h>

/* What a stream has of a type: dimension 1 … 3, or 0 where it has nothing. */
typedef struct tm_inp_type {
    uint8_t dimension;
    uint8_t nodes;
    uint8_t corners;
    uint8_t vtk; /* VTK's number of the type with all nodes (vtkCellType.h) */
} tm_inp_type;

/* The type of a name: "C3D10M". What follows the number of nodes (R, H, I, T, …) is not
 * looked at. */
tm_inp_type tm_inp_type_of(tm_word name);

/* The nodes of an element of the type, in the order of VTK's: the triangle of a wedge
 * turns the other way, and a line of three nodes has the middle one last. */
void tm_inp_reorder(const tm_inp_type *type, uint32_t *node);

/* The number of a face that a surface names: S1 … S6; 0 for that of a shell, SPOS or
 * SNEG, and where there is none; -1 for anything else. */
int tm_inp_face_label(tm_word label);

/* Which face in shape.h face S`number` is of an element of `corners` nodes, in the order
 * of .mix; -1 where it has none of that number. And back. */
int tm_inp_face(size_t corners, int number);
int tm_inp_face_number(size_t corners, size_t face);

#endif
