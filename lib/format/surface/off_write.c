/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polygon_list.h"

static void put(tm_text *text, tm_polygon_list *list, const tm_surface_file *file)
{
    (void)file;
    tm_text_format(text, "OFF\n%zu %zu 0\n", list->nodes, list->polygons);
    for (size_t v = 0; v < list->nodes; v++)
        tm_polygon_point(list, v, "", text);
    for (size_t p = 0; p < list->polygons; p++) {
        tm_polygon_row(list, p, text);
        tm_text_append(text, "\n", 1);
    }
}

tm_status tm_off_write(tm_text *text, const tm_stream *stream,
                       const tm_surface_file *file, tm_surface_written *written,
                       tm_error *error)
{
    return tm_polygon_write(text, stream, file, written, put, error);
}
