/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A grid that becomes a stream, in the making: its steps. */
#ifndef TM_FORMAT_VTK_MAKER_H
#define TM_FORMAT_VTK_MAKER_H

#include "../../mesh/cell_faces.h"
#include "vtk_cells.h"

typedef struct tm_vtk_maker {
    tm_vtk_mesh *cells;
    tm_stream *stream;
    tm_vtk_read_report *report;
    tm_error *error;
    bool *keep;       /* [cells] */
    uint32_t *number; /* [points]: the node that a point is; TM_NONE: left out */
    size_t nodes;
    size_t volumes; /* cells that are kept and have one */
    size_t others;  /* polygons that are kept */
    tm_content content;
    tm_vtk_roles roles;
} tm_vtk_maker;

/* The dimension of cell c, -1 where it is not kept. */
static inline int tm_vtk_kept(const tm_vtk_maker *m, size_t c)
{
    return m->keep[c] ? tm_vtk_dimension(m->cells->type[c]) : -1;
}

/* The marker of cell c; 0 where cells have none. */
static inline int32_t tm_vtk_marker(const tm_vtk_maker *m, size_t c)
{
    const size_t array = m->roles.marker;
    return array == TM_VTK_NO_ARRAY ? 0
                                    : (int32_t)m->cells->cell_data.array[array].value[c];
}

/* vtk_elements.c: adds .ele, .mix, or .facet and .cell, without attributes and markers.
 */
tm_status tm_vtk_make_elements(tm_vtk_maker *maker);

/* vtk_polygons.c: what polygons and lines become, with their markers. */
tm_status tm_vtk_make_polygons(tm_vtk_maker *maker);
tm_status tm_vtk_make_lines(tm_vtk_maker *maker);

/* vtk_attributes.c: those of .node, with its markers, and of the cells. */
tm_status tm_vtk_make_attributes(tm_vtk_maker *maker);

#endif
