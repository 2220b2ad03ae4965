/* SPDX-License-Identifier: GPL-3.0-or-later */
/* TetGen's .poly and .smesh files, and .node files as surfaces of points alone: nodes,
 * facets, holes, regions, numbered from 0 or 1, with comments, attributes and markers.
 * A .smesh file is a .poly file whose facets are one polygon each. */
#ifndef TM_FORMAT_TETGEN_POLY_H
#define TM_FORMAT_TETGEN_POLY_H

#include "../base/text.h"
#include "../stream/stream.h"
#include "../surface/polygon_surface.h"

typedef enum tm_plc_kind { TM_PLC_NODE, TM_PLC_POLY, TM_PLC_SMESH } tm_plc_kind;

/* True where the text claims no nodes: they are in the .node file of the same name. */
bool tm_plc_lacks_nodes(const char *bytes, size_t size);

/* Of a numeric text, which of the three it looks like: TM_PLC_NODE where nothing
 * follows the nodes. O(size). */
tm_plc_kind tm_plc_kind_of(const char *bytes, size_t size);

/* *surface must be empty; after an error it is again. Where the text has no nodes those
 * that *surface holds already, from the .node file, are its nodes: it then need not be
 * empty. O(size). */
tm_status tm_plc_read(tm_polygon_surface *surface, tm_plc_kind kind, const char *bytes,
                      size_t size, const char *name, tm_error *error);

/* Appends the surface as a .poly file, numbered from surface->base. */
void tm_plc_write(tm_text *text, const tm_polygon_surface *surface);

/* Appends its nodes as a .node file. */
void tm_plc_write_nodes(tm_text *text, const tm_polygon_surface *surface);

#endif
