/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dual_link.h"

#include "../../base/array.h"
#include "dual_steps.h"

#include <math.h>
#include <stdlib.h>

void tm_dual_link_free(tm_dual_link *link)
{
    free(link->triangle);
    free(link->vertex);
    *link = (tm_dual_link){0};
}

/* The place of a number in an ascending list whose members begin with it. */
static uint32_t find(const void *list, size_t count, size_t size, uint32_t number)
{
    const char *found = bsearch(&number, list, count, size, tm_compare_numbers);
    return found ? (uint32_t)((size_t)(found - (const char *)list) / size) : TM_NONE;
}

static bool allocate(tm_dual_link *link, size_t pieces)
{
    tm_dual_link_triangle *triangle =
        tm_grow(link->triangle, &link->triangle_room, pieces, sizeof *triangle);
    if (triangle)
        link->triangle = triangle;
    tm_dual_link_vertex *vertex =
        tm_grow(link->vertex, &link->vertex_room, 3 * pieces, sizeof *vertex);
    if (vertex)
        link->vertex = vertex;
    return triangle && vertex;
}

static void find_vertices(tm_dual_link *link, const tm_dual *d)
{
    const tm_tet_mesh *mesh = d->mesh;
    size_t count = 0;
    for (size_t a = 0; a < link->triangles; a++) {
        uint32_t node[3];
        tm_dual_half_nodes(mesh, link->triangle[a].piece, node);
        for (int j = 0; j < 3; j++)
            link->vertex[count++] = (tm_dual_link_vertex){.node = node[j]};
    }
    qsort(link->vertex, count, sizeof *link->vertex, tm_compare_numbers);
    link->vertices = 0;
    for (size_t i = 0; i < count; i++)
        if (i == 0 || link->vertex[i].node != link->vertex[link->vertices - 1].node)
            link->vertex[link->vertices++] = link->vertex[i];
    for (size_t i = 0; i < link->vertices; i++) {
        tm_dual_link_vertex *vertex = &link->vertex[i];
        tm_subtract(vertex->to, mesh->xyz[vertex->node], link->centre);
        const double length = tm_norm(vertex->to);
        for (int x = 0; x < 3; x++)
            vertex->to[x] /= length;
    }
}

/* The triangle beyond side j of triangle a. */
static uint32_t beyond(const tm_dual_link *link, const tm_dual *d, uint32_t a, int j)
{
    const tm_tet_mesh *mesh = d->mesh;
    const uint32_t piece = link->triangle[a].piece, t = piece / 4;
    const uint32_t k = tm_face_corner[piece % 4][j], n = mesh->neighbour[t][k];
    if (n & TM_FACE_BIT || d->cuts[piece] >> k & 1)
        return TM_NONE;
    const uint32_t corner = tm_tet_corner(mesh, n / 4, mesh->tet[t][piece % 4]);
    return find(link->triangle, link->triangles, sizeof *link->triangle,
                n - n % 4 + corner);
}

bool tm_dual_link_fill(tm_dual_link *link, const tm_dual *d, const uint32_t *piece,
                       size_t pieces)
{
    const tm_tet_mesh *mesh = d->mesh;
    if (!allocate(link, pieces))
        return false;
    link->centre = mesh->xyz[mesh->tet[piece[0] / 4][piece[0] % 4]];
    link->triangles = pieces;
    for (size_t a = 0; a < pieces; a++)
        link->triangle[a].piece = piece[a];
    find_vertices(link, d);
    for (uint32_t a = 0; a < pieces; a++) {
        tm_dual_link_triangle *triangle = &link->triangle[a];
        uint32_t node[3];
        tm_dual_half_nodes(mesh, triangle->piece, node);
        for (int j = 0; j < 3; j++) {
            triangle->vertex[j] =
                find(link->vertex, link->vertices, sizeof *link->vertex, node[j]);
            triangle->beyond[j] = beyond(link, d, a, j);
        }
        for (int j = 0; j < 3; j++) {
            const uint32_t k = tm_face_corner[triangle->piece % 4][j];
            const bool stays =
                (mesh->neighbour[triangle->piece / 4][k] & TM_FACE_BIT) != 0;
            for (int i = 1; i < 3; i++) {
                tm_dual_link_vertex *end = &link->vertex[triangle->vertex[(j + i) % 3]];
                end->border |= triangle->beyond[j] == TM_NONE;
                end->constrained |= stays;
            }
        }
    }
    return true;
}

double tm_dual_link_angle(const tm_dual_link *link, uint32_t triangle, int i)
{
    const uint32_t *vertex = link->triangle[triangle].vertex;
    const double *axis = link->vertex[vertex[i]].to;
    double across[2][3], normal[3];
    for (int k = 0; k < 2; k++)
        tm_cross(across[k], axis, link->vertex[vertex[(i + 1 + k) % 3]].to);
    tm_cross(normal, across[0], across[1]);
    return atan2(tm_norm(normal), tm_dot(across[0], across[1]));
}

void tm_dual_link_cut(tm_dual_link *link, tm_dual *d, uint32_t triangle, int j)
{
    tm_dual_link_triangle *here = &link->triangle[triangle];
    const uint32_t other = here->beyond[j];
    tm_dual_link_triangle *there = &link->triangle[other];
    int i = 0;
    while (there->beyond[i] != triangle)
        i++;
    here->beyond[j] = there->beyond[i] = TM_NONE;
    d->cuts[here->piece] |= (uint8_t)(1u << tm_face_corner[here->piece % 4][j]);
    d->cuts[there->piece] |= (uint8_t)(1u << tm_face_corner[there->piece % 4][i]);
    d->has_cuts = true;
    for (int e = 1; e < 3; e++)
        link->vertex[here->vertex[(j + e) % 3]].border = true;
}
