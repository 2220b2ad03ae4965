/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What exporters, importers and the *-stats do alike: meshes of any content in, and
 * foreign files out and in. */
#ifndef CMD_COMMON_MESH_INPUT_H
#define CMD_COMMON_MESH_INPUT_H

#include "../../../lib/mesh/cell_faces.h"
#include "../app/filter.h"

/* Reads the stream from FILE or standard input and says what it holds. Tetrahedra of .ele
 * that are left-handed are turned, with a note; where there are other elements instead,
 * they are not looked at. Exits on failure. */
tm_content mesh_input_read(const filter *f, tm_stream *stream);

/* What measures a mesh reads it so: coordinates that are too large or too small to
 * compute with (lib/stream/coordinates.h) are refused, too. */
void mesh_input_read_to_compute(const filter *f, tm_stream *stream);

/* Turns the left-handed tetrahedra of .ele, with a note: "… were left-handed and WHAT".
 */
void mesh_input_turn(const filter *f, const tm_stream *stream, tm_block *ele,
                     const char *what);

/* The note alone, of so many of so many. */
void mesh_note_turned(const filter *f, size_t turned, size_t of, const char *what);

/* filter_fail() with the input's name, for errors that have none. */
_Noreturn void mesh_input_fail(const filter *f, tm_error *error);

/* The rows of a block; 0 where there is none. */
size_t mesh_rows(const tm_stream *stream, const char *name);

/* Writes what a stream holds to where --json says, if it does: its nodes, and its
 * triangles, tetrahedra, elements or polyhedra. */
void mesh_input_report(filter *f, const tm_stream *stream);

/* Adds the rows of .node, .ele, .face and .edge to an object: nodes tets faces edges. */
void mesh_rows_json(tm_json *json, const tm_stream *stream);

/* Writes a stream in a foreign format to the end of a text. */
typedef tm_status mesh_writer(tm_text *text, const tm_stream *stream, unsigned threads,
                              tm_error *error);

/* What an exporter does after its options: reads, says what it leaves out, writes,
 * reports. For main() to return. */
int mesh_write(filter *f, mesh_writer *write);

/* Reads a foreign file into an empty stream, with notes about what it had to do. */
typedef tm_status mesh_reader(const filter *f, tm_stream *stream, const tm_text *bytes,
                              tm_error *error);

/* Notes of a reader: so many of something, nothing where there are none; and elements of
 * second order that are taken by their corners. */
void mesh_note_count(const filter *f, size_t count, const char *what);
void mesh_leave_out_count(const filter *f, size_t count, const char *what);
void mesh_leave_out_middles(const filter *f, size_t nodes, size_t elements);

/* Says by filter_leave_out() of how many elements of an .m3d file the constants of the
 * material are others than the usual ones. */
void mesh_leave_out_materials(const filter *f, size_t count);

/* What an importer does after its options: reads, reports, writes. */
int mesh_read(filter *f, mesh_reader *read);

/* The end of that: reports, writes the stream and frees it. For main() to return. */
int mesh_write_stream(filter *f, tm_stream *stream);

/* All of main() of an exporter or an importer that has no options of its own. */
int mesh_export(int argc, char **argv, const char *name, const char *purpose,
                mesh_writer *write);
int mesh_import(int argc, char **argv, const char *name, const char *purpose,
                mesh_reader *read);

#endif
