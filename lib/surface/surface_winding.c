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
 * Barill 2018, section 3.2, calls it β and takes 2. */
static const double far_radii = 2;

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

/* The middle, and the normal, which is as long as the area. */
static double measure(const tm_tree_triangle *triangle, double middle[3],
                      double normal[3])
{
    const double third = 1.0 / 3;
    tm_triangle_normal(normal, triangle->corner[0], triangle->corner[1],
                       triangle->corner[2]);
    for (int i = 0; i < 3; i++) {
        normal[i] /= 2;
        middle[i] = third * (triangle->corner[0][i] + triangle->corner[1][i] +
                             triangle->corner[2][i]);
    }
    return tm_norm(normal);
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

static void set_centre(const tm_tree_triangle *triangle, size_t count,
                       tm_tree_dipole *dipole)
{
    double area = 0;
    for (size_t t = 0; t < count; t++) {
        double middle[3], normal[3], one = measure(&triangle[t], middle, normal);
        area += one;
        for (int i = 0; i < 3; i++) {
            dipole->normal[i] += normal[i];
            dipole->centre[i] += one * middle[i];
        }
    }
    for (int i = 0; i < 3; i++)
        dipole->centre[i] =
            area > 0 ? dipole->centre[i] / area : triangle[0].corner[0][i];
}

static void set_moment(const tm_tree_triangle *triangle, size_t count,
                       tm_tree_dipole *dipole)
{
    for (size_t t = 0; t < count; t++) {
        double middle[3], normal[3];
        measure(&triangle[t], middle, normal);
        for (int i = 0; i < 3; i++) {
            dipole->radius2 = fmax(dipole->radius2,
                                   tm_distance2(dipole->centre, triangle[t].corner[i]));
            for (int k = 0; k < 3; k++)
                dipole->moment[i][k] += (middle[i] - dipole->centre[i]) * normal[k];
        }
    }
}

tm_status tm_surface_winding_build(tm_surface *surface, tm_error *error)
{
    tm_surface_tree *tree = surface->tree;
    tree->dipole = tm_new(tree->nodes, sizeof *tree->dipole);
    if (!tree->dipole)
        return tm_fail_memory(error);
    for (size_t n = 0; n < tree->nodes; n++) {
        uint32_t first, last;
        range_of(tree, n, &first, &last);
        tree->dipole[n] = (tm_tree_dipole){0};
        set_centre(tree->triangle + first, last - first, &tree->dipole[n]);
        set_moment(tree->triangle + first, last - first, &tree->dipole[n]);
    }
    return TM_OK;
}

/* Times 4π, for a point that is `to` before the centre. */
static double far_angle(const tm_tree_dipole *dipole, const double to[3],
                        double distance2)
{
    double trace = 0, product = 0;
    for (int i = 0; i < 3; i++) {
        trace += dipole->moment[i][i];
        product += to[i] * tm_dot(dipole->moment[i], to);
    }
    return (tm_dot(to, dipole->normal) + trace - 3 * product / distance2) /
           (distance2 * sqrt(distance2));
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
            sum += far_angle(dipole, to, distance2);
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
