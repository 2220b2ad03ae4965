/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The polygons that a file of a surface gets from a mesh, and their groups: for the
 * writers in this folder. */
#ifndef TM_FORMAT_POLYGON_LIST_H
#define TM_FORMAT_POLYGON_LIST_H

#include "../../mesh/cell_faces.h"
#include "../../stream/group.h"
#include "surface_write.h"

typedef struct tm_polygon {
    uint32_t facet;
    bool turned;   /* it is the other way round than the facet */
    int32_t value; /* its marker or region */
} tm_polygon;

typedef struct tm_polygon_list {
    const tm_stream *stream;
    tm_cell_faces faces;
    const double (*xyz)[3];
    size_t polygons;
    tm_polygon *polygon;
    size_t corners; /* of the polygon that has most */
    uint32_t *room; /* [2 * corners] */
    size_t nodes;
    uint32_t *node;   /* [nodes] that polygons have, as the stream numbers them */
    uint32_t *number; /* [nodes of the stream]: their place in node */
    tm_group_dimension dimension;
    bool grouped; /* there is more than one group, or one with a name */
} tm_polygon_list;

/* Makes the list for a file. It is to be freed, after an error too. */
tm_status tm_polygon_list_make(tm_polygon_list *list, const tm_stream *stream,
                               tm_polygons_of of, tm_error *error);
void tm_polygon_list_free(tm_polygon_list *list);

/* Makes the list, lets `put` append the file to *text, and says what was written: all
 * that a writer of whole polygons does. */
typedef void tm_polygon_put(tm_text *text, tm_polygon_list *list,
                            const tm_surface_file *file);
tm_status tm_polygon_write(tm_text *text, const tm_stream *stream,
                           const tm_surface_file *file, tm_surface_written *written,
                           tm_polygon_put *put, tm_error *error);

/* Sorts polygons by value, 0 first, if they are grouped; those of one keep their order.
 */
void tm_polygon_list_sort(tm_polygon_list *list);

/* Puts the nodes of polygon p, as the stream has them, into room, and returns how many.
 */
size_t tm_polygon_corners(const tm_polygon_list *list, size_t p);

/* Appends to *text a line of a word, or "", and the coordinates of node v of the file. */
void tm_polygon_point(const tm_polygon_list *list, size_t v, const char *word,
                      tm_text *text);

/* Appends how many corners polygon p has, and these as the file numbers them from 0. */
void tm_polygon_row(const tm_polygon_list *list, size_t p, tm_text *text);

/* The end of the run of polygons that have the value of polygon p. */
size_t tm_polygon_group_end(const tm_polygon_list *list, size_t p);

/* Sets a text to the name of a value: that of .group, else marker_N or region_N, with _
 * behind it where .group has that for another one; empty for a 0 without one. */
void tm_polygon_name(const tm_polygon_list *list, int32_t value, tm_text *name);

#endif
