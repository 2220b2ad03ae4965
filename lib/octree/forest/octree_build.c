/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_build.h"

#include "../../base/array.h"
#include "octree_parts.h"
#include "brick.h"
#include "mpi_start.h"

#include <stdlib.h>

tm_octree tm_octree_on_brick(const tm_brick *brick, unsigned threads)
{
    return (tm_octree){.threads = threads,
                       .low = {brick->low[0], brick->low[1], brick->low[2]},
                       .side = brick->side,
                       .roots = {brick->roots[0], brick->roots[1], brick->roots[2]},
                       .finest = TM_OCTREE_FINEST};
}

/* The children of a leaf. */
static tm_status split_leaf(tm_leaf_list *out, const tm_octree *octree,
                            const tm_surface *surface, const tm_leaf *leaf,
                            tm_error *error)
{
    if (leaf->level >= TM_OCTREE_LEVEL_MAX)
        return tm_fail(error, TM_ERROR_INPUT,
                       "a leaf of level %d cannot be split (the deepest there is)",
                       TM_OCTREE_LEVEL_MAX);
    const unsigned level = leaf->level + 1U;
    tm_status status = TM_OK;
    for (unsigned c = 0; c < 8 && status == TM_OK; c++) {
        uint32_t child[3];
        double low[3], high[3];
        tm_octree_child(leaf->anchor, tm_leaf_shift(leaf), c, child);
        tm_octree_box(octree, child, tm_leaf_shift(leaf) - 1, low, high);
        const bool crossed = leaf->crossed && tm_surface_meets_box(surface, low, high);
        status = tm_leaf_list_add(out, child, level, crossed, error);
    }
    return status;
}

tm_status tm_octree_split_leaves(tm_leaf_list *out, const tm_octree *octree,
                                 const tm_surface *surface, const tm_leaf *leaf,
                                 size_t leaves, const uint8_t *split, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t i = 0; i < leaves && status == TM_OK; i++)
        status = split[i] ? split_leaf(out, octree, surface, &leaf[i], error)
                          : tm_leaf_list_add(out, leaf[i].anchor, leaf[i].level,
                                             leaf[i].crossed, error);
    return status;
}

/* Makes the octree of balanced leaves, in which only the brick is set yet. The list is
 * emptied. */
static tm_status finish(tm_octree *octree, tm_leaf_list *leaves, tm_error *error)
{
    octree->leaf = leaves->leaf;
    octree->leaves = leaves->count;
    *leaves = (tm_leaf_list){.count = 0};
    return tm_octree_number_nodes(octree, error);
}

/* Marks the listed leaves; says whether there are any. */
static tm_status mark(uint8_t *split, size_t leaves, const tm_octree_rule *rule,
                      tm_error *error)
{
    for (size_t i = 0; i < rule->leaves; i++) {
        if (rule->leaf[i] >= leaves)
            return tm_fail(error, TM_ERROR_INPUT,
                           "octant %u is not in the octree (0..%zu)", rule->leaf[i],
                           leaves - 1);
        split[rule->leaf[i]] = 1;
    }
    return TM_OK;
}

static bool has_list(const tm_octree_rule *rule, size_t rules)
{
    for (size_t r = 0; r < rules; r++)
        if (rule[r].kind == TM_RULE_LEAVES && rule[r].leaves > 0)
            return true;
    return false;
}

/* Replaces the listed leaves by their children. */
static tm_status split_listed(tm_leaf_list *leaves, const tm_octree *octree,
                              const tm_surface *surface, const tm_octree_rule *rule,
                              size_t rules, tm_error *error)
{
    uint8_t *split = calloc(leaves->count, 1);
    if (!split)
        return tm_fail_memory(error);
    tm_status status = TM_OK;
    for (size_t r = 0; r < rules && status == TM_OK; r++)
        if (rule[r].kind == TM_RULE_LEAVES)
            status = mark(split, leaves->count, &rule[r], error);
    tm_leaf_list now = {.count = 0};
    if (status == TM_OK)
        status = tm_octree_split_leaves(&now, octree, surface, leaves->leaf,
                                        leaves->count, split, error);
    free(split);
    free(leaves->leaf);
    *leaves = now;
    return status;
}

static tm_status build(tm_octree *octree, tm_leaf_list *leaves, const tm_surface *surface,
                       const tm_octree_rule *rule, size_t rules, tm_error *error)
{
    tm_status status =
        tm_octree_descend(leaves, octree, surface, rule, rules, false, error);
    if (status == TM_OK)
        status = tm_balance(leaves, octree, NULL, surface, error);
    if (status == TM_OK && has_list(rule, rules)) {
        status = split_listed(leaves, octree, surface, rule, rules, error);
        if (status == TM_OK)
            status = tm_balance(leaves, octree, NULL, surface, error);
    }
    if (status == TM_OK)
        status = finish(octree, leaves, error);
    return status;
}

tm_status tm_octree_build(tm_octree *octree, const tm_surface *surface,
                          const tm_octree_rule *rule, size_t rules, tm_error *error)
{
    *octree = (tm_octree){.leaves = 0};
    tm_status status = tm_mpi_start(error);
    if (status != TM_OK)
        return status;
    tm_brick brick;
    status = tm_brick_over(&brick, surface->low, surface->high,
                           tm_octree_least_size(rule, rules), error);
    tm_leaf_list leaves = {.count = 0};
    tm_octree_rule *levels = tm_new(rules, sizeof *levels);
    if (status == TM_OK)
        status = levels ? tm_octree_set_levels(rule, rules, brick.side, levels, error)
                        : tm_fail_memory(error);
    if (status == TM_OK) {
        *octree = tm_octree_on_brick(&brick, surface->threads);
        status = build(octree, &leaves, surface, levels, rules, error);
    }
    free(leaves.leaf);
    free(levels);
    tm_brick_free(&brick);
    if (status != TM_OK)
        tm_octree_free(octree);
    return status;
}

tm_status tm_octree_refine(tm_octree *octree, const tm_surface *surface,
                           const uint8_t *split, tm_error *error)
{
    tm_brick brick;
    tm_status status = tm_brick_of(&brick, octree, error);
    tm_octree now = tm_octree_on_brick(&brick, octree->threads);
    tm_leaf_list leaves = {.count = 0};
    if (status == TM_OK)
        status = tm_octree_split_leaves(&leaves, octree, surface, octree->leaf,
                                        octree->leaves, split, error);
    if (status == TM_OK)
        status = tm_balance(&leaves, octree, NULL, surface, error);
    if (status == TM_OK)
        status = finish(&now, &leaves, error);
    tm_brick_free(&brick);
    free(leaves.leaf);
    if (status != TM_OK) {
        tm_octree_free(&now);
        return status;
    }
    tm_octree_free(octree);
    *octree = now;
    return TM_OK;
}
