/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sharp edges, the curves and corners that they make, and the patches between them. */
#include "surface_loose.h"
#include "surface_parts.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* The angles of the triangles around the tip of a cone make less than this: that of one
 * that opens by 39°. */
static const double sharp_corner_angle = 120;

/* A triangle whose height is less than this part of the surface has no normal of its own:
 * coordinates of six digits, or of 32 bits, do not say which it is. */
static const double least_height = 1e-6;

typedef struct feature_finder {
    tm_surface *surface;
    double (*normal)[3];
    double most_cosine; /* of the feature angle */
    size_t edges;
    tm_sharp_edge *edge;
    size_t *start; /* [nodes + 1]: sharp edges at v are at[start[v] … start[v + 1]) */
    uint32_t *at;
    bool *rough;      /* [nodes], or NULL: no edge there is sharp by its angle */
    bool *corner;     /* [nodes] */
    bool *done;       /* [edges] */
    uint32_t *parent; /* [triangles]: sets of those in one patch */
} feature_finder;

bool tm_surface_own_normal(const tm_surface *surface, uint32_t t, double normal[3])
{
    const double *p[3];
    double longest2 = 0;
    for (int i = 0; i < 3; i++)
        p[i] = surface->xyz[surface->triangle[t][i]];
    for (int i = 0; i < 3; i++)
        longest2 = fmax(longest2, tm_distance2(p[i], p[(i + 1) % 3]));
    tm_triangle_normal(normal, p[0], p[1], p[2]);
    double length = tm_norm(normal);
    double size = sqrt(tm_distance2(surface->low, surface->high));
    if (!(length > least_height * size * sqrt(longest2)))
        return false;
    for (int i = 0; i < 3; i++)
        normal[i] /= length;
    return true;
}

/* The triangle beyond the longest edge of t, which has most of the surface that is
 * there. */
static uint32_t beyond_longest(const tm_surface *surface, uint32_t t)
{
    uint32_t best = TM_NONE;
    double longest = -1;
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t *v = surface->triangle[t];
        double length2 = tm_distance2(surface->xyz[v[i]], surface->xyz[v[(i + 1) % 3]]);
        if (length2 > longest) {
            longest = length2;
            best = surface->across[t][i];
        }
    }
    return best;
}

static void find_normals(feature_finder *f)
{
    const int steps_most = 16;
    for (size_t t = 0; t < f->surface->triangles; t++) {
        uint32_t from = (uint32_t)t;
        bool found = false;
        for (int i = 0; i < steps_most && from != TM_NONE && !found; i++) {
            found = tm_surface_own_normal(f->surface, from, f->normal[t]);
            if (!found)
                from = beyond_longest(f->surface, from);
        }
        if (!found)
            memset(f->normal[t], 0, sizeof *f->normal);
    }
}

/* Whether the normals differ; those that are zero are at no angle to anything. */
static bool bends(const feature_finder *f, uint32_t t, uint32_t n)
{
    if (n == TM_NONE)
        return true;
    const double *a = f->normal[t], *b = f->normal[n];
    if (tm_norm2(a) == 0 || tm_norm2(b) == 0)
        return false;
    return tm_dot(a, b) < f->most_cosine;
}

/* Whether the edge from corner i of t is sharp: an open one is, and where two groups of
 * the surface meet there is an edge, too, that has to stay. */
static bool is_sharp(const feature_finder *f, uint32_t t, unsigned i)
{
    const uint32_t n = f->surface->across[t][i];
    const int32_t *marker = f->surface->marker;
    if (n == TM_NONE || (marker && marker[t] != marker[n]))
        return true;
    return bends(f, t, n) && !(f->rough && f->rough[f->surface->triangle[t][i]]);
}

static int compare_edges(const void *a, const void *b)
{
    const tm_sharp_edge *p = a, *q = b;
    for (int i = 0; i < 2; i++)
        if (p->node[i] != q->node[i])
            return p->node[i] < q->node[i] ? -1 : 1;
    return (p->triangle[0] > q->triangle[0]) - (p->triangle[0] < q->triangle[0]);
}

/* Lists sharp edges (each from its triangle with the smaller number) and joins the
 * triangles beside the others in `parent`. Returns how many; counts only for edge NULL.
 */
static size_t list_edges(const feature_finder *f, tm_sharp_edge *edge, uint32_t *parent)
{
    const tm_surface *surface = f->surface;
    size_t count = 0;
    for (uint32_t t = 0; t < surface->triangles; t++)
        for (unsigned i = 0; i < 3; i++) {
            uint32_t n = surface->across[t][i];
            if (n != TM_NONE && n < t)
                continue;
            if (!is_sharp(f, t, i)) {
                tm_set_unite(parent, t, n);
                continue;
            }
            uint32_t p = surface->triangle[t][i], q = surface->triangle[t][(i + 1) % 3];
            if (edge)
                edge[count] = (tm_sharp_edge){{p < q ? p : q, p < q ? q : p}, {t, n}};
            count++;
        }
    return count;
}

/* Where solids touch in an edge it is listed for each of them. */
static void unite_edges(feature_finder *f)
{
    size_t kept = 0;
    if (f->edges == 0)
        return;
    qsort(f->edge, f->edges, sizeof *f->edge, compare_edges);
    for (size_t e = 0; e < f->edges; e++)
        if (kept == 0 ||
            memcmp(f->edge[kept - 1].node, f->edge[e].node, sizeof f->edge->node) != 0)
            f->edge[kept++] = f->edge[e];
    f->edges = kept;
}

/* Patches are numbered by their first triangles. */
static tm_status number_patches(tm_surface *surface, uint32_t *parent, tm_error *error)
{
    surface->patch = tm_new(surface->triangles, sizeof *surface->patch);
    if (!surface->patch)
        return tm_fail_memory(error);
    for (uint32_t t = 0; t < surface->triangles; t++) {
        uint32_t root = tm_set_root(parent, t);
        surface->patch[t] =
            root == t ? (uint32_t)surface->patches++ : surface->patch[root];
    }
    return TM_OK;
}

static tm_status find_edges(feature_finder *f, tm_error *error)
{
    tm_surface *surface = f->surface;
    f->parent = tm_new(surface->triangles, sizeof *f->parent);
    if (!f->parent)
        return tm_fail_memory(error);
    for (uint32_t t = 0; t < surface->triangles; t++)
        f->parent[t] = t;
    f->edges = list_edges(f, NULL, f->parent);
    f->edge = tm_new(f->edges, sizeof *f->edge);
    if (!f->edge)
        return tm_fail_memory(error);
    list_edges(f, f->edge, f->parent);
    unite_edges(f);
    return TM_OK;
}

static tm_status attach_edges(feature_finder *f, tm_error *error)
{
    size_t nodes = f->surface->nodes;
    f->start = calloc(nodes + 2, sizeof *f->start);
    f->at = tm_new(2 * f->edges, sizeof *f->at);
    if (!f->start || !f->at)
        return tm_fail_memory(error);
    for (size_t i = 0; i < 2 * f->edges; i++)
        f->start[f->edge[i / 2].node[i % 2] + 2]++;
    for (size_t v = 1; v <= nodes; v++)
        f->start[v + 1] += f->start[v];
    for (size_t i = 0; i < 2 * f->edges; i++)
        f->at[f->start[f->edge[i / 2].node[i % 2] + 1]++] = (uint32_t)(i / 2);
    return TM_OK;
}

/* Takes the dropped ones out: the patches beside them are one. */
static void take_out(feature_finder *f, const bool *dropped)
{
    size_t kept = 0;
    for (size_t e = 0; e < f->edges; e++) {
        if (dropped[e])
            tm_set_unite(f->parent, f->edge[e].triangle[0], f->edge[e].triangle[1]);
        else
            f->edge[kept++] = f->edge[e];
    }
    f->edges = kept;
}

static tm_status drop_short(feature_finder *f, double least, tm_error *error)
{
    const tm_sharp_network network = {f->surface, f->edges, f->edge, f->start, f->at};
    bool *dropped = calloc(f->edges + 1, sizeof *dropped);
    if (!dropped)
        return tm_fail_memory(error);
    tm_status status =
        tm_surface_find_loose(&network, least, dropped, &f->surface->rough, error);
    if (status == TM_OK) {
        take_out(f, dropped);
        free(f->start);
        free(f->at);
        f->start = NULL;
        f->at = NULL;
        status = attach_edges(f, error);
    }
    free(dropped);
    return status;
}

static size_t degree(const feature_finder *f, uint32_t v)
{
    return f->start[v + 1] - f->start[v];
}

static uint32_t other_end(const feature_finder *f, uint32_t e, uint32_t v)
{
    return f->edge[e].node[f->edge[e].node[0] == v];
}

/* The unit vector from a to b. */
static void direction(const tm_surface *surface, uint32_t a, uint32_t b, double unit[3])
{
    tm_subtract(unit, surface->xyz[b], surface->xyz[a]);
    double length = tm_norm(unit);
    for (int i = 0; i < 3; i++)
        unit[i] /= length;
}

/* The two neighbours on the curve through a node with two sharp edges. */
static void neighbours(const feature_finder *f, uint32_t v, uint32_t ends[2])
{
    for (size_t i = 0; i < 2; i++)
        ends[i] = other_end(f, f->at[f->start[v] + i], v);
}

static bool turns(const feature_finder *f, uint32_t v)
{
    uint32_t ends[2];
    double in[3], out[3];
    if (f->rough && f->rough[v])
        return false;
    neighbours(f, v, ends);
    direction(f->surface, ends[0], v, in);
    direction(f->surface, v, ends[1], out);
    return tm_dot(in, out) < f->most_cosine;
}

/* Whether the next node of the curve, `next`, takes the turn at v back: it turns, too,
 * and the direction after it is that before v. */
static bool is_taken_back(const feature_finder *f, uint32_t v, uint32_t before,
                          uint32_t next)
{
    if (degree(f, next) != 2 || !turns(f, next))
        return false;
    uint32_t ends[2];
    double in[3], out[3];
    neighbours(f, next, ends);
    direction(f->surface, before, v, in);
    direction(f->surface, next, ends[0] == v ? ends[1] : ends[0], out);
    return tm_dot(in, out) >= f->most_cosine;
}

static bool is_corner(const feature_finder *f, uint32_t v)
{
    if (degree(f, v) == 0)
        return false;
    if (degree(f, v) != 2)
        return true;
    if (!turns(f, v))
        return false;
    uint32_t ends[2];
    neighbours(f, v, ends);
    return !is_taken_back(f, v, ends[0], ends[1]) &&
           !is_taken_back(f, v, ends[1], ends[0]);
}

/* Adds the angle of every triangle to its corners' sums: degrees; and a full angle to the
 * ends of open edges, which have less anyway. */
static void add_angles(const tm_surface *surface, double *sum)
{
    const double degrees = 180 / pi, full = 360;
    for (size_t t = 0; t < surface->triangles; t++)
        for (int i = 0; i < 3; i++) {
            const uint32_t *v = surface->triangle[t];
            double a[3], b[3], cross[3];
            tm_subtract(a, surface->xyz[v[(i + 1) % 3]], surface->xyz[v[i]]);
            tm_subtract(b, surface->xyz[v[(i + 2) % 3]], surface->xyz[v[i]]);
            tm_cross(cross, a, b);
            sum[v[i]] += atan2(tm_norm(cross), tm_dot(a, b)) * degrees;
            if (surface->across[t][i] == TM_NONE) {
                sum[v[i]] += full;
                sum[v[(i + 1) % 3]] += full;
            }
        }
}

static tm_status find_corners(feature_finder *f, tm_error *error)
{
    tm_surface *surface = f->surface;
    double *sum = calloc(surface->nodes + 1, sizeof *sum);
    f->corner = calloc(surface->nodes + 1, sizeof *f->corner);
    f->done = calloc(f->edges + 1, sizeof *f->done);
    if (!sum || !f->corner || !f->done) {
        free(sum);
        return tm_fail_memory(error);
    }
    add_angles(surface, sum);
    for (uint32_t v = 0; v < surface->nodes; v++) {
        f->corner[v] = is_corner(f, v) || sum[v] < sharp_corner_angle;
        surface->corners += f->corner[v];
    }
    free(sum);
    surface->corner = tm_new(surface->corners, sizeof *surface->corner);
    if (!surface->corner)
        return tm_fail_memory(error);
    size_t count = 0;
    for (uint32_t v = 0; v < surface->nodes; v++)
        if (f->corner[v])
            surface->corner[count++] = v;
    return TM_OK;
}

static uint32_t patch_beside(const tm_surface *surface, uint32_t t)
{
    return t == TM_NONE ? TM_NONE : surface->patch[t];
}

/* The curve from v along e to a corner, or back to v. *used counts the nodes. */
static void follow(feature_finder *f, uint32_t v, uint32_t e, size_t *used)
{
    tm_surface *surface = f->surface;
    const uint32_t first = v;
    size_t c = surface->curves++;
    surface->curve_start[c] = *used;
    surface->curve_patch[c][0] = patch_beside(surface, f->edge[e].triangle[0]);
    surface->curve_patch[c][1] = patch_beside(surface, f->edge[e].triangle[1]);
    surface->curve_node[(*used)++] = v;
    for (;;) {
        f->done[e] = true;
        v = other_end(f, e, v);
        surface->curve_node[(*used)++] = v;
        surface->curve_length[c] += sqrt(tm_distance2(surface->xyz[f->edge[e].node[0]],
                                                      surface->xyz[f->edge[e].node[1]]));
        if (f->corner[v] || v == first)
            return;
        e = f->at[f->start[v] + (f->at[f->start[v]] == e)];
    }
}

static tm_status find_curves(feature_finder *f, tm_error *error)
{
    tm_surface *surface = f->surface;
    size_t used = 0;
    surface->curve_start = tm_new(f->edges + 1, sizeof *surface->curve_start);
    surface->curve_node = tm_new(2 * f->edges, sizeof *surface->curve_node);
    surface->curve_patch = tm_new(f->edges, sizeof *surface->curve_patch);
    surface->curve_length = calloc(f->edges + 1, sizeof *surface->curve_length);
    if (!surface->curve_length || !surface->curve_start || !surface->curve_node ||
        !surface->curve_patch)
        return tm_fail_memory(error);
    /* From corners; what is left has none. */
    for (int closed = 0; closed < 2; closed++)
        for (uint32_t v = 0; v < surface->nodes; v++)
            for (size_t i = f->start[v]; i < f->start[v + 1]; i++)
                if ((f->corner[v] || closed) && !f->done[f->at[i]])
                    follow(f, v, f->at[i], &used);
    surface->curve_start[surface->curves] = used;
    return TM_OK;
}

/* The edges that are sharp by their angle, and open ones. Counts only for edge NULL. */
static size_t list_bends(const feature_finder *f, tm_sharp_edge *edge)
{
    const tm_surface *surface = f->surface;
    size_t count = 0;
    for (uint32_t t = 0; t < surface->triangles; t++)
        for (unsigned i = 0; i < 3; i++) {
            const uint32_t n = surface->across[t][i];
            if ((n != TM_NONE && n < t) || !bends(f, t, n))
                continue;
            const uint32_t *v = surface->triangle[t];
            if (edge)
                edge[count] = (tm_sharp_edge){{v[i], v[(i + 1) % 3]}, {t, n}};
            count++;
        }
    return count;
}

static tm_status find_rough(feature_finder *f, tm_error *error)
{
    tm_surface *surface = f->surface;
    const size_t count = list_bends(f, NULL);
    tm_sharp_edge *edge = tm_new(count, sizeof *edge);
    f->rough = calloc(surface->nodes + 1, sizeof *f->rough);
    tm_status status = edge && f->rough ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK) {
        list_bends(f, edge);
        status = tm_surface_find_rough(surface, edge, count, f->rough,
                                       &surface->rough_edges, error);
        surface->rough = surface->rough_edges > 0;
    }
    free(edge);
    return status;
}

tm_status tm_surface_find_features(tm_surface *surface, double feature_angle,
                                   bool unless_rough, double least_length,
                                   tm_error *error)
{
    feature_finder f = {.surface = surface,
                        .most_cosine = cos(feature_angle * pi / 180),
                        .normal = tm_new(surface->triangles, sizeof *f.normal)};
    tm_status status = f.normal ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK) {
        find_normals(&f);
        if (unless_rough)
            status = find_rough(&f, error);
    }
    if (status == TM_OK)
        status = find_edges(&f, error);
    if (status == TM_OK)
        status = attach_edges(&f, error);
    if (status == TM_OK && least_length > 0)
        status = drop_short(&f, least_length, error);
    if (status == TM_OK)
        status = number_patches(surface, f.parent, error);
    if (status == TM_OK)
        status = find_corners(&f, error);
    if (status == TM_OK)
        status = find_curves(&f, error);
    free(f.normal);
    free(f.edge);
    free(f.parent);
    free(f.start);
    free(f.at);
    free(f.rough);
    free(f.corner);
    free(f.done);
    return status;
}
