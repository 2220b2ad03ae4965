/* SPDX-License-Identifier: GPL-3.0-or-later */
/* visf-import: a ViSF file as a stream. */
#include "common/input/mesh_input.h"

#include "../lib/base/file.h"
#include "../lib/format/visf.h"

#include <unistd.h>

static const struct option long_options[] = {FILTER_OPTIONS};

static size_t rows(const tm_stream *stream, const char *name)
{
    const tm_block *block = tm_stream_find(stream, name);
    return block ? block->count : 0;
}

static void note_repairs(const filter *f, const tm_visf_repairs *repairs)
{
    if (repairs->dropped > 0)
        filter_note(f, "%s: %zu polygons are of no polyhedron and left out",
                    filter_input_name(f), repairs->dropped);
    if (repairs->turned > 0)
        filter_note(f, "%s: %zu polygons of the boundary were inward and are turned",
                    filter_input_name(f), repairs->turned);
    filter_verbose(f, "%s: %zu polygons were there before and are joined",
                   filter_input_name(f), repairs->joined);
}

static void read_stream(const filter *f, tm_stream *stream)
{
    tm_text bytes = {0};
    tm_visf_repairs repairs;
    tm_error error;
    const char *name = filter_input_name(f);
    int fd = filter_open_input(f);
    if (tm_read_all(fd, name, &bytes, &error) != TM_OK)
        filter_fail(f, &error);
    if (f->input)
        close(fd);
    tm_stream_init(stream);
    if (tm_visf_read(stream, bytes.byte, bytes.size, name, &repairs, &error) != TM_OK)
        filter_fail(f, &error);
    tm_text_free(&bytes);
    note_repairs(f, &repairs);
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "visf-import",
        .synopsis = "[options] [FILE]",
        .purpose =
            "Reads a ViSF file, text or binary: points, a surface of triangles or\n"
            "polyhedra.",
        .help = "",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ;
    filter_operands(&f);

    tm_stream stream;
    read_stream(&f, &stream);
    const size_t nodes = rows(&stream, ".node"), faces = rows(&stream, ".face");
    const size_t facets = rows(&stream, ".facet"), cells = rows(&stream, ".cell");
    if (tm_stream_find(&stream, ".cell"))
        filter_write(&f, &stream, "%zu nodes, %zu facets, %zu polyhedra", nodes, facets,
                     cells);
    else if (tm_stream_find(&stream, ".face"))
        filter_write(&f, &stream, "%zu nodes, %zu triangles", nodes, faces);
    else
        filter_write(&f, &stream, "%zu nodes", nodes);
    mesh_input_report(&f, &stream);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
