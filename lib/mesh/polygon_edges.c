/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The corners are sorted by the group, the lesser and the greater node of their sides:
 * by counting, the last key first (Knuth 1973, section 5.2.5). */
#include "polygon_edges.h"

#include "../base/array.h"

#include <stdlib.h>
#include <string.h>

typedef struct sides {
    size_t count;      /* corners */
    uint32_t *lesser;  /* [count] */
    uint32_t *greater; /* [count] */
    uint32_t *polygon; /* [count] */
    uint32_t *group;   /* [count], or NULL */
    size_t *order;     /* [count]: corners as they are sorted so far */
    size_t *other;     /* [count]: those to come */
    size_t *begin;     /* [keys + 1] */
} sides;

static void sides_free(sides *s)
{
    free(s->lesser);
    free(s->greater);
    free(s->polygon);
    free(s->group);
    free(s->order);
    free(s->other);
    free(s->begin);
}

static tm_status sides_make(sides *s, size_t polygons, const size_t *start,
                            const uint32_t *node, size_t keys, const uint32_t *group,
                            tm_error *error)
{
    *s = (sides){.count = start[polygons]};
    s->lesser = tm_new(s->count, sizeof *s->lesser);
    s->greater = tm_new(s->count, sizeof *s->greater);
    s->polygon = tm_new(s->count, sizeof *s->polygon);
    s->group = group ? tm_new(s->count, sizeof *s->group) : NULL;
    s->order = tm_new(s->count, sizeof *s->order);
    s->other = tm_new(s->count, sizeof *s->other);
    s->begin = tm_new(keys + 1, sizeof *s->begin);
    if (!s->lesser || !s->greater || !s->polygon || (group && !s->group) || !s->order ||
        !s->other || !s->begin)
        return tm_fail_memory(error);
    for (size_t p = 0; p < polygons; p++)
        for (size_t i = start[p]; i < start[p + 1]; i++) {
            uint32_t a = node[i], b = node[i + 1 < start[p + 1] ? i + 1 : start[p]];
            s->lesser[i] = a < b ? a : b;
            s->greater[i] = a < b ? b : a;
            s->polygon[i] = (uint32_t)p;
            if (group)
                s->group[i] = group[p];
            s->order[i] = i;
        }
    return TM_OK;
}

/* Sorts the corners by key[corner] < keys; those with the same one stay as they are. */
static void sort_by(sides *s, const uint32_t *key, size_t keys)
{
    memset(s->begin, 0, (keys + 1) * sizeof *s->begin);
    for (size_t i = 0; i < s->count; i++)
        s->begin[key[i] + 1]++;
    for (size_t k = 0; k < keys; k++)
        s->begin[k + 1] += s->begin[k];
    for (size_t i = 0; i < s->count; i++)
        s->other[s->begin[key[s->order[i]]]++] = s->order[i];
    size_t *sorted = s->other;
    s->other = s->order;
    s->order = sorted;
}

static bool same_edge(const sides *s, size_t i, size_t j)
{
    return s->lesser[i] == s->lesser[j] && s->greater[i] == s->greater[j] &&
           (!s->group || s->group[i] == s->group[j]);
}

/* The sorted corners, cut where an edge ends. */
static tm_status cut(tm_polygon_edges *edges, const sides *s, const uint32_t *node,
                     tm_error *error)
{
    edges->edge_of = tm_new(s->count, sizeof *edges->edge_of);
    edges->start = tm_new(s->count + 1, sizeof *edges->start);
    edges->polygon = tm_new(s->count, sizeof *edges->polygon);
    edges->ascending = tm_new(s->count, sizeof *edges->ascending);
    if (!edges->edge_of || !edges->start || !edges->polygon || !edges->ascending)
        return tm_fail_memory(error);
    for (size_t at = 0; at < s->count; at++) {
        size_t i = s->order[at];
        if (at == 0 || !same_edge(s, s->order[at - 1], i))
            edges->start[edges->edges++] = at;
        edges->edge_of[i] = edges->edges - 1;
        edges->polygon[at] = s->polygon[i];
        edges->ascending[at] = node[i] == s->lesser[i];
    }
    edges->start[edges->edges] = s->count;
    return TM_OK;
}

tm_status tm_polygon_edges_find(tm_polygon_edges *edges, size_t polygons,
                                const size_t *start, const uint32_t *node, size_t nodes,
                                const uint32_t *group, size_t groups, tm_error *error)
{
    *edges = (tm_polygon_edges){0};
    sides s;
    tm_status status = sides_make(&s, polygons, start, node,
                                  nodes > groups ? nodes : groups, group, error);
    if (status == TM_OK) {
        sort_by(&s, s.greater, nodes);
        sort_by(&s, s.lesser, nodes);
        if (group)
            sort_by(&s, s.group, groups);
        status = cut(edges, &s, node, error);
    }
    sides_free(&s);
    return status;
}

void tm_polygon_edges_free(tm_polygon_edges *edges)
{
    free(edges->edge_of);
    free(edges->start);
    free(edges->polygon);
    free(edges->ascending);
    *edges = (tm_polygon_edges){0};
}
