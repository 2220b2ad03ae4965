/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh-check: what is wrong with a mesh, as exit status and as a list. */
#include "common/filter.h"

#include "../lib/poly/poly_examine.h"
#include "../lib/tet/examine.h"

#include <string.h>

static const struct option long_options[] = {FILTER_OPTIONS};

/* Elements that are not examined: an error where they are all that there is. */
static void refuse_other_elements(const filter *f, const tm_stream *stream)
{
    const bool tetrahedra = tm_stream_find(stream, ".ele");
    const bool polyhedra = tm_stream_find(stream, ".cell");
    if (tetrahedra && polyhedra)
        filter_note(f, "%s: .cell is not examined, only .ele", filter_input_name(f));
    if (!tm_stream_find(stream, ".mix"))
        return;
    if (tetrahedra || polyhedra) {
        filter_note(f, "%s: .mix is not examined, only %s", filter_input_name(f),
                    tetrahedra ? ".ele" : ".cell");
        return;
    }
    tm_error error;
    tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, ".mix",
               "mesh-check reads tetrahedra (.ele) or polyhedra (.cell)");
    filter_fail(f, &error);
}

static tm_tet_arrays arrays_of(const tm_stream *stream)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *ele = tm_stream_find(stream, ".ele");
    const tm_block *face = tm_stream_find(stream, ".face");
    const tm_block *edge = tm_stream_find(stream, ".edge");
    tm_tet_arrays mesh = {0};
    if (node) {
        mesh.nodes = node->count;
        mesh.xyz = (const double(*)[3])node->real;
    }
    if (ele) {
        mesh.tets = ele->count;
        mesh.tet = (const uint32_t(*)[4])ele->integer;
    }
    if (face) {
        mesh.faces = face->count;
        mesh.face = (const uint32_t(*)[3])face->integer;
    }
    if (edge) {
        mesh.edges = edge->count;
        mesh.edge = (const uint32_t(*)[2])edge->integer;
    }
    return mesh;
}

static void examine(const filter *f, const tm_stream *stream, tm_examination *found)
{
    tm_error error;
    tm_status status;
    if (tm_stream_find(stream, ".cell") && !tm_stream_find(stream, ".ele")) {
        const tm_poly_arrays mesh = tm_poly_arrays_of(stream);
        status = tm_poly_examine(found, &mesh, f->threads, &error);
    } else {
        const tm_tet_arrays mesh = arrays_of(stream);
        status = tm_tet_examine(found, &mesh, f->threads, &error);
    }
    if (status != TM_OK)
        filter_fail(f, &error);
}

/* Nothing where standard output is for the JSON, or is to be quiet. */
static void write_report(filter *f, const tm_examination *found, unsigned base)
{
    const bool json_instead = f->json && strcmp(f->json, "-") == 0;
    if (!f->output && (json_instead || f->verbosity < 0))
        return;
    tm_text text = {0};
    tm_examination_text(&text, found, base);
    filter_write_text(f, &text);
    tm_text_free(&text);
}

static void write_json(filter *f, const tm_examination *found)
{
    tm_text text = {0};
    tm_json json = {.text = &text};
    tm_json_open(&json, NULL, '{');
    tm_examination_json(&json, found);
    tm_json_close(&json, '}');
    tm_text_string(&text, "\n");
    filter_write_json(f, &text);
    tm_text_free(&text);
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "mesh-check",
        .synopsis = "[FILE]",
        .purpose =
            "Says what is wrong with a mesh of tetrahedra or polyhedra: inverted,\n"
            "flat and overlapping ones, polyhedra that are not closed, a boundary\n"
            "that is not closed or not manifold, duplicate nodes. Exit status 1 if\n"
            "anything is.",
        .help = "",
        .options = long_options,
        .letters = FILTER_LETTERS,
        .json_is_output = true,
    };
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ;
    filter_operands(&f);

    tm_stream stream;
    filter_read(&f, &stream);
    refuse_other_elements(&f, &stream);
    tm_examination found;
    examine(&f, &stream, &found);
    write_report(&f, &found, stream.base);
    if (f.json)
        write_json(&f, &found);
    tm_stream_free(&stream);
    return filter_finish(&f, tm_examination_is_good(&found) ? 0 : EXIT_GOAL);
}
