/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walls between regions. Each side of a triangle is on the border of one region: half 2 t
 * is that before triangle t, 2 t + 1 that behind it. About an edge the halves that face
 * each other are of one border; a border is one side of a piece of surface. That around a
 * region encloses a volume; others are around what is left out of it. */
#include "surface_parts.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../geom/vector.h"
#include "surface_tree.h"

#include <stdlib.h>
#include <string.h>

/* A half edge where walls meet. */
typedef struct wall_edge {
    uint32_t low, high, half;
} wall_edge;

typedef struct finder {
    tm_surface *surface;
    unsigned base;
    size_t edges;
    wall_edge *edge;
    uint32_t *border;       /* [2 * triangles]: disjoint sets of halves */
    uint32_t *piece;        /* [triangles]: disjoint sets of triangles */
    double *volume;         /* [2 * triangles], at roots of borders */
    uint32_t *region;       /* [2 * triangles], at roots: of the border */
    uint32_t *outer;        /* [cells + 1]: the border around a region */
    bool *empty;            /* [cells + 1]: a hole, and the outside */
    uint32_t within;        /* the border that a ray is asked about */
    size_t different_edges; /* those where walls meet */
} finder;

static int compare_edges(const void *a, const void *b)
{
    const wall_edge *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return (p->half > q->half) - (p->half < q->half);
}

static tm_status list_edges(finder *f, tm_error *error)
{
    const tm_surface *s = f->surface;
    for (int count = 1; count >= 0; count--) {
        f->edges = 0;
        for (uint32_t h = 0; h < 3 * s->triangles; h++) {
            const uint32_t *v = s->triangle[h / 3];
            const uint32_t a = v[h % 3], b = v[(h + 1 - h / 3 * 3) % 3];
            if (s->across[h / 3][h % 3] != TM_NONE)
                continue;
            if (!count)
                f->edge[f->edges] = (wall_edge){a < b ? a : b, a < b ? b : a, h};
            f->edges++;
        }
        if (count && !(f->edge = tm_new(f->edges, sizeof *f->edge)))
            return tm_fail_memory(error);
    }
    qsort(f->edge, f->edges, sizeof *f->edge, compare_edges);
    return TM_OK;
}

static tm_status fail_at(const finder *f, uint32_t t, const char *what, tm_error *error)
{
    const tm_surface *s = f->surface;
    const uint32_t *v = s->triangle[t];
    double middle[3];
    for (int i = 0; i < 3; i++)
        middle[i] = (s->xyz[v[0]][i] + s->xyz[v[1]][i] + s->xyz[v[2]][i]) / 3;
    return tm_fail(error, TM_ERROR_INPUT,
                   "walls inside the surface: %s facet %zu, near (%g, %g, %g)", what,
                   (size_t)s->facet[t] + f->base, middle[0], middle[1], middle[2]);
}

/* The half of a half edge's triangle that looks to larger angles (ahead), or back. */
static uint32_t half_towards(const tm_surface *surface, uint32_t half, uint32_t low,
                             bool ahead)
{
    const bool from_low = surface->triangle[half / 3][half % 3] == low;
    return 2 * (half / 3) + (from_low != ahead);
}

/* Joins what faces each other about one edge. */
static tm_status join_around(finder *f, const wall_edge *edge, size_t count,
                             tm_error *error)
{
    tm_around at[TM_WEDGES_MOST];
    const tm_surface *s = f->surface;
    if (count > TM_WEDGES_MOST)
        return fail_at(f, edge->half / 3, "too many meet in an edge of", error);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *v = s->triangle[edge[i].half / 3];
        if (tm_is_flat(s->xyz[v[0]], s->xyz[v[1]], s->xyz[v[2]]))
            return fail_at(f, edge[i].half / 3, "without an area is", error);
        at[i].half = edge[i].half;
        tm_set_unite(f->piece, edge->half / 3, edge[i].half / 3);
    }
    tm_surface_sort_around(s, edge->low, edge->high, at, count);
    for (size_t i = 0; i < count; i++)
        tm_set_unite(f->border, half_towards(s, at[i].half, edge->low, true),
                     half_towards(s, at[(i + 1) % count].half, edge->low, false));
    return TM_OK;
}

static tm_status join_borders(finder *f, tm_error *error)
{
    const tm_surface *s = f->surface;
    for (uint32_t t = 0; t < s->triangles; t++) {
        f->piece[t] = t;
        f->border[2 * t] = 2 * t;
        f->border[2 * t + 1] = 2 * t + 1;
    }
    for (uint32_t t = 0; t < s->triangles; t++)
        for (int i = 0; i < 3; i++) {
            const uint32_t n = s->across[t][i];
            if (n == TM_NONE)
                continue;
            tm_set_unite(f->piece, t, n);
            tm_set_unite(f->border, 2 * t, 2 * n);
            tm_set_unite(f->border, 2 * t + 1, 2 * n + 1);
        }
    for (size_t i = 0, next; i < f->edges; i = next) {
        for (next = i + 1; next < f->edges && f->edge[next].low == f->edge[i].low &&
                           f->edge[next].high == f->edge[i].high;)
            next++;
        f->different_edges++;
        const tm_status status = join_around(f, &f->edge[i], next - i, error);
        if (status != TM_OK)
            return status;
    }
    return TM_OK;
}

/* Pieces are numbered by their first triangles. */
static void number_pieces(finder *f)
{
    tm_surface *s = f->surface;
    s->components = 0;
    for (uint32_t t = 0; t < s->triangles; t++) {
        const uint32_t root = tm_set_root(f->piece, t);
        s->shell[t] = root == t ? (uint32_t)s->components++ : s->shell[root];
    }
    const size_t halves = 3 * s->triangles - f->edges;
    s->euler = (int64_t)s->nodes - (int64_t)(halves / 2 + f->different_edges) +
               (int64_t)s->triangles;
}

/* Numbers the borders that enclose a volume: so many regions there are. */
static void number_regions(finder *f)
{
    tm_surface *s = f->surface;
    for (uint32_t h = 0; h < 2 * s->triangles; h++) {
        const uint32_t *v = s->triangle[h / 2];
        const double volume = tm_tet_volume(s->xyz[s->triangle[0][0]], s->xyz[v[0]],
                                            s->xyz[v[1]], s->xyz[v[2]]);
        f->volume[tm_set_root(f->border, h)] += h % 2 ? volume : -volume;
    }
    for (uint32_t t = 0; t < s->triangles; t++)
        for (uint32_t behind = 2; behind-- > 0;) {
            const uint32_t root = tm_set_root(f->border, 2 * t + behind);
            if (f->region[root] != TM_NONE || !(f->volume[root] > 0))
                continue;
            f->region[root] = (uint32_t)++s->cells;
            f->outer[s->cells] = root;
        }
}

/* Whether a triangle is of a border on one side only. */
static uint64_t is_of_border(const tm_surface *surface, uint32_t t, const void *context)
{
    const finder *f = context;
    (void)surface;
    return (tm_set_root(f->border, 2 * t) == f->within) ^
           (tm_set_root(f->border, 2 * t + 1) == f->within);
}

/* The region around a piece of surface that t is of: the smallest that it is in. */
static uint32_t region_around(finder *f, uint32_t t)
{
    const tm_surface *s = f->surface;
    uint32_t best = 0;
    for (uint32_t r = 1; r <= s->cells && s->components > 1; r++) {
        f->within = f->outer[r];
        if (s->shell[f->within / 2] != s->shell[t] &&
            tm_surface_sum_along_ray(s, s->xyz[s->triangle[t][0]], s->shell[t],
                                     is_of_border, f) != 0 &&
            (best == 0 || f->volume[f->within] < f->volume[f->outer[best]]))
            best = r;
    }
    return best;
}

static tm_status find_sides(finder *f, tm_error *error)
{
    tm_surface *s = f->surface;
    for (uint32_t h = 0; h < 2 * s->triangles; h++) {
        const uint32_t root = tm_set_root(f->border, h);
        if (f->region[root] == TM_NONE)
            f->region[root] = region_around(f, h / 2);
        s->side[h / 2][h % 2] = f->region[root];
    }
    for (uint32_t t = 0; t < s->triangles; t++)
        if (s->side[t][0] == s->side[t][1])
            return fail_at(f, t, "the same region is on both sides of", error);
    return TM_OK;
}

/* Takes the regions that have a hole of the file away. */
static tm_status find_holes(finder *f, const tm_polygon_surface *polygons,
                            tm_error *error)
{
    tm_surface *s = f->surface;
    for (size_t h = 0; h < polygons->holes; h++)
        f->empty[tm_surface_region_at(s, polygons->hole[h])] = true;
    f->empty[0] = true;
    uint32_t kept = 0;
    for (uint32_t r = 0; r <= s->cells; r++)
        f->outer[r] = f->empty[r] ? 0 : ++kept;
    for (uint32_t t = 0; t < s->triangles; t++) {
        for (int i = 0; i < 2; i++)
            s->side[t][i] = f->outer[s->side[t][i]];
        if (s->side[t][0] == s->side[t][1])
            return fail_at(f, t, "there is no region on either side of", error);
    }
    s->cells = kept;
    return TM_OK;
}

static void turn(tm_surface *s)
{
    for (uint32_t t = 0; t < s->triangles; t++) {
        uint32_t *side = s->side[t];
        if (side[0] < side[1])
            continue;
        s->turned |= side[1] == 0;
        tm_surface_turn_triangle(s, t);
        const uint32_t before = side[0];
        side[0] = side[1];
        side[1] = before;
    }
    tm_surface_tree_refresh(s);
}

/* The place of a region among those that there are. */
static uint32_t region_at(const tm_surface *surface, const double point[3],
                          const void *context)
{
    (void)context;
    const uint32_t r = tm_surface_region_at(surface, point);
    return r == 0 ? TM_NONE : r - 1;
}

static tm_status find_walls(finder *f, const tm_polygon_surface *polygons,
                            tm_error *error)
{
    tm_status status = list_edges(f, error);
    if (status == TM_OK && f->surface->crossings > 0)
        status = tm_fail(error, TM_ERROR_INPUT, "walls inside the surface cross");
    if (status == TM_OK)
        status = join_borders(f, error);
    if (status != TM_OK)
        return status;
    number_pieces(f);
    number_regions(f);
    status = find_sides(f, error);
    if (status == TM_OK)
        status = find_holes(f, polygons, error);
    if (status != TM_OK)
        return status;
    turn(f->surface);
    f->surface->regions = true;
    return tm_surface_number_regions(f->surface, polygons, f->surface->cells, region_at,
                                     NULL, error);
}

tm_status tm_surface_find_walls(tm_surface *surface, const tm_polygon_surface *polygons,
                                tm_error *error)
{
    const size_t halves = 2 * surface->triangles;
    finder f = {.surface = surface,
                .base = polygons->base,
                .border = tm_new(halves, sizeof *f.border),
                .piece = tm_new(surface->triangles, sizeof *f.piece),
                .volume = calloc(halves + 1, sizeof *f.volume),
                .region = tm_new(halves, sizeof *f.region),
                .outer = calloc(halves + 1, sizeof *f.outer),
                .empty = calloc(halves + 1, sizeof *f.empty)};
    surface->side = tm_new(surface->triangles, sizeof *surface->side);
    const bool ok = f.border && f.piece && f.volume && f.region && f.outer && f.empty &&
                    surface->side;
    for (size_t h = 0; ok && h < halves; h++)
        f.region[h] = TM_NONE;
    const tm_status status = ok ? find_walls(&f, polygons, error) : tm_fail_memory(error);
    free(f.edge);
    free(f.border);
    free(f.piece);
    free(f.volume);
    free(f.region);
    free(f.outer);
    free(f.empty);
    return status;
}
