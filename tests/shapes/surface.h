/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A triangle surface as it grows. What does not fit into memory ends the program. */
#ifndef TM_SHAPES_SURFACE_H
#define TM_SHAPES_SURFACE_H

#include <stddef.h>
#include <stdint.h>

typedef struct surface {
    size_t nodes, node_room;
    double (*xyz)[3];
    size_t triangles, triangle_room;
    uint32_t (*triangle)[3];
} surface;

/* Room for more than `count` items, in the block that `old` is. */
void *grow(void *old, size_t count, size_t *room, size_t size);

/* Returns its number. */
uint32_t add_node(surface *s, const double xyz[3]);

void add_triangle(surface *s, uint32_t a, uint32_t b, uint32_t c);

static const uint32_t absent = UINT32_MAX; /* no node yet */

/* So many of them. */
uint32_t *all_absent(size_t count);

#endif
