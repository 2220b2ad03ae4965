/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cell_faces.h"

#include "../base/array.h"
#include "../base/ids.h"
#include "../geom/predicates.h"
#include "../geom/vector.h"
#include "../element/shape.h"
#include "face_table.h"
#include "polygon_table.h"

#include <stdlib.h>
#include <string.h>

#define FAIL(block, ...) tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, block, __VA_ARGS__)

enum { TRIANGLE = 3 };

static const struct {
    const char *block;
    tm_content content;
} blocks[] = {{".cell", TM_CONTENT_POLYHEDRA},
              {".mix", TM_CONTENT_MIXED},
              {".ele", TM_CONTENT_TETRAHEDRA},
              {".face", TM_CONTENT_SURFACE},
              {".node", TM_CONTENT_POINTS}};
enum { CONTENTS = sizeof blocks / sizeof blocks[0] };

tm_content tm_content_of(const tm_stream *stream)
{
    for (size_t i = 0; i < CONTENTS; i++) {
        const tm_block *block = tm_stream_find(stream, blocks[i].block);
        if (block && block->count > 0)
            return blocks[i].content;
    }
    return TM_CONTENT_NOTHING;
}

tm_block *tm_content_block(const tm_stream *stream, tm_content content)
{
    for (size_t i = 0; i < CONTENTS; i++)
        if (blocks[i].content == content)
            return tm_stream_find(stream, blocks[i].block);
    return NULL;
}

/* Elements ------------------------------------------------------------------------- */

typedef struct finder {
    tm_cell_faces *faces;
    tm_mesh_view mesh; /* rows only where they have markers */
    const char *block; /* .ele or .mix */
    unsigned base;
    uint32_t *mate; /* see tm_face_mates(); of halves that were met: their facet */
    size_t side_room, start_room, node_room;
} finder;

/* Six times the volume that the fans of triangles of all faces enclose, as seen from the
 * first node. */
static double volume6(const finder *find, const uint32_t *v,
                      const tm_element_shape *shape)
{
    double volume = 0;
    const double *origin = find->mesh.xyz[v[0]];
    for (size_t i = 0; i < shape->faces; i++) {
        const uint8_t *face = shape->face[i];
        for (size_t j = 2; j < tm_mixed_face_nodes(face); j++) {
            double a[3], b[3], c[3], normal[3];
            tm_subtract(a, find->mesh.xyz[v[face[0]]], origin);
            tm_subtract(b, find->mesh.xyz[v[face[j - 1]]], origin);
            tm_subtract(c, find->mesh.xyz[v[face[j]]], origin);
            tm_cross(normal, a, b);
            volume += tm_dot(normal, c);
        }
    }
    return volume;
}

/* The sign of an element's volume: exact for tetrahedra, rounded for others. */
static int sign_of(const finder *find, size_t e)
{
    size_t k;
    const uint32_t *v = tm_mesh_view_nodes(&find->mesh, e, &k);
    if (k == 4)
        return tm_orient3d(find->mesh.xyz[v[0]], find->mesh.xyz[v[1]],
                           find->mesh.xyz[v[2]], find->mesh.xyz[v[3]]);
    double volume = volume6(find, v, &tm_element_shapes[k]);
    return (volume > 0) - (volume < 0);
}

static tm_status make_room(finder *find, size_t facets, size_t nodes, tm_error *error)
{
    tm_cell_faces *faces = find->faces;
    if (facets >= TM_IDS)
        return tm_fail(error, TM_ERROR_SYSTEM, "more facets than 32 bits can number");
    void *side = tm_grow(faces->side, &find->side_room, facets, sizeof *faces->side);
    faces->side = side ? side : faces->side;
    size_t *start =
        tm_grow(faces->start, &find->start_room, facets + 1, sizeof *faces->start);
    faces->start = start ? start : faces->start;
    uint32_t *node = tm_grow(faces->node, &find->node_room, nodes, sizeof *faces->node);
    faces->node = node ? node : faces->node;
    return side && start && node ? TM_OK : tm_fail_memory(error);
}

/* Makes element e the other side of facet f, of which it has the polygon; TM_NONE: of one
 * that has both. */
static tm_status meet(finder *find, uint32_t f, const uint32_t *polygon, size_t k,
                      uint32_t e, tm_error *error)
{
    const char *block = find->block;
    unsigned base = find->base;
    if (f == TM_NONE)
        return FAIL(block,
                    "element %zu: its face at nodes %u %u %u has two elements "
                    "already",
                    e + (size_t)base, polygon[0] + base, polygon[1] + base,
                    polygon[2] + base);
    uint32_t *side = find->faces->side[f];
    const uint32_t *facet = find->faces->node + find->faces->start[f];
    if (tm_polygon_compare(facet, polygon, k) > 0 && sign_of(find, e) != 0 &&
        sign_of(find, side[0]) != 0)
        return FAIL(block,
                    "elements %zu and %zu are on the same side of their face at "
                    "nodes %u %u %u",
                    side[0] + (size_t)base, e + (size_t)base, polygon[0] + base,
                    polygon[1] + base, polygon[2] + base);
    side[1] = e;
    return TM_OK;
}

/* Appends face i of element e as a facet, or meets the one that it is. */
static tm_status add_face(finder *find, uint32_t e, size_t i, bool turn, uint32_t *facet,
                          tm_error *error)
{
    tm_cell_faces *faces = find->faces;
    size_t count;
    const uint32_t *v = tm_mesh_view_nodes(&find->mesh, e, &count);
    const uint8_t *face = tm_element_shapes[count].face[i];
    size_t k = tm_mixed_face_nodes(face), f = faces->facets, begin = faces->start[f];
    uint32_t half = tm_half_face(&find->mesh, e, i), *mate = find->mate;
    tm_status status = make_room(find, f + 1, begin + k, error);
    if (status != TM_OK)
        return status;
    uint32_t *polygon = faces->node + begin;
    for (size_t j = 0; j < k; j++)
        polygon[j] = v[face[turn ? k - 1 - j : j]];
    /* The second one of a facet has been given its number, which is less than its own. */
    const bool is_first = mate[half] != TM_NONE && mate[half] >= half;
    *facet = is_first ? (uint32_t)f : mate[half];
    if (!is_first)
        return meet(find, *facet, polygon, k, e, error);
    const uint32_t other = mate[half];
    mate[other] = mate[half] = *facet;
    faces->start[f + 1] = begin + k;
    faces->side[f][0] = e;
    faces->side[f][1] = TM_NONE;
    faces->facets++;
    return TM_OK;
}

static tm_status add_element(finder *find, size_t e, tm_error *error)
{
    size_t k;
    const uint32_t *v = tm_mesh_view_nodes(&find->mesh, e, &k);
    const size_t count = tm_element_shapes[k].faces;
    tm_cell_faces *faces = find->faces;
    if (tm_has_node_twice(v, k))
        return FAIL(find->block, "element %zu has a node twice", e + find->base);
    bool turn = sign_of(find, e) < 0;
    size_t begin = faces->cell_start[e];
    tm_status status = TM_OK;
    for (size_t i = 0; i < count && status == TM_OK; i++)
        status =
            add_face(find, (uint32_t)e, i, turn, &faces->cell_facet[begin + i], error);
    faces->cell_start[e + 1] = begin + count;
    return status;
}

/* The markers that the rows of .face or .facet give, whose first number is `row`; those
 * that are no facet are passed over. */
static tm_status mark(const finder *find, const int32_t *marker, size_t rows, size_t row,
                      tm_error *error)
{
    tm_cell_faces *faces = find->faces;
    if (rows == 0)
        return TM_OK;
    if (!faces->marker)
        faces->marker = calloc(faces->facets, sizeof *faces->marker);
    if (!faces->marker)
        return tm_fail_memory(error);
    for (size_t i = 0; i < rows; i++) {
        const uint32_t half = find->mate[row + i];
        if (half != TM_NONE)
            faces->marker[find->mate[half]] = marker[i];
    }
    return TM_OK;
}

static size_t count_faces(const tm_mesh_view *mesh)
{
    size_t faces = 0, k;
    for (size_t e = 0; e < mesh->elements; e++) {
        tm_mesh_view_nodes(mesh, e, &k);
        faces += tm_element_shapes[k].faces;
    }
    return faces;
}

static tm_status find_of_elements(tm_cell_faces *faces, const tm_stream *stream,
                                  const tm_block *element, tm_error *error)
{
    const tm_block *face = tm_stream_find(stream, ".face");
    const tm_block *facet = tm_stream_find(stream, ".facet");
    finder find = {.faces = faces,
                   .mesh = element->kind == TM_MIX ? tm_mesh_view_of_mixed(stream)
                                                   : tm_mesh_view_of_tets(stream),
                   .block = element->name,
                   .base = stream->base};
    if (!face || !face->marker)
        find.mesh.faces = 0;
    if (!facet || !facet->marker)
        find.mesh.facets = 0;
    faces->cells = find.mesh.elements;
    faces->cell_start = tm_new(faces->cells + 1, sizeof *faces->cell_start);
    faces->cell_facet = tm_new(count_faces(&find.mesh), sizeof *faces->cell_facet);
    tm_status status = make_room(&find, 1, 1, error);
    if (status == TM_OK && !(faces->cell_start && faces->cell_facet))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_face_mates(&find.mate, &find.mesh, error);
    if (status == TM_OK) {
        faces->start[0] = 0;
        faces->cell_start[0] = 0;
    }
    for (size_t e = 0; e < faces->cells && status == TM_OK; e++)
        status = add_element(&find, e, error);
    const size_t first_row = tm_half_faces(&find.mesh);
    if (status == TM_OK && find.mesh.faces > 0)
        status = mark(&find, face->marker, find.mesh.faces, first_row, error);
    if (status == TM_OK && find.mesh.facets > 0)
        status = mark(&find, facet->marker, find.mesh.facets, first_row + find.mesh.faces,
                      error);
    free(find.mate);
    return status;
}

/* A surface ------------------------------------------------------------------------ */

static tm_status find_of_surface(tm_cell_faces *faces, const tm_block *face,
                                 tm_error *error)
{
    size_t count = face->count;
    faces->side = tm_new(count, sizeof *faces->side);
    faces->start = tm_new(count + 1, sizeof *faces->start);
    faces->node = tm_new(count, TRIANGLE * sizeof *faces->node);
    faces->cell_start = calloc(1, sizeof *faces->cell_start);
    if (face->marker)
        faces->marker = tm_new(count, sizeof *faces->marker);
    if (!faces->side || !faces->start || !faces->node || !faces->cell_start ||
        (face->marker && !faces->marker))
        return tm_fail_memory(error);
    memset(faces->side, UINT8_MAX, count * sizeof *faces->side);
    memcpy(faces->node, face->integer, count * TRIANGLE * sizeof *faces->node);
    if (face->marker)
        memcpy(faces->marker, face->marker, count * sizeof *faces->marker);
    for (size_t f = 0; f <= count; f++)
        faces->start[f] = TRIANGLE * f;
    faces->facets = count;
    return TM_OK;
}

/* Polyhedra ------------------------------------------------------------------------ */

/* Each facet is once in the list of each of its cells, and in no other. */
static tm_status check_polyhedra(const tm_cell_faces *faces, unsigned base,
                                 unsigned char *listed, tm_error *error)
{
    for (size_t c = 0; c < faces->cells; c++)
        for (size_t i = faces->cell_start[c]; i < faces->cell_start[c + 1]; i++) {
            uint32_t f = faces->cell_facet[i];
            const uint32_t *side = faces->side[f];
            if (side[0] != c && side[1] != c)
                return FAIL(".cell",
                            "row %zu: facet %zu is not between this cell and "
                            "another one",
                            c + base, f + (size_t)base);
            unsigned char bit = side[0] == c ? 1 : 2;
            if (listed[f] & bit)
                return FAIL(".cell", "row %zu: facet %zu is there twice", c + base,
                            f + (size_t)base);
            listed[f] |= bit;
        }
    for (size_t f = 0; f < faces->facets; f++) {
        const uint32_t *side = faces->side[f];
        if (side[0] == side[1])
            return FAIL(".facet", "row %zu: both of its cells are %zu", f + base,
                        side[0] + (size_t)base);
        for (int i = 0; i < 2; i++)
            if (side[i] != TM_NONE && !(listed[f] & (1 << i)))
                return FAIL(".facet", "row %zu: cell %zu does not have this facet",
                            f + base, side[i] + (size_t)base);
    }
    return TM_OK;
}

static tm_status find_of_polyhedra(tm_cell_faces *faces, const tm_stream *stream,
                                   const tm_block *cell, tm_error *error)
{
    /* A cell has facets, and the stream's reader has looked for them. */
    const tm_block *facet = tm_stream_find(stream, ".facet");
    faces->borrowed = true;
    faces->cells = cell->count;
    faces->cell_start = cell->start;
    faces->cell_facet = cell->item;
    faces->facets = facet->count;
    faces->side = (uint32_t(*)[2])facet->integer;
    faces->start = facet->start;
    faces->node = facet->item;
    faces->marker = facet->marker;
    unsigned char *listed = calloc(facet->count, 1);
    if (!listed)
        return tm_fail_memory(error);
    tm_status status = check_polyhedra(faces, stream->base, listed, error);
    free(listed);
    return status;
}

/* ---------------------------------------------------------------------------------- */

tm_status tm_cell_faces_find(tm_cell_faces *faces, const tm_stream *stream,
                             tm_error *error)
{
    *faces = (tm_cell_faces){0};
    tm_content content = tm_content_of(stream);
    const tm_block *block = tm_content_block(stream, content);
    switch (content) {
    case TM_CONTENT_SURFACE:
        return find_of_surface(faces, block, error);
    case TM_CONTENT_TETRAHEDRA:
    case TM_CONTENT_MIXED:
        return find_of_elements(faces, stream, block, error);
    case TM_CONTENT_POLYHEDRA:
        return find_of_polyhedra(faces, stream, block, error);
    default:
        return TM_OK;
    }
}

void tm_cell_faces_free(tm_cell_faces *faces)
{
    if (!faces->borrowed) {
        free(faces->cell_start);
        free(faces->cell_facet);
        free(faces->side);
        free(faces->start);
        free(faces->node);
        free(faces->marker);
    }
    *faces = (tm_cell_faces){0};
}
