/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "boundary_cells.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>

enum { KEY_BITS = 21 };

typedef struct tm_boundary_cell {
    uint64_t key;
    uint32_t node;
} tm_boundary_cell;

static uint64_t key_of(int64_t x, int64_t y, int64_t z)
{
    return (uint64_t)x << 2 * KEY_BITS | (uint64_t)y << KEY_BITS | (uint64_t)z;
}

static int compare(const void *a, const void *b)
{
    const tm_boundary_cell *ca = a;
    const tm_boundary_cell *cb = b;
    if (ca->key != cb->key)
        return ca->key < cb->key ? -1 : 1;
    return (ca->node > cb->node) - (ca->node < cb->node);
}

tm_status tm_boundary_cells_sort(tm_boundary_cells *cells,
                                 const tm_interior_boundary *boundary, tm_error *error)
{
    const unsigned shift = boundary->finest - boundary->coarsest + 1;
    *cells = (tm_boundary_cells){.boundary = boundary, .shift = shift};
    cells->cell = tm_new(boundary->nodes, sizeof *cells->cell);
    if (!cells->cell)
        return tm_fail_memory(error);
    for (size_t s = 0; s < boundary->nodes; s++) {
        const uint32_t *grid = boundary->grid[s];
        cells->cell[s] = (tm_boundary_cell){
            key_of(grid[0] >> shift, grid[1] >> shift, grid[2] >> shift), (uint32_t)s};
    }
    if (boundary->nodes > 0)
        qsort(cells->cell, boundary->nodes, sizeof *cells->cell, compare);
    return TM_OK;
}

void tm_boundary_cells_free(tm_boundary_cells *cells)
{
    free(cells->cell);
    *cells = (tm_boundary_cells){0};
}

/* The first entry whose key is not below. */
static size_t lower_bound(const tm_boundary_cells *cells, uint64_t key)
{
    size_t begin = 0, end = cells->boundary->nodes;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (cells->cell[middle].key < key)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

void tm_boundary_cells_near(const tm_boundary_cells *cells, const double point[3],
                            void (*found)(void *context, uint32_t node), void *context)
{
    const tm_interior_boundary *boundary = cells->boundary;
    const double side =
        tm_boundary_unit(boundary) * (double)((uint64_t)1 << cells->shift);
    int64_t at[3];
    for (int i = 0; i < 3; i++)
        at[i] = (int64_t)floor((point[i] - boundary->low[i]) / side);
    for (int64_t x = at[0] - 1; x <= at[0] + 1; x++) {
        for (int64_t y = at[1] - 1; y <= at[1] + 1; y++) {
            for (int64_t z = at[2] - 1; z <= at[2] + 1; z++) {
                if (x < 0 || y < 0 || z < 0)
                    continue;
                const uint64_t key = key_of(x, y, z);
                for (size_t i = lower_bound(cells, key);
                     i < boundary->nodes && cells->cell[i].key == key; i++)
                    found(context, cells->cell[i].node);
            }
        }
    }
}

typedef struct {
    const tm_boundary_cells *cells;
    const double *point;
    tm_boundary_filter filter;
    uint32_t node;
    double distance2;
} nearest;

static void compare_nearest(void *context, uint32_t s)
{
    nearest *n = context;
    double xyz[3];
    if ((n->filter.taken && n->filter.taken[s]) ||
        (n->filter.set && n->filter.set[s] != n->filter.which))
        return;
    tm_boundary_node_point(n->cells->boundary, s, xyz);
    const double distance2 = tm_distance2(n->point, xyz);
    if (distance2 < n->distance2 || (distance2 == n->distance2 && s < n->node)) {
        n->node = s;
        n->distance2 = distance2;
    }
}

uint32_t tm_boundary_cells_nearest(const tm_boundary_cells *cells, const double point[3],
                                   tm_boundary_filter filter, double *distance2)
{
    nearest n = {cells, point, filter, TM_NONE, INFINITY};
    tm_boundary_cells_near(cells, point, compare_nearest, &n);
    *distance2 = n.distance2;
    return n.node;
}
