/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cheapest paths over the sides of a link (R. Bellman, 1958; L. R. Ford, 1956). */
#include "dual_link.h"

#include <math.h>

void tm_dual_ways_begin(tm_dual_way *way, const tm_dual_link *link)
{
    for (size_t v = 0; v < link->vertices; v++)
        way[v] =
            (tm_dual_way){HUGE_VAL, TM_NONE, 0, TM_NONE, true, !link->vertex[v].border};
}

double tm_dual_way_cost(const tm_dual_link *link, const double normal[3], uint32_t vertex)
{
    const double step = 0.05;
    return step + fabs(tm_dot(normal, link->vertex[vertex].to));
}

void tm_dual_ways_find(tm_dual_way *way, const tm_dual_link *link, const double normal[3])
{
    for (bool again = true; again;) {
        again = false;
        for (uint32_t a = 0; a < link->triangles; a++)
            for (int k = 0; k < 6; k++) {
                const tm_dual_link_triangle *here = &link->triangle[a];
                const int side = k / 2;
                const uint32_t from = here->vertex[(side + 1 + k % 2) % 3];
                const uint32_t to = here->vertex[(side + 2 - k % 2) % 3];
                if (here->beyond[side] == TM_NONE || !way[from].leaves || !way[to].enters)
                    continue;
                const double cost = way[from].cost + tm_dual_way_cost(link, normal, to);
                if (!(cost < way[to].cost))
                    continue;
                way[to].cost = cost;
                way[to].triangle = a;
                way[to].side = side;
                way[to].from = from;
                again = true;
            }
    }
}

void tm_dual_way_cut(const tm_dual_way *way, tm_dual_link *link, tm_dual *d, uint32_t end)
{
    for (; way[end].from != TM_NONE; end = way[end].from)
        tm_dual_link_cut(link, d, way[end].triangle, way[end].side);
}
