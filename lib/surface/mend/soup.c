/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "soup.h"

#include "../../base/array.h"
#include "../../base/ids.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tm_soup_put_in_box(tm_soup_box *box, const double place[3])
{
    for (int x = 0; x < 3; x++) {
        box->low[x] = fmin(box->low[x], place[x]);
        box->high[x] = fmax(box->high[x], place[x]);
    }
}

double tm_soup_box_diagonal(const tm_soup_box *box)
{
    return sqrt(tm_distance2(box->low, box->high));
}

static tm_status check_count(size_t triangles, tm_error *error)
{
    if (triangles < TM_IDS_THIRD)
        return TM_OK;
    return tm_fail(error, TM_ERROR_SYSTEM,
                   "%zu triangles have more sides than 32 bits can number", triangles);
}

tm_status tm_soup_take(tm_soup *soup, tm_stream *stream, tm_error *error)
{
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *face = tm_stream_find(stream, ".face");
    *soup = (tm_soup){.nodes = node->count,
                      .xyz = (const double(*)[3])node->real,
                      .triangles = face->count,
                      .room = face->count,
                      .marker_room = face->count,
                      .triangle = (uint32_t(*)[3])face->integer,
                      .marker = face->marker};
    tm_soup_box box = TM_SOUP_NO_BOX;
    for (size_t v = 0; v < soup->nodes; v++)
        tm_soup_put_in_box(&box, soup->xyz[v]);
    soup->diagonal = soup->nodes > 0 ? tm_soup_box_diagonal(&box) : 0;
    face->integer = NULL;
    face->marker = NULL;
    face->count = 0;
    const tm_status status = check_count(soup->triangles, error);
    return status == TM_OK ? tm_soup_find_edges(soup, error) : status;
}

void tm_soup_give(tm_soup *soup, tm_stream *stream)
{
    tm_block *face = tm_stream_find(stream, ".face");
    face->count = soup->triangles;
    face->integer = (uint32_t *)soup->triangle;
    face->marker = soup->marker;
    soup->triangle = NULL;
    soup->marker = NULL;
    tm_soup_free(soup);
}

void tm_soup_free(tm_soup *soup)
{
    free(soup->triangle);
    free(soup->marker);
    free(soup->start);
    tm_polygon_edges_free(&soup->edges);
    *soup = (tm_soup){0};
}

tm_status tm_soup_copy(tm_soup *copy, const tm_soup *soup, tm_error *error)
{
    const size_t n = soup->triangles;
    *copy = *soup;
    copy->start = NULL;
    copy->start_room = 0;
    copy->edges = (tm_polygon_edges){0};
    copy->room = copy->marker_room = n;
    copy->triangle = tm_new(n, sizeof *copy->triangle);
    copy->marker = soup->marker ? tm_new(n, sizeof *copy->marker) : NULL;
    if (!copy->triangle || (soup->marker && !copy->marker))
        return tm_fail_memory(error);
    memcpy(copy->triangle, soup->triangle, n * sizeof *copy->triangle);
    if (soup->marker)
        memcpy(copy->marker, soup->marker, n * sizeof *copy->marker);
    return TM_OK;
}

tm_status tm_soup_find_edges(tm_soup *soup, tm_error *error)
{
    size_t *start =
        tm_grow(soup->start, &soup->start_room, soup->triangles + 1, sizeof *start);
    if (!start)
        return tm_fail_memory(error);
    soup->start = start;
    for (size_t t = 0; t <= soup->triangles; t++)
        start[t] = 3 * t;
    tm_polygon_edges_free(&soup->edges);
    const tm_status status = tm_polygon_edges_find(&soup->edges, soup->triangles, start,
                                                   (const uint32_t *)soup->triangle,
                                                   soup->nodes, NULL, 1, error);
    soup->open = soup->crowded = 0;
    for (size_t e = 0; status == TM_OK && e < soup->edges.edges; e++) {
        const size_t count = soup->edges.start[e + 1] - soup->edges.start[e];
        soup->open += count == 1;
        soup->crowded += count > 2;
    }
    return status;
}

tm_status tm_soup_add(tm_soup *soup, const uint32_t node[3], int32_t marker,
                      tm_error *error)
{
    const tm_status status = check_count(soup->triangles + 1, error);
    if (status != TM_OK)
        return status;
    void *more =
        tm_grow(soup->triangle, &soup->room, soup->triangles + 1, sizeof *soup->triangle);
    if (!more)
        return tm_fail_memory(error);
    soup->triangle = more;
    memcpy(soup->triangle[soup->triangles], node, sizeof *soup->triangle);
    if (soup->marker) {
        more = tm_grow(soup->marker, &soup->marker_room, soup->triangles + 1,
                       sizeof *soup->marker);
        if (!more)
            return tm_fail_memory(error);
        soup->marker = more;
        soup->marker[soup->triangles] = marker;
    }
    soup->triangles++;
    return TM_OK;
}

void tm_soup_drop(tm_soup *soup, const bool *gone, size_t count)
{
    size_t kept = 0;
    for (size_t t = 0; t < soup->triangles; t++) {
        if (t < count && gone[t])
            continue;
        memmove(soup->triangle[kept], soup->triangle[t], sizeof *soup->triangle);
        if (soup->marker)
            soup->marker[kept] = soup->marker[t];
        kept++;
    }
    soup->triangles = kept;
}

bool tm_soup_open_nodes(const tm_soup *soup, uint32_t **list, size_t *count)
{
    bool *open = calloc(soup->nodes + 1, sizeof *open);
    *list = tm_new(soup->nodes, sizeof **list);
    *count = 0;
    if (!open || !*list) {
        free(open);
        free(*list);
        *list = NULL;
        return false;
    }
    for (size_t t = 0; t < soup->triangles; t++)
        for (unsigned i = 0; i < 3; i++)
            if (tm_soup_is_open(soup, t, i))
                open[soup->triangle[t][i]] = open[soup->triangle[t][(i + 1) % 3]] = true;
    for (uint32_t v = 0; v < soup->nodes; v++)
        if (open[v])
            (*list)[(*count)++] = v;
    free(open);
    return true;
}
