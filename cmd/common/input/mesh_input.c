/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_input.h"

#include "../../../lib/base/json.h"
#include "../../../lib/format/tetgen_orient.h"

#include <stdio.h>

void mesh_input_fail(const filter *f, tm_error *error)
{
    if (error->status == TM_ERROR_INPUT && !error->file[0])
        snprintf(error->file, sizeof error->file, "%s", filter_input_name(f));
    filter_fail(f, error);
}

tm_content mesh_input_read(const filter *f, tm_stream *stream)
{
    tm_error error;
    filter_read(f, stream);
    const tm_content content = tm_content_of(stream);
    if (content == TM_CONTENT_NOTHING) {
        tm_fail(&error, TM_ERROR_INPUT, "has no nodes (.node)");
        mesh_input_fail(f, &error);
    }
    if (content == TM_CONTENT_TETRAHEDRA) {
        tm_block *ele = tm_content_block(stream, content);
        const tm_turned turned = tm_tetgen_orient(tm_stream_find(stream, ".node"), ele);
        if (turned.turned > 0)
            filter_note(f, "%s: %zu of %zu tetrahedra were left-handed and are turned",
                        filter_input_name(f), turned.turned, ele->count);
    }
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
    const tm_block *node = tm_stream_find(stream, ".node");
    tm_text text = {0};
    tm_json json = {.text = &text};
    tm_json_open(&json, NULL, '{');
    tm_json_integer(&json, "nodes", node ? (int64_t)node->count : 0);
    if (content > TM_CONTENT_POINTS)
        tm_json_integer(&json, key[content],
                        (int64_t)tm_content_block(stream, content)->count);
    tm_json_close(&json, '}');
    tm_text_string(&text, "\n");
    filter_write_json(f, &text);
    tm_text_free(&text);
}

int mesh_export(int argc, char **argv, const char *name, const char *purpose,
                mesh_writer *write)
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

    tm_stream stream;
    tm_text text = {0};
    tm_error error;
    mesh_input_read(&f, &stream);
    if (write(&text, &stream, f.threads, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    filter_write_text(&f, &text);
    mesh_input_report(&f, &stream);
    tm_text_free(&text);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
