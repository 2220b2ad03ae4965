/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A flat triangle a b c with b between a and c stands for a node b in the edge of its
 * neighbour c a d. Flipping their edge a c to b d makes two triangles that both have an
 * area, where d is not on the line. */
#include "surface_parts.h"

#include "../base/array.h"
#include "../geom/vector.h"

#include <stdlib.h>
#include <string.h>

enum { FAN_MOST = 1000 };

/* Whether nodes b and d have an edge: the fan of b, from triangle t, both ways. */
static bool has_edge(const tm_surface *surface, uint32_t t, uint32_t b, uint32_t d)
{
    for (unsigned way = 1; way <= 2; way++) {
        uint32_t now = t;
        for (int steps = 0; steps < FAN_MOST; steps++) {
            const uint32_t *v = surface->triangle[now];
            unsigned i = v[0] == b ? 0 : v[1] == b ? 1 : 2;
            if (v[(i + 1) % 3] == d || v[(i + 2) % 3] == d)
                return true;
            now = surface->across[now][way == 1 ? i : (i + 2) % 3];
            if (now == TM_NONE || now == t)
                break;
        }
    }
    return false;
}

static unsigned longest_side(const tm_surface *surface, uint32_t t)
{
    const uint32_t *v = surface->triangle[t];
    unsigned best = 0;
    double longest = -1;
    for (unsigned i = 0; i < 3; i++) {
        double length2 = tm_distance2(surface->xyz[v[i]], surface->xyz[v[(i + 1) % 3]]);
        if (length2 > longest) {
            longest = length2;
            best = i;
        }
    }
    return best;
}

static void relink(tm_surface *surface, uint32_t n, uint32_t old, uint32_t new)
{
    if (n != TM_NONE)
        surface->across[n][tm_surface_side(surface, n, old)] = new;
}

/* t is c a b, flat, with the longest edge c a; n is a c d. They become d b c, d a b. */
static bool flip(tm_surface *surface, uint32_t t)
{
    unsigned i = longest_side(surface, t);
    uint32_t n = surface->across[t][i];
    if (n == TM_NONE)
        return false;
    unsigned k = tm_surface_side(surface, n, t);
    const uint32_t *v = surface->triangle[t];
    uint32_t c = v[i], a = v[(i + 1) % 3], b = v[(i + 2) % 3];
    uint32_t d = surface->triangle[n][(k + 2) % 3];
    if (d == b || surface->triangle[n][k] != a || has_edge(surface, t, b, d) ||
        tm_is_flat(surface->xyz[a], surface->xyz[b], surface->xyz[d]) ||
        tm_is_flat(surface->xyz[b], surface->xyz[c], surface->xyz[d]))
        return false;
    uint32_t ab = surface->across[t][(i + 1) % 3], bc = surface->across[t][(i + 2) % 3];
    uint32_t cd = surface->across[n][(k + 1) % 3], da = surface->across[n][(k + 2) % 3];
    const uint32_t first[3] = {d, b, c}, second[3] = {d, a, b};
    const uint32_t first_across[3] = {n, bc, cd}, second_across[3] = {da, ab, t};
    relink(surface, ab, t, n);
    relink(surface, cd, n, t);
    memcpy(surface->triangle[t], first, sizeof first);
    memcpy(surface->triangle[n], second, sizeof second);
    memcpy(surface->across[t], first_across, sizeof first_across);
    memcpy(surface->across[n], second_across, sizeof second_across);
    surface->facet[t] = surface->facet[n];
    if (surface->marker)
        surface->marker[t] = surface->marker[n];
    surface->flat++;
    return true;
}

/* A flat triangle may have to wait for the one beyond its longest edge: as long as one of
 * those that are left could be flipped, they are tried again. */
static void flip_listed(tm_surface *surface, uint32_t *list, size_t count)
{
    size_t before = count + 1;
    while (count < before) {
        before = count;
        count = 0;
        for (size_t i = 0; i < before; i++)
            if (!flip(surface, list[i]))
                list[count++] = list[i];
    }
}

tm_status tm_surface_mend(tm_surface *surface, tm_error *error)
{
    uint32_t *list = tm_new(surface->triangles, sizeof *list);
    size_t count = 0;
    if (!list)
        return tm_fail_memory(error);
    for (uint32_t t = 0; t < surface->triangles; t++) {
        const uint32_t *v = surface->triangle[t];
        if (tm_is_flat(surface->xyz[v[0]], surface->xyz[v[1]], surface->xyz[v[2]]))
            list[count++] = t;
    }
    flip_listed(surface, list, count);
    free(list);
    return TM_OK;
}
