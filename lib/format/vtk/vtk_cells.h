/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An unstructured grid as VTK's files hold it, in flat arrays, and how it becomes a
 * stream: what the readers of both formats do alike. */
#ifndef TM_FORMAT_VTK_CELLS_H
#define TM_FORMAT_VTK_CELLS_H

#include "../../mesh/polyhedra.h"
#include "../numbers.h"
#include "vtk_read.h"

/* VTK's numbers of cell types that shape.h does not have (vtkCellType.h). */
enum {
    TM_VTK_EMPTY = 0,
    TM_VTK_POLY_VERTEX = 2,
    TM_VTK_POLY_LINE = 4,
    TM_VTK_STRIP = 6,
    TM_VTK_PIXEL = 8,
    TM_VTK_VOXEL = 11,
    TM_VTK_TYPES = 82
};

/* An array of point or cell data: `components` values of each point or cell. */
typedef struct tm_vtk_data {
    size_t name; /* names.byte + name */
    size_t components;
    bool whole; /* its numbers are whole */
    bool lacks; /* a piece has it not, or otherwise; or they are strings */
    bool strings;
    bool measure;  /* vtu-export's: its values are not needed */
    double *value; /* [count][components] */
    size_t room;
} tm_vtk_data;

typedef struct tm_vtk_data_list {
    size_t arrays;
    tm_vtk_data *array;
    size_t room;
} tm_vtk_data_list;

/* The lists of cell c are its nodes and, of a polyhedron, its faces: how many nodes, and
 * the nodes, of one after the other; those of other cells are empty. */
typedef struct tm_vtk_mesh {
    const char *name;               /* of the file, for messages, */
    size_t first_point, first_cell; /* and the first ones of it */
    size_t points;
    double (*xyz)[3];
    size_t pieces;
    size_t *piece_start; /* [pieces]: its first point */
    size_t cells;
    uint8_t *type;
    tm_lists nodes, faces;
    tm_vtk_data_list point_data, cell_data;
    tm_text names;           /* of arrays, with 0 behind each */
    tm_text groups;          /* the strings group_names, with 0 behind each */
    size_t open, open_faces; /* items of the cell that is being made */
    size_t point_room, piece_room, type_room;
} tm_vtk_mesh;

/* An empty grid. TM_ERROR_SYSTEM where memory is out. */
tm_status tm_vtk_mesh_new(tm_vtk_mesh *cells, const char *name, tm_error *error);
void tm_vtk_mesh_free(tm_vtk_mesh *cells);

/* The points that are added from here on are another piece's. */
tm_status tm_vtk_begin_piece(tm_vtk_mesh *cells, tm_error *error);

/* Appends points from numbers, three each. TM_ERROR_INPUT where one is not finite. */
tm_status tm_vtk_add_points(tm_vtk_mesh *cells, const tm_numbers *xyz, tm_error *error);

/* Appends a node of the cell that is being made: number i of `numbers`, of points first …
 * cells->points - 1, counted from `first`. TM_ERROR_INPUT where it is out of range. Then
 * tm_vtk_end_cell() ends the cell. The same of its faces: a number of nodes, and nodes.
 */
tm_status tm_vtk_add_node(tm_vtk_mesh *cells, const tm_numbers *numbers, size_t i,
                          size_t first, tm_error *error);
tm_status tm_vtk_end_cell(tm_vtk_mesh *cells, uint8_t type, tm_error *error);
tm_status tm_vtk_add_face(tm_vtk_mesh *cells, const tm_numbers *numbers, size_t i,
                          size_t nodes, size_t first, tm_error *error);

/* The array of that name, a new one where it is new and `is_new`, else NULL. NULL also
 * where memory is out. */
tm_vtk_data *tm_vtk_data_named(tm_vtk_mesh *cells, tm_vtk_data_list *list,
                               const char *name, bool is_new);

/* Puts the numbers behind the first `done` tuples. TM_ERROR_SYSTEM where memory is out.
 */
tm_status tm_vtk_add_values(tm_vtk_data *data, size_t done, const tm_numbers *numbers,
                            tm_error *error);

/* vtk_types.c ----------------------------------------------------------------------- */

enum { TM_VTK_PENTAGONAL_PRISM = 15, TM_VTK_HEXAGONAL_PRISM = 16 };

/* What cells of a type are the corners of: 0 points, 1 lines, 2 polygons, 3 with a
 * volume; -1 of types that a stream cannot hold. */
int tm_vtk_dimension(uint8_t type);

/* Makes cells of higher order, pixels and voxels what they are without their other nodes,
 * in the order of shape.h, and counts them. middle[points], which is false before,
 * becomes true for points that are such other nodes and nothing else. TM_ERROR_INPUT
 * where a type of cell is unknown, or has another number of nodes. O(n). */
tm_status tm_vtk_take_corners(tm_vtk_mesh *cells, bool *middle, size_t *higher_order,
                              tm_error *error);

/* vtk_names.c ----------------------------------------------------------------------- */

/* Which arrays are what: indices of them; TM_VTK_NO_ARRAY where there is none. */
#define TM_VTK_NO_ARRAY SIZE_MAX
typedef struct tm_vtk_roles {
    size_t region;      /* of cell data */
    size_t tetrahedra;  /* of cell data: how many a polyhedron is */
    size_t marker;      /* of cell data */
    size_t node_marker; /* of point data */
} tm_vtk_roles;

/* Chooses them, by the options or by names that are in use; keep[cells] says which cells
 * count. TM_ERROR_INPUT where an option's name is not there, which the error tells with
 * the names that are, or is there of markers that are no whole numbers. O(n). */
tm_status tm_vtk_find_roles(const tm_vtk_mesh *cells, const bool *keep,
                            const tm_vtk_read_options *options, tm_vtk_roles *roles,
                            tm_error *error);

/* Whether an array is one that VTK keeps for itself, as vtkGhostType. */
bool tm_vtk_is_internal(const char *name);

/* Says which arrays of cell data are what vtu-export measures, but for those that an
 * option names. O(arrays). */
void tm_vtk_find_measures(tm_vtk_mesh *cells, const tm_vtk_read_options *options);

/* vtk_stream.c: makes the grid a stream, which is empty; after an error it is again. */
tm_status tm_vtk_mesh_to_stream(tm_vtk_mesh *cells, tm_stream *stream,
                                const tm_vtk_read_options *options,
                                tm_vtk_read_report *report, tm_error *error);

#endif
