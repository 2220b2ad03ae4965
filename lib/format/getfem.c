/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_format.h"

#include "../base/array.h"
#include "../element/shape.h"
#include "../mesh/cell_faces.h"
#include "../stream/group.h"
#include "../surface/point_table.h"
#include "../mesh/polygon_table.h"
#include "text_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NODES_MAX = 8, FACES_MAX = 6, WHOLE = 255, ROW = 64 };

/* An element of GetFEM: which node of ours each of its nodes is; and its faces, the nodes
 * of ours that are in each as bits. The faces of GT_PK are each opposite to a node; those
 * of a product are the faces of its first factor with the second, then the first with
 * those of the second, of which the one at 1 comes before that at 0. */
typedef struct convex_shape {
    const char *name;
    unsigned char node[NODES_MAX];
    unsigned char faces;
    unsigned char face[FACES_MAX];
} convex_shape;

static const convex_shape shapes[NODES_MAX + 1] = {
    [3] = {"GT_PK(2,1)", {0, 1, 2}, 0, {0}},
    [4] = {"GT_PK(3,1)", {0, 1, 2, 3}, 4, {0xe, 0xd, 0xb, 0x7}},
    [5] = {"GT_PYRAMID(1)", {0, 1, 3, 2, 4}, 5, {0x0f, 0x13, 0x16, 0x1c, 0x19}},
    [6] = {"GT_PRISM(3,1)", {0, 2, 1, 3, 5, 4}, 5, {0x36, 0x1b, 0x2d, 0x38, 0x07}},
    [8] = {"GT_QK(3,1)",
           {0, 1, 3, 2, 4, 5, 7, 6},
           6,
           {0x66, 0x99, 0xcc, 0x33, 0xf0, 0x0f}},
};

/* A convex, or a face of one, in a region. */
typedef struct member {
    uint32_t region;
    uint32_t convex;
    unsigned char face; /* WHOLE: the convex */
} member;

typedef struct writer {
    const tm_stream *stream;
    const tm_block *cell;
    tm_text *text;
    member *members;
    size_t count, room;
    tm_error *error;
} writer;

/* Points and convexes -------------------------------------------------------------- */

static size_t point_room(const void *context, size_t first, size_t past)
{
    (void)context;
    return (past - first) * (ROW + 3 * TM_NUMBER_ROOM);
}

static char *put_point(const void *context, size_t row, char *to)
{
    static const char begin[] = "  POINT  ";
    const tm_block *node = context;
    memcpy(to, begin, sizeof begin - 1);
    to = tm_write_uint32(to + sizeof begin - 1, (uint32_t)row);
    for (size_t i = 0; i < 3; i++) {
        *to++ = ' ';
        to = tm_write_double(to, node->real[3 * row + i]);
    }
    *to++ = '\n';
    return to;
}

static size_t convex_room(const void *context, size_t first, size_t past)
{
    (void)context;
    return (past - first) * (ROW + NODES_MAX * TM_NUMBER_ROOM);
}

static char *put_text(char *to, const char *text)
{
    size_t length = strlen(text);
    memcpy(to, text, length);
    return to + length;
}

static char *put_convex(const void *context, size_t row, char *to)
{
    size_t k;
    const uint32_t *node = tm_row_nodes(context, row, &k);
    const convex_shape *shape = &shapes[k];
    to = tm_write_uint32(put_text(to, "  CONVEX "), (uint32_t)row);
    to = put_text(put_text(put_text(to, " '"), shape->name), "' ");
    for (size_t i = 0; i < k; i++)
        to = tm_put_number(to, node[shape->node[i]]);
    *to++ = '\n';
    return to;
}

static void append_mesh(const writer *w, unsigned threads)
{
    const tm_block *node = tm_stream_find(w->stream, ".node");
    const tm_text_rows points = {node, node->count, point_room, put_point};
    const tm_text_rows convexes = {w->cell, w->cell->count, convex_room, put_convex};
    tm_text_format(w->text,
                   "%% GETFEM MESH FILE\n%% GETFEM VERSION 5.4\n\n"
                   "BEGIN POINTS LIST\n\n  POINT COUNT %zu\n",
                   node->count);
    tm_text_append_rows(w->text, &points, threads);
    tm_text_format(w->text,
                   "\nEND POINTS LIST\n\nBEGIN MESH STRUCTURE DESCRIPTION\n\n"
                   "  CONVEX COUNT %zu\n",
                   w->cell->count);
    tm_text_append_rows(w->text, &convexes, threads);
    tm_text_string(w->text, "\nEND MESH STRUCTURE DESCRIPTION\n");
}

static tm_status check_places(const writer *w)
{
    const tm_block *node = tm_stream_find(w->stream, ".node");
    tm_point_table table = {0};
    tm_status status = TM_OK;
    for (uint32_t v = 0; v < node->count && status == TM_OK; v++) {
        uint32_t first;
        if (!tm_point_table_join(&table, (double(*)[3])node->real, v, &first))
            status = tm_fail_memory(w->error);
        else if (first != v)
            status =
                tm_fail_at(w->error, TM_ERROR_INPUT, NULL, 0, ".node",
                           "nodes %zu and %zu are in the same place, which GetFEM "
                           "does not allow",
                           first + (size_t)w->stream->base, v + (size_t)w->stream->base);
    }
    tm_point_table_free(&table);
    return status;
}

/* Regions -------------------------------------------------------------------------- */

static tm_status add_member(writer *w, double number, uint32_t offset, size_t convex,
                            unsigned char face)
{
    if (number >= TM_GETFEM_ELEMENTS)
        return tm_fail(w->error, TM_ERROR_INPUT,
                       "%s is too large for the number of a region (below %d)",
                       offset ? "an attribute" : "a marker", TM_GETFEM_ELEMENTS);
    member *members = tm_grow(w->members, &w->room, w->count + 1, sizeof *members);
    if (!members)
        return tm_fail_memory(w->error);
    w->members = members;
    members[w->count++] = (member){(uint32_t)number + offset, (uint32_t)convex, face};
    return TM_OK;
}

/* The rows of .face and of .facet that have a marker of a region, as polygons. */
typedef struct marked {
    size_t polygons;
    size_t *start; /* [polygons + 1] */
    uint32_t *node;
    int32_t *marker;
    tm_polygon_table table;
    unsigned char *taken; /* by an element */
} marked;

static bool has_markers(const tm_block *block)
{
    return block && block->marker;
}

/* Adds the rows of a block; with no arrays yet they are only counted, in polygons and
 * *corners. */
static void list_marked(marked *m, const tm_block *block, size_t *corners)
{
    for (size_t f = 0; has_markers(block) && f < block->count; f++) {
        if (block->marker[f] <= 0)
            continue;
        size_t k;
        const uint32_t *node = tm_row_nodes(block, f, &k);
        if (m->node) {
            memcpy(m->node + *corners, node, k * sizeof *node);
            m->start[m->polygons] = *corners;
            m->marker[m->polygons] = block->marker[f];
        }
        *corners += k;
        m->polygons++;
    }
}

static tm_status find_marked(marked *m, const tm_stream *stream, tm_error *error)
{
    const tm_block *block[] = {tm_stream_find(stream, ".face"),
                               tm_stream_find(stream, ".facet")};
    size_t corners = 0;
    for (size_t b = 0; b < 2; b++)
        list_marked(m, block[b], &corners);
    m->start = tm_new(m->polygons + 1, sizeof *m->start);
    m->node = tm_new(corners, sizeof *m->node);
    m->marker = tm_new(m->polygons, sizeof *m->marker);
    m->taken = calloc(m->polygons + 1, 1);
    if (!m->start || !m->node || !m->marker || !m->taken)
        return tm_fail_memory(error);
    m->polygons = corners = 0;
    for (size_t b = 0; b < 2; b++)
        list_marked(m, block[b], &corners);
    m->start[m->polygons] = corners;
    for (uint32_t f = 0; f < m->polygons; f++) {
        uint32_t first;
        if (!tm_polygon_table_join(&m->table, m->start, m->node, f, &first))
            return tm_fail_memory(error);
    }
    return TM_OK;
}

/* The nodes, in a cycle, of the face that has those of the bits, of an element of k
 * nodes. Returns how many there are. */
static size_t nodes_of_face(const uint32_t *node, size_t k, unsigned bits,
                            uint32_t corner[4])
{
    const tm_element_shape *shape = &tm_element_shapes[k];
    for (size_t i = 0; i < shape->faces; i++) {
        const uint8_t *face = shape->face[i];
        unsigned of_face = 0;
        for (size_t c = 0; c < 4; c++) {
            of_face |= 1u << face[c];
            corner[c] = node[face[c]];
        }
        if (of_face == bits)
            return tm_mixed_face_nodes(face);
    }
    return 0; /* not reached: the table has all of them */
}

static tm_status add_element_faces(writer *w, marked *m, size_t e)
{
    size_t k;
    const uint32_t *node = tm_row_nodes(w->cell, e, &k);
    tm_status status = TM_OK;
    for (unsigned char i = 0; i < shapes[k].faces && status == TM_OK; i++) {
        uint32_t corner[4];
        const size_t corners = nodes_of_face(node, k, shapes[k].face[i], corner);
        const uint32_t f =
            tm_polygon_table_find(&m->table, m->start, m->node, corner, corners);
        if (f == TM_NONE || m->taken[f])
            continue;
        m->taken[f] = 1;
        status = add_member(w, m->marker[f], 0, e, i);
    }
    return status;
}

static tm_status add_faces(writer *w)
{
    marked m = {0};
    tm_status status = find_marked(&m, w->stream, w->error);
    for (size_t e = 0; e < w->cell->count && m.polygons > 0 && status == TM_OK; e++)
        status = add_element_faces(w, &m, e);
    tm_polygon_table_free(&m.table);
    free(m.start);
    free(m.node);
    free(m.marker);
    free(m.taken);
    return status;
}

static tm_status add_triangles(writer *w)
{
    tm_status status = TM_OK;
    for (size_t f = 0; f < w->cell->count && w->cell->marker && status == TM_OK; f++)
        if (w->cell->marker[f] > 0)
            status = add_member(w, w->cell->marker[f], 0, f, WHOLE);
    return status;
}

static tm_status add_elements(writer *w)
{
    tm_status status = TM_OK;
    size_t stride = w->cell->attributes;
    for (size_t e = 0; e < w->cell->count && stride > 0 && status == TM_OK; e++) {
        double region = w->cell->attribute[e * stride];
        if (region >= 0 && region == floor(region))
            status = add_member(w, region, TM_GETFEM_ELEMENTS, e, WHOLE);
    }
    return status;
}

static int compare(const void *a, const void *b)
{
    const member *p = a, *q = b;
    if (p->region != q->region)
        return p->region < q->region ? -1 : 1;
    if (p->convex != q->convex)
        return p->convex < q->convex ? -1 : 1;
    return (p->face > q->face) - (p->face < q->face);
}

static size_t member_room(const void *context, size_t first, size_t past)
{
    (void)context;
    return (past - first) * 3 * ROW;
}

/* The names of the regions, as comments. */
static void append_names(const writer *w)
{
    const tm_block *group = tm_stream_find(w->stream, ".group");
    for (size_t g = 0; group && g < group->count; g++) {
        const int dimension = (int)tm_group_dimension_of(group, g);
        const int64_t number = (int64_t)tm_group_value(group, g) +
                               (dimension == TM_GROUP_REGIONS ? TM_GETFEM_ELEMENTS : 0);
        const int32_t least = dimension == TM_GROUP_REGIONS ? 0 : 1;
        if ((dimension == TM_GROUP_REGIONS || dimension == TM_GROUP_FACES) &&
            tm_group_value(group, g) >= least)
            tm_text_format(w->text, "%% REGION %lld: %s\n", (long long)number,
                           tm_group_name(group, g));
    }
}

/* Between regions stands the end of one and the beginning of the next. */
static char *put_member(const void *context, size_t row, char *to)
{
    const writer *w = context;
    const member *m = &w->members[row];
    if (row == 0 || m[-1].region != m->region) {
        to = tm_write_uint32(put_text(to, "BEGIN REGION "), m->region);
        *to++ = '\n';
    }
    to = tm_write_uint32(to, m->convex);
    if (m->face != WHOLE) {
        *to++ = '/';
        to = tm_write_uint32(to, m->face);
    }
    *to++ = '\n';
    if (row + 1 == w->count || m[1].region != m->region) {
        to = tm_write_uint32(put_text(to, "END REGION "), m->region);
        *to++ = '\n';
    }
    return to;
}

static tm_status append_regions(writer *w, tm_content content, unsigned threads)
{
    tm_status status = content == TM_CONTENT_SURFACE ? add_triangles(w) : add_elements(w);
    if (status == TM_OK && content != TM_CONTENT_SURFACE)
        status = add_faces(w);
    if (status == TM_OK && w->count > 0) {
        qsort(w->members, w->count, sizeof *w->members, compare);
        const tm_text_rows rows = {w, w->count, member_room, put_member};
        append_names(w);
        tm_text_append_rows(w->text, &rows, threads);
    }
    free(w->members);
    return status;
}

tm_status tm_getfem_write(tm_text *text, const tm_stream *stream, unsigned threads,
                          tm_error *error)
{
    tm_content content = tm_content_of(stream);
    if (content < TM_CONTENT_SURFACE || content == TM_CONTENT_POLYHEDRA)
        return tm_fail(error, TM_ERROR_INPUT,
                       "has no elements that GetFEM knows (.mix, .ele or .face)");
    writer w = {.stream = stream,
                .cell = tm_content_block(stream, content),
                .text = text,
                .error = error};
    tm_status status = check_places(&w);
    if (status != TM_OK)
        return status;
    append_mesh(&w, threads);
    status = append_regions(&w, content, threads);
    return status == TM_OK && text->failed ? tm_fail_memory(error) : status;
}
