/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh of an input file: what stands in its instances, one behind the other, with
 * nodes and elements looked up. */
#ifndef TM_FORMAT_ABAQUS_INP_MESH_H
#define TM_FORMAT_ABAQUS_INP_MESH_H

#include "../../mesh/polygon_table.h"
#include "inp_model.h"

typedef struct tm_inp_mesh {
    tm_inp_model *model;
    size_t nodes, elements;
    double (*xyz)[3];  /* [nodes] */
    tm_inp_type *type; /* [elements] */
    tm_lists of;       /* the nodes of each element */
    tm_lists faces;    /* polygons: shells, and what surfaces name */
    tm_polygon_table table;
    uint32_t *face_of; /* [elements]: that a shell is; TM_INP_NONE */
} tm_inp_mesh;

/* Sorts the ids of the model and looks up all nodes. TM_ERROR_INPUT where one is not
 * there, or an id is there twice. To be freed, after an error too. O(n log n). */
tm_status tm_inp_mesh_make(tm_inp_mesh *mesh, tm_inp_model *model);
void tm_inp_mesh_free(tm_inp_mesh *mesh);

/* The face that a surface names, of an element (see tm_inp_member); TM_INP_NONE where
 * the element has none of that number. A new one is put in. TM_ERROR_SYSTEM where memory
 * is out. Expected O(1). */
tm_status tm_inp_mesh_face(tm_inp_mesh *mesh, uint32_t element, int number,
                           uint32_t *face);

#endif
