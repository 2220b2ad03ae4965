/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_stream.h"

#include <stdio.h>
#include <string.h>

enum { TRIANGLE = 3 };

static tm_block *add(tm_stream *stream, const char *part, const char *suffix)
{
    char name[TM_BLOCK_NAME];
    snprintf(name, sizeof name, "%s%s", part, suffix);
    return tm_stream_add(stream, name);
}

static tm_status give_nodes(const tm_polygon_surface *surface, tm_stream *stream,
                            const char *part, tm_error *error)
{
    tm_block *node = add(stream, part, ".node");
    if (!node)
        return tm_fail_memory(error);
    node->attributes = surface->attribute ? surface->attributes : 0;
    node->markers = surface->node_marker != NULL;
    tm_status status = tm_block_allocate(node, surface->nodes, 0, error);
    if (status != TM_OK || !surface->xyz)
        return status;
    memcpy(node->real, surface->xyz, surface->nodes * sizeof *surface->xyz);
    if (node->attribute && surface->attribute)
        memcpy(node->attribute, surface->attribute,
               surface->nodes * node->attributes * sizeof *node->attribute);
    if (node->marker && surface->node_marker)
        memcpy(node->marker, surface->node_marker, surface->nodes * sizeof *node->marker);
    return TM_OK;
}

static size_t corners_of(const tm_polygon_surface *surface, size_t p)
{
    return surface->start[p + 1] - surface->start[p];
}

/* The triangles of polygon p, which are put in from row t on. Returns the next row. */
static size_t put_fan(const tm_polygon_surface *surface, size_t p, int32_t marker,
                      tm_block *face, size_t t)
{
    const uint32_t *corner = surface->item + surface->start[p];
    for (size_t i = 2; i < corners_of(surface, p); i++, t++) {
        uint32_t *node = face->integer + TRIANGLE * t;
        node[0] = corner[0];
        node[1] = corner[i - 1];
        node[2] = corner[i];
        if (face->marker)
            face->marker[t] = marker;
    }
    return t;
}

tm_status tm_polygon_surface_to_stream(const tm_polygon_surface *surface,
                                       tm_stream *stream, const char *part,
                                       tm_error *error)
{
    size_t triangles = 0, t = 0;
    tm_status status = give_nodes(surface, stream, part, error);
    if (status != TM_OK)
        return status;
    for (size_t p = 0; p < surface->polygons; p++)
        triangles += corners_of(surface, p) > 2 ? corners_of(surface, p) - 2 : 0;
    if (triangles >= UINT32_MAX)
        return tm_fail(error, TM_ERROR_SYSTEM, "more triangles than 32 bits can number");
    tm_block *face = add(stream, part, ".face");
    if (!face)
        return tm_fail_memory(error);
    face->markers = surface->has_facet_markers;
    status = tm_block_allocate(face, triangles, 0, error);
    for (size_t f = 0; f < surface->facets && status == TM_OK; f++)
        for (size_t p = surface->facet_start[f]; p < surface->facet_start[f + 1]; p++)
            t = put_fan(surface, p, surface->facet_marker[f], face, t);
    return status;
}
