/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bounding boxes of a surface's triangles, as a binary tree in one array: the root is
 * node 0, the two children of a node are side by side. */
#ifndef TM_SURFACE_SURFACE_TREE_H
#define TM_SURFACE_SURFACE_TREE_H

#include "surface.h"

/* The boxes of a tree are at most so deep: the size of a search's stack. */
enum { TM_TREE_DEPTH = 80 };

/* 64 bytes: a line of the cache. */
typedef struct tm_tree_node {
    double low[3], high[3];
    uint32_t first; /* the first child, or the first triangle of a leaf */
    uint32_t count; /* triangles of a leaf; 0: no leaf */
    uint32_t patch; /* of all triangles below; TM_NONE where they differ */
    uint32_t unused;
} tm_tree_node;

/* Squared distance from a point to the closed box; 0 inside. */
static inline double tm_tree_box_distance2(const tm_tree_node *node, const double p[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double below = node->low[i] - p[i];
        double above = p[i] - node->high[i];
        double d = below > above ? below : above;
        d = d > 0 ? d : 0;
        sum += d * d;
    }
    return sum;
}

/* A triangle in the order of the leaves. */
typedef struct tm_tree_triangle {
    double corner[3][3];
    uint32_t id; /* in the surface */
    uint32_t patch : 31;
    uint32_t thin : 1; /* so thin that its plane is rounding: a measure is its edges' */
} tm_tree_triangle;

/* What the triangles of a box are from afar: the first two terms of Barill 2018,
 * equation 8. */
typedef struct tm_tree_dipole {
    double centre[3]; /* of area */
    double normal[3]; /* the sum of the triangles', as long as their areas */
    double moment[3]
                 [3]; /* the sum of the products of positions from the centre, normals */
    double radius2;   /* squared, of a ball around centre with all of them */
} tm_tree_dipole;

typedef struct tm_surface_tree {
    size_t nodes;
    tm_tree_node *node;
    tm_tree_triangle *triangle;
    uint32_t *slot;         /* [triangles of the surface]: where it is in triangle */
    tm_tree_dipole *dipole; /* [nodes], or NULL: see surface_inside.c */
    unsigned axis;          /* of rays: the one along which the surface is thinnest */
    double (*curve_box)[6]; /* [nodes of curves], low and high: see surface_closest.c */
} tm_surface_tree;

/* Makes surface->tree, with patches TM_NONE. The boxes are split where the areas of both
 * halves times their numbers of triangles are least (the surface area heuristic:
 * J. D. MacDonald and K. S. Booth, Heuristics for ray tracing using space subdivision,
 * The Visual Computer 6, 1990), with the candidates of I. Wald, On fast construction of
 * SAH-based bounding volume hierarchies, 2007: borders of equal bins. O(n log n). */
tm_status tm_surface_tree_build(tm_surface *surface, tm_error *error);

/* The squared distance from a point to one of the triangles of the surface. */
double tm_surface_triangle_distance2(const tm_surface *surface, uint32_t t,
                                     const double point[3]);

/* The same to any triangle of three corners. */
double tm_corners_distance2(const double corner[3][3], const double point[3]);

/* Copies corners and patches to the tree again after they have changed. */
void tm_surface_tree_refresh(tm_surface *surface);

void tm_surface_tree_free(tm_surface_tree *tree);

/* Whether the ray from a point along the tree's axis meets an odd number of triangles of
 * other shells than `but` (TM_NONE: of all). Sets *on where the point is found to be on a
 * triangle of these. */
bool tm_surface_ray_is_odd(const tm_surface *surface, const double point[3], uint32_t but,
                           bool *on);

/* What all triangles stand for, added without carry, that such a ray meets. */
uint64_t tm_surface_sum_along_ray(const tm_surface *surface, const double point[3],
                                  uint32_t but,
                                  uint64_t (*sign)(const tm_surface *surface, uint32_t t,
                                                   const void *context),
                                  const void *context);

/* Whether a point is within a shell. */
bool tm_surface_is_within(const tm_surface *surface, uint32_t shell,
                          const double point[3]);

/* Makes the tree's dipoles. */
tm_status tm_surface_winding_build(tm_surface *surface, tm_error *error);

/* Makes the tree's curve boxes. */
tm_status tm_surface_curve_build(tm_surface *surface, tm_error *error);

#endif
