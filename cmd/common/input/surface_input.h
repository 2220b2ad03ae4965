/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A filter's input where that is a surface: a foreign file of any format that is read,
 * or the part `surface` of a stream, or a stream whose main mesh is a surface. */
#ifndef CMD_COMMON_SURFACE_INPUT_H
#define CMD_COMMON_SURFACE_INPUT_H

#include "../../../lib/format/surface/surface_format.h"
#include "../../../lib/surface/surface.h"
#include "../app/filter.h"

/* Reads FILE or standard input; exits on failure. Of a stream, its blocks and history
 * are in *stream, and surface.node and surface.face in *surface as well; where it has
 * none of them and is .node and .face alone, these have become they. Else *stream is
 * empty. The nodes of a .poly or .smesh file may be in the .node file beside it. Of
 * a stream with elements that the filter takes, but no surface, *surface stays empty. */
tm_format surface_input_read(const filter *f, tm_polygon_surface *surface,
                             tm_stream *stream);

/* The same where any mesh is taken, too. */
tm_format surface_input_read_any(const filter *f, tm_polygon_surface *surface,
                                 tm_stream *stream);

/* Whether a block of the stream is of the surface, or edges without a marker, which
 * nobody misses. */
bool surface_input_takes(const tm_stream *stream, const tm_block *block);

/* Says by filter_leave_out() which blocks are neither. */
void surface_input_leave_out_blocks(const filter *f, const tm_stream *stream);

/* Reads it and makes a closed surface of it, with a note about what had to be mended;
 * exits on failure. Of a stream, *history gets its history; history may be NULL. */
void surface_input_build(const filter *f, const tm_surface_options *options,
                         tm_surface *surface, tm_stream *history);

/* Adds what helps to the error of tm_surface_build(), if that takes the surface as it is
 * with options.lenient. */
void surface_input_add_help(tm_error *error, const tm_polygon_surface *polygons,
                            const tm_surface_options *options, const char *help);

/* Copies nodes and triangles of blocks, which are numbered from base, to *surface, which
 * is initialised; face may be NULL. */
tm_status surface_input_of_blocks(const tm_block *node, const tm_block *face,
                                  unsigned base, tm_polygon_surface *surface,
                                  tm_error *error);

/* Copies surface.node and surface.face of a stream to *surface, which is initialised.
 * TM_ERROR_INPUT where there is no surface.node. */
tm_status surface_input_of_stream(const tm_stream *stream, const char *name,
                                  tm_polygon_surface *surface, tm_error *error);

#endif
