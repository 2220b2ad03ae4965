/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_defects.h"

#include "../base/array.h"
#include "../geom/predicates.h"
#include "point_table.h"

#include <stdlib.h>
#include <string.h>

enum { POLYGON_MIN = 3 };

typedef uint32_t edge[2]; /* smaller node first */

static int compare_edges(const void *a, const void *b)
{
    const uint32_t *p = a, *q = b;
    if (p[0] != q[0])
        return p[0] < q[0] ? -1 : 1;
    return (p[1] > q[1]) - (p[1] < q[1]);
}

static void count_unused(const tm_polygon_surface *surface, const uint32_t *unique,
                         bool *used, tm_surface_defects *defects)
{
    memset(used, 0, surface->nodes * sizeof *used);
    for (size_t i = 0; i < surface->corners; i++)
        used[unique[surface->item[i]]] = true;
    for (size_t v = 0; v < surface->nodes; v++)
        defects->unused_nodes += unique[v] == v && !used[v];
}

/* The edges of a polygon, without those between two corners at one point; sets *repeated
 * where there is such an edge. */
static size_t polygon_edges(const tm_polygon_surface *surface, size_t polygon,
                            const uint32_t *unique, edge *edges, bool *repeated)
{
    size_t first = surface->start[polygon], last = surface->start[polygon + 1], count = 0;
    for (size_t i = first; i < last; i++) {
        uint32_t a = unique[surface->item[i]];
        uint32_t b = unique[surface->item[i + 1 < last ? i + 1 : first]];
        if (a == b) {
            *repeated = true;
            continue;
        }
        edges[count][0] = a < b ? a : b;
        edges[count++][1] = a < b ? b : a;
    }
    return count;
}

static void count_edges(const tm_polygon_surface *surface, const uint32_t *unique,
                        edge *edges, tm_surface_defects *defects)
{
    size_t count = 0;
    for (size_t p = 0; p < surface->polygons; p++) {
        if (surface->start[p + 1] - surface->start[p] < POLYGON_MIN)
            continue;
        bool repeated = false;
        count += polygon_edges(surface, p, unique, edges + count, &repeated);
        defects->repeated_corners += repeated;
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0, next; i < count; i = next) {
        for (next = i + 1; next < count; next++)
            if (compare_edges(edges[i], edges[next]) != 0)
                break;
        if (next - i == 1 && defects->open_edges++ < TM_EDGES_LISTED)
            memcpy(defects->open_edge[defects->open_edges - 1], edges[i], sizeof *edges);
        defects->crowded_edges += next - i > 2;
        defects->odd_edges += next - i > 2 && (next - i) % 2 != 0;
    }
}

static double squared_distance(const double a[3], const double b[3])
{
    double x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
    return x * x + y * y + z * z;
}

/* Squared length of (b - a) × (c - a). */
static double squared_area(const double a[3], const double b[3], const double c[3])
{
    double p[3], q[3];
    for (int i = 0; i < 3; i++) {
        p[i] = b[i] - a[i];
        q[i] = c[i] - a[i];
    }
    double x = p[1] * q[2] - p[2] * q[1], y = p[2] * q[0] - p[0] * q[2];
    double z = p[0] * q[1] - p[1] * q[0];
    return x * x + y * y + z * z;
}

/* The farthest point from the first one, and the farthest from the line of both, span
 * the plane that all others must be in. Rounding may choose other points than the
 * farthest; the answer is wrong only where it takes a line for three such points. */
static bool is_flat(const tm_polygon_surface *surface)
{
    const double(*xyz)[3] = (const double(*)[3])surface->xyz;
    size_t b = 0, c = 0;
    if (surface->nodes == 0)
        return true;
    for (size_t v = 1; v < surface->nodes; v++)
        if (squared_distance(xyz[0], xyz[v]) > squared_distance(xyz[0], xyz[b]))
            b = v;
    for (size_t v = 1; v < surface->nodes; v++)
        if (squared_area(xyz[0], xyz[b], xyz[v]) > squared_area(xyz[0], xyz[b], xyz[c]))
            c = v;
    for (size_t v = 0; v < surface->nodes; v++)
        if (tm_orient3d(xyz[0], xyz[b], xyz[c], xyz[v]) != 0)
            return false;
    return true;
}

tm_status tm_surface_find_defects(const tm_polygon_surface *surface,
                                  tm_surface_defects *defects, tm_error *error)
{
    *defects = (tm_surface_defects){.flat = is_flat(surface)};
    uint32_t *unique = tm_new(surface->nodes, sizeof *unique);
    bool *used = tm_new(surface->nodes, sizeof *used);
    edge *edges = tm_new(surface->corners, sizeof *edges);
    bool done =
        unique && used && edges &&
        tm_points_weld(surface->xyz, surface->nodes, unique, &defects->duplicate_nodes);
    if (done) {
        count_unused(surface, unique, used, defects);
        count_edges(surface, unique, edges, defects);
    }
    free(unique);
    free(used);
    free(edges);
    return done ? TM_OK : tm_fail_memory(error);
}
