/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The generalised winding number: the sum of the solid angles of all triangles, over 4π;
 * see surface.h for the sources. */
#include "surface_tree.h"

#include "../base/array.h"
#include "../geom/vector.h"

#include <math.h>
#include <string.h>

static const double full_angle = 12.566370614359172; /* 4π */

/* A box is far, and is taken as a dipole, where its centre is farther than so many radii:
 * Barill 2018, section 3.2, calls it β and takes 2; the next term is left out here. */
static const double far_radii = 3;

/* Signed solid angle (A. Van Oosterom and J. Strackee, The solid angle of a plane
 * triangle, IEEE Transactions on Biomedical Engineering 30, 1983); positive where the
 * point sees the triangle from within. */
static double solid_angle(const double corner[3][3], const double p[3])
{
    double a[3], b[3], c[3], cross[3];
    tm_subtract(a, corner[0], p);
    tm_subtract(b, corner[1], p);
    tm_subtract(c, corner[2], p);
    tm_cross(cross, b, c);
    double la = tm_norm(a), lb = tm_norm(b), lc = tm_norm(c);
    double below =
        la * lb * lc + tm_dot(a, b) * lc + tm_dot(b, c) * la + tm_dot(c, a) * lb;
    return 2 * atan2(tm_dot(a, cross), below);
}

static void add_triangle(const tm_tree_triangle *triangle, tm_tree_dipole *sum,
                         double *total)
{
    const double third = 1.0 / 3;
    double normal[3];
    tm_triangle_normal(normal, triangle->corner[0], triangle->corner[1],
                       triangle->corner[2]);
    double area = tm_norm(normal) / 2;
    for (int i = 0; i < 3; i++) {
        sum->normal[i] += normal[i] / 2;
        sum->centre[i] +=
            area * third *
            (triangle->corner[0][i] + triangle->corner[1][i] + triangle->corner[2][i]);
    }
    *total += area;
}

/* The triangles below a node are a range: from the first leaf to the last. */
static void range_of(const tm_surface_tree *tree, size_t n, uint32_t *first,
                     uint32_t *last)
{
    const tm_tree_node *left = &tree->node[n], *right = left;
    while (left->count == 0)
        left = &tree->node[left->first];
    while (right->count == 0)
        right = &tree->node[right->first + 1];
    *first = left->first;
    *last = right->first + right->count;
}

static void set_dipole(const tm_surface_tree *tree, size_t n)
{
    tm_tree_dipole *dipole = &tree->dipole[n];
    uint32_t first, last;
    double area = 0;
    *dipole = (tm_tree_dipole){0};
    range_of(tree, n, &first, &last);
    for (uint32_t i = first; i < last; i++)
        add_triangle(&tree->triangle[i], dipole, &area);
    for (int i = 0; i < 3; i++)
        dipole->centre[i] =
            area > 0 ? dipole->centre[i] / area : tree->triangle[first].corner[0][i];
    for (uint32_t i = first; i < last; i++)
        for (int k = 0; k < 3; k++)
            dipole->radius2 =
                fmax(dipole->radius2,
                     tm_distance2(dipole->centre, tree->triangle[i].corner[k]));
}

tm_status tm_surface_winding_build(tm_surface *surface, tm_error *error)
{
    tm_surface_tree *tree = surface->tree;
    tree->dipole = tm_new(tree->nodes, sizeof *tree->dipole);
    if (!tree->dipole)
        return tm_fail_memory(error);
    for (size_t n = 0; n < tree->nodes; n++)
        set_dipole(tree, n);
    return TM_OK;
}

double tm_surface_winding_number(const tm_surface *surface, const double point[3])
{
    const tm_surface_tree *tree = surface->tree;
    uint32_t stack[TM_TREE_DEPTH];
    size_t height = 1;
    double sum = 0;
    stack[0] = 0;
    while (height > 0) {
        uint32_t n = stack[--height];
        const tm_tree_node *node = &tree->node[n];
        const tm_tree_dipole *dipole = &tree->dipole[n];
        double to[3];
        tm_subtract(to, dipole->centre, point);
        double distance2 = tm_norm2(to);
        if (distance2 > far_radii * far_radii * dipole->radius2) {
            sum += tm_dot(to, dipole->normal) / (distance2 * sqrt(distance2));
        } else if (node->count == 0) {
            stack[height++] = node->first;
            stack[height++] = node->first + 1;
        } else {
            for (uint32_t i = 0; i < node->count; i++)
                sum += solid_angle(
                    (const double(*)[3])tree->triangle[node->first + i].corner, point);
        }
    }
    return sum / full_angle;
}
