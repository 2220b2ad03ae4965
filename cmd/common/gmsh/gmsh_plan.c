/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gmsh_groups.h"
#include "gmsh_write.h"

#include "../../../lib/base/array.h"
#include "../../../lib/mesh/cell_faces.h"
#include "../../../lib/number/number.h"

#include <stdlib.h>
#include <string.h>

/* Items ---------------------------------------------------------------------------- */

/* The marker or region of a row; 0 where it has none. */
static int32_t value_of(const tm_block *block, size_t row)
{
    int32_t value = 0;
    if (block->kind == TM_ELE || block->kind == TM_MIX)
        return tm_group_region(block, row, &value) ? value : 0;
    return block->marker ? block->marker[row] : 0;
}

/* The nodes of an item, and how many. */
static const uint32_t *nodes_of(const gmsh_item *item, size_t *count)
{
    *count = 1;
    return item->block->kind == TM_NODE ? &item->row
                                        : tm_row_nodes(item->block, item->row, count);
}

static bool is_too_large(const tm_block *block, size_t row)
{
    enum { MOST = 4 };
    return block->kind == TM_FACET && block->start[row + 1] - block->start[row] > MOST;
}

static void append(gmsh_plan *plan, int dimension, const tm_block *block, uint32_t row)
{
    const size_t i = plan->items[dimension]++;
    plan->item[dimension][i] = (gmsh_item){block, row, (uint32_t)i, 0};
}

/* Adds the rows of a block; `all`, or those with a marker. */
static tm_status add_rows(gmsh_plan *plan, int dimension, const char *name, bool all,
                          tm_error *error)
{
    const tm_block *block = tm_stream_find(plan->stream, name);
    if (!block)
        return TM_OK;
    const size_t before = plan->items[dimension];
    gmsh_item *item = plan->item[dimension];
    item = realloc(item, (before + block->count + 1) * sizeof *item);
    if (!item)
        return tm_fail_memory(error);
    plan->item[dimension] = item;
    for (size_t r = 0; r < block->count; r++) {
        if (!all && value_of(block, r) == 0)
            continue;
        if (is_too_large(block, r))
            plan->polygons++;
        else
            append(plan, dimension, block, (uint32_t)r);
    }
    return TM_OK;
}

static tm_status find_items(gmsh_plan *plan, tm_error *error)
{
    const tm_content content = tm_content_of(plan->stream);
    tm_status status = TM_OK;
    if (content == TM_CONTENT_TETRAHEDRA)
        status = add_rows(plan, GMSH_CELLS, ".ele", true, error);
    else if (content == TM_CONTENT_MIXED)
        status = add_rows(plan, GMSH_CELLS, ".mix", true, error);
    if (status == TM_OK)
        status =
            add_rows(plan, GMSH_FACES, ".face", content == TM_CONTENT_SURFACE, error);
    if (status == TM_OK && content == TM_CONTENT_MIXED)
        status = add_rows(plan, GMSH_FACES, ".facet", false, error);
    if (status == TM_OK)
        status = add_rows(plan, GMSH_LINES, ".edge", false, error);
    if (status == TM_OK && (plan->points || content == TM_CONTENT_POINTS))
        status =
            add_rows(plan, GMSH_POINTS, ".node", content == TM_CONTENT_POINTS, error);
    return status;
}

static tm_status count_unused(gmsh_plan *plan, tm_error *error)
{
    unsigned char *is_used = calloc(plan->node->count + 1, 1);
    if (!is_used)
        return tm_fail_memory(error);
    for (int d = 0; d < GMSH_DIMENSIONS; d++)
        for (size_t i = 0, count; i < plan->items[d]; i++) {
            const uint32_t *node = nodes_of(&plan->item[d][i], &count);
            for (size_t k = 0; k < count; k++)
                is_used[node[k]] = 1;
        }
    for (size_t v = 0; v < plan->node->count; v++)
        plan->unused += !is_used[v];
    free(is_used);
    return TM_OK;
}

/* Values --------------------------------------------------------------------------- */

static int compare_values(const void *a, const void *b)
{
    const int32_t p = ((const gmsh_value *)a)->value, q = ((const gmsh_value *)b)->value;
    return (p > q) - (p < q);
}

/* The distinct values of a dimension, ascending. */
static tm_status find_values(gmsh_plan *plan, int d, tm_error *error)
{
    gmsh_value *value = NULL;
    size_t count = 0, room = 0;
    for (size_t i = 0; i < plan->items[d]; i++) {
        const int32_t here = value_of(plan->item[d][i].block, plan->item[d][i].row);
        if (i > 0 && here == value[count - 1].value)
            continue;
        gmsh_value *moved = tm_grow(value, &room, count + 1, sizeof *value);
        if (!moved) {
            free(value);
            return tm_fail_memory(error);
        }
        value = moved;
        value[count++] = (gmsh_value){.value = here};
    }
    if (count > 0)
        qsort(value, count, sizeof *value, compare_values);
    plan->value[d] = value;
    for (size_t i = 0; i < count; i++)
        if (plan->values[d] == 0 || value[plan->values[d] - 1].value != value[i].value)
            value[plan->values[d]++] = value[i];
    return TM_OK;
}

static uint32_t group_of(const gmsh_plan *plan, int d, int32_t value)
{
    size_t lo = 0, hi = plan->values[d];
    while (lo + 1 < hi) {
        const size_t middle = (lo + hi) / 2;
        if (plan->value[d][middle].value <= value)
            lo = middle;
        else
            hi = middle;
    }
    return (uint32_t)lo;
}

/* Numbers of entities and groups are above 0: other values get those that are above all
 * that there are, also in .group. */
static void number_values(gmsh_plan *plan, int d)
{
    int32_t next = 1;
    for (size_t i = 0; i < plan->values[d]; i++)
        if (plan->value[d][i].value >= next && plan->value[d][i].value < INT32_MAX)
            next = plan->value[d][i].value + 1;
    for (size_t g = 0; plan->names && g < plan->names->count; g++) {
        const int32_t value = tm_group_value(plan->names, g);
        if ((int)tm_group_dimension_of(plan->names, g) == d && value >= next &&
            value < INT32_MAX)
            next = value + 1;
    }
    for (size_t i = 0; i < plan->values[d]; i++) {
        gmsh_value *value = &plan->value[d][i];
        const bool is_number = value->value > 0;
        value->number = is_number ? value->value : next++;
        plan->renumbered += value->value < 0;
    }
}

/* Groups --------------------------------------------------------------------------- */

/* The groups of a value: those that its name is made of, or the one with its number. */
static tm_status find_groups(gmsh_plan *plan, int d, gmsh_value *value, tm_error *error)
{
    const tm_group_dimension dimension = (tm_group_dimension)d;
    const char *name = tm_group_find(plan->names, dimension, value->value);
    if (name) {
        const tm_status status = tm_group_parts(plan->names, dimension, name,
                                                &value->group, &value->groups, error);
        if (status != TM_OK || (value->groups > 0 && value->group[0] > 0 &&
                                value->group[value->groups - 1] > 0))
            return status;
    }
    free(value->group);
    value->groups = 0;
    value->group = malloc(sizeof *value->group);
    if (!value->group)
        return tm_fail_memory(error);
    value->group[value->groups++] = value->number;
    return TM_OK;
}

/* ---------------------------------------------------------------------------------- */

/* Puts items in the order of their groups, and within one of how many nodes they have. */
static tm_status sort_items(gmsh_plan *plan, int d, tm_error *error)
{
    enum { KINDS = 9 };
    const size_t items = plan->items[d];
    size_t *start = calloc(plan->values[d] * KINDS + 2, sizeof *start);
    gmsh_item *sorted = tm_new(items, sizeof *sorted);
    if (!start || !sorted) {
        free(start);
        free(sorted);
        return tm_fail_memory(error);
    }
    for (size_t i = 0, count; i < items; i++) {
        gmsh_item *item = &plan->item[d][i];
        item->group = group_of(plan, d, value_of(item->block, item->row));
        nodes_of(item, &count);
        start[item->group * KINDS + count + 1]++;
    }
    for (size_t i = 0; i < plan->values[d] * KINDS; i++)
        start[i + 1] += start[i];
    for (size_t i = 0, count; i < items; i++) {
        const gmsh_item *item = &plan->item[d][i];
        nodes_of(item, &count);
        sorted[start[item->group * KINDS + count]++] = *item;
    }
    free(start);
    free(plan->item[d]);
    plan->item[d] = sorted;
    return TM_OK;
}

static tm_status plan_dimension(gmsh_plan *plan, int d, tm_error *error)
{
    tm_status status = find_values(plan, d, error);
    if (status != TM_OK)
        return status;
    number_values(plan, d);
    for (size_t i = 0; i < plan->values[d] && status == TM_OK; i++)
        status = find_groups(plan, d, &plan->value[d][i], error);
    return status == TM_OK ? sort_items(plan, d, error) : status;
}

tm_status gmsh_plan_make(gmsh_plan *plan, const tm_stream *stream, tm_error *error)
{
    plan->stream = stream;
    plan->node = tm_stream_find(stream, ".node");
    plan->names = tm_stream_find(stream, ".group");
    if (!plan->node)
        return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".node", "is not there");
    tm_status status = find_items(plan, error);
    if (status == TM_OK)
        status = count_unused(plan, error);
    for (int d = 0; d < GMSH_DIMENSIONS && status == TM_OK; d++)
        status = plan_dimension(plan, d, error);
    return status;
}

void gmsh_plan_free(gmsh_plan *plan)
{
    for (int d = 0; d < GMSH_DIMENSIONS; d++) {
        for (size_t i = 0; i < plan->values[d]; i++)
            free(plan->value[d][i].group);
        free(plan->value[d]);
        free(plan->item[d]);
    }
    *plan = (gmsh_plan){0};
}
