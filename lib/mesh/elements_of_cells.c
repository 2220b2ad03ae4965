/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "elements_of_cells.h"

#include "../base/array.h"
#include "../element/shape.h"

#include <stdlib.h>
#include <string.h>

enum { TRIANGLE = 3, QUADRILATERAL = 4 };

typedef struct maker {
    const tm_block *facet, *cell;
    size_t *start; /* [cells + 1] */
    uint32_t *item;
    bool tetrahedra; /* all of them are */
} maker;

/* Corner i of a face of cell c as seen from inside of it: clockwise, outward. */
static uint32_t corner(const maker *m, size_t c, size_t f, size_t i)
{
    const tm_block *facet = m->facet;
    const size_t begin = facet->start[f], k = facet->start[f + 1] - begin;
    const bool outward = facet->integer[2 * f] == c;
    return facet->item[begin + (outward ? i % k : k - 1 - i % k)];
}

static size_t corners(const maker *m, size_t f)
{
    return m->facet->start[f + 1] - m->facet->start[f];
}

/* How many nodes the element has that the cell may be; 0: none. *base is the face that it
 * is described from: the quadrilateral of a pyramid, else one of its triangles, or any.
 */
static size_t kind_of(const maker *m, size_t c, size_t *base)
{
    const size_t *start = m->cell->start;
    size_t triangles = 0, quadrilaterals = 0, last[2] = {0, 0};
    for (size_t i = start[c]; i < start[c + 1]; i++) {
        const size_t f = m->cell->item[i], k = corners(m, f);
        if (k > QUADRILATERAL)
            return 0;
        triangles += k == TRIANGLE;
        quadrilaterals += k == QUADRILATERAL;
        last[k == QUADRILATERAL] = f;
    }
    const size_t both = 10 * triangles + quadrilaterals;
    *base = last[both == 41 || both == 6];
    return both == 40   ? TM_TET_NODES
           : both == 41 ? TM_PYRAMID_NODES
           : both == 23 ? TM_WEDGE_NODES
           : both == 6  ? TM_HEX_NODES
                        : 0;
}

/* The node over node v of the base: the next one on a face beside it, which has v and the
 * node `before` in the base (as the base turns) in the other sense; TM_NONE. */
static uint32_t over(const maker *m, size_t c, size_t base, uint32_t before, uint32_t v)
{
    for (size_t i = m->cell->start[c]; i < m->cell->start[c + 1]; i++) {
        const size_t f = m->cell->item[i], k = corners(m, f);
        for (size_t j = 0; j < k && f != base; j++)
            if (corner(m, c, f, j) == v && corner(m, c, f, j + 1) == before)
                return corner(m, c, f, j + k - 1);
    }
    return TM_NONE;
}

/* Whether the faces of an element of these nodes are those of the cell: each has the same
 * nodes in the same sense. */
static bool has_faces(const maker *m, size_t c, const uint32_t *v, size_t nodes)
{
    const tm_element_shape *shape = &tm_element_shapes[nodes];
    for (size_t i = 0; i < shape->faces; i++) {
        const size_t k = tm_mixed_face_nodes(shape->face[i]);
        bool found = false;
        for (size_t a = m->cell->start[c]; a < m->cell->start[c + 1] && !found; a++) {
            const size_t f = m->cell->item[a];
            for (size_t turn = 0; turn < k && corners(m, f) == k && !found; turn++) {
                size_t same = 0;
                while (same < k &&
                       corner(m, c, f, same + turn) == v[shape->face[i][same]])
                    same++;
                found = same == k;
            }
        }
        if (!found)
            return false;
    }
    return true;
}

/* The base turns counter-clockwise seen from outside: that of a wedge as it does, that of
 * the others the other way round. */
static bool describe(const maker *m, size_t c, size_t nodes, size_t base, uint32_t *v)
{
    const size_t k = corners(m, base);
    const bool wedge = nodes == TM_WEDGE_NODES;
    for (size_t i = 0; i < k; i++) {
        const size_t at = wedge ? i : k - i;
        const uint32_t here = corner(m, c, base, at);
        v[i] = here;
        const uint32_t above = over(m, c, base, corner(m, c, base, at + k - 1), here);
        if (nodes > k + 1)
            v[k + i] = above;
        else
            v[k] = above;
    }
    return !tm_has_node_twice(v, nodes) && has_faces(m, c, v, nodes);
}

static size_t find_elements(maker *m)
{
    size_t others = 0, at = 0;
    m->tetrahedra = true;
    for (size_t c = 0; c < m->cell->count; c++) {
        size_t base = 0;
        const size_t nodes = kind_of(m, c, &base);
        m->start[c] = at;
        if (nodes == 0 || !describe(m, c, nodes, base, m->item + at))
            others++;
        at += others > 0 ? 0 : nodes;
        m->tetrahedra &= nodes == TM_TET_NODES;
    }
    m->start[m->cell->count] = at;
    return others;
}

/* The stream ------------------------------------------------------------------------- */

static bool is_row(const tm_block *facet, size_t f)
{
    return facet->integer[2 * f + 1] == TM_NONE ||
           (facet->marker && facet->marker[f] != 0);
}

static void count_rows(const tm_block *facet, size_t *rows, size_t *items)
{
    *rows = *items = 0;
    for (size_t f = 0; f < facet->count; f++)
        if (is_row(facet, f)) {
            ++*rows;
            *items += facet->start[f + 1] - facet->start[f];
        }
}

/* The facets that are rows, as .face or .facet. */
static tm_status copy_facets(const tm_block *facet, tm_block *to, tm_error *error)
{
    size_t rows, items, row = 0, at = 0;
    count_rows(facet, &rows, &items);
    to->markers = facet->markers;
    const tm_status status =
        tm_block_allocate(to, rows, to->kind == TM_FACET ? items : 0, error);
    for (size_t f = 0; f < facet->count && status == TM_OK; f++) {
        const size_t k = facet->start[f + 1] - facet->start[f];
        if (!is_row(facet, f))
            continue;
        if (facet->marker)
            to->marker[row] = facet->marker[f];
        memcpy((to->kind == TM_FACET ? to->item : to->integer) + at,
               facet->item + facet->start[f], k * sizeof *facet->item);
        at += k;
        if (to->kind == TM_FACET) {
            memcpy(to->integer + 2 * row, facet->integer + 2 * f,
                   2 * sizeof *facet->integer);
            to->start[row + 1] = at;
        }
        row++;
    }
    return status;
}

/* With all attributes of .cell but the first. */
static void give_elements(maker *m, tm_block *cell, tm_block *to)
{
    if (cell->attributes > 0)
        tm_block_drop_attribute(cell, 0);
    to->attributes = cell->attributes;
    to->attribute = cell->attribute;
    cell->attribute = NULL;
    to->count = cell->count;
    if (to->kind == TM_ELE) {
        to->integer = m->item;
    } else {
        to->item = m->item;
        to->start = m->start;
        m->start = NULL;
    }
    m->item = NULL;
}

static void put(tm_stream *stream, const char *old, tm_block *made)
{
    tm_block *block = tm_stream_find(stream, old);
    tm_block_clear(block);
    *block = *made;
    *made = (tm_block){0};
}

static tm_status replace(maker *m, tm_stream *stream, tm_error *error)
{
    tm_block elements = {.name = ".mix", .kind = TM_MIX};
    tm_block faces = {.name = ".facet", .kind = TM_FACET};
    if (m->tetrahedra) {
        elements = (tm_block){.name = ".ele", .kind = TM_ELE};
        faces = (tm_block){.name = ".face", .kind = TM_FACE};
    }
    const tm_status status = copy_facets(m->facet, &faces, error);
    if (status == TM_OK) {
        give_elements(m, tm_stream_find(stream, ".cell"), &elements);
        put(stream, ".facet", &faces);
        put(stream, ".cell", &elements);
    }
    tm_block_clear(&elements);
    tm_block_clear(&faces);
    return status;
}

tm_status tm_elements_of_cells(tm_stream *stream, size_t *others, tm_error *error)
{
    maker m = {.facet = tm_stream_find(stream, ".facet"),
               .cell = tm_stream_find(stream, ".cell")};
    m.start = tm_new(m.cell->count + 1, sizeof *m.start);
    m.item = tm_new(TM_ELEMENT_NODES * (m.cell->count + 1), sizeof *m.item);
    tm_status status = m.start && m.item ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK) {
        *others = find_elements(&m);
        if (*others == 0)
            status = replace(&m, stream, error);
    }
    free(m.start);
    free(m.item);
    return status;
}
