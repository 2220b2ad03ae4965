/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polygon_list.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

/* The region of a cell of the list's mesh; 0 where it has none. */
static int32_t region_of(const tm_block *cells, uint32_t c)
{
    int32_t region = 0;
    return tm_group_region(cells, c, &region) ? region : 0;
}

static void add(tm_polygon_list *list, size_t f, bool turned, int32_t value)
{
    const size_t corners = list->faces.start[f + 1] - list->faces.start[f];
    if (corners > list->corners)
        list->corners = corners;
    list->polygon[list->polygons++] = (tm_polygon){(uint32_t)f, turned, value};
}

/* Both sides of facet f, each for its region, where these are two. */
static void add_sides(tm_polygon_list *list, const tm_block *cells, size_t f)
{
    const uint32_t *side = list->faces.side[f];
    int32_t region[2] = {0};
    for (int i = 0; i < 2; i++)
        if (side[i] != TM_NONE)
            region[i] = region_of(cells, side[i]);
    if (side[0] != TM_NONE && side[1] != TM_NONE && region[0] == region[1])
        return;
    for (int i = 0; i < 2; i++)
        if (side[i] != TM_NONE)
            add(list, f, i == 1, region[i]);
}

static tm_status choose(tm_polygon_list *list, tm_polygons_of of, tm_error *error)
{
    const tm_cell_faces *faces = &list->faces;
    const tm_content content = tm_content_of(list->stream);
    const tm_block *cells = tm_content_block(list->stream, content);
    if (of == TM_POLYGONS_REGIONS && content < TM_CONTENT_TETRAHEDRA)
        return tm_fail(error, TM_ERROR_INPUT,
                       "has no cells (.cell, .mix or .ele), and so no regions");
    list->polygon = tm_new(2 * faces->facets, sizeof *list->polygon);
    if (!list->polygon)
        return tm_fail_memory(error);
    for (size_t f = 0; f < faces->facets; f++)
        if (of == TM_POLYGONS_REGIONS)
            add_sides(list, cells, f);
        else if (of == TM_POLYGONS_ALL || faces->side[f][1] == TM_NONE)
            add(list, f, false, faces->marker ? faces->marker[f] : 0);
    return TM_OK;
}

static tm_status number_nodes(tm_polygon_list *list, size_t nodes, tm_error *error)
{
    const tm_cell_faces *faces = &list->faces;
    list->number = tm_new(nodes, sizeof *list->number);
    list->node = tm_new(nodes, sizeof *list->node);
    list->room = tm_new(2 * list->corners, sizeof *list->room);
    if (!list->number || !list->node || !list->room)
        return tm_fail_memory(error);
    memset(list->number, UINT8_MAX, nodes * sizeof *list->number);
    for (size_t p = 0; p < list->polygons; p++) {
        const uint32_t f = list->polygon[p].facet;
        for (size_t i = faces->start[f]; i < faces->start[f + 1]; i++)
            list->number[faces->node[i]] = 0;
    }
    for (uint32_t v = 0; v < nodes; v++)
        if (list->number[v] != TM_NONE) {
            list->number[v] = (uint32_t)list->nodes;
            list->node[list->nodes++] = v;
        }
    return TM_OK;
}

static const char *find_name(const tm_polygon_list *list, int32_t value)
{
    return tm_group_find(tm_stream_find(list->stream, ".group"), list->dimension, value);
}

/* Markers that are all 1 or -1 only say where the boundary is. */
static bool is_grouped(const tm_polygon_list *list)
{
    const int32_t first = list->polygons > 0 ? list->polygon[0].value : 0;
    for (size_t p = 1; p < list->polygons; p++)
        if (list->polygon[p].value != first)
            return true;
    return first < -1 || first > 1 || find_name(list, first) != NULL;
}

tm_status tm_polygon_list_make(tm_polygon_list *list, const tm_stream *stream,
                               tm_polygons_of of, tm_error *error)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    *list = (tm_polygon_list){.stream = stream,
                              .dimension = of == TM_POLYGONS_REGIONS ? TM_GROUP_REGIONS
                                                                     : TM_GROUP_FACES};
    tm_status status = tm_cell_faces_find(&list->faces, stream, error);
    if (status == TM_OK && list->faces.facets == 0)
        status =
            tm_fail(error, TM_ERROR_INPUT, "has no faces (.cell, .mix, .ele or .face)");
    if (status == TM_OK)
        status = choose(list, of, error);
    if (status == TM_OK)
        status = number_nodes(list, node->count, error);
    if (status == TM_OK) {
        list->xyz = (const double(*)[3])node->real;
        list->grouped = is_grouped(list);
    }
    return status;
}

void tm_polygon_list_free(tm_polygon_list *list)
{
    tm_cell_faces_free(&list->faces);
    free(list->polygon);
    free(list->room);
    free(list->node);
    free(list->number);
    *list = (tm_polygon_list){0};
}

tm_status tm_polygon_write(tm_text *text, const tm_stream *stream,
                           const tm_surface_file *file, tm_surface_written *written,
                           tm_polygon_put *put, tm_error *error)
{
    tm_polygon_list list;
    tm_status status = tm_polygon_list_make(&list, stream, file->of, error);
    if (status == TM_OK) {
        put(text, &list, file);
        *written = (tm_surface_written){.polygons = list.polygons};
        status = text->failed ? tm_fail_memory(error) : TM_OK;
    }
    tm_polygon_list_free(&list);
    return status;
}

static int compare_polygons(const void *a, const void *b)
{
    const tm_polygon *p = a, *q = b;
    if (p->value != q->value) {
        if (p->value == 0 || q->value == 0)
            return p->value == 0 ? -1 : 1;
        return p->value < q->value ? -1 : 1;
    }
    if (p->facet != q->facet)
        return p->facet < q->facet ? -1 : 1;
    return p->turned - q->turned;
}

void tm_polygon_list_sort(tm_polygon_list *list)
{
    if (list->grouped)
        qsort(list->polygon, list->polygons, sizeof *list->polygon, compare_polygons);
}

size_t tm_polygon_corners(const tm_polygon_list *list, size_t p)
{
    const tm_polygon *polygon = &list->polygon[p];
    const size_t start = list->faces.start[polygon->facet];
    const size_t k = list->faces.start[polygon->facet + 1] - start;
    for (size_t i = 0; i < k; i++)
        list->room[polygon->turned ? k - 1 - i : i] = list->faces.node[start + i];
    return k;
}

void tm_polygon_point(const tm_polygon_list *list, size_t v, const char *word,
                      tm_text *text)
{
    const double *point = list->xyz[list->node[v]];
    tm_text_string(text, word);
    for (int c = 0; c < 3; c++) {
        tm_text_double(text, point[c]);
        tm_text_append(text, c < 2 ? " " : "\n", 1);
    }
}

void tm_polygon_row(const tm_polygon_list *list, size_t p, tm_text *text)
{
    const size_t k = tm_polygon_corners(list, p);
    tm_text_integer(text, (int64_t)k);
    for (size_t i = 0; i < k; i++) {
        tm_text_append(text, " ", 1);
        tm_text_integer(text, list->number[list->room[i]]);
    }
}

size_t tm_polygon_group_end(const tm_polygon_list *list, size_t p)
{
    const int32_t value = list->polygon[p].value;
    while (p < list->polygons && list->polygon[p].value == value)
        p++;
    return p;
}

void tm_polygon_name(const tm_polygon_list *list, int32_t value, tm_text *name)
{
    const char *given = find_name(list, value);
    name->size = 0;
    if (given || value == 0) {
        tm_text_string(name, given ? given : "");
        return;
    }
    tm_text_format(name, list->dimension == TM_GROUP_REGIONS ? "region_%d" : "marker_%d",
                   value);
    const tm_block *group = tm_stream_find(list->stream, ".group");
    while (!name->failed &&
           tm_group_named(group, list->dimension, name->byte, name->size))
        tm_text_append(name, "_", 1);
}
