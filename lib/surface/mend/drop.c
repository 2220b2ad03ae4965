/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles that are too many. */
#include "soup.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../base/hash.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* `within` is for those below that need it. */
typedef bool bad_triangle(const tm_soup *soup, const uint32_t v[3], double within);

static bool has_node_twice(const tm_soup *soup, const uint32_t v[3], double within)
{
    (void)soup;
    (void)within;
    return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
}

/* Whether a triangle is no higher, over its longest edge, than that. */
static bool is_flat(const tm_soup *soup, const uint32_t v[3], double within)
{
    double longest2 = 0;
    for (int i = 0; i < 3; i++)
        longest2 =
            fmax(longest2, tm_distance2(soup->xyz[v[i]], soup->xyz[v[(i + 1) % 3]]));
    return 2 * tm_triangle_area(soup->xyz[v[0]], soup->xyz[v[1]], soup->xyz[v[2]]) <=
           within * sqrt(longest2);
}

static tm_status drop_bad(tm_soup *soup, bad_triangle *is_bad, double within,
                          tm_mended *dropped, tm_error *error)
{
    bool *gone = calloc(soup->triangles + 1, sizeof *gone);
    if (!gone)
        return tm_fail_memory(error);
    for (size_t t = 0; t < soup->triangles; t++) {
        gone[t] = is_bad(soup, soup->triangle[t], within);
        if (gone[t])
            tm_mend_count(dropped, soup->xyz[soup->triangle[t][0]]);
    }
    tm_soup_drop(soup, gone, soup->triangles);
    free(gone);
    return TM_OK;
}

tm_status tm_soup_drop_degenerate(tm_soup *soup, tm_mended *dropped, tm_error *error)
{
    return drop_bad(soup, has_node_twice, 0, dropped, error);
}

tm_status tm_soup_drop_flat(tm_soup *soup, double within, tm_mended *dropped,
                            tm_error *error)
{
    return drop_bad(soup, is_flat, within, dropped, error);
}

bool tm_soup_has_flat(const tm_soup *soup, double within)
{
    for (size_t t = 0; t < soup->triangles; t++)
        if (is_flat(soup, soup->triangle[t], within))
            return true;
    return false;
}

/* Triangles with the same nodes have all edges in common, so also the first one's. */
bool tm_soup_has_doubles(const tm_soup *soup)
{
    enum { MANY = 16 };
    const tm_polygon_edges *edges = &soup->edges;
    for (size_t t = 0; t < soup->triangles; t++) {
        const size_t e = edges->edge_of[3 * t];
        const size_t first = edges->start[e], end = edges->start[e + 1];
        const uint32_t apex = soup->triangle[t][2];
        if (end - first > MANY)
            return true;
        for (size_t i = first; i < end; i++) {
            const uint32_t *v = soup->triangle[edges->polygon[i]];
            if (edges->polygon[i] != t && (v[0] == apex || v[1] == apex || v[2] == apex))
                return true;
        }
    }
    return false;
}

/* The nodes ascending; whether that turns the same way. */
static bool sorted(const uint32_t v[3], uint32_t to[3])
{
    bool even = true;
    memcpy(to, v, 3 * sizeof *to);
    for (int i = 0; i < 3; i++) {
        const int a = i % 2, b = a + 1;
        if (to[a] > to[b]) {
            const uint32_t swap = to[a];
            to[a] = to[b];
            to[b] = swap;
            even = !even;
        }
    }
    return even;
}

static uint32_t *find(const tm_soup *soup, const tm_hash_table *table,
                      const uint32_t *key)
{
    uint32_t other[3];
    uint32_t *slot =
        tm_hash_slot(table, tm_hash(tm_hash(tm_hash(0, key[0]), key[1]), key[2]));
    while (*slot != TM_HASH_FREE) {
        sorted(soup->triangle[*slot], other);
        if (memcmp(other, key, sizeof other) == 0)
            break;
        slot = tm_hash_next(table, slot);
    }
    return slot;
}

tm_status tm_soup_drop_doubles(tm_soup *soup, bool all, tm_mended *dropped,
                               tm_error *error)
{
    tm_hash_table table = {0};
    bool *gone = calloc(soup->triangles + 1, sizeof *gone);
    if (!gone || !tm_hash_make(&table, soup->triangles)) {
        free(gone);
        return tm_fail_memory(error);
    }
    for (uint32_t t = 0; t < soup->triangles; t++) {
        uint32_t key[3], other[3];
        const bool even = sorted(soup->triangle[t], key);
        uint32_t *slot = find(soup, &table, key);
        if (*slot == TM_HASH_FREE) {
            *slot = t;
            continue;
        }
        tm_mend_count(dropped, soup->xyz[key[0]]);
        gone[t] = true;
        if (all && sorted(soup->triangle[*slot], other) != even)
            gone[*slot] = true;
    }
    tm_soup_drop(soup, gone, soup->triangles);
    tm_hash_free(&table);
    free(gone);
    return TM_OK;
}

tm_status tm_soup_drop_islands(tm_soup *soup, double most, tm_mended *dropped,
                               tm_error *error)
{
    const tm_polygon_edges *edges = &soup->edges;
    uint32_t *set = tm_new(soup->triangles, sizeof *set);
    tm_soup_box *boxes = tm_new(soup->triangles, sizeof *boxes); /* at roots */
    bool *gone = calloc(soup->triangles + 1, sizeof *gone);
    if (!set || !boxes || !gone) {
        free(set);
        free(boxes);
        free(gone);
        return tm_fail_memory(error);
    }
    for (uint32_t t = 0; t < soup->triangles; t++) {
        set[t] = t;
        boxes[t] = (tm_soup_box)TM_SOUP_NO_BOX;
    }
    for (size_t e = 0; e < edges->edges; e++)
        for (size_t i = edges->start[e] + 1; i < edges->start[e + 1]; i++)
            tm_set_unite(set, edges->polygon[i], edges->polygon[i - 1]);
    for (uint32_t t = 0; t < soup->triangles; t++) {
        const uint32_t root = tm_set_root(set, t);
        for (int i = 0; i < 3; i++)
            tm_soup_put_in_box(&boxes[root], soup->xyz[soup->triangle[t][i]]);
    }
    for (uint32_t t = 0; t < soup->triangles; t++) {
        const uint32_t root = tm_set_root(set, t);
        gone[t] = tm_soup_box_diagonal(&boxes[root]) <= most;
        if (gone[t] && root == t)
            tm_mend_count(dropped, soup->xyz[soup->triangle[t][0]]);
    }
    tm_soup_drop(soup, gone, soup->triangles);
    free(set);
    free(boxes);
    free(gone);
    return TM_OK;
}
