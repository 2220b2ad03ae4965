/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "view_parts.h"

#include "../base/array.h"
#include "../mesh/poly_arrays.h"
#include "../stream/group.h"

#include <stdlib.h>
#include <string.h>

/* A list of numbers in the making. */
typedef struct list {
    uint32_t *number;
    size_t count;
} list;

static bool list_new(list *l, size_t room)
{
    *l = (list){tm_new(room, sizeof *l->number), 0};
    return l->number != NULL;
}

static void list_add(list *l, const uint32_t *number, size_t k)
{
    memcpy(l->number + l->count, number, k * sizeof *number);
    l->count += k;
}

/* Nodes and elements ----------------------------------------------------------------- */

static tm_status add_nodes(view_writer *w, const view_source *s, tm_error *error)
{
    const size_t count = 3 * s->node->count;
    uint32_t *bits = tm_new(count, sizeof *bits);
    if (!bits)
        return tm_fail_memory(error);
    for (size_t i = 0; i < count; i++)
        bits[i] = tm_view_float((s->node->real[i] - w->centre[i % 3]) / w->scale);
    tm_view_numbers(w, "xyz", "f32", bits, count);
    free(bits);
    return TM_OK;
}

/* The nodes of elements; of mixed ones, how many each has, too. */
static tm_status add_elements(view_writer *w, const view_source *s, tm_error *error)
{
    uint8_t *size = tm_new(s->kept, 1);
    list item;
    if (!list_new(&item, s->kept * TM_ELEMENT_NODES) || !size) {
        free(size);
        return tm_fail_memory(error);
    }
    for (size_t e = 0, k; e < s->kept; e++) {
        const uint32_t *node = tm_row_nodes(s->cell, view_element(s, e), &k);
        list_add(&item, node, k);
        size[e] = (uint8_t)k;
    }
    tm_view_numbers(w, "item", "u32", item.number, item.count);
    if (s->content == TM_CONTENT_MIXED)
        tm_view_bytes(w, "size", size, s->kept);
    free(item.number);
    free(size);
    return TM_OK;
}

/* Polyhedra -------------------------------------------------------------------------- */

/* The number of each cell in the page; malloc'ed. */
static uint32_t *find_places(const view_source *s)
{
    uint32_t *place = tm_new(s->cell->count, sizeof *place);
    for (size_t c = 0; place && c < s->cell->count; c++)
        place[c] = s->number ? TM_VIEW_LEFT_OUT : (uint32_t)c;
    for (size_t k = 0; place && s->number && k < s->kept; k++)
        place[s->number[k]] = (uint32_t)k;
    return place;
}

typedef struct facet_lists {
    list side, size, item, marker;
} facet_lists;

static bool is_side(uint32_t side)
{
    return side < TM_VIEW_LEFT_OUT;
}

/* The facets of cells that are in the page; the first side is one. */
static void take_facets(facet_lists *l, const tm_block *facet, const uint32_t *place,
                        size_t cells)
{
    for (size_t f = 0, k; f < facet->count; f++) {
        const uint32_t *node = tm_row_nodes(facet, f, &k);
        uint32_t side[2];
        for (size_t i = 0; i < 2; i++) {
            const uint32_t c = facet->integer[2 * f + i];
            side[i] = c < cells ? place[c] : TM_NONE;
        }
        if (!is_side(side[0]) && !is_side(side[1]))
            continue;
        const uint32_t turned[2] = {side[1], side[0]}, corners = (uint32_t)k;
        const uint32_t marker = facet->marker ? (uint32_t)facet->marker[f] : 0;
        list_add(&l->side, is_side(side[0]) ? side : turned, 2);
        list_add(&l->size, &corners, 1);
        list_add(&l->item, node, k);
        list_add(&l->marker, &marker, 1);
    }
}

static tm_status add_facets(view_writer *w, const view_source *s, tm_error *error)
{
    static const tm_block none = {.kind = TM_FACET};
    const tm_block *found = tm_stream_find(s->stream, ".facet");
    const tm_block *facet = found ? found : &none;
    uint32_t *place = find_places(s);
    facet_lists l = {0};
    const bool room = list_new(&l.side, 2 * facet->count) &&
                      list_new(&l.size, facet->count) &&
                      list_new(&l.item, facet->count ? facet->start[facet->count] : 0) &&
                      list_new(&l.marker, facet->count);
    if (room && place) {
        take_facets(&l, facet, place, s->cell->count);
        tm_view_numbers(w, "side", "u32", l.side.number, l.side.count);
        tm_view_numbers(w, "facetSize", "u32", l.size.number, l.size.count);
        tm_view_numbers(w, "facetItem", "u32", l.item.number, l.item.count);
        if (facet->marker)
            tm_view_numbers(w, "facetMarker", "i32", l.marker.number, l.marker.count);
    }
    free(l.side.number);
    free(l.size.number);
    free(l.item.number);
    free(l.marker.number);
    free(place);
    return room && place ? TM_OK : tm_fail_memory(error);
}

/* Marked faces beside elements ---------------------------------------------------------
 */

static bool add_marked(facet_lists *l, const tm_block *block)
{
    if (!block || !block->marker)
        return true;
    const size_t items = block->start ? block->start[block->count] : 3 * block->count;
    if (!list_new(&l->size, block->count) || !list_new(&l->item, items) ||
        !list_new(&l->marker, block->count))
        return false;
    for (size_t r = 0, k; r < block->count; r++) {
        const uint32_t *node = tm_row_nodes(block, r, &k);
        const uint32_t corners = (uint32_t)k, marker = (uint32_t)block->marker[r];
        if (marker == 0)
            continue;
        list_add(&l->size, &corners, 1);
        list_add(&l->item, node, k);
        list_add(&l->marker, &marker, 1);
    }
    return true;
}

/* "marked": the rows of .face and .facet that have a marker other than 0. */
static tm_status add_marks(view_writer *w, const view_source *s, tm_error *error)
{
    static const char *const name[] = {".face", ".facet"};
    tm_status status = TM_OK;
    tm_json_open(&w->json, "marked", '[');
    for (size_t i = 0; i < 2 && status == TM_OK; i++) {
        facet_lists l = {0};
        if (!add_marked(&l, tm_stream_find(s->stream, name[i])))
            status = tm_fail_memory(error);
        if (status == TM_OK && l.marker.count > 0) {
            tm_json_open(&w->json, NULL, '{');
            tm_view_numbers(w, "size", "u32", l.size.number, l.size.count);
            tm_view_numbers(w, "item", "u32", l.item.number, l.item.count);
            tm_view_numbers(w, "marker", "i32", l.marker.number, l.marker.count);
            tm_json_close(&w->json, '}');
        }
        free(l.size.number);
        free(l.item.number);
        free(l.marker.number);
    }
    tm_json_close(&w->json, ']');
    return status;
}

/* "edge": the nodes of the rows of .edge, and "edgeMarker". */
static void add_edges(view_writer *w, const view_source *s)
{
    const tm_block *edge = tm_stream_find(s->stream, ".edge");
    if (!edge || edge->count == 0)
        return;
    tm_view_numbers(w, "edge", "u32", edge->integer, 2 * edge->count);
    if (edge->marker)
        tm_view_numbers(w, "edgeMarker", "i32", (const uint32_t *)edge->marker,
                        edge->count);
}

/* Words ------------------------------------------------------------------------------ */

void tm_view_string(tm_json *json, const char *key, const char *bytes)
{
    tm_text clean = {0};
    tm_group_clean(&clean, bytes, strlen(bytes));
    tm_json_string(json, key, clean.byte ? clean.byte : "");
    json->text->failed |= clean.failed;
    tm_text_free(&clean);
}

/* [dimension, value, name] of each row of .group. */
static void add_names(view_writer *w, const view_source *s)
{
    const tm_block *group = tm_stream_find(s->stream, ".group");
    tm_json_open(&w->json, "names", '[');
    for (size_t g = 0; group && g < group->count; g++) {
        tm_json_open(&w->json, NULL, '[');
        tm_json_integer(&w->json, NULL, tm_group_dimension_of(group, g));
        tm_json_integer(&w->json, NULL, tm_group_value(group, g));
        tm_view_string(&w->json, NULL, tm_group_name(group, g));
        tm_json_close(&w->json, ']');
    }
    tm_json_close(&w->json, ']');
}

/* The lines of the history without their "# ". */
static void add_history(view_writer *w, const view_source *s)
{
    const tm_text *history = &s->stream->history;
    tm_json_open(&w->json, "history", '[');
    for (size_t from = 0; from < history->size;) {
        const char *line = history->byte + from;
        const char *end = memchr(line, '\n', history->size - from);
        const size_t size = end ? (size_t)(end - line) : history->size - from;
        const size_t skip = size >= 2 && line[1] == ' ' ? 2 : size > 0;
        tm_text clean = {0};
        tm_group_clean(&clean, line + skip, size - skip);
        tm_json_string(&w->json, NULL, clean.byte ? clean.byte : "");
        w->data->failed |= clean.failed;
        tm_text_free(&clean);
        from += size + 1;
    }
    tm_json_close(&w->json, ']');
}

/* How many elements of each kind there are, in the page or not. */
static void add_kinds(view_writer *w, const view_source *s)
{
    static const char *const one[] = {[TM_CONTENT_POINTS] = "points",
                                      [TM_CONTENT_SURFACE] = "triangles",
                                      [TM_CONTENT_TETRAHEDRA] = "tetrahedra",
                                      [TM_CONTENT_POLYHEDRA] = "polyhedra"};
    size_t count[TM_ELEMENT_NODES + 1] = {0};
    tm_json_open(&w->json, "kinds", '{');
    if (s->content != TM_CONTENT_MIXED)
        tm_json_integer(&w->json, one[s->content], (int64_t)s->cell->count);
    for (size_t e = 0, k; s->content == TM_CONTENT_MIXED && e < s->cell->count; e++) {
        tm_row_nodes(s->cell, e, &k);
        count[k]++;
    }
    for (size_t kind = 0; kind < TM_ELEMENT_KINDS; kind++) {
        const size_t k = tm_element_kind_nodes[kind];
        if (count[k] > 0)
            tm_json_integer(&w->json, tm_element_shapes[k].plural, (int64_t)count[k]);
    }
    tm_json_close(&w->json, '}');
}

/* ------------------------------------------------------------------------------------ */

static tm_status add_arrays(view_writer *w, const view_source *s, tm_error *error)
{
    tm_status status = add_nodes(w, s, error);
    if (status == TM_OK && s->content == TM_CONTENT_POLYHEDRA)
        status = add_facets(w, s, error);
    else if (status == TM_OK && s->content > TM_CONTENT_POINTS)
        status = add_elements(w, s, error);
    add_edges(w, s);
    if (s->number)
        tm_view_numbers(w, "number", "u32", s->number, s->kept);
    if (s->number && s->content != TM_CONTENT_POLYHEDRA)
        tm_view_bytes(w, "outer", s->outer, s->kept);
    return status;
}

tm_status tm_view_put_mesh(view_writer *w, const view_source *s, const char *name,
                           tm_error *error)
{
    static const char *const content[] = {"nothing",    "points", "surface",
                                          "tetrahedra", "mixed",  "polyhedra"};
    tm_json_open(&w->json, NULL, '{');
    tm_view_string(&w->json, "name", name);
    tm_json_string(&w->json, "content", content[s->content]);
    tm_json_integer(&w->json, "base", s->stream->base);
    tm_json_integer(&w->json, "nodes", (int64_t)s->node->count);
    tm_json_integer(&w->json, "elements", (int64_t)s->cell->count);
    tm_json_integer(&w->json, "shown", (int64_t)s->kept);
    add_kinds(w, s);
    add_names(w, s);
    add_history(w, s);
    tm_json_open(&w->json, "arrays", '{');
    tm_status status = add_arrays(w, s, error);
    tm_json_close(&w->json, '}');
    if (status == TM_OK &&
        (s->content == TM_CONTENT_TETRAHEDRA || s->content == TM_CONTENT_MIXED))
        status = add_marks(w, s, error);
    if (status == TM_OK)
        status = tm_view_fields(w, s, error);
    tm_json_close(&w->json, '}');
    return status;
}
