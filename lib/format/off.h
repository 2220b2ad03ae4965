/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OFF of Geomview, text: OFF, and with colours, normals or texture coordinates per
 * vertex COFF, NOFF, STOFF and their combinations. One vertex and one face a line;
 * colours and all else behind them are skipped, `#` begins a comment, the three counts
 * stand behind the keyword or on the next line (the number of edges may lack).
 * 4OFF, nOFF and OFF BINARY are refused. */
#ifndef TM_FORMAT_OFF_H
#define TM_FORMAT_OFF_H

#include "../surface/polygon_surface.h"

/* *surface must be empty; after an error it is again. O(size). */
tm_status tm_off_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);

/* Appends the boundary of a stream's main mesh to *text, as polygons that turn outward,
 * or all its facets, each once: outward for the first of its two cells. A surface is all
 * boundary. Only nodes that these polygons have are written, in their order.
 * TM_ERROR_INPUT as tm_cell_faces_find(), or where there are no cells and no surface.
 * Expected O(n). */
tm_status tm_off_write(tm_text *text, const tm_stream *stream, bool all, tm_error *error);

#endif
