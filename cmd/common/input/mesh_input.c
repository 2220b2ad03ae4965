/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_input.h"

#include "../../../lib/format/tetgen.h"
#include "../../../lib/stream/coordinates.h"
#include "left_out.h"

#include <stdio.h>

void mesh_input_fail(const filter *f, tm_error *error)
{
    if (error->status == TM_ERROR_INPUT && !error->file[0])
        snprintf(error->file, sizeof error->file, "%s", filter_input_name(f));
    filter_fail(f, error);
}

void mesh_input_turn(const filter *f, const tm_stream *stream, tm_block *ele,
                     const char *what)
{
    const tm_turned turned = tm_tetgen_orient(tm_stream_find(stream, ".node"), ele);
    mesh_note_turned(f, turned.turned, ele->count, what);
}

void mesh_note_turned(const filter *f, size_t turned, size_t of, const char *what)
{
    if (turned > 0)
        filter_note(f, "%s: %zu of %zu tetrahedra were left-handed and %s",
                    filter_input_name(f), turned, of, what);
}

size_t mesh_rows(const tm_stream *stream, const char *name)
{
    const tm_block *block = tm_stream_find(stream, name);
    return block ? block->count : 0;
}

void mesh_input_read_to_compute(const filter *f, tm_stream *stream)
{
    tm_error error;
    filter_read(f, stream);
    if (tm_stream_check_coordinates(stream, &error) != TM_OK)
        mesh_input_fail(f, &error);
}

tm_content mesh_input_read(const filter *f, tm_stream *stream)
{
    filter_read(f, stream);
    const tm_content content = tm_content_of(stream);
    if (content == TM_CONTENT_TETRAHEDRA)
        mesh_input_turn(f, stream, tm_content_block(stream, content), "are turned");
    return content;
}

void mesh_input_report(filter *f, const tm_stream *stream)
{
    static const char *const key[] = {[TM_CONTENT_SURFACE] = "triangles",
                                      [TM_CONTENT_TETRAHEDRA] = "tetrahedra",
                                      [TM_CONTENT_MIXED] = "elements",
                                      [TM_CONTENT_POLYHEDRA] = "polyhedra"};
    if (!f->json)
        return;
    const tm_content content = tm_content_of(stream);
    tm_json *json = filter_json_begin(f);
    tm_json_integer(json, "nodes", (int64_t)mesh_rows(stream, ".node"));
    if (content > TM_CONTENT_POINTS)
        tm_json_integer(json, key[content],
                        (int64_t)tm_content_block(stream, content)->count);
    filter_json_end(f);
}

void mesh_rows_json(tm_json *json, const tm_stream *stream)
{
    static const char *const row[][2] = {
        {"nodes", ".node"}, {"tets", ".ele"}, {"faces", ".face"}, {"edges", ".edge"}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        tm_json_integer(json, row[i][0], (int64_t)mesh_rows(stream, row[i][1]));
}

int mesh_write(filter *f, mesh_writer *write)
{
    tm_stream stream;
    tm_text text = {0};
    tm_error error;
    mesh_input_read(f, &stream);
    filter_stage(f, "formatting");
    if (write(&text, &stream, f->threads, &error) != TM_OK)
        mesh_input_fail(f, &error);
    mesh_leave_out(f, &stream);
    mesh_input_report(f, &stream);
    filter_write_text(f, &text);
    tm_text_free(&text);
    tm_stream_free(&stream);
    return filter_finish(f, 0);
}

/* A filter with the shared options alone, up to its operands. */
static filter start(int argc, char **argv, const char *name, const char *purpose)
{
    static const struct option long_options[] = {FILTER_OPTIONS};
    filter f = {.name = name,
                .synopsis = "[options] [FILE]",
                .purpose = purpose,
                .help = "",
                .options = long_options,
                .letters = FILTER_LETTERS};
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ;
    filter_operands(&f);
    return f;
}

int mesh_export(int argc, char **argv, const char *name, const char *purpose,
                mesh_writer *write)
{
    filter f = start(argc, argv, name, purpose);
    return mesh_write(&f, write);
}

static void write_imported(filter *f, tm_stream *stream)
{
    const size_t nodes = mesh_rows(stream, ".node");
    if (tm_stream_find(stream, ".cell"))
        filter_write(f, stream, "%zu nodes, %zu facets, %zu polyhedra", nodes,
                     mesh_rows(stream, ".facet"), mesh_rows(stream, ".cell"));
    else if (tm_stream_find(stream, ".mix"))
        filter_write(f, stream, "%zu nodes, %zu elements", nodes,
                     mesh_rows(stream, ".mix"));
    else if (tm_stream_find(stream, ".ele"))
        filter_write(f, stream, "%zu nodes, %zu tetrahedra", nodes,
                     mesh_rows(stream, ".ele"));
    else if (tm_stream_find(stream, ".face"))
        filter_write(f, stream, "%zu nodes, %zu triangles", nodes,
                     mesh_rows(stream, ".face"));
    else
        filter_write(f, stream, "%zu nodes", nodes);
}

int mesh_write_stream(filter *f, tm_stream *stream)
{
    mesh_input_report(f, stream);
    write_imported(f, stream);
    tm_stream_free(stream);
    return filter_finish(f, 0);
}

void mesh_note_count(const filter *f, size_t count, const char *what)
{
    if (count > 0)
        filter_note(f, "%s: %zu %s", filter_input_name(f), count, what);
}

void mesh_leave_out_materials(const filter *f, size_t count)
{
    if (count > 0)
        filter_leave_out(f,
                         "the constants of the material of %zu elements, which are "
                         "others than 1000.0 0.45 1.0",
                         count);
}

void mesh_leave_out_count(const filter *f, size_t count, const char *what)
{
    if (count > 0)
        filter_leave_out(f, "%zu %s", count, what);
}

void mesh_leave_out_middles(const filter *f, size_t nodes, size_t elements)
{
    if (elements > 0)
        filter_leave_out(
            f,
            "%zu nodes of %zu elements of second order, of which the corners "
            "are taken",
            nodes, elements);
}

int mesh_read(filter *f, mesh_reader *read)
{
    tm_stream stream;
    tm_text bytes = {0};
    tm_error error;
    tm_stream_init(&stream);
    filter_read_bytes(f, &bytes);
    if (read(f, &stream, &bytes, &error) != TM_OK)
        filter_fail_file(f, &error, &bytes, f->name);
    tm_text_free(&bytes);
    return mesh_write_stream(f, &stream);
}

int mesh_import(int argc, char **argv, const char *name, const char *purpose,
                mesh_reader *read)
{
    filter f = start(argc, argv, name, purpose);
    return mesh_read(&f, read);
}
