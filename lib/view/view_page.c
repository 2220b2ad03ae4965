/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "view_parts.h"

#include "../base/version.h"
#include "../stream/group.h"
#include "view_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Text that stands between tags. */
static void append_escaped(tm_text *page, const char *bytes)
{
    tm_text clean = {0};
    tm_group_clean(&clean, bytes, strlen(bytes));
    for (size_t i = 0; i < clean.size; i++) {
        const char c = clean.byte[i];
        if (c == '<' || c == '>' || c == '&')
            tm_text_format(page, "&#%d;", c);
        else
            tm_text_append(page, &c, 1);
    }
    page->failed |= clean.failed;
    tm_text_free(&clean);
}

/* JSON in an element of the page, which "</script" would end. */
static void append_json(tm_text *page, const tm_text *json)
{
    page->failed |= json->failed;
    for (size_t from = 0; from < json->size && !page->failed;) {
        const char *at = memchr(json->byte + from, '<', json->size - from);
        const size_t size = at ? (size_t)(at - json->byte) - from : json->size - from;
        tm_text_append(page, json->byte + from, size);
        if (at)
            tm_text_string(page, "\\u003c");
        from += size + 1;
    }
}

/* The frame in which coordinates are: that of all nodes. */
static void find_frame(view_writer *w, const view_source *s, size_t meshes)
{
    double least[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    double most[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t m = 0; m < meshes; m++) {
        for (size_t i = 0; i < 3 * s[m].node->count; i++) {
            least[i % 3] = fmin(least[i % 3], s[m].node->real[i]);
            most[i % 3] = fmax(most[i % 3], s[m].node->real[i]);
        }
    }
    w->scale = 0;
    for (size_t i = 0; i < 3; i++) {
        w->centre[i] = least[i] / 2 + most[i] / 2;
        w->scale = fmax(w->scale, most[i] / 2 - least[i] / 2);
    }
    if (!(w->scale > 0))
        w->scale = 1;
}

static tm_status find_sources(view_source *s, tm_view_mesh *mesh, size_t meshes,
                              const tm_view_options *options, unsigned threads,
                              tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t m = 0; m < meshes && status == TM_OK; m++) {
        const tm_content content = tm_content_of(mesh[m].stream);
        if (content == TM_CONTENT_NOTHING)
            return tm_fail(error, TM_ERROR_INPUT, "has no nodes (.node)");
        s[m] = (view_source){.stream = mesh[m].stream,
                             .content = content,
                             .node = tm_stream_find(mesh[m].stream, ".node"),
                             .cell = tm_content_block(mesh[m].stream, content)};
        status = tm_view_keep(&s[m], options->most, threads, error);
        mesh[m].elements = s[m].cell->count;
        mesh[m].shown = s[m].kept;
    }
    return status;
}

/* The header and the arrays. */
static tm_status write_meshes(view_writer *w, const view_source *s,
                              const tm_view_mesh *mesh, size_t meshes,
                              const tm_view_options *options, tm_error *error)
{
    tm_status status = TM_OK;
    tm_json_open(&w->json, NULL, '{');
    tm_json_string(&w->json, "version", TM_VERSION);
    tm_view_string(&w->json, "title", options->title);
    tm_json_open(&w->json, "centre", '[');
    for (size_t i = 0; i < 3; i++)
        tm_json_double(&w->json, NULL, w->centre[i]);
    tm_json_close(&w->json, ']');
    tm_json_double(&w->json, "scale", w->scale);
    tm_json_open(&w->json, "meshes", '[');
    for (size_t m = 0; m < meshes && status == TM_OK; m++)
        status = tm_view_put_mesh(w, &s[m], mesh[m].name, error);
    tm_json_close(&w->json, ']');
    tm_json_close(&w->json, '}');
    return status;
}

static void write_page(tm_text *page, const tm_text *header, const tm_text *data,
                       const tm_view_options *options)
{
    tm_text_string(page, view_before_title);
    append_escaped(page, options->title);
    tm_text_string(page, view_before_header);
    append_json(page, header);
    tm_text_string(page, view_before_arrays);
    page->failed |= data->failed;
    if (data->byte)
        tm_text_append(page, data->byte, data->size);
    tm_text_string(page, view_after_arrays);
}

tm_status tm_view_write(tm_text *page, tm_view_mesh *mesh, size_t meshes,
                        const tm_view_options *options, unsigned threads, tm_error *error)
{
    tm_text header = {0}, data = {0};
    view_writer w = {.json = {.text = &header}, .data = &data, .threads = threads};
    view_source s[TM_VIEW_MESHES] = {0};
    tm_status status = find_sources(s, mesh, meshes, options, threads, error);
    if (status == TM_OK) {
        find_frame(&w, s, meshes);
        status = write_meshes(&w, s, mesh, meshes, options, error);
    }
    if (status == TM_OK)
        write_page(page, &header, &data, options);
    for (size_t m = 0; m < meshes; m++) {
        free(s[m].number);
        free(s[m].outer);
    }
    tm_text_free(&header);
    tm_text_free(&data);
    return status == TM_OK && page->failed ? tm_fail_memory(error) : status;
}
