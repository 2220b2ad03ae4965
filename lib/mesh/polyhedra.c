/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polyhedra.h"

#include "../base/array.h"
#include "cell_orient.h"
#include "polygon_table.h"

#include <stdlib.h>
#include <string.h>

#define FAIL(m, ...)                                                                     \
    tm_fail_at((m)->error, TM_ERROR_INPUT, (m)->file, 0, NULL, __VA_ARGS__)

typedef struct maker {
    tm_lists *polygons;
    tm_lists *polyhedra;
    const tm_block *node;
    const char *file;
    tm_polyhedra_repairs *repairs;
    tm_error *error;
} maker;

/* Lists ----------------------------------------------------------------------------- */

bool tm_lists_begin(tm_lists *lists)
{
    tm_lists_free(lists);
    lists->start = tm_grow(NULL, &lists->start_room, 1, sizeof *lists->start);
    if (lists->start)
        lists->start[0] = 0;
    return lists->start != NULL;
}

uint32_t *tm_lists_room(tm_lists *lists, size_t k)
{
    const size_t begin = lists->start[lists->count];
    uint32_t *item =
        tm_grow(lists->item, &lists->item_room, begin + k, sizeof *lists->item);
    if (!item)
        return NULL;
    lists->item = item;
    return item + begin;
}

bool tm_lists_end(tm_lists *lists, size_t k)
{
    size_t *start =
        tm_grow(lists->start, &lists->start_room, lists->count + 2, sizeof *lists->start);
    if (!start)
        return false;
    lists->start = start;
    start[lists->count + 1] = start[lists->count] + k;
    lists->count++;
    return true;
}

void tm_lists_free(tm_lists *lists)
{
    free(lists->start);
    free(lists->item);
    *lists = (tm_lists){0};
}

/* Polygons -------------------------------------------------------------------------- */

/* Each polygon's first one that is the same; NULL where memory is out. */
static uint32_t *find_firsts(const tm_lists *polygons)
{
    uint32_t *first = tm_new(polygons->count, sizeof *first);
    tm_polygon_table table = {0};
    bool done = first != NULL;
    for (size_t p = 0; p < polygons->count && done; p++)
        done = tm_polygon_table_join(&table, polygons->start, polygons->item, (uint32_t)p,
                                     &first[p]);
    tm_polygon_table_free(&table);
    if (done)
        return first;
    free(first);
    return NULL;
}

/* Drops polygons that are not used; number[p] becomes that of p, if it is kept. */
static void drop_polygons(maker *m, const unsigned char *used, uint32_t *number)
{
    tm_lists *polygons = m->polygons;
    size_t kept = 0, end = 0;
    for (size_t p = 0; p < polygons->count; p++) {
        const size_t begin = polygons->start[p], k = polygons->start[p + 1] - begin;
        m->repairs->dropped += number[p] == p && !used[p];
        if (!used[p])
            continue;
        memmove(polygons->item + end, polygons->item + begin, k * sizeof *polygons->item);
        polygons->start[kept] = end;
        end += k;
        number[p] = (uint32_t)kept++;
    }
    polygons->start[kept] = end;
    polygons->count = kept;
}

/* Makes all polygons that are the same one, and drops those that no polyhedron has: the
 * polyhedra then name polygons as they are numbered then. */
static tm_status join_polygons(maker *m)
{
    tm_lists *polyhedra = m->polyhedra;
    uint32_t *number = find_firsts(m->polygons);
    unsigned char *used = calloc(m->polygons->count + 1, 1);
    const size_t items = polyhedra->start[polyhedra->count];
    if (number && used) {
        for (size_t i = 0; i < items; i++) {
            const uint32_t first = number[polyhedra->item[i]];
            m->repairs->joined += first != polyhedra->item[i];
            polyhedra->item[i] = first;
            used[first] = 1;
        }
        drop_polygons(m, used, number);
        for (size_t i = 0; i < items; i++)
            polyhedra->item[i] = number[polyhedra->item[i]];
    }
    const tm_status status = number && used ? TM_OK : tm_fail_memory(m->error);
    free(number);
    free(used);
    return status;
}

/* Sides ----------------------------------------------------------------------------- */

/* A polygon is in two polyhedra at most, and only once in each. */
static tm_status check_uses(const maker *m, tm_block *facet)
{
    const tm_lists *polyhedra = m->polyhedra;
    memset(facet->integer, UINT8_MAX, 2 * facet->count * sizeof *facet->integer);
    for (size_t c = 0; c < polyhedra->count; c++)
        for (size_t i = polyhedra->start[c]; i < polyhedra->start[c + 1]; i++) {
            uint32_t *side = facet->integer + 2 * (size_t)polyhedra->item[i];
            if (side[0] == c || side[1] != TM_NONE)
                return FAIL(m,
                            "polyhedron %zu has a polygon twice, or one that two others "
                            "have",
                            c);
            side[side[0] != TM_NONE] = (uint32_t)c;
        }
    return TM_OK;
}

/* Side 0 becomes the cell that the facet is outward for; where there is one cell and the
 * facet is inward, the facet is turned. */
static void set_sides(const maker *m, tm_block *facet, const bool *inward)
{
    const tm_lists *polyhedra = m->polyhedra;
    memset(facet->integer, UINT8_MAX, 2 * facet->count * sizeof *facet->integer);
    for (size_t c = 0; c < polyhedra->count; c++)
        for (size_t i = polyhedra->start[c]; i < polyhedra->start[c + 1]; i++)
            facet->integer[2 * (size_t)polyhedra->item[i] + inward[i]] = (uint32_t)c;
    for (size_t f = 0; f < facet->count; f++) {
        uint32_t *side = facet->integer + 2 * f;
        if (side[0] != TM_NONE)
            continue;
        side[0] = side[1];
        side[1] = TM_NONE;
        tm_polygon_turn(facet->item + facet->start[f],
                        facet->start[f + 1] - facet->start[f]);
        m->repairs->turned++;
    }
}

static tm_status orient(const maker *m, tm_block *facet)
{
    const tm_lists *polyhedra = m->polyhedra;
    const tm_polygon_cells mesh = {m->node->count,   (const double(*)[3])m->node->real,
                                   facet->count,     facet->start,
                                   facet->item,      polyhedra->count,
                                   polyhedra->start, polyhedra->item};
    bool *inward = tm_new(polyhedra->start[polyhedra->count], sizeof *inward);
    tm_status status = inward ? check_uses(m, facet) : tm_fail_memory(m->error);
    if (status == TM_OK) {
        tm_error cause;
        status = tm_cells_orient(&mesh, inward, &cause);
        if (status == TM_ERROR_INPUT)
            FAIL(m, "%s", cause.what);
        else if (status != TM_OK)
            tm_fail_as(m->error, &cause);
    }
    if (status == TM_OK)
        set_sides(m, facet, inward);
    free(inward);
    return status;
}

/* Blocks ---------------------------------------------------------------------------- */

/* Adds a block with a copy of the lists. */
static tm_status add_lists(const maker *m, tm_stream *stream, const char *name,
                           const tm_lists *from, tm_block **block)
{
    *block = tm_stream_add(stream, name);
    if (!*block)
        return tm_fail_memory(m->error);
    size_t items = from->start[from->count];
    tm_status status = tm_block_allocate(*block, from->count, items, m->error);
    if (status != TM_OK)
        return status;
    memcpy((*block)->start, from->start, (from->count + 1) * sizeof *from->start);
    if (items > 0)
        memcpy((*block)->item, from->item, items * sizeof *from->item);
    return TM_OK;
}

tm_status tm_polyhedra_to_stream(tm_stream *stream, tm_lists *polygons,
                                 tm_lists *polyhedra, const char *file,
                                 tm_polyhedra_repairs *repairs, tm_error *error)
{
    maker m = {polygons, polyhedra, NULL, file, repairs, error};
    tm_block *facet, *cell;
    *repairs = (tm_polyhedra_repairs){0};
    tm_status status = join_polygons(&m);
    if (status == TM_OK)
        status = add_lists(&m, stream, ".facet", polygons, &facet);
    m.node = tm_stream_find(stream, ".node"); /* adding may move blocks */
    if (status == TM_OK)
        status = orient(&m, facet);
    if (status == TM_OK)
        status = add_lists(&m, stream, ".cell", polyhedra, &cell);
    return status;
}
