/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions of meshes whose octants are split: the new mesh knows those of the surface;
 * which numbers of the file these have, the old elements in the same octants say. */
#include "repair_steps.h"

#include "../../base/array.h"
#include "../../stream/stream.h"
#include "repair_shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a region's volume may be off, of what it was, where the surface says nothing. */
static const double volume_off = 0.01;

/* The number that a leaf of a region of the surface had. */
typedef struct {
    uint32_t region;
    double number;
} ballot;

static int compare_ballots(const void *a, const void *b)
{
    const ballot *p = a, *q = b;
    if (p->region != q->region)
        return p->region < q->region ? -1 : 1;
    return (p->number > q->number) - (p->number < q->number);
}

static int compare_regions(const void *a, const void *b)
{
    const tm_repair_region *p = a, *q = b;
    return (p->number > q->number) - (p->number < q->number);
}

static bool has_leaf(const tm_leaf *large, const tm_leaf *small)
{
    bool has = large->level <= small->level;
    for (int i = 0; i < 3; i++)
        has &=
            (large->anchor[i] ^ small->anchor[i]) >> (TM_OCTREE_FINEST - large->level) ==
            0;
    return has;
}

/* The number of each leaf of the old octree that has elements, NAN of others. */
static double *numbers_of_leaves(const tm_repair_state *from)
{
    const size_t leaves = from->octree.leaves;
    double *by_row = tm_new(leaves, sizeof *by_row);
    double *number = tm_new(leaves, sizeof *number);
    if (by_row && number) {
        for (size_t l = 0; l < leaves; l++)
            by_row[l] = NAN;
        for (size_t e = 0; e < from->mesh.elements; e++)
            if (from->octant[e] < leaves)
                by_row[from->octant[e]] = from->region[from->origin[e]];
        for (size_t l = 0; l < leaves; l++)
            number[l] = from->row[l] < leaves ? by_row[from->row[l]] : NAN;
        free(by_row);
        return number;
    }
    free(by_row);
    free(number);
    return NULL;
}

/* Ballots of the leaves of the new octree that have elements, sorted; malloc'ed. Leaves
 * of both octrees come in the same order. */
static ballot *collect(const tm_repair_state *to, const tm_repair_state *from,
                       const tm_octree_mesh *made, size_t *count)
{
    double *number = numbers_of_leaves(from);
    ballot *list = tm_new(to->octree.leaves, sizeof *list);
    size_t old = 0;
    *count = 0;
    for (size_t l = 0; number && list && l < to->octree.leaves; l++) {
        while (old + 1 < from->octree.leaves &&
               !has_leaf(&from->octree.leaf[old], &to->octree.leaf[l]))
            old++;
        if (made->assembly.first[l] < made->assembly.first[l + 1] && !isnan(number[old]))
            list[(*count)++] = (ballot){made->region[l], number[old]};
    }
    if (!number) {
        free(list);
        return NULL;
    }
    free(number);
    if (list)
        qsort(list, *count, sizeof *list, compare_ballots);
    return list;
}

static int compare_doubles(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* How many ballots there are for a number; `all` are the sorted numbers of all. */
static size_t count_ballots(const double *all, size_t count, double number)
{
    size_t end[2];
    for (int past = 0; past < 2; past++) {
        size_t low = 0, high = count;
        while (low < high) {
            const size_t middle = low + (high - low) / 2;
            if (all[middle] < number || (past && all[middle] == number))
                low = middle + 1;
            else
                high = middle;
        }
        end[past] = low;
    }
    return end[1] - end[0];
}

static size_t past_region(const ballot *list, size_t count, size_t first)
{
    size_t past = first;
    while (past < count && list[past].region == list[first].region)
        past++;
    return past;
}

/* Gives each region the number with which it has most in common (P. Jaccard's index: what
 * is in both over what is in either), as a large one has most of what is around a small
 * one that was too coarse. NAN stays where there are no ballots. */
static tm_status elect(const ballot *list, size_t count, double *number, tm_error *error)
{
    double *all = tm_new(count, sizeof *all);
    if (!all)
        return tm_fail_memory(error);
    for (size_t i = 0; i < count; i++)
        all[i] = list[i].number;
    qsort(all, count, sizeof *all, compare_doubles);
    for (size_t first = 0, past; first < count; first = past) {
        double most = 0;
        past = past_region(list, count, first);
        for (size_t i = first, next; i < past; i = next) {
            next = i;
            while (next < past && list[next].number == list[i].number)
                next++;
            const size_t either =
                past - first + count_ballots(all, count, list[i].number) - (next - i);
            const double common = (double)(next - i) / (double)either;
            if (common > most)
                number[list[i].region] = list[i].number;
            most = fmax(most, common);
        }
    }
    free(all);
    return TM_OK;
}

/* What the surface has of each number, in to->fill; regions without elements count for
 * none. */
static tm_status fill_table(tm_repair_state *to, const tm_surface *surface,
                            const double *number, size_t regions, tm_error *error)
{
    double *volume = tm_new(regions + 1, sizeof *volume);
    tm_repair_region *fill = tm_new(regions, sizeof *fill);
    size_t count = 0, kept = 0;
    to->fill = fill;
    tm_status status = volume && fill ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK && !surface->by_winding)
        status = tm_surface_region_volumes(surface, volume, error);
    for (size_t r = 1; status == TM_OK && r <= regions; r++)
        if (!isnan(number[r]))
            fill[count++] =
                (tm_repair_region){number[r], surface->by_winding ? NAN : volume[r]};
    free(volume);
    if (status != TM_OK)
        return status;
    qsort(fill, count, sizeof *fill, compare_regions);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || fill[i].number != fill[kept - 1].number)
            fill[kept++] = fill[i];
        else
            fill[kept - 1].volume += fill[i].volume;
    to->regions = kept;
    return TM_OK;
}

static size_t find_region(const tm_repair_state *state, double number)
{
    const tm_repair_region key = {.number = number};
    const tm_repair_region *found =
        bsearch(&key, state->fill, state->regions, sizeof *state->fill, compare_regions);
    return found ? (size_t)(found - state->fill) : state->regions;
}

static tm_status refuse(tm_error *error)
{
    return tm_fail(error, TM_ERROR_INPUT,
                   "regions would become others where octants are split");
}

/* The number of each element; all there were must be there still. */
static tm_status number_elements(tm_repair_state *to, const tm_repair_state *from,
                                 const tm_octree_mesh *made, const double *number,
                                 tm_error *error)
{
    for (size_t e = 0; e < from->mesh.elements; e++)
        if (find_region(to, from->region[from->origin[e]]) == to->regions)
            return refuse(error);
    to->region = tm_new(to->mesh.elements, sizeof *to->region);
    if (!to->region)
        return tm_fail_memory(error);
    for (size_t l = 0; l < to->octree.leaves; l++)
        for (uint32_t e = made->assembly.first[l]; e < made->assembly.first[l + 1]; e++) {
            to->region[e] = number[made->region[l]];
            if (isnan(to->region[e]))
                return refuse(error);
        }
    return TM_OK;
}

tm_status tm_repair_take_regions(tm_repair_state *to, const tm_repair_state *from,
                                 const tm_octree_mesh *made, const tm_surface *surface,
                                 tm_error *error)
{
    const size_t regions = surface->walls ? surface->cells : surface->components;
    size_t count = 0;
    if (!from->region)
        return TM_OK;
    if (!made->region)
        return refuse(error);
    double *number = tm_new(regions + 1, sizeof *number);
    ballot *list = number ? collect(to, from, made, &count) : NULL;
    tm_status status = list ? TM_OK : tm_fail_memory(error);
    for (size_t r = 0; number && r <= regions; r++)
        number[r] = NAN;
    if (status == TM_OK) {
        status = elect(list, count, number, error);
        if (status == TM_OK)
            status = fill_table(to, surface, number, regions, error);
    }
    if (status == TM_OK)
        status = number_elements(to, from, made, number, error);
    free(list);
    free(number);
    return status;
}

/* Elements by region. */
typedef struct {
    const tm_repair_state *state;
    size_t *start;     /* [regions + 1] */
    uint32_t *element; /* of region r: element[start[r]] … */
    uint32_t *local;   /* [nodes]: TM_NONE but while a region is picked */
} grouping;

static void end_grouping(grouping *g)
{
    free(g->start);
    free(g->element);
    free(g->local);
}

/* By the numbers that `table` has. */
static tm_status start_grouping(grouping *g, const tm_repair_state *state,
                                const tm_repair_state *table, tm_error *error)
{
    const size_t elements = state->mesh.elements;
    *g = (grouping){state, calloc(table->regions + 2, sizeof *g->start),
                    tm_new(elements, sizeof *g->element),
                    tm_new(state->mesh.nodes, sizeof *g->local)};
    if (!g->start || !g->element || !g->local)
        return tm_fail_memory(error);
    for (size_t v = 0; v < state->mesh.nodes; v++)
        g->local[v] = TM_NONE;
    size_t *end = g->start + 1;
    for (size_t e = 0; e < elements; e++)
        end[find_region(table, state->region[state->origin[e]]) + 1]++;
    for (size_t r = 0; r < table->regions; r++)
        end[r + 1] += end[r];
    for (uint32_t e = 0; e < elements; e++)
        g->element[end[find_region(table, state->region[state->origin[e]])]++] = e;
    return TM_OK;
}

/* The elements of one region as a mesh of their own; *part is to be freed. */
static tm_status pick(const grouping *g, size_t region, tm_repair_state *part,
                      tm_error *error)
{
    const tm_mixed_mesh *mesh = &g->state->mesh;
    const uint32_t *element = g->element + g->start[region];
    const size_t count = g->start[region + 1] - g->start[region];
    size_t items = 0;
    *part = (tm_repair_state){.mesh.elements = count};
    for (size_t i = 0; i < count; i++)
        items += mesh->start[element[i] + 1] - mesh->start[element[i]];
    part->mesh.nodes = items; /* room enough */
    const tm_status status = tm_repair_allocate(part, items, error);
    if (status != TM_OK)
        return status;
    items = part->mesh.nodes = 0;
    part->mesh.start[0] = 0;
    for (size_t i = 0; i < count; i++) {
        for (size_t j = mesh->start[element[i]]; j < mesh->start[element[i] + 1]; j++) {
            const uint32_t v = mesh->item[j];
            if (g->local[v] == TM_NONE) {
                const size_t n = part->mesh.nodes++;
                g->local[v] = (uint32_t)n;
                memcpy(part->mesh.xyz[n], mesh->xyz[v], sizeof *mesh->xyz);
                part->rule[n] = g->state->rule[v];
                part->on[n] = g->state->on[v];
            }
            part->mesh.item[items++] = g->local[v];
        }
        part->mesh.start[i + 1] = items;
    }
    for (size_t i = 0; i < count; i++)
        for (size_t j = mesh->start[element[i]]; j < mesh->start[element[i] + 1]; j++)
            g->local[mesh->item[j]] = TM_NONE;
    return TM_OK;
}

static tm_status measure(const grouping *g, size_t region, const tm_surface *surface,
                         tm_repair_shape *shape, tm_error *error)
{
    tm_repair_state part = {0};
    tm_status status = pick(g, region, &part, error);
    if (status == TM_OK)
        status = tm_repair_shape_measure(shape, &part, surface, error);
    tm_repair_state_free(&part);
    return status;
}

static bool keeps_volume(double is, double was, double volume)
{
    return isnan(volume) ? fabs(is - was) <= volume_off * fabs(was)
                         : tm_repair_volume_keeps(is, was, volume);
}

tm_status tm_repair_regions_keep(const tm_repair_state *a, const tm_repair_state *b,
                                 const tm_surface *surface, bool *keeps, tm_error *error)
{
    grouping now = {0}, old = {0};
    *keeps = true;
    if (!a->region)
        return TM_OK;
    tm_status status = start_grouping(&now, a, a, error);
    if (status == TM_OK)
        status = start_grouping(&old, b, a, error);
    for (size_t r = 0; status == TM_OK && *keeps && r < a->regions; r++) {
        tm_repair_shape is, was;
        status = measure(&now, r, surface, &is, error);
        if (status == TM_OK)
            status = measure(&old, r, surface, &was, error);
        *keeps = status == TM_OK && tm_repair_shape_keeps(&is, &was, surface) &&
                 keeps_volume(is.volume, was.volume, a->fill[r].volume);
    }
    end_grouping(&now);
    end_grouping(&old);
    return status;
}
