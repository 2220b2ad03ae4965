/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_files.h"

#include "../../lib/format/m3d.h"
#include "../../lib/format/oct.h"
#include "../../lib/format/vtk_legacy.h"
#include "../../lib/octree/repair_trace.h"
#include "../../lib/quality/jens_statistics.h"
#include "output_files.h"

#include <stdio.h>

typedef struct {
    const char *base;
    unsigned iteration, threads;
    const tm_stream *stream;
} writer;

/* Writes the text as BASE_i.SUFFIX and frees it. */
static tm_status put(const writer *w, const char *suffix, tm_text *text, tm_error *error)
{
    tm_text name = {0};
    tm_text_format(&name, "%s_%u.%s", w->base, w->iteration, suffix);
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
    const tm_jens_request request = {.threads = w->threads};
    tm_jens_statistics statistics = {0};
    tm_text text = {0};
    const tm_status status =
        tm_jens_statistics_measure(&statistics, &elements, &request, error);
    if (status != TM_OK)
        return status;
    tm_jens_histogram_file(&text, &statistics.jens);
    return put(w, "histo", &text, error);
}

static tm_status write_octants(const writer *w, const uint32_t *octant, size_t count,
                               tm_error *error)
{
    tm_text text = {0};
    for (size_t i = 0; i < count; i++)
        tm_text_format(&text, "%u\n", octant[i]);
    return put(w, "ref", &text, error);
}

static tm_status write_m3d(const writer *w, tm_error *error)
{
    tm_text text = {0};
    const tm_status status = tm_m3d_write(&text, w->stream, TM_M3D, w->threads, error);
    if (status == TM_OK)
        return put(w, "m3d", &text, error);
    tm_text_free(&text);
    return status;
}

static tm_status write_vtk(const writer *w, tm_error *error)
{
    tm_text text = {0};
    const tm_status status = tm_vtk_write(&text, w->stream, w->threads, error);
    if (status == TM_OK)
        return put(w, "vtk", &text, error);
    tm_text_free(&text);
    return status;
}

static tm_status write_oct(const writer *w, tm_error *error)
{
    tm_text text = {0};
    const tm_status status = tm_oct_write(&text, w->stream, w->threads, error);
    if (status == TM_OK)
        return put(w, "oct", &text, error);
    tm_text_free(&text);
    return status;
}

tm_status repair_files_write(const char *base, unsigned iteration,
                             const tm_repair_state *state, const tm_surface *surface,
                             const uint32_t *octant, size_t count, unsigned threads,
                             tm_error *error)
{
    tm_stream stream;
    tm_stream_init(&stream);
    const writer w = {base, iteration, threads, &stream};
    tm_status status = tm_repair_trace(state, surface, &stream, error);
    if (status == TM_OK)
        status = write_histogram(&w, error);
    if (status == TM_OK && count > 0)
        status = write_octants(&w, octant, count, error);
    if (status == TM_OK)
        status = write_m3d(&w, error);
    if (status == TM_OK)
        status = write_vtk(&w, error);
    if (status == TM_OK && state->octree.leaves > 0)
        status = write_oct(&w, error);
    tm_stream_free(&stream);
    return status;
}
