/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_trace_files.h"

#include "../../../lib/examine/jens_statistics.h"
#include "../../../lib/format/mesh_format.h"
#include "../../../lib/format/oct.h"
#include "../../../lib/format/vtk/vtk.h"
#include "../../../lib/octree/repair/repair_trace.h"
#include "../app/output_files.h"
#include "../input/mesh_input.h"

typedef struct {
    const repair_trace *to;
    const tm_stream *stream;
} writer;

/* Writes the text as BASE_i.SUFFIX and frees it. */
static tm_status put(const writer *w, const char *suffix, tm_text *text, tm_error *error)
{
    tm_text name = {0};
    tm_text_format(&name, "%s_%u.%s", w->to->base, w->to->iteration, suffix);
    tm_status status = name.failed || text->failed
                           ? tm_fail_memory(error)
                           : output_file_write(name.byte, text, error);
    tm_text_free(&name);
    tm_text_free(text);
    return status;
}

static tm_status write_histogram(const writer *w, tm_error *error)
{
    const tm_block *node = tm_stream_find(w->stream, ".node");
    const tm_block *mix = tm_stream_find(w->stream, ".mix");
    const tm_elements elements = {(const double(*)[3])node->real, mix->count, mix->start,
                                  mix->item};
    const tm_jens_request request = {.threads = w->to->threads};
    tm_jens_statistics statistics = {0};
    tm_text text = {0};
    const tm_status status =
        tm_jens_statistics_measure(&statistics, &elements, &request, error);
    if (status != TM_OK)
        return status;
    tm_jens_histogram_file(&text, &statistics.jens);
    return put(w, "histo", &text, error);
}

static tm_status write_octants(const writer *w, const uint32_t *id,
                               const uint32_t *octant, size_t count, tm_error *error)
{
    tm_text text = {0};
    for (size_t i = 0; i < count; i++)
        tm_text_format(&text, "%u\n", id ? id[octant[i]] : octant[i]);
    return put(w, "ref", &text, error);
}

static tm_status write_mesh(const writer *w, const char *suffix, mesh_writer *write,
                            tm_error *error)
{
    tm_text text = {0};
    const tm_status status = write(&text, w->stream, w->to->threads, error);
    if (status == TM_OK)
        return put(w, suffix, &text, error);
    tm_text_free(&text);
    return status;
}

/* With the ids by which .ref names octants. */
static tm_status write_oct(tm_text *text, const tm_stream *stream, unsigned threads,
                           tm_error *error)
{
    return tm_oct_write(text, stream, true, threads, error);
}

/* Of the elements nothing but their shape. */
static tm_status write_vtk(tm_text *text, const tm_stream *stream, unsigned threads,
                           tm_error *error)
{
    const tm_vtk_options elements = {.boundary = false};
    return tm_vtk_write(text, stream, &elements, threads, error);
}

tm_status repair_trace_write(const repair_trace *to, const tm_repair_state *state,
                             const tm_surface *surface, const uint32_t *octant,
                             size_t count, tm_error *error)
{
    tm_stream stream;
    tm_stream_init(&stream);
    const writer w = {to, &stream};
    tm_status status = tm_repair_trace(state, surface, &stream, error);
    if (status == TM_OK)
        status = write_histogram(&w, error);
    if (status == TM_OK && count > 0)
        status = write_octants(&w, state->id, octant, count, error);
    if (status == TM_OK)
        status = write_mesh(&w, "m3d", tm_m3d_write, error);
    if (status == TM_OK)
        status = write_mesh(&w, "vtk", write_vtk, error);
    if (status == TM_OK && state->octree.leaves > 0)
        status = write_mesh(&w, "oct", write_oct, error);
    tm_stream_free(&stream);
    return status;
}
