/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polygon_list.h"

static void write(tm_text *text, const tm_polygon_list *list)
{
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
    tm_polygon_list list;
    tm_status status = tm_polygon_list_make(&list, stream, file->of, error);
    if (status == TM_OK) {
        write(text, &list);
        *written = (tm_surface_written){.polygons = list.polygons};
        status = text->failed ? tm_fail_memory(error) : TM_OK;
    }
    tm_polygon_list_free(&list);
    return status;
}
