/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The input of an exporter: a stream with a mesh of any content. */
#ifndef CMD_COMMON_MESH_INPUT_H
#define CMD_COMMON_MESH_INPUT_H

#include "../../../lib/mesh/cell_faces.h"
#include "../app/filter.h"

/* Reads the stream from FILE or standard input and says what it holds, which is at least
 * points. Tetrahedra of .ele that are left-handed are turned, with a note; where there
 * are other elements instead, they are not looked at. Exits on failure. */
tm_content mesh_input_read(const filter *f, tm_stream *stream);

/* filter_fail() with the input's name, for errors that have none. */
_Noreturn void mesh_input_fail(const filter *f, tm_error *error);

/* Writes what a stream holds to where --json says, if it does: its nodes, and its
 * triangles, tetrahedra, elements or polyhedra. */
void mesh_input_report(filter *f, const tm_stream *stream);

/* Writes a stream in a foreign format to the end of a text. */
typedef tm_status mesh_writer(tm_text *text, const tm_stream *stream, unsigned threads,
                              tm_error *error);

/* All of main() of an exporter that has no options of its own. */
int mesh_export(int argc, char **argv, const char *name, const char *purpose,
                mesh_writer *write);

#endif
