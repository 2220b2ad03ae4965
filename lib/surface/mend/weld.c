/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "soup.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../geom/vector.h"
#include "../point_table.h"

#include <math.h>
#include <stdlib.h>

/* Gives triangles the nodes that theirs are one with, and counts those that were another
 * and are in a triangle. */
static tm_status rename_nodes(tm_soup *soup, uint32_t *same, tm_mended *welded,
                              tm_error *error)
{
    bool *done = calloc(soup->nodes + 1, sizeof *done);
    if (!done)
        return tm_fail_memory(error);
    for (size_t t = 0; t < soup->triangles; t++)
        for (int i = 0; i < 3; i++) {
            uint32_t *v = &soup->triangle[t][i];
            const uint32_t to = tm_set_root(same, *v);
            if (to != *v && !done[*v])
                tm_mend_count(welded, soup->xyz[*v]);
            done[*v] = true;
            *v = to;
        }
    free(done);
    return TM_OK;
}

/* Lists all nodes. */
static bool list_all(const tm_soup *soup, uint32_t **list, size_t *count)
{
    *list = tm_new(soup->nodes, sizeof **list);
    for (uint32_t v = 0; *list && v < soup->nodes; v++)
        (*list)[v] = v;
    *count = soup->nodes;
    return *list != NULL;
}

/* Which cells beside its own, by axis, what is near a place may be in. */
static void find_reach(const tm_near *near, const double place[3], double within,
                       int low[3], int high[3])
{
    for (int x = 0; x < 3; x++) {
        const double at = floor(place[x] / near->cell);
        low[x] = floor((place[x] - within) / near->cell) < at ? -1 : 0;
        high[x] = floor((place[x] + within) / near->cell) > at ? 1 : 0;
    }
}

/* Unites a node with those before it that are so close. */
static void unite_node(const tm_near *near, uint32_t node, double within, uint32_t *same)
{
    const double *place = near->xyz[node];
    int low[3], high[3], at[3];
    find_reach(near, place, within, low, high);
    for (at[0] = low[0]; at[0] <= high[0]; at[0]++)
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
            for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
                for (uint32_t v = tm_near_first(near, place, at); v != TM_NONE;
                     v = near->next[v])
                    if (v < node && tm_distance2(near->xyz[v], place) <= within * within)
                        tm_set_unite(same, v, node);
}

/* Unites nodes that are so close. Cells are of the size of edges, if that is more. */
static tm_status unite(const tm_soup *soup, double within, bool all, uint32_t *same,
                       tm_error *error)
{
    uint32_t *list;
    size_t count;
    tm_near near = {0};
    bool ok = (all ? list_all : tm_soup_open_nodes)(soup, &list, &count);
    const double cell = fmax(2 * within, soup->diagonal / sqrt((double)count + 1));
    ok = ok && tm_near_make(&near, soup->xyz, soup->nodes, list, count, cell);
    for (size_t i = 0; ok && i < count; i++)
        unite_node(&near, list[i], within, same);
    tm_near_free(&near);
    free(list);
    return ok ? TM_OK : tm_fail_memory(error);
}

tm_status tm_soup_weld(tm_soup *soup, double within, bool all, tm_mended *welded,
                       tm_error *error)
{
    size_t joined;
    uint32_t *same = tm_new(soup->nodes, sizeof *same);
    if (!same)
        return tm_fail_memory(error);
    for (uint32_t v = 0; v < soup->nodes; v++)
        same[v] = v;
    tm_status status = TM_OK;
    if (within > 0)
        status = unite(soup, within, all, same, error);
    else if (!tm_points_weld((double(*)[3])soup->xyz, soup->nodes, same, &joined))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = rename_nodes(soup, same, welded, error);
    free(same);
    return status;
}
