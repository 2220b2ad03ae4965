/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "facet.h"

#include "../geom/vector.h"

#include <float.h>

double tm_facet_flatness(const tm_tet_mesh *mesh)
{
    const double ulps = 64;
    double largest = 0;
    for (uint32_t v = 0; v < mesh->nodes; v++)
        for (int k = 0; k < 3 && tm_node_lives(mesh, v); k++)
            largest = fmax(largest, fabs(mesh->xyz[v][k]));
    return ulps * DBL_EPSILON * largest;
}

static bool is_near_plane(const double normal[3], const double on_plane[3],
                          const double p[3], double flatness)
{
    double to[3];
    tm_subtract(to, p, on_plane);
    return fabs(tm_dot(normal, to)) <= flatness * tm_norm(normal);
}

static bool is_between_two(const tm_constrained_face *face)
{
    return face->side[0] != TM_NONE && face->side[1] != TM_NONE;
}

bool tm_facet_continues(const tm_tet_mesh *mesh, uint32_t f, uint32_t g, uint32_t a,
                        uint32_t b, uint32_t c, uint32_t d, double flatness)
{
    const tm_constrained_face *p = &mesh->face[f], *q = &mesh->face[g];
    const tm_marked_edge *edge = tm_tet_mesh_edge(mesh, a, b);
    if (p->marker != q->marker || p->listed != q->listed ||
        is_between_two(p) != is_between_two(q) || (edge && edge->marker != 0) ||
        tm_edge_map_get(&mesh->locked, a, b))
        return false;
    double of_c[3], of_d[3];
    tm_triangle_normal(of_c, mesh->xyz[a], mesh->xyz[b], mesh->xyz[c]);
    tm_triangle_normal(of_d, mesh->xyz[b], mesh->xyz[a], mesh->xyz[d]);
    return tm_dot(of_c, of_d) > 0 &&
           is_near_plane(of_c, mesh->xyz[a], mesh->xyz[d], flatness) &&
           is_near_plane(of_d, mesh->xyz[a], mesh->xyz[c], flatness);
}
