/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where points are put first: in tetrahedra and triangles from the centroid towards the
 * circumcentre, with which facets are plane and across the edges that they are dual to,
 * as far as that is inside; in the middle of edges. */
#include "dual_steps.h"

#include "../../base/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The least barycentric coordinate of a point that is put towards the circumcentre. */
static const double least_in_tet = 0.2, least_in_face = 0.12;

/* How far the points of cuts are put towards what is cut, so that the cells beside it are
 * bent inward there, and stay convex. */
static const double bulge = 0.1;

/* Moves from equal coordinates towards `to`, whose sum is 1, until one is `least`, and
 * writes the point. */
static void put_towards(double out[3], const double *const *corner, const double *to,
                        int corners, double least)
{
    const double centre = 1.0 / corners;
    double share = 1;
    for (int i = 0; i < corners; i++)
        if (to[i] < least)
            share = fmin(share, (centre - least) / (centre - to[i]));
    share = share >= 0 ? share : 0; /* NaN: the corners are in one plane */
    for (int x = 0; x < 3; x++) {
        out[x] = 0;
        for (int i = 0; i < corners; i++)
            out[x] +=
                corner[i][x] * (share > 0 ? centre + share * (to[i] - centre) : centre);
    }
}

/* Barycentric coordinates of the circumcentre of a tetrahedron. */
static void find_circumcentre(const double *const *p, double coordinate[4])
{
    double edge[3][3], normal[3][3], square[3], to[3];
    for (int i = 0; i < 3; i++) {
        tm_subtract(edge[i], p[i + 1], p[0]);
        square[i] = tm_norm2(edge[i]);
    }
    for (int i = 0; i < 3; i++)
        tm_cross(normal[i], edge[(i + 1) % 3], edge[(i + 2) % 3]);
    const double determinant = tm_dot(edge[0], normal[0]);
    for (int x = 0; x < 3; x++)
        to[x] = (square[0] * normal[0][x] + square[1] * normal[1][x] +
                 square[2] * normal[2][x]) /
                (2 * determinant);
    coordinate[0] = 1;
    for (int i = 0; i < 3; i++) {
        coordinate[i + 1] = tm_dot(to, normal[i]) / determinant;
        coordinate[0] -= coordinate[i + 1];
    }
}

static void find_circumcentre_of_face(const double *const *p, double coordinate[3])
{
    double weight[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        const double a = tm_distance2(p[(i + 1) % 3], p[(i + 2) % 3]);
        const double b = tm_distance2(p[i], p[(i + 1) % 3]);
        const double c = tm_distance2(p[i], p[(i + 2) % 3]);
        weight[i] = a * (b + c - a);
        sum += weight[i];
    }
    for (int i = 0; i < 3; i++)
        coordinate[i] = weight[i] / sum;
}

void tm_dual_place_tets(tm_dual *d)
{
    const tm_tet_mesh *mesh = d->mesh;
    for (size_t t = 0; t < mesh->slots; t++) {
        const double *corner[4];
        double to[4];
        for (int i = 0; i < 4; i++)
            corner[i] = mesh->xyz[mesh->tet[t][i]];
        find_circumcentre(corner, to);
        put_towards(d->tet_xyz[t], corner, to, 4, least_in_tet);
    }
}

static void place_in_face(const tm_dual *d, const tm_dual_wall *wall, double out[3])
{
    const double *corner[3];
    double to[3];
    uint32_t node[3];
    tm_dual_half_nodes(d->mesh, wall->half, node);
    for (int i = 0; i < 3; i++)
        corner[i] = d->mesh->xyz[node[i]];
    find_circumcentre_of_face(corner, to);
    put_towards(out, corner, to, 3, d->frozen[wall->half / 4] ? 1.0 / 3 : least_in_face);
}

void tm_dual_put_at_centroid(tm_dual *d, size_t t)
{
    const tm_tet_mesh *mesh = d->mesh;
    for (int x = 0; x < 3; x++) {
        d->tet_xyz[t][x] = 0;
        for (int i = 0; i < 4; i++)
            d->tet_xyz[t][x] += mesh->xyz[mesh->tet[t][i]][x] / 4;
    }
}

/* Where a node is taken apart, the points in its tetrahedra are their centroids; again
 * where they were moved from there and no more are. */
static void freeze(tm_dual *d)
{
    const tm_tet_mesh *mesh = d->mesh;
    if (d->spent)
        memset(d->frozen, 0, mesh->slots * sizeof *d->frozen);
    for (size_t t = 0; t < mesh->slots; t++)
        for (int i = 0; i < 4 && !d->frozen[t]; i++) {
            if (d->level[mesh->tet[t][i]] != TM_DUAL_PIECES)
                continue;
            d->frozen[t] = true;
            tm_dual_put_at_centroid(d, t);
        }
}

/* Where the line between the points on both sides meets the plane of a wall. */
static void put_between(const tm_dual *d, const tm_dual_wall *wall,
                        const uint32_t node[3], double out[3])
{
    const tm_tet_mesh *mesh = d->mesh;
    const uint32_t t = wall->half / 4;
    const double *a = d->xyz[t], *b = d->xyz[tm_tet_across(mesh, t, wall->half % 4) / 4];
    double normal[3], from[3], to[2];
    tm_triangle_normal(normal, mesh->xyz[node[0]], mesh->xyz[node[1]],
                       mesh->xyz[node[2]]);
    for (int s = 0; s < 2; s++) {
        tm_subtract(from, s ? b : a, mesh->xyz[node[0]]);
        to[s] = fabs(tm_dot(from, normal));
    }
    const double share = to[0] + to[1] > 0 ? to[0] / (to[0] + to[1]) : 0.5;
    for (int x = 0; x < 3; x++)
        out[x] = a[x] + share * (b[x] - a[x]);
}

void tm_dual_place_cuts(tm_dual *d)
{
    for (size_t p = 0; p < d->points; p++) {
        const tm_dual_wall *wall = &d->wall[d->point[p].of];
        if (d->point[p].place != TM_DUAL_IN_FACE || wall->constrained ||
            d->frozen[wall->half / 4])
            continue;
        uint32_t node[3];
        const int quads = wall->quad[0] + wall->quad[1] + wall->quad[2];
        tm_dual_half_nodes(d->mesh, wall->half, node);
        put_between(d, wall, node, d->xyz[p]);
        for (int x = 0; x < 3 && quads < 3; x++) {
            double mean = 0;
            for (int j = 0; j < 3; j++)
                mean += wall->quad[j] ? d->mesh->xyz[node[j]][x] / quads : 0;
            d->xyz[p][x] += bulge * (mean - d->xyz[p][x]);
        }
    }
}

void tm_dual_forget(tm_dual *d)
{
    free(d->kept.wall);
    free(d->kept.edge);
    free(d->kept.xyz);
    tm_edge_map_free(&d->kept.edge_of);
    d->kept = (tm_dual_kept){0};
}

void tm_dual_keep(tm_dual *d)
{
    if (d->xyz) {
        tm_dual_forget(d);
        d->kept = (tm_dual_kept){d->wall, d->walls, d->edge, d->edge_of, d->xyz};
    } else {
        free(d->wall);
        free(d->edge);
        tm_edge_map_free(&d->edge_of);
    }
    d->wall = NULL;
    d->edge = NULL;
    d->xyz = NULL;
    d->edge_of = (tm_edge_map){0};
    d->wall_room = d->edge_room = d->xyz_room = 0;
}

/* Puts the points of walls and edges where they were, but of nodes taken apart since. */
static void put_back(tm_dual *d)
{
    const tm_dual_kept *kept = &d->kept;
    size_t k = 0;
    for (size_t w = 0; w < d->walls; w++) {
        const tm_dual_wall *wall = &d->wall[w];
        while (k < kept->walls && kept->wall[k].half < wall->half)
            k++;
        if (k < kept->walls && kept->wall[k].half == wall->half &&
            !d->frozen[wall->half / 4])
            memcpy(d->xyz[wall->point], kept->xyz[kept->wall[k].point], sizeof *d->xyz);
    }
    for (size_t e = 0; e < d->edges; e++) {
        const tm_dual_edge *edge = &d->edge[e];
        const uint32_t *was =
            tm_edge_map_get(&kept->edge_of, edge->node[0], edge->node[1]);
        if (was && edge->point != TM_NONE && kept->edge[*was].point != TM_NONE &&
            d->level[edge->node[0]] != TM_DUAL_PIECES &&
            d->level[edge->node[1]] != TM_DUAL_PIECES)
            memcpy(d->xyz[edge->point], kept->xyz[kept->edge[*was].point],
                   sizeof *d->xyz);
    }
}

tm_status tm_dual_place_walls(tm_dual *d, tm_error *error)
{
    const double(*node)[3] = (const double(*)[3])d->mesh->xyz;
    double(*xyz)[3] = tm_grow(d->xyz, &d->xyz_room, d->points, sizeof *xyz);
    if (!xyz)
        return tm_fail_memory(error);
    d->xyz = xyz;
    freeze(d);
    for (size_t p = 0; p < d->points; p++) {
        const uint32_t of = d->point[p].of;
        const tm_dual_place place = d->point[p].place;
        const uint32_t *end = place == TM_DUAL_ON_EDGE ? d->edge[of].node : NULL;
        if (place == TM_DUAL_IN_FACE)
            place_in_face(d, &d->wall[of], xyz[p]);
        for (int x = 0; x < 3; x++)
            if (place == TM_DUAL_IN_TET)
                xyz[p][x] = d->tet_xyz[of][x];
            else if (place == TM_DUAL_AT_NODE)
                xyz[p][x] = node[of][x];
            else if (end)
                xyz[p][x] = node[end[0]][x] + (node[end[1]][x] - node[end[0]][x]) / 2;
    }
    tm_dual_place_cuts(d);
    put_back(d);
    return TM_OK;
}
