/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points in tetrahedra are put where facets become plane: across the edge of each facet
 * is a plane at the mean height of its points, and each point goes to where the sum of
 * its squared distances to its six planes, and some times that to the centroid of its
 * tetrahedron, is least. Where all planes are those halfway between the nodes, that is
 * between circumcentre and centroid. */
#include "dual_steps.h"

#include "../../base/array.h"
#include "../../geom/barycentric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ITERATIONS = 6 };

/* How many times the squared distance to the centroid counts; the least barycentric
 * coordinate that a point gets. Of what was tried, these left the fewest cells that are
 * not convex. */
static const double weight_of_centroid = 1, least_coordinate = 0.06;

/* The sums of n nᵀ and of n (n·x) for the planes that a point should be in. */
typedef struct {
    double matrix[6], right[3];
} planes;

/* Solves (matrix + weight) out = right + weight from. */
static void solve(const planes *p, double weight, const double from[3], double out[3])
{
    const double a = p->matrix[0] + weight, b = p->matrix[1], c = p->matrix[2];
    const double e = p->matrix[3] + weight, f = p->matrix[4], i = p->matrix[5] + weight;
    const double r[3] = {p->right[0] + weight * from[0], p->right[1] + weight * from[1],
                         p->right[2] + weight * from[2]};
    const double A = e * i - f * f, B = c * f - b * i, C = b * f - c * e;
    const double D = a * i - c * c, E = b * c - a * f, F = a * e - b * b;
    const double determinant = a * A + b * B + c * C;
    out[0] = (A * r[0] + B * r[1] + C * r[2]) / determinant;
    out[1] = (B * r[0] + D * r[1] + E * r[2]) / determinant;
    out[2] = (C * r[0] + E * r[1] + F * r[2]) / determinant;
}

static void add_plane(planes *p, const double n[3], double height)
{
    p->matrix[0] += n[0] * n[0];
    p->matrix[1] += n[0] * n[1];
    p->matrix[2] += n[0] * n[2];
    p->matrix[3] += n[1] * n[1];
    p->matrix[4] += n[1] * n[2];
    p->matrix[5] += n[2] * n[2];
    for (int x = 0; x < 3; x++)
        p->right[x] += height * n[x];
}

/* Gathers the planes of all points in tetrahedra. */
static void gather(const tm_dual *d, planes *at)
{
    const double(*node)[3] = (const double(*)[3])d->mesh->xyz;
    for (size_t f = 0; f < d->facets; f++) {
        const uint32_t *side = d->facet.integer + 2 * f;
        double n[3], height = 0;
        if (side[1] == TM_NONE || d->cell_node[side[0]] == d->cell_node[side[1]])
            continue;
        const size_t begin = d->facet.start[f], end = d->facet.start[f + 1];
        tm_subtract(n, node[d->cell_node[side[1]]], node[d->cell_node[side[0]]]);
        const double length = tm_norm(n);
        for (int x = 0; x < 3; x++)
            n[x] /= length;
        for (size_t i = begin; i < end; i++)
            height += tm_dot(n, d->xyz[d->facet.item[i]]) / (double)(end - begin);
        for (size_t i = begin; i < end; i++)
            if (d->point[d->facet.item[i]].place == TM_DUAL_IN_TET)
                add_plane(&at[d->facet.item[i]], n, height);
    }
}

/* Moves the point of a tetrahedron near to its planes. */
static void move_point(tm_dual *d, size_t t, const planes *at)
{
    const tm_tet_mesh *mesh = d->mesh;
    const double *corner[4];
    double centroid[3] = {0}, to[3], coordinate[4], share = 1;
    if (d->frozen[t])
        return;
    for (int i = 0; i < 4; i++) {
        corner[i] = mesh->xyz[mesh->tet[t][i]];
        for (int x = 0; x < 3; x++)
            centroid[x] += corner[i][x] / 4;
    }
    solve(at, weight_of_centroid, centroid, to);
    tm_barycentric(corner, to, coordinate);
    for (int i = 0; i < 4; i++)
        if (!(coordinate[i] >= least_coordinate))
            share = fmin(share, (0.25 - least_coordinate) / (0.25 - coordinate[i]));
    for (int x = 0; x < 3 && share > 0; x++)
        d->tet_xyz[t][x] = d->xyz[t][x] = centroid[x] + share * (to[x] - centroid[x]);
}

tm_status tm_dual_flatten(tm_dual *d, tm_error *error)
{
    const size_t tets = d->mesh->slots;
    planes *at = tm_new(tets, sizeof *at);
    if (!at)
        return tm_fail_memory(error);
    for (int k = 0; k < ITERATIONS; k++) {
        memset(at, 0, tets * sizeof *at);
        gather(d, at);
        for (size_t t = 0; t < tets; t++)
            move_point(d, t, &at[t]);
    }
    free(at);
    return TM_OK;
}
