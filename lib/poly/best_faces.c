/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "best_faces.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "../tet/operation/ball.h"

#include <stdlib.h>
#include <string.h>

/* A face by its rank. */
typedef struct {
    double metric;
    uint32_t node[3]; /* descending */
} face_rank;

/* Squared: it is only compared. */
static double metric_of(const double *a, const double *b, const double *c,
                        tm_face_metric metric)
{
    double area = tm_triangle_area(a, b, c);
    if (metric == TM_FACE_AREA)
        return area;
    double around =
        sqrt(tm_distance2(a, b)) + sqrt(tm_distance2(b, c)) + sqrt(tm_distance2(c, a));
    return around > 0 ? 2 * area / around : 0;
}

static void sort_two(uint32_t *a, uint32_t *b)
{
    if (*a < *b) {
        const uint32_t swap = *a;
        *a = *b;
        *b = swap;
    }
}

/* The rank does not depend on the side from which the face is seen. */
static face_rank rank_of(const tm_tet_mesh *mesh, uint32_t t, uint32_t i,
                         tm_face_metric metric)
{
    face_rank r;
    tm_tet_face_below(mesh, t, i, r.node);
    sort_two(&r.node[0], &r.node[1]);
    sort_two(&r.node[1], &r.node[2]);
    sort_two(&r.node[0], &r.node[1]);
    r.metric = metric_of(mesh->xyz[r.node[0]], mesh->xyz[r.node[1]], mesh->xyz[r.node[2]],
                         metric);
    return r;
}

static bool is_better(const face_rank *a, const face_rank *b)
{
    if (a->metric != b->metric)
        return a->metric > b->metric;
    for (int k = 0; k < 3; k++)
        if (a->node[k] != b->node[k])
            return a->node[k] > b->node[k];
    return false;
}

static uint32_t best_face(const tm_tet_mesh *mesh, uint32_t t, tm_face_metric metric)
{
    uint32_t best = 0;
    face_rank most = rank_of(mesh, t, 0, metric);
    for (uint32_t i = 1; i < 4; i++) {
        const face_rank r = rank_of(mesh, t, i, metric);
        if (!is_better(&r, &most))
            continue;
        most = r;
        best = i;
    }
    return best;
}

/* The trees: next[t] is the tetrahedron across the best face, TM_NONE of roots, which
 * have a terminal face, or a best one that is kept. link[t] is that face, 0 … 3. */
static void find_trees(const tm_tet_mesh *mesh, tm_face_metric metric, uint32_t *next,
                       uint8_t *link)
{
    for (uint32_t t = 0; t < mesh->slots; t++)
        link[t] = (uint8_t)best_face(mesh, t, metric);
    for (uint32_t t = 0; t < mesh->slots; t++) {
        const uint32_t across = mesh->neighbour[t][link[t]];
        const bool is_terminal =
            !(across & TM_FACE_BIT) && link[across / 4] == across % 4;
        next[t] = across & TM_FACE_BIT || (is_terminal && across / 4 > t) ? TM_NONE
                                                                          : across / 4;
    }
}

/* How many links from t to its root, which is written. */
static size_t depth_of(const uint32_t *next, uint32_t t, uint32_t *root)
{
    size_t depth = 0;
    for (; next[t] != TM_NONE; t = next[t])
        depth++;
    *root = t;
    return depth;
}

/* Cuts the way from t to u, which are of one tree, in the middle: the link of one of
 * them, or of one beyond, from the deeper side where it is the same. */
static void cut_between(uint32_t *next, uint32_t t, uint32_t u, size_t depth_t,
                        size_t depth_u)
{
    uint32_t a = depth_t >= depth_u ? t : u, b = depth_t >= depth_u ? u : t;
    const uint32_t deep = a;
    size_t from_a = depth_t >= depth_u ? depth_t - depth_u : depth_u - depth_t;
    size_t from_b = 0;
    for (size_t k = 0; k < from_a; k++)
        a = next[a];
    for (; a != b; a = next[a], b = next[b]) {
        from_a++;
        from_b++;
    }
    /* from_a links go up from the deeper one, which has half of the way at least. */
    uint32_t at = deep;
    for (size_t k = 0; k < (from_a + from_b - 1) / 2; k++)
        at = next[at];
    next[at] = TM_NONE;
}

/* Cuts until no two tetrahedra of a tree have a face that is no link. */
static void cut_at_barriers(const tm_tet_mesh *mesh, uint32_t *next, const uint8_t *link)
{
    for (uint32_t t = 0; t < mesh->slots; t++)
        for (uint32_t i = 0; i < 4; i++) {
            const uint32_t across = mesh->neighbour[t][i], u = across / 4;
            uint32_t roots[2];
            if (across & TM_FACE_BIT || u < t || link[t] == i || link[u] == across % 4)
                continue;
            const size_t depth_t = depth_of(next, t, &roots[0]);
            const size_t depth_u = depth_of(next, u, &roots[1]);
            if (roots[0] == roots[1])
                cut_between(next, t, u, depth_t, depth_u);
        }
}

/* Numbers trees in the order of their first tetrahedra; next[] is used up. */
static size_t number_trees(uint32_t *next, size_t tets, uint32_t *label)
{
    size_t trees = 0;
    for (size_t t = 0; t < tets; t++)
        label[t] = TM_NONE;
    for (uint32_t t = 0; t < tets; t++) {
        uint32_t at = t;
        while (label[at] == TM_NONE && next[at] != TM_NONE)
            at = next[at];
        const uint32_t name = label[at] != TM_NONE ? label[at] : (uint32_t)trees++;
        label[at] = name;
        for (at = t; label[at] == TM_NONE; at = next[at])
            label[at] = name;
    }
    return trees;
}

static tm_status label_faces(const tm_tet_mesh *mesh, const tm_poly_options *options,
                             bool cuts, uint32_t *label, size_t *regions, tm_error *error)
{
    uint32_t *next = tm_new(mesh->slots, sizeof *next);
    uint8_t *link = tm_new(mesh->slots, sizeof *link);
    const bool done = next && link;
    if (done) {
        find_trees(mesh, options->face_metric, next, link);
        if (cuts)
            cut_at_barriers(mesh, next, link);
        *regions = number_trees(next, mesh->slots, label);
    }
    free(next);
    free(link);
    return done ? TM_OK : tm_fail_memory(error);
}

tm_status tm_poly_terminal_faces(const tm_tet_mesh *mesh, const tm_poly_options *options,
                                 uint32_t *label, size_t *regions, tm_error *error)
{
    return label_faces(mesh, options, false, label, regions, error);
}

tm_status tm_poly_faces(const tm_tet_mesh *mesh, const tm_poly_options *options,
                        uint32_t *label, size_t *regions, tm_error *error)
{
    return label_faces(mesh, options, true, label, regions, error);
}
