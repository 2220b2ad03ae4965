/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polygon_list.h"

#include "../../base/version.h"
#include "../binary.h"

enum { COORDINATES = 3 };

/* With how many bytes the number of corners is written. */
static size_t length_size(const tm_polygon_list *list)
{
    return list->corners <= UINT8_MAX ? 1 : sizeof(uint32_t);
}

static const char *property_of(const tm_polygon_list *list)
{
    return list->dimension == TM_GROUP_REGIONS ? "region" : "marker";
}

static void write_names(tm_text *text, const tm_polygon_list *list)
{
    const tm_block *group = tm_stream_find(list->stream, ".group");
    for (size_t g = 0; group && list->grouped && g < group->count; g++)
        if (tm_group_dimension_of(group, g) == list->dimension)
            tm_text_format(text, "comment %s %d %s\n", property_of(list),
                           tm_group_value(group, g), tm_group_name(group, g));
}

static void write_header(tm_text *text, const tm_polygon_list *list, bool binary)
{
    tm_text_format(text, "ply\nformat %s 1.0\ncomment termesh %s\n",
                   binary ? "binary_little_endian" : "ascii", TM_VERSION);
    write_names(text, list);
    tm_text_format(text,
                   "element vertex %zu\nproperty double x\nproperty double y\n"
                   "property double z\nelement face %zu\n"
                   "property list %s uint vertex_indices\n",
                   list->nodes, list->polygons,
                   length_size(list) == 1 ? "uchar" : "uint");
    if (list->grouped)
        tm_text_format(text, "property int %s\n", property_of(list));
    tm_text_string(text, "end_header\n");
}

static void write_text(tm_text *text, const tm_polygon_list *list)
{
    for (size_t v = 0; v < list->nodes; v++)
        tm_polygon_point(list, v, "", text);
    for (size_t p = 0; p < list->polygons; p++) {
        tm_polygon_row(list, p, text);
        if (list->grouped) {
            tm_text_append(text, " ", 1);
            tm_text_integer(text, list->polygon[p].value);
        }
        tm_text_append(text, "\n", 1);
    }
}

static void put_unsigned(tm_text *text, uint64_t value, size_t size)
{
    char bytes[sizeof value];
    tm_binary_put_unsigned(bytes, value, size, false);
    tm_text_append(text, bytes, size);
}

static void write_binary(tm_text *text, const tm_polygon_list *list)
{
    for (size_t v = 0; v < list->nodes; v++)
        for (int c = 0; c < COORDINATES; c++) {
            uint64_t bits;
            memcpy(&bits, &list->xyz[list->node[v]][c], sizeof bits);
            put_unsigned(text, bits, sizeof bits);
        }
    for (size_t p = 0; p < list->polygons; p++) {
        const size_t k = tm_polygon_corners(list, p);
        put_unsigned(text, k, length_size(list));
        for (size_t i = 0; i < k; i++)
            put_unsigned(text, list->number[list->room[i]], sizeof(uint32_t));
        if (list->grouped)
            put_unsigned(text, (uint32_t)list->polygon[p].value, sizeof(uint32_t));
    }
}

static void put(tm_text *text, tm_polygon_list *list, const tm_surface_file *file)
{
    write_header(text, list, file->binary);
    if (file->binary)
        write_binary(text, list);
    else
        write_text(text, list);
}

tm_status tm_ply_write(tm_text *text, const tm_stream *stream,
                       const tm_surface_file *file, tm_surface_written *written,
                       tm_error *error)
{
    return tm_polygon_write(text, stream, file, written, put, error);
}
