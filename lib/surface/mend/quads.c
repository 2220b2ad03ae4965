/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two triangles that are, together, the quadrilateral of two others with the other
 * diagonal: as where two bodies have a wall, each cut in its own way. */
#include "soup.h"

#include "../../base/array.h"
#include "../../base/hash.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    uint32_t node[4]; /* ascending */
    uint32_t triangle[2];
    bool even; /* whether it turns as its nodes do, from the least one on */
} quad;

/* The corner of triangle t that is neither a nor b. */
static uint32_t third(const uint32_t *t, uint32_t a, uint32_t b)
{
    for (int i = 0; i < 2; i++)
        if (t[i] != a && t[i] != b)
            return t[i];
    return t[2];
}

/* Whether two triangles at an edge are in one plane, to a hair, and on either side. */
static bool is_plane(const tm_soup *soup, uint32_t a, uint32_t b, uint32_t c, uint32_t d,
                     double within)
{
    const double(*xyz)[3] = soup->xyz;
    double n[3], m[3];
    tm_triangle_normal(n, xyz[a], xyz[b], xyz[c]);
    tm_triangle_normal(m, xyz[b], xyz[a], xyz[d]);
    const double area = tm_norm(n);
    double to[3];
    tm_subtract(to, xyz[d], xyz[a]);
    return tm_dot(n, m) > 0 && area > 0 && fabs(tm_dot(n, to)) <= within * area;
}

/* The quadrilateral of the two triangles of edge e. */
static bool take_quad(const tm_soup *soup, size_t e, double within, quad *q)
{
    const tm_polygon_edges *edges = &soup->edges;
    const size_t at = edges->start[e];
    if (edges->start[e + 1] - at != 2)
        return false;
    const uint32_t t = edges->polygon[at], u = edges->polygon[at + 1];
    const uint32_t *v = soup->triangle[t];
    unsigned i = 0;
    while (i < 2 && edges->edge_of[3 * (size_t)t + i] != e)
        i++;
    const uint32_t a = v[i], b = v[(i + 1) % 3], c = v[(i + 2) % 3];
    const uint32_t d = third(soup->triangle[u], a, b);
    if (c == d || !is_plane(soup, a, b, c, d, within))
        return false;
    const uint32_t around[4] = {a, d, b, c};
    unsigned least = 0;
    for (unsigned k = 1; k < 4; k++)
        if (around[k] < around[least])
            least = k;
    *q = (quad){.triangle = {t, u},
                .even = around[(least + 1) % 4] < around[(least + 3) % 4]};
    memcpy(q->node, around, sizeof around);
    qsort(q->node, 4, sizeof *q->node, tm_compare_numbers);
    return true;
}

static uint32_t *find(const quad *list, const tm_hash_table *table, const quad *q)
{
    uint64_t h = 0;
    for (int i = 0; i < 4; i++)
        h = tm_hash(h, q->node[i]);
    uint32_t *slot = tm_hash_slot(table, h);
    while (*slot != TM_HASH_FREE &&
           memcmp(list[*slot].node, q->node, sizeof q->node) != 0)
        slot = tm_hash_next(table, slot);
    return slot;
}

static void drop(const tm_soup *soup, const quad *q, bool *gone, tm_mended *dropped)
{
    for (int i = 0; i < 2; i++) {
        gone[q->triangle[i]] = true;
        tm_mend_count(dropped, soup->xyz[soup->triangle[q->triangle[i]][0]]);
    }
}

tm_status tm_soup_drop_quads(tm_soup *soup, double within, bool all, tm_mended *dropped,
                             tm_error *error)
{
    const size_t edges = soup->edges.edges;
    tm_hash_table table = {0};
    size_t count = 0;
    quad *list = tm_new(edges, sizeof *list);
    bool *gone = calloc(soup->triangles + 1, sizeof *gone);
    if (!list || !gone || !tm_hash_make(&table, edges)) {
        free(list);
        free(gone);
        return tm_fail_memory(error);
    }
    for (size_t e = 0; e < edges; e++) {
        quad *q = &list[count];
        if (!take_quad(soup, e, within, q))
            continue;
        uint32_t *slot = find(list, &table, q);
        if (*slot == TM_HASH_FREE) {
            *slot = (uint32_t)count++;
            continue;
        }
        const quad *first = &list[*slot];
        const bool late = q->triangle[0] > first->triangle[0];
        if (gone[q->triangle[0]] || gone[first->triangle[0]] ||
            q->triangle[0] == first->triangle[0])
            continue;
        drop(soup, late ? q : first, gone, dropped);
        if (all && q->even != first->even)
            drop(soup, late ? first : q, gone, dropped);
    }
    tm_soup_drop(soup, gone, soup->triangles);
    tm_hash_free(&table);
    free(list);
    free(gone);
    return TM_OK;
}
