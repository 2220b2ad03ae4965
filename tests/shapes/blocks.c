/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "blocks.h"

#include <stdlib.h>

static unsigned region_of(const blocks *b, const size_t cell[3])
{
    for (int i = 0; i < 3; i++) {
        if (cell[i] >= b->grid.cells[i]) /* also below 0 */
            return 0;
    }
    return b->region == NULL ? 1 : b->region(&b->grid, cell);
}

static uint32_t node_at(blocks *b, const size_t line[3])
{
    const grid *g = &b->grid;
    const size_t x = g->wrapped ? line[0] % g->cells[0] : line[0];
    uint32_t *number =
        &b->number[(line[2] * (g->cells[1] + 1) + line[1]) * (g->cells[0] + 1) + x];
    if (*number == absent) {
        double at[3] = {(double)x / (double)g->cells[0],
                        (double)line[1] / (double)g->cells[1],
                        (double)line[2] / (double)g->cells[2]};
        b->place(g, at);
        *number = add_node(b->surface, at);
    }
    return *number;
}

static double distance2(const surface *s, uint32_t a, uint32_t b)
{
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += (s->xyz[a][i] - s->xyz[b][i]) * (s->xyz[a][i] - s->xyz[b][i]);
    return square;
}

/* The side of a cell in the direction of an axis, low or high, cut along its shorter
 * diagonal. */
static void add_side(blocks *b, const size_t cell[3], unsigned axis, unsigned high)
{
    static const unsigned char ring[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const double clearly = 0.999; /* rounding does not decide */
    uint32_t node[4];
    for (unsigned i = 0; i < 4; i++) {
        const unsigned char *corner = ring[high != 0 ? i : 3 - i];
        size_t line[3];
        line[axis] = cell[axis] + high;
        line[(axis + 1) % 3] = cell[(axis + 1) % 3] + corner[0];
        line[(axis + 2) % 3] = cell[(axis + 2) % 3] + corner[1];
        node[i] = node_at(b, line);
    }
    const unsigned first = distance2(b->surface, node[1], node[3]) <
                                   clearly * distance2(b->surface, node[0], node[2])
                               ? 1
                               : 0;
    add_triangle(b->surface, node[first], node[first + 1], node[first + 2]);
    add_triangle(b->surface, node[first], node[first + 2], node[(first + 3) % 4]);
}

void make_blocks(blocks *b)
{
    const size_t *n = b->grid.cells;
    b->number = all_absent((n[0] + 1) * (n[1] + 1) * (n[2] + 1));
    size_t cell[3];
    for (cell[2] = 0; cell[2] < n[2]; cell[2]++)
        for (cell[1] = 0; cell[1] < n[1]; cell[1]++)
            for (cell[0] = 0; cell[0] < n[0]; cell[0]++)
                for (unsigned side = 0; side < 6; side++) {
                    size_t next[3] = {cell[0], cell[1], cell[2]};
                    next[side / 2] += side % 2 != 0 ? 1 : SIZE_MAX;
                    if (b->grid.wrapped && side < 2)
                        next[0] = (next[0] + n[0]) % n[0];
                    if (region_of(b, next) < region_of(b, cell))
                        add_side(b, cell, side / 2, side % 2);
                }
    free(b->number);
}
