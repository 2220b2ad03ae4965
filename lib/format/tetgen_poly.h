/* SPDX-License-Identifier: GPL-3.0-or-later */
/* TetGen's .poly and .smesh files, and .node files as surfaces of points alone: nodes,
 * facets, holes, regions, numbered from 0 or 1, with comments, attributes and markers.
 * A .smesh file is a .poly file whose facets are one polygon each. */
#ifndef TM_FORMAT_TETGEN_POLY_H
#define TM_FORMAT_TETGEN_POLY_H

#include "../base/text.h"
#include "../stream/stream.h"
#include "../surface/surface_file.h"

typedef enum tm_poly_kind { TM_POLY_NODE, TM_POLY_POLY, TM_POLY_SMESH } tm_poly_kind;

/* True where the text claims no nodes: they are in the .node file of the same name. */
bool tm_poly_lacks_nodes(const char *bytes, size_t size);

/* Of a numeric text, which of the three it looks like: TM_POLY_NODE where nothing
 * follows the nodes. O(size). */
tm_poly_kind tm_poly_kind_of(const char *bytes, size_t size);

/* *surface must be empty; after an error it is again. Where the text has no nodes those
 * that *surface holds already, from the .node file, are its nodes: it then need not be
 * empty. O(size). */
tm_status tm_poly_read(tm_polygon_surface *surface, tm_poly_kind kind, const char *bytes,
                       size_t size, const char *name, tm_error *error);

/* Appends the surface as a .poly file, numbered from surface->base. */
void tm_poly_write(tm_text *text, const tm_polygon_surface *surface);

/* Appends its nodes as a .node file. */
void tm_poly_write_nodes(tm_text *text, const tm_polygon_surface *surface);

#endif
