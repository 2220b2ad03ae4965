/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_stream.h"

#include "../../base/array.h"
#include "brick.h"
#include "octree_build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns of the integers of .octant and the reals of .root. */
enum { LEVEL, ANCHOR, FIRST = 4, PAST, OCTANT_COLUMNS };
enum { SIDE = 3, ROOT_COLUMNS };

/* The low corner of the root at that position in the brick. */
static void root_corner(const tm_octree *octree, const uint32_t position[3],
                        double low[3])
{
    for (int i = 0; i < 3; i++)
        low[i] = octree->low[i] + octree->side * (double)position[i];
}

static tm_status roots_to_stream(const tm_octree *octree, unsigned finest,
                                 tm_stream *stream, tm_error *error)
{
    tm_brick brick;
    tm_status status = tm_brick_of(&brick, octree, error);
    tm_block *block = status == TM_OK ? tm_stream_add(stream, ".root") : NULL;
    if (status == TM_OK)
        status = block ? tm_block_allocate(block, brick.count, 0, error)
                       : tm_fail_memory(error);
    for (size_t r = 0; r < brick.count && status == TM_OK; r++) {
        double *row = block->real + r * ROOT_COLUMNS;
        root_corner(octree, brick.root[r], row);
        row[SIDE] = octree->side;
        block->integer[r] = finest;
    }
    tm_brick_free(&brick);
    return status;
}

tm_status tm_octree_to_stream(const tm_octree *octree, unsigned finest,
                              const uint32_t *element, tm_stream *stream, tm_error *error)
{
    tm_status status = roots_to_stream(octree, finest, stream, error);
    if (status != TM_OK)
        return status;
    tm_block *block = tm_stream_add(stream, ".octant");
    if (!block)
        return tm_fail_memory(error);
    status = tm_block_allocate(block, octree->leaves, 0, error);
    for (size_t i = 0; i < octree->leaves && status == TM_OK; i++) {
        uint32_t *row = block->integer + i * OCTANT_COLUMNS;
        row[LEVEL] = octree->leaf[i].level;
        for (int k = 0; k < 3; k++)
            row[ANCHOR + k] = octree->leaf[i].anchor[k] >> (TM_OCTREE_FINEST - finest);
        row[FIRST] = element[i];
        row[PAST] = element[i + 1];
    }
    return status;
}

static tm_status wrong_root(size_t row, unsigned base, const char *what, tm_error *error)
{
    return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".root", "root %zu %s", row + base,
                      what);
}

/* Takes the position of a root in the brick. */
static tm_status take_position(const tm_octree *octree, const tm_block *block, size_t row,
                               unsigned base, uint8_t *taken, tm_error *error)
{
    const double *given = block->real + row * ROOT_COLUMNS;
    if (given[SIDE] != octree->side || block->integer[row] != block->integer[0])
        return wrong_root(row, base, "has another size or finest level than the first",
                          error);
    uint32_t position[3];
    double low[3];
    for (int i = 0; i < 3; i++) {
        const double steps = round((given[i] - octree->low[i]) / octree->side);
        if (!(steps < octree->roots[i]))
            return wrong_root(row, base, "is outside the brick that so many make", error);
        position[i] = (uint32_t)steps;
    }
    root_corner(octree, position, low);
    for (int i = 0; i < 3; i++)
        if (!(fabs(low[i] - given[i]) <= 1e-9 * octree->side))
            return wrong_root(row, base, "is not in line with the others", error);
    uint8_t *here =
        &taken[((size_t)position[2] * octree->roots[1] + position[1]) * octree->roots[0] +
               position[0]];
    if (*here)
        return wrong_root(row, base, "is there twice", error);
    *here = 1;
    return TM_OK;
}

/* The smallest and the largest corner of all roots. */
static tm_status span_roots(tm_octree *octree, const tm_block *block, tm_error *error)
{
    double far[3];
    for (int i = 0; i < 3; i++)
        octree->low[i] = far[i] = block->real[i];
    for (size_t r = 1; r < block->count; r++)
        for (int i = 0; i < 3; i++) {
            const double x = block->real[r * ROOT_COLUMNS + (size_t)i];
            octree->low[i] = fmin(octree->low[i], x);
            far[i] = fmax(far[i], x);
        }
    octree->side = block->real[SIDE];
    size_t count = 1;
    for (int i = 0; i < 3; i++) {
        const double along = round((far[i] - octree->low[i]) / octree->side) + 1;
        if (!(along >= 1) || along > TM_BRICK_ROOTS)
            return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".root",
                              "the roots are no brick (of at most %d along an axis)",
                              TM_BRICK_ROOTS);
        octree->roots[i] = (uint32_t)along;
        count *= octree->roots[i];
    }
    if (count != block->count)
        return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".root",
                          "%zu roots are no brick of %u × %u × %u", block->count,
                          octree->roots[0], octree->roots[1], octree->roots[2]);
    return TM_OK;
}

static tm_status read_roots(tm_octree *octree, const tm_block *block, unsigned base,
                            tm_error *error)
{
    if (block->count == 0 || !(block->real[SIDE] > 0))
        return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".root",
                          "there is no root with a size above 0");
    if (block->integer[0] > TM_OCTREE_LEVEL_MAX)
        return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".root",
                          "the finest level is %u (0..%d)", block->integer[0],
                          TM_OCTREE_LEVEL_MAX);
    tm_status status = span_roots(octree, block, error);
    if (status != TM_OK)
        return status;
    uint8_t *taken = calloc(block->count, 1);
    if (!taken)
        return tm_fail_memory(error);
    for (size_t r = 0; r < block->count && status == TM_OK; r++)
        status = take_position(octree, block, r, base, taken, error);
    free(taken);
    return status;
}

static tm_status read_octants(tm_leaf *leaf, const tm_octree *octree,
                              const tm_block *block, unsigned finest, unsigned base,
                              tm_error *error)
{
    const unsigned coarser = TM_OCTREE_FINEST - finest;
    for (size_t i = 0; i < block->count; i++) {
        const uint32_t *row = block->integer + i * OCTANT_COLUMNS;
        bool right = row[LEVEL] <= finest;
        for (int k = 0; k < 3; k++)
            right &= row[ANCHOR + k] < octree->roots[k] << finest;
        if (!right)
            return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".octant",
                              "octant %zu is deeper than the finest level of .root, or "
                              "outside the roots",
                              i + base);
        leaf[i] = (tm_leaf){.level = (uint8_t)row[LEVEL]};
        for (int k = 0; k < 3; k++)
            leaf[i].anchor[k] = row[ANCHOR + k] << coarser;
    }
    return TM_OK;
}

tm_status tm_octree_read_blocks(tm_octree *octree, const tm_stream *stream,
                                const tm_surface *surface, uint32_t **order,
                                tm_error *error)
{
    *octree = (tm_octree){.threads = surface ? surface->threads : 1};
    *order = NULL;
    const tm_block *root = tm_stream_find(stream, ".root");
    const tm_block *octant = tm_stream_find(stream, ".octant");
    if (!root || !octant)
        return tm_fail(error, TM_ERROR_INPUT,
                       "the stream has no octree (the blocks .root and .octant)");
    tm_leaf *leaf = tm_new(octant->count, sizeof *leaf);
    tm_status status =
        leaf ? read_roots(octree, root, stream->base, error) : tm_fail_memory(error);
    if (status == TM_OK)
        status =
            read_octants(leaf, octree, octant, root->integer[0], stream->base, error);
    if (status == TM_OK)
        status =
            tm_octree_from_leaves(octree, leaf, octant->count, surface, order, error);
    free(leaf);
    return status;
}
