/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "brick.h"

#include "../../base/array.h"
#include "p4est_call.h"

#include <math.h>
#include <p8est_connectivity.h>
#include <stdlib.h>

/* Of the shortest side of the box; and how far beyond the box the roots reach, both sides
 * together, as a part of its side. */
static const double cube_of_shortest = 1.01;
static const double beyond = 1e-4;

/* p4est needs some hundred bytes for each. */
static const size_t roots_max = (size_t)1 << 20;

double tm_brick_side(const double low[3], const double high[3], double size)
{
    double extent[3];
    for (int i = 0; i < 3; i++)
        extent[i] = high[i] - low[i];
    const double shortest = fmin(extent[0], fmin(extent[1], extent[2]));
    const double longest = fmax(extent[0], fmax(extent[1], extent[2]));
    const double least =
        fmax(cube_of_shortest * shortest, (1 + 2 * beyond) * longest / TM_BRICK_LONGEST);
    if (!(size > 0) || !isfinite(least))
        return least;
    double side = size;
    while (side < least)
        side *= 2;
    return side;
}

static void make_trees(void *user)
{
    tm_brick *brick = user;
    brick->trees = p8est_connectivity_new_brick(
        (int)brick->roots[0], (int)brick->roots[1], (int)brick->roots[2], 0, 0, 0);
}

/* Of a brick with low, side and roots the rest. */
static tm_status fill(tm_brick *brick, tm_error *error)
{
    brick->count = (size_t)brick->roots[0] * brick->roots[1] * brick->roots[2];
    if (brick->count > roots_max)
        return tm_fail(error, TM_ERROR_INPUT, "%zu root cubes are too many (%zu)",
                       brick->count, roots_max);
    brick->root = tm_new(brick->count, sizeof *brick->root);
    const tm_status status =
        brick->root ? tm_p4est_call(make_trees, brick, error) : tm_fail_memory(error);
    /* The first vertex of a tree is its low corner. */
    for (size_t r = 0; r < brick->count && status == TM_OK; r++) {
        const size_t v = (size_t)brick->trees->tree_to_vertex[P8EST_CHILDREN * r];
        for (size_t i = 0; i < 3; i++)
            brick->root[r][i] = (uint32_t)brick->trees->vertices[3 * v + i];
    }
    return status;
}

/* How far below the middle of the roots the box is, where octants are of a size. A thin
 * box is to be in the middle of them. Faces of others may be in one plane with centres,
 * of which rounding would say whether they are inside: then half an octant, and one more
 * root where the roots would end with the box. */
static double beside_middle(tm_brick *brick, int i, double extent, double size)
{
    const double tie = 1e-6;
    if (brick->side > size && (1 + beyond) * extent < size)
        return size / 2;
    const double margin = (brick->roots[i] * brick->side - extent) / (2 * size);
    if (fabs(margin - floor(margin) - 0.5) > tie)
        return 0;
    const bool ends = margin < 1;
    brick->roots[i] += ends;
    return size / 2 - (ends ? brick->side / 2 : 0);
}

tm_status tm_brick_over(tm_brick *brick, const double low[3], const double high[3],
                        double size, tm_error *error)
{
    *brick = (tm_brick){.side = 0};
    double extent[3];
    for (int i = 0; i < 3; i++)
        extent[i] = high[i] - low[i];
    brick->side = tm_brick_side(low, high, size);
    if (!(brick->side > 0) || !isfinite(brick->side))
        return tm_fail(error, TM_ERROR_INPUT, "the surface has no extent");
    for (int i = 0; i < 3; i++) {
        const double count = ceil((1 + beyond) * extent[i] / brick->side);
        brick->roots[i] = count < 1 ? 1 : (uint32_t)count;
        const double beside = size > 0 ? beside_middle(brick, i, extent[i], size) : 0;
        const double across = brick->roots[i] * brick->side;
        brick->low[i] = low[i] + extent[i] / 2 - across / 2 - beside;
        if (!(brick->low[i] < low[i]) || !(brick->low[i] + across > high[i]))
            return tm_fail(error, TM_ERROR_INPUT,
                           "the surface is too far from the origin for its size");
    }
    return fill(brick, error);
}

tm_status tm_brick_of(tm_brick *brick, const tm_octree *octree, tm_error *error)
{
    *brick = (tm_brick){.low = {octree->low[0], octree->low[1], octree->low[2]},
                        .side = octree->side,
                        .roots = {octree->roots[0], octree->roots[1], octree->roots[2]}};
    return fill(brick, error);
}

void tm_brick_free(tm_brick *brick)
{
    free(brick->root);
    if (brick->trees)
        p8est_connectivity_destroy(brick->trees);
    *brick = (tm_brick){.side = 0};
}
