/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "quadrature.h"

#include "../../lib/base/array.h"
#include "../../lib/geom/vector.h"

#include <stdlib.h>
#include <string.h>

enum { POINTS = 3 };

/* Gauss and Legendre's points and weights on 0 … 1. */
static double point(int i)
{
    return (1 + (i - 1) * sqrt(3. / 5)) / 2; // NOLINT(readability-magic-numbers)
}

static double weight(int i)
{
    return (i == 1 ? 8. : 5.) / 18; // NOLINT(readability-magic-numbers)
}

void quadrature_free(quadrature *q)
{
    free(q->x);
    free(q->weight);
    free(q->normal);
    *q = (quadrature){0};
}

/* Makes room for one more point. */
static bool reserve(quadrature *q)
{
    double(*x)[3] = tm_grow(q->x, &q->room[0], q->count + 1, sizeof *x);
    q->x = x ? x : q->x;
    double *w = tm_grow(q->weight, &q->room[1], q->count + 1, sizeof *w);
    q->weight = w ? w : q->weight;
    double(*normal)[3] = tm_grow(q->normal, &q->room[2], q->count + 1, sizeof *normal);
    q->normal = normal ? normal : q->normal;
    return x && w && normal;
}

/* Adds the point origin + Σ at[k]·edge[k]. */
static bool add(quadrature *q, const double origin[3], const double edge[3][3],
                const double at[3], double w)
{
    if (!reserve(q))
        return false;
    for (int j = 0; j < 3; j++)
        q->x[q->count][j] =
            origin[j] + at[0] * edge[0][j] + at[1] * edge[1][j] + at[2] * edge[2][j];
    q->weight[q->count++] = w;
    return true;
}

/* Adds a tetrahedron's points, by its edges from `origin`. */
static bool add_tetrahedron(quadrature *q, const double origin[3],
                            const double edge[3][3], double determinant)
{
    for (int n = 0; n < POINTS * POINTS * POINTS; n++) {
        const int i = n / POINTS / POINTS, j = n / POINTS % POINTS, k = n % POINTS;
        double left = 1 - point(i);
        double w = determinant * weight(i) * weight(j) * weight(k) * left * left;
        double at[3] = {point(i), point(j) * left, 0};
        left *= 1 - point(j);
        at[2] = point(k) * left;
        if (!add(q, origin, edge, at, w * (1 - point(j))))
            return false;
    }
    return true;
}

bool quadrature_of_cell(quadrature *q, const solve_mesh *mesh, size_t c)
{
    q->count = 0;
    for (size_t k = mesh->of.cell_start[c]; k < mesh->of.cell_start[c + 1]; k++) {
        const uint32_t f = mesh->of.cell_facet[k];
        for (size_t i = 2; i < solve_corners(mesh, f); i++) {
            const uint32_t v[3] = {solve_corner(mesh, f, 0), solve_corner(mesh, f, i - 1),
                                   solve_corner(mesh, f, i)};
            double edge[3][3], cross[3];
            for (int j = 0; j < 3; j++)
                tm_subtract(edge[j], mesh->of.xyz[v[j]], mesh->centroid[c]);
            tm_cross(cross, edge[0], edge[1]);
            if (!add_tetrahedron(q, mesh->centroid[c], (const double(*)[3])edge,
                                 solve_side(mesh, f, c) * tm_dot(cross, edge[2])))
                return false;
        }
    }
    return true;
}

/* Adds a triangle's points; `unit` is the facet's normal of length 1. */
static bool add_triangle(quadrature *q, const double origin[3], const double edge[3][3],
                         const double unit[3])
{
    double normal[3];
    tm_cross(normal, edge[0], edge[1]);
    for (int n = 0; n < POINTS * POINTS; n++) {
        const int i = n / POINTS, j = n % POINTS;
        const double left = 1 - point(i), w = weight(i) * weight(j) * left;
        const double at[3] = {point(i), point(j) * left, 0};
        if (!add(q, origin, edge, at, w * tm_dot(normal, unit)))
            return false;
        for (int k = 0; k < 3; k++)
            q->normal[q->count - 1][k] = w * normal[k];
    }
    return true;
}

bool quadrature_of_facet(quadrature *q, const solve_mesh *mesh, size_t f)
{
    const double area = tm_norm(mesh->area[f]);
    const double *origin = mesh->of.xyz[solve_corner(mesh, f, 0)];
    double unit[3], edge[3][3] = {{0}};
    for (int k = 0; k < 3; k++)
        unit[k] = area > 0 ? mesh->area[f][k] / area : 0;
    q->count = 0;
    for (size_t i = 2; i < solve_corners(mesh, f); i++) {
        tm_subtract(edge[0], mesh->of.xyz[solve_corner(mesh, f, i - 1)], origin);
        tm_subtract(edge[1], mesh->of.xyz[solve_corner(mesh, f, i)], origin);
        if (!add_triangle(q, origin, (const double(*)[3])edge, unit))
            return false;
    }
    return true;
}
