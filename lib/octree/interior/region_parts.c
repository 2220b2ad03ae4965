/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions get colours, so that those with a node in common have different ones. */
#include "region_leaves.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

enum { OCTANTS = 8 };

/* Two regions that have a node in common, the larger one first. */
typedef struct {
    uint32_t large, small;
} neighbours;

typedef struct {
    size_t count, room;
    neighbours *pair;
} neighbour_list;

static int compare_neighbours(const void *a, const void *b)
{
    const neighbours *p = a, *q = b;
    if (p->large != q->large)
        return p->large < q->large ? -1 : 1;
    return (p->small > q->small) - (p->small < q->small);
}

static bool add_neighbours(neighbour_list *list, uint32_t a, uint32_t b)
{
    const neighbours pair = {a > b ? a : b, a > b ? b : a};
    if (a == b || pair.small == 0 ||
        (list->count > 0 && compare_neighbours(&pair, &list->pair[list->count - 1]) == 0))
        return true;
    void *more = tm_grow(list->pair, &list->room, list->count + 1, sizeof *list->pair);
    if (!more)
        return false;
    list->pair = more;
    list->pair[list->count++] = pair;
    return true;
}

static bool find_neighbours(neighbour_list *list, const tm_interior *interior,
                            const tm_octree *octree)
{
    for (size_t n = 0; n < octree->nodes; n++)
        for (unsigned i = 0; i < OCTANTS; i++)
            for (unsigned j = 0; j < i; j++)
                if (!add_neighbours(list, interior->octant[n][i], interior->octant[n][j]))
                    return false;
    if (list->count > 0)
        qsort(list->pair, list->count, sizeof *list->pair, compare_neighbours);
    return true;
}

/* The colours of regions, which are as many as the result says. */
static size_t colour(const neighbour_list *list, size_t regions, uint32_t *of,
                     uint32_t *taken)
{
    size_t colours = 1, i = 0;
    for (uint32_t r = 1; r <= regions; r++) {
        for (; i < list->count && list->pair[i].large == r; i++)
            taken[of[list->pair[i].small]] = r;
        of[r] = 0;
        while (taken[of[r]] == r)
            of[r]++;
        if (of[r] >= colours)
            colours = of[r] + 1;
    }
    return colours;
}

static tm_status fill_parts(tm_interior *part, size_t parts, const tm_interior *whole,
                            const tm_octree *octree, const uint32_t *colour_of,
                            tm_error *error)
{
    for (size_t p = 0; p < parts; p++) {
        tm_interior *of = &part[p];
        of->chosen = calloc(octree->leaves + 1, sizeof *of->chosen);
        of->mask = calloc(octree->nodes + 1, sizeof *of->mask);
        of->used = tm_new(octree->nodes, sizeof *of->used);
        if (!of->chosen || !of->mask || !of->used)
            return tm_fail_memory(error);
        memcpy(of->used, whole->used, octree->nodes * sizeof *of->used);
        for (size_t l = 0; l < octree->leaves; l++) {
            const uint32_t label = whole->label[l];
            of->chosen[l] = label != 0 && colour_of[label] == p;
            of->count += of->chosen[l];
            for (int i = 0; of->chosen[l] && i < TM_LEAF_NODES; i++)
                if (octree->node[l][i] != TM_NONE)
                    of->mask[octree->node[l][i]] |= tm_point_octants[i];
        }
    }
    return TM_OK;
}

tm_status tm_interior_divide(tm_interior **part, size_t *parts, const tm_octree *octree,
                             size_t regions, tm_error *error)
{
    tm_interior whole = **part, *made = NULL;
    neighbour_list list = {0};
    size_t colours = 0;
    uint32_t *of = tm_new(regions + 1, sizeof *of);
    uint32_t *taken = calloc(regions + 2, sizeof *taken);
    bool ok = of && taken && find_neighbours(&list, &whole, octree);
    if (ok) {
        colours = colour(&list, regions, of, taken);
        made = calloc(colours, sizeof *made);
        ok = made != NULL;
    }
    tm_status status =
        ok ? fill_parts(made, colours, &whole, octree, of, error) : tm_fail_memory(error);
    if (made) {
        made->label = whole.label;
        made->octant = whole.octant;
        made->filled = whole.filled;
        made->removed = whole.removed;
        whole.label = NULL;
        whole.octant = NULL;
        tm_interior_free(&whole);
        free(*part);
        *part = made;
        *parts = colours;
    }
    free(list.pair);
    free(of);
    free(taken);
    return status;
}
