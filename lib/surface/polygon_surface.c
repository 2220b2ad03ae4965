/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polygon_surface.h"

#include "../base/array.h"
#include "../base/ids.h"
#include "../geom/ears.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Which capacity belongs to which array. */
enum {
    XYZ,
    START,
    ITEM,
    FACET_START,
    FACET_HOLE_START,
    FACET_MARKER,
    FACET_HOLE,
    HOLE,
    REGION
};

void tm_polygon_surface_init(tm_polygon_surface *surface)
{
    *surface = (tm_polygon_surface){.base = 1};
    tm_group_init(&surface->group, ".group");
}

void tm_polygon_surface_free(tm_polygon_surface *surface)
{
    free(surface->xyz);
    free(surface->attribute);
    free(surface->node_marker);
    free(surface->start);
    free(surface->item);
    free(surface->facet_start);
    free(surface->facet_marker);
    free(surface->facet_hole);
    free(surface->facet_hole_start);
    free(surface->hole);
    free(surface->region);
    tm_group_free(&surface->group);
    tm_polygon_surface_init(surface);
}

/* Makes room for one more item of an array; NULL where memory is out. */
static void *room(tm_polygon_surface *surface, int which, void *array, size_t count,
                  size_t size)
{
    return tm_grow(array, &surface->capacity[which], count + 1, size);
}

tm_status tm_polygon_surface_add_node(tm_polygon_surface *surface, const double xyz[3],
                                      tm_error *error)
{
    if (surface->nodes >= TM_IDS - 1)
        return tm_fail(error, TM_ERROR_INPUT, "more than %u nodes", TM_IDS - 1);
    double(*grown)[3] =
        room(surface, XYZ, surface->xyz, surface->nodes, sizeof *surface->xyz);
    if (!grown)
        return tm_fail_memory(error);
    surface->xyz = grown;
    memcpy(grown[surface->nodes++], xyz, sizeof *grown);
    return TM_OK;
}

tm_status tm_polygon_surface_add_corner(tm_polygon_surface *surface, uint32_t node,
                                        tm_error *error)
{
    uint32_t *grown =
        room(surface, ITEM, surface->item, surface->corners, sizeof *surface->item);
    if (!grown)
        return tm_fail_memory(error);
    surface->item = grown;
    grown[surface->corners++] = node;
    return TM_OK;
}

/* Appends the end of range number `ranges` to an array of offsets, which begins with 0.
 * False where memory is out. */
static bool end_range(tm_polygon_surface *surface, int which, size_t **start,
                      size_t ranges, size_t end)
{
    size_t *grown = room(surface, which, *start, ranges + 1, sizeof *grown);
    if (!grown)
        return false;
    *start = grown;
    grown[0] = 0;
    grown[ranges + 1] = end;
    return true;
}

tm_status tm_polygon_surface_end_polygon(tm_polygon_surface *surface, tm_error *error)
{
    if (!end_range(surface, START, &surface->start, surface->polygons, surface->corners))
        return tm_fail_memory(error);
    surface->polygons++;
    return TM_OK;
}

tm_status tm_polygon_surface_end_facet(tm_polygon_surface *surface, int32_t marker,
                                       tm_error *error)
{
    size_t f = surface->facets;
    int32_t *grown = room(surface, FACET_MARKER, surface->facet_marker, f, sizeof *grown);
    if (grown)
        surface->facet_marker = grown;
    if (!grown ||
        !end_range(surface, FACET_START, &surface->facet_start, f, surface->polygons) ||
        !end_range(surface, FACET_HOLE_START, &surface->facet_hole_start, f,
                   surface->facet_holes))
        return tm_fail_memory(error);
    grown[f] = marker;
    surface->facets++;
    return TM_OK;
}

tm_status tm_polygon_surface_end_face(tm_polygon_surface *surface, tm_error *error)
{
    const tm_status status = tm_polygon_surface_end_polygon(surface, error);
    if (status != TM_OK)
        return status;
    return tm_polygon_surface_end_facet(surface, surface->next_marker, error);
}

tm_status tm_polygon_surface_add_polygon(tm_polygon_surface *surface,
                                         const uint32_t *node, size_t k, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t i = 0; i < k && status == TM_OK; i++)
        status = tm_polygon_surface_add_corner(surface, node[i], error);
    return status == TM_OK ? tm_polygon_surface_end_face(surface, error) : status;
}

tm_status tm_polygon_surface_add_facet_hole(tm_polygon_surface *surface,
                                            const double xyz[3], tm_error *error)
{
    double(*grown)[3] = room(surface, FACET_HOLE, surface->facet_hole,
                             surface->facet_holes, sizeof *grown);
    if (!grown)
        return tm_fail_memory(error);
    surface->facet_hole = grown;
    memcpy(grown[surface->facet_holes++], xyz, sizeof *grown);
    return TM_OK;
}

tm_status tm_polygon_surface_add_hole(tm_polygon_surface *surface, const double xyz[3],
                                      tm_error *error)
{
    double(*grown)[3] = room(surface, HOLE, surface->hole, surface->holes, sizeof *grown);
    if (!grown)
        return tm_fail_memory(error);
    surface->hole = grown;
    memcpy(grown[surface->holes++], xyz, sizeof *grown);
    return TM_OK;
}

tm_status tm_polygon_surface_add_region(tm_polygon_surface *surface,
                                        const tm_region *region, tm_error *error)
{
    tm_region *grown =
        room(surface, REGION, surface->region, surface->regions, sizeof *grown);
    if (!grown)
        return tm_fail_memory(error);
    surface->region = grown;
    grown[surface->regions++] = *region;
    return TM_OK;
}

tm_status tm_polygon_surface_nodes_from_stream(tm_polygon_surface *surface,
                                               tm_block *node, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t v = 0; v < node->count && status == TM_OK; v++)
        status = tm_polygon_surface_add_node(surface, node->real + 3 * v, error);
    if (status != TM_OK)
        return status;
    surface->attributes = node->attributes;
    surface->attribute = node->attribute;
    surface->node_marker = node->marker;
    node->attributes = 0;
    node->attribute = NULL;
    node->markers = false;
    node->marker = NULL;
    return TM_OK;
}

tm_status tm_polygon_surface_add_faces(tm_polygon_surface *surface, const tm_block *face,
                                       tm_error *error)
{
    enum { CORNERS = 3 };
    surface->has_facet_markers = face->markers;
    tm_status status = TM_OK;
    for (size_t f = 0; f < face->count && status == TM_OK; f++) {
        status = tm_polygon_surface_add_polygon(surface, face->integer + CORNERS * f,
                                                CORNERS, error);
        if (status == TM_OK && face->markers)
            surface->facet_marker[surface->facets - 1] = face->marker[f];
    }
    return status;
}

static tm_block *add_block(tm_stream *stream, const char *part, const char *suffix)
{
    char name[TM_BLOCK_NAME];
    snprintf(name, sizeof name, "%s%s", part, suffix);
    return tm_stream_add(stream, name);
}

static tm_status nodes_to_stream(const tm_polygon_surface *surface, tm_stream *stream,
                                 const char *part, tm_error *error)
{
    tm_block *node = add_block(stream, part, ".node");
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

/* Puts the triangles of all polygons into .face, whose rows are then those; aside: room
 * for the corners of one. */
static void put_triangles(const tm_polygon_surface *surface, tm_block *face,
                          uint32_t *aside)
{
    face->count = 0;
    for (size_t f = 0; f < surface->facets; f++)
        for (size_t p = surface->facet_start[f]; p < surface->facet_start[f + 1]; p++) {
            const size_t t = face->count;
            face->count += tm_cut_ears(
                (const double(*)[3])surface->xyz, surface->item + surface->start[p],
                corners_of(surface, p), aside, (uint32_t(*)[3])face->integer + t);
            for (size_t i = t; i < face->count && face->marker; i++)
                face->marker[i] = surface->facet_marker[f];
        }
}

tm_status tm_polygon_surface_to_stream(const tm_polygon_surface *surface,
                                       tm_stream *stream, const char *part,
                                       tm_error *error)
{
    size_t triangles = 0, most = 0;
    tm_status status = nodes_to_stream(surface, stream, part, error);
    if (status != TM_OK)
        return status;
    for (size_t p = 0; p < surface->polygons; p++) {
        const size_t k = corners_of(surface, p);
        triangles += k > 2 ? k - 2 : 0;
        most = k > most ? k : most;
    }
    if (triangles >= TM_IDS)
        return tm_fail(error, TM_ERROR_SYSTEM, "more triangles than 32 bits can number");
    tm_block *face = add_block(stream, part, ".face");
    if (!face)
        return tm_fail_memory(error);
    face->markers = surface->has_facet_markers;
    status = tm_block_allocate(face, triangles, 0, error);
    uint32_t *aside = tm_new(most, sizeof *aside);
    if (status == TM_OK && !aside)
        status = tm_fail_memory(error);
    if (status == TM_OK)
        put_triangles(surface, face, aside);
    free(aside);
    char name[TM_BLOCK_NAME];
    snprintf(name, sizeof name, "%s.group", part);
    if (status == TM_OK)
        status = tm_group_to_stream(&surface->group, stream, name, error);
    return status;
}
