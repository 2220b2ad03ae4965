/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *grow(void *old, size_t count, size_t *room, size_t size)
{
    if (count < *room)
        return old;
    *room = 2 * count + 1024;
    void *new = realloc(old, *room * size);
    if (new == NULL) {
        fprintf(stderr, "shapes: not enough memory\n");
        exit(EXIT_FAILURE);
    }
    return new;
}

uint32_t add_node(surface *s, const double xyz[3])
{
    s->xyz = grow(s->xyz, s->nodes, &s->node_room, sizeof *s->xyz);
    memcpy(s->xyz[s->nodes], xyz, sizeof *s->xyz);
    return (uint32_t)s->nodes++;
}

void add_triangle(surface *s, uint32_t a, uint32_t b, uint32_t c)
{
    s->triangle = grow(s->triangle, s->triangles, &s->triangle_room, sizeof *s->triangle);
    const uint32_t triangle[3] = {a, b, c};
    memcpy(s->triangle[s->triangles++], triangle, sizeof triangle);
}

uint32_t *all_absent(size_t count)
{
    size_t room = 0;
    uint32_t *table = grow(NULL, count, &room, sizeof *table);
    memset(table, UCHAR_MAX, count * sizeof *table);
    return table;
}
