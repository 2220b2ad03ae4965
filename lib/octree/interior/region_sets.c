/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "region_sets.h"

#include "../../base/array.h"
#include "../../mesh/edge_map.h"

#include <stdlib.h>

/* A region that something has: a node, or an edge. */
typedef struct {
    uint64_t key;
    uint32_t region;
} member;

typedef struct {
    size_t count;
    member *member;
} member_list;

static int compare_members(const void *a, const void *b)
{
    const member *p = a, *q = b;
    if (p->key != q->key)
        return p->key < q->key ? -1 : 1;
    return (p->region > q->region) - (p->region < q->region);
}

static void sort_members(member_list *list)
{
    if (list->count > 0)
        qsort(list->member, list->count, sizeof *list->member, compare_members);
}

static void add_both(member_list *list, uint64_t key, const uint32_t region[2])
{
    for (int i = 0; i < 2; i++)
        list->member[list->count++] = (member){key, region[i]};
}

/* The set of what has a key, in a sorted list. */
static uint64_t set_of(const member_list *list, uint64_t key)
{
    size_t begin = 0, end = list->count;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (list->member[middle].key < key)
            begin = middle + 1;
        else
            end = middle;
    }
    uint64_t set = 0;
    for (size_t i = begin; i < list->count && list->member[i].key == key; i++)
        if (i == begin || list->member[i].region != list->member[i - 1].region)
            set ^= tm_region_number(list->member[i].region);
    return set;
}

static void find_nodes(member_list *list, const tm_interior_boundary *boundary,
                       uint64_t *node)
{
    list->count = 0;
    for (size_t f = 0; f < boundary->faces; f++)
        for (unsigned i = 0; i < tm_boundary_face_corners(boundary, f); i++)
            add_both(list, boundary->face[f][i], boundary->region[f]);
    sort_members(list);
    for (size_t s = 0; s < boundary->nodes; s++)
        node[s] = set_of(list, s);
}

static void list_nodes(member_list *list, const tm_surface *s)
{
    list->count = 0;
    for (size_t t = 0; t < s->triangles; t++)
        for (int i = 0; i < 3; i++)
            add_both(list, s->triangle[t][i], s->side[t]);
    sort_members(list);
}

static void find_corners(member_list *list, const tm_surface *s, uint64_t *corner)
{
    list_nodes(list, s);
    for (size_t c = 0; c < s->corners; c++)
        corner[c] = set_of(list, s->corner[c]);
}

/* The half edges where walls meet. */
static void list_edges(member_list *list, const tm_surface *s)
{
    list->count = 0;
    for (size_t t = 0; t < s->triangles; t++)
        for (int i = 0; i < 3; i++)
            if (s->across[t][i] == TM_NONE)
                add_both(list,
                         tm_edge_key(s->triangle[t][i], s->triangle[t][(i + 1) % 3]),
                         s->side[t]);
    sort_members(list);
}

/* Beside a curve that walls do not meet at there are those of its patches. */
static void find_curves(member_list *list, const tm_surface *s, uint64_t *patch,
                        uint64_t *curve)
{
    for (size_t t = 0; t < s->triangles; t++)
        patch[s->patch[t]] = tm_region_set_of_triangle(s, t);
    list_edges(list, s);
    for (size_t c = 0; c < s->curves; c++) {
        const uint32_t *node = s->curve_node + s->curve_start[c];
        curve[c] = tm_curve_is_of_walls(s, c)
                       ? set_of(list, tm_edge_key(node[0], node[1]))
                       : patch[s->curve_patch[c][0]];
    }
}

tm_status tm_region_sets_find(tm_region_sets *sets, const tm_interior_boundary *boundary,
                              const tm_surface *surface, tm_error *error)
{
    const size_t here = 2 * 4 * boundary->faces, there = 2 * 3 * surface->triangles;
    member_list list = {.member = tm_new(here > there ? here : there, sizeof(member))};
    uint64_t *patch = tm_new(surface->patches, sizeof *patch);
    *sets = (tm_region_sets){tm_new(boundary->nodes, sizeof *sets->node),
                             tm_new(surface->curves, sizeof *sets->curve),
                             tm_new(surface->corners, sizeof *sets->corner)};
    const bool done = list.member && patch && sets->node && sets->curve && sets->corner;
    if (done) {
        find_nodes(&list, boundary, sets->node);
        find_corners(&list, surface, sets->corner);
        find_curves(&list, surface, patch, sets->curve);
    }
    free(list.member);
    free(patch);
    return done ? TM_OK : tm_fail_memory(error);
}

void tm_region_sets_free(tm_region_sets *sets)
{
    free(sets->node);
    free(sets->curve);
    free(sets->corner);
    *sets = (tm_region_sets){0};
}

static int compare_sets(const void *a, const void *b)
{
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return (p > q) - (p < q);
}

/* Adds the sets of a sorted list. */
static void add_sets(tm_walls *walls, const member_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        if (i == 0 || list->member[i].key != list->member[i - 1].key)
            walls->set[walls->count++] = set_of(list, list->member[i].key);
}

static void keep_different(tm_walls *walls)
{
    size_t kept = 0;
    qsort(walls->set, walls->count, sizeof *walls->set, compare_sets);
    for (size_t i = 0; i < walls->count; i++)
        if (i == 0 || walls->set[i] != walls->set[kept - 1])
            walls->set[kept++] = walls->set[i];
    walls->count = kept;
}

tm_status tm_walls_find(tm_walls *walls, const tm_surface *surface, tm_error *error)
{
    const size_t corners = 3 * surface->triangles;
    member_list list = {.member = tm_new(2 * corners, sizeof(member))};
    *walls =
        (tm_walls){.set = tm_new(2 * corners + surface->triangles, sizeof(uint64_t))};
    const bool done = list.member && walls->set;
    if (done) {
        for (size_t t = 0; t < surface->triangles; t++)
            walls->set[walls->count++] = tm_region_set_of_triangle(surface, t);
        list_edges(&list, surface);
        add_sets(walls, &list);
        list_nodes(&list, surface);
        add_sets(walls, &list);
        keep_different(walls);
    }
    free(list.member);
    return done ? TM_OK : tm_fail_memory(error);
}

void tm_walls_free(tm_walls *walls)
{
    free(walls->set);
    *walls = (tm_walls){0};
}

bool tm_walls_have(const tm_walls *walls, uint64_t set)
{
    return bsearch(&set, walls->set, walls->count, sizeof set, compare_sets) != NULL;
}

uint64_t tm_region_set_between(const tm_interior_boundary *boundary, uint32_t s,
                               uint32_t t)
{
    enum { MOST = 8 }; /* octants around a node */
    uint32_t found[MOST];
    unsigned count = 0;
    uint64_t set = 0;
    for (size_t i = boundary->around_start[s]; i < boundary->around_start[s + 1]; i++) {
        const uint32_t f = boundary->around[i];
        bool has = false;
        for (unsigned c = 0; c < tm_boundary_face_corners(boundary, f); c++)
            has |= boundary->face[f][c] == t;
        for (int side = 0; has && side < 2; side++) {
            const uint32_t region = boundary->region[f][side];
            unsigned k = 0;
            while (k < count && found[k] != region)
                k++;
            if (k < count || count == MOST)
                continue;
            found[count++] = region;
            set ^= tm_region_number(region);
        }
    }
    return set;
}

uint64_t tm_region_set_of_triangle(const tm_surface *surface, size_t t)
{
    return tm_region_number(surface->side[t][0]) ^ tm_region_number(surface->side[t][1]);
}
