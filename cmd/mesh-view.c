/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh-view: one page of HTML that shows a mesh, or two. */
#include "common/input/left_out.h"
#include "common/input/mesh_input.h"

#include "../lib/view/view.h"

#include <limits.h>
#include <string.h>

enum { OPTION_TITLE = FILTER_OWN, OPTION_MOST };

static const struct option long_options[] = {
    {"title", required_argument, NULL, OPTION_TITLE},
    {"most", required_argument, NULL, OPTION_MOST},
    FILTER_OPTIONS};

typedef struct options {
    tm_view_options page;
    size_t meshes;
    const char *second; /* NULL: standard input, where there are two meshes */
} options;

static void read_options(filter *f, options *o)
{
    int c;
    while ((c = filter_option(f)) != -1) {
        if (c == OPTION_TITLE)
            o->page.title = optarg;
        else
            o->page.most = (size_t)filter_integer(f, "--most", optarg, 0, LONG_MAX);
    }
    if (f->argc - optind > TM_VIEW_MESHES)
        filter_usage_error(f, "two files at most, but there is also '%s'",
                           f->argv[optind + TM_VIEW_MESHES]);
    o->meshes = f->argc - optind == TM_VIEW_MESHES ? TM_VIEW_MESHES : 1;
    if (o->meshes == TM_VIEW_MESHES)
        o->second = f->argv[--f->argc];
    filter_operands(f);
    filter_no_picture(f, f->output, "a page, whose button Save PNG makes a picture");
    if (o->second && strcmp(o->second, "-") == 0)
        o->second = NULL;
    if (o->meshes == TM_VIEW_MESHES && !o->second && !f->input)
        filter_usage_error(f, "only one of the two files can be standard input");
}

/* The file without its folders; of standard input what the last line of the stream's
 * history says of the filter before this one, up to what that counted. */
static void name_mesh(const filter *f, const tm_stream *stream, tm_text *name)
{
    const tm_text *history = &stream->history;
    const char *slash = f->input ? strrchr(f->input, '/') : NULL;
    size_t from = history->size, to;
    if (f->input || from == 0) {
        tm_text_string(name, f->input ? (slash && slash[1] ? slash + 1 : f->input)
                                      : "standard input");
        return;
    }
    for (from--; from > 0 && history->byte[from - 1] != '\n'; from--)
        ;
    while (strchr("# ", history->byte[from]) && from + 1 < history->size)
        from++;
    for (to = from; to < history->size && history->byte[to] != '\n'; to++)
        if (strncmp(history->byte + to, ": ", 2) == 0)
            break;
    tm_text_append(name, history->byte + from, to - from);
}

static void read_mesh(const filter *f, tm_stream *stream, tm_text *name,
                      tm_view_mesh *mesh)
{
    mesh_input_read_to_compute(f, stream);
    name_mesh(f, stream, name);
    if (name->failed)
        filter_fail_memory(f);
    *mesh = (tm_view_mesh){.stream = stream, .name = name->byte};
}

static void say_what_is_missing(const filter *f, const tm_view_mesh *mesh)
{
    if (mesh->shown < mesh->elements)
        filter_leave_out(f,
                         "%zu of %zu elements, neither at the boundary nor the worst "
                         "(--most)",
                         mesh->elements - mesh->shown, mesh->elements);
    mesh_leave_out(f, mesh->stream);
}

static void write_json(filter *f, const tm_view_mesh *mesh, size_t meshes)
{
    if (!f->json)
        return;
    tm_json *json = filter_json_begin(f);
    tm_json_open(json, "meshes", '[');
    for (size_t m = 0; m < meshes; m++) {
        tm_json_open(json, NULL, '{');
        tm_json_integer(json, "nodes", (int64_t)mesh_rows(mesh[m].stream, ".node"));
        tm_json_integer(json, "elements", (int64_t)mesh[m].elements);
        tm_json_integer(json, "shown", (int64_t)mesh[m].shown);
        tm_json_close(json, '}');
    }
    tm_json_close(json, ']');
    filter_json_end(f);
}

int main(int argc, char **argv)
{
    const size_t most = 3000000;
    filter f = {
        .name = "mesh-view",
        .synopsis = "[--most N] [--title T] [FILE [FILE2]]",
        .purpose =
            "Writes a page of HTML that shows points, a surface, tetrahedra, mixed\n"
            "elements or polyhedra in a browser: inside and out, by quality, kinds,\n"
            "names; of two meshes both. Nothing else is needed, and no network.",
        .help =
            "      --most N        above N elements only those at the boundary and the\n"
            "                      worst hundredth are in the page (3000000)\n"
            "      --title T       what is above the page instead of the file's name\n",
        .options = long_options,
        .letters = FILTER_LETTERS,
        .binary = true,
    };
    options o = {.page = {.most = most}};
    filter_start(&f, argc, argv);
    read_options(&f, &o);
    filter of_second = f;
    of_second.input = o.second;
    tm_stream stream[TM_VIEW_MESHES];
    tm_view_mesh mesh[TM_VIEW_MESHES];
    tm_text name[TM_VIEW_MESHES] = {0};
    read_mesh(&f, &stream[0], &name[0], &mesh[0]);
    if (o.meshes == TM_VIEW_MESHES)
        read_mesh(&of_second, &stream[1], &name[1], &mesh[1]);
    if (!o.page.title)
        o.page.title = name[0].byte;
    if (o.meshes == 1)
        mesh[0].name = o.page.title;
    tm_text page = {0};
    tm_error error;
    filter_stage(&f, "packing");
    if (tm_view_write(&page, mesh, o.meshes, &o.page, f.threads, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    say_what_is_missing(&f, &mesh[0]);
    if (o.meshes == TM_VIEW_MESHES)
        say_what_is_missing(&of_second, &mesh[1]);
    write_json(&f, mesh, o.meshes);
    filter_write_text(&f, &page);
    tm_text_free(&page);
    for (size_t m = 0; m < o.meshes; m++) {
        tm_stream_free(&stream[m]);
        tm_text_free(&name[m]);
    }
    return filter_finish(&f, 0);
}
