/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polygon_list.h"

/* A backslash at the end of a name would join the next line to it. */
static void write_group(tm_text *text, tm_text *name)
{
    if (name->failed || name->size == 0)
        return;
    if (name->byte[name->size - 1] == '\\')
        tm_text_append(name, "_", 1);
    tm_text_format(text, "g %s\n", name->failed ? "" : name->byte);
}

static void write_polygon(tm_text *text, const tm_polygon_list *list, size_t p)
{
    const size_t k = tm_polygon_corners(list, p);
    tm_text_append(text, "f", 1);
    for (size_t i = 0; i < k; i++) {
        tm_text_append(text, " ", 1);
        tm_text_integer(text, (int64_t)list->number[list->room[i]] + 1);
    }
    tm_text_append(text, "\n", 1);
}

static void put(tm_text *text, tm_polygon_list *list, const tm_surface_file *file)
{
    tm_text name = {0};
    (void)file;
    tm_polygon_list_sort(list);
    for (size_t v = 0; v < list->nodes; v++)
        tm_polygon_point(list, v, "v ", text);
    for (size_t p = 0, end; p < list->polygons; p = end) {
        end = list->grouped ? tm_polygon_group_end(list, p) : list->polygons;
        if (list->grouped) {
            tm_polygon_name(list, list->polygon[p].value, &name);
            write_group(text, &name);
        }
        for (size_t i = p; i < end; i++)
            write_polygon(text, list, i);
    }
    text->failed |= name.failed;
    tm_text_free(&name);
}

tm_status tm_obj_write(tm_text *text, const tm_stream *stream,
                       const tm_surface_file *file, tm_surface_written *written,
                       tm_error *error)
{
    return tm_polygon_write(text, stream, file, written, put, error);
}
