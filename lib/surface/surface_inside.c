/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inside by the parity of a ray: for p, the ray along axis w of the tree, up or down
 * (whichever is nearer to the end of the box), with u and v the other two axes. The point
 * is p + (δu, δv) with 0 < δv ≪ δu ≪ anything else; no edge that is seen along w runs
 * through it. */
#include "surface_tree.h"

#include "../base/array.h"
#include "../geom/predicates.h"
#include "../geom/vector.h"

#include <math.h>
#include <string.h>

typedef struct ray {
    const double *p;
    unsigned u, v, w; /* turn as x, y, z do */
    bool up;
} ray;

/* Whether the triangle, seen along w, has the moved point: the half line from it along u
 * meets an odd number of edges. An edge is met the same way for both its triangles. */
static bool is_over(const ray *r, const double corner[3][3])
{
    bool odd = false;
    const double p[2] = {r->p[r->u], r->p[r->v]};
    for (int i = 0; i < 3; i++) {
        const double *a = corner[i], *b = corner[(i + 1) % 3];
        if ((a[r->v] > p[1]) == (b[r->v] > p[1]))
            continue;
        const double *low = a[r->v] > p[1] ? b : a, *high = a[r->v] > p[1] ? a : b;
        if (low[r->u] <= p[0] && high[r->u] <= p[0])
            continue;
        const double from[2] = {low[r->u], low[r->v]};
        const double to[2] = {high[r->u], high[r->v]};
        odd ^= tm_orient2d(from, to, p) > 0;
    }
    return odd;
}

/* Whether a triangle that has the point in sight along w is on the ray. */
static bool is_ahead(const ray *r, const double corner[3][3], bool *on)
{
    int above = 0, below = 0;
    for (int i = 0; i < 3; i++) {
        above += corner[i][r->w] > r->p[r->w];
        below += corner[i][r->w] < r->p[r->w];
    }
    if (above == 3 || below == 3)
        return (above == 3) == r->up;
    double flat[3][2];
    for (int i = 0; i < 3; i++) {
        flat[i][0] = corner[i][r->u];
        flat[i][1] = corner[i][r->v];
    }
    int side = tm_orient3d(corner[0], corner[1], corner[2], r->p);
    int facing = tm_orient2d(flat[0], flat[1], flat[2]);
    *on |= side == 0;
    return (side * facing < 0) == r->up;
}

static inline bool can_meet(const ray *r, const tm_tree_node *node)
{
    const double *p = r->p;
    return node->low[r->u] <= p[r->u] && p[r->u] <= node->high[r->u] &&
           node->low[r->v] <= p[r->v] && p[r->v] <= node->high[r->v] &&
           (r->up ? p[r->w] <= node->high[r->w] : node->low[r->w] <= p[r->w]);
}

/* What stands for a shell where those that a ray meets an odd number of times are added
 * without carry: bit 0 of the sum is whether the ray meets an odd number of triangles,
 * and the sum is 0 where there are no such shells (and else once in 2^63 times). The
 * finaliser of SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, 2014). */
static uint64_t sign_of_shell(uint32_t shell)
{
    uint64_t z = (shell + UINT64_C(1)) * UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return (z ^ z >> 31) | 1;
}

/* What a triangle that a ray meets stands for. */
typedef uint64_t sign_function(const tm_surface *surface, uint32_t t,
                               const void *context);

/* What all triangles that a ray from the point meets stand for, added without carry. */
static inline uint64_t sum_along_ray(const tm_surface *surface, const double point[3],
                                     uint32_t but, sign_function *sign,
                                     const void *context, bool *on)
{
    const tm_surface_tree *tree = surface->tree;
    unsigned w = tree->axis;
    ray r = {point, (w + 1) % 3, (w + 2) % 3, w, false};
    r.up = surface->high[w] - point[w] < point[w] - surface->low[w];
    uint32_t stack[TM_TREE_DEPTH];
    size_t height = 0;
    uint64_t sum = 0;
    if (can_meet(&r, &tree->node[0]))
        stack[height++] = 0;
    while (height > 0) {
        const tm_tree_node *node = &tree->node[stack[--height]];
        if (node->count == 0) {
            if (can_meet(&r, &tree->node[node->first]))
                stack[height++] = node->first;
            if (can_meet(&r, &tree->node[node->first + 1]))
                stack[height++] = node->first + 1;
        }
        for (uint32_t i = 0; i < node->count; i++) {
            const tm_tree_triangle *triangle = &tree->triangle[node->first + i];
            if (but != TM_NONE && surface->shell[triangle->id] == but)
                continue;
            const double(*corner)[3] = (const double(*)[3])triangle->corner;
            if (is_over(&r, corner) && is_ahead(&r, corner, on))
                sum ^= sign(surface, triangle->id, context);
        }
    }
    return sum;
}

static uint64_t shell_sign(const tm_surface *surface, uint32_t t, const void *context)
{
    (void)context;
    return sign_of_shell(surface->shell[t]);
}

/* The sum of the shells that a ray from the point meets an odd number of times. */
static uint64_t odd_shells(const tm_surface *surface, const double point[3], uint32_t but,
                           bool *on)
{
    return sum_along_ray(surface, point, but, shell_sign, NULL, on);
}

uint64_t tm_surface_sum_along_ray(const tm_surface *surface, const double point[3],
                                  uint32_t but,
                                  uint64_t (*sign)(const tm_surface *surface, uint32_t t,
                                                   const void *context),
                                  const void *context)
{
    bool on = false;
    return sum_along_ray(surface, point, but, sign, context, &on);
}

/* From a region to the outside all others come twice. */
static uint64_t side_sign(const tm_surface *surface, uint32_t t, const void *context)
{
    (void)context;
    return surface->side[t][0] ^ surface->side[t][1];
}

bool tm_surface_ray_is_odd(const tm_surface *surface, const double point[3], uint32_t but,
                           bool *on)
{
    return odd_shells(surface, point, but, on) & 1;
}

static bool is_in_box(const tm_surface *surface, const double point[3])
{
    for (int i = 0; i < 3; i++)
        if (!(surface->low[i] <= point[i] && point[i] <= surface->high[i]))
            return false;
    return true;
}

uint32_t tm_surface_region_at(const tm_surface *surface, const double point[3])
{
    bool on = false;
    return is_in_box(surface, point)
               ? (uint32_t)sum_along_ray(surface, point, TM_NONE, side_sign, NULL, &on)
               : 0;
}

bool tm_surface_is_beside(const tm_surface *surface, size_t t, int behind,
                          const double point[3])
{
    if (surface->walls)
        return tm_surface_region_at(surface, point) == surface->side[t][behind];
    return tm_surface_has_inside(surface, point) == (behind != 0);
}

bool tm_surface_has_inside(const tm_surface *surface, const double point[3])
{
    const double most = 0.5;
    bool on = false;
    if (!is_in_box(surface, point))
        return false;
    if (surface->by_winding)
        return tm_surface_winding_number(surface, point) > most;
    if (surface->walls)
        return tm_surface_region_at(surface, point) != 0;
    return tm_surface_ray_is_odd(surface, point, TM_NONE, &on);
}

bool tm_surface_is_within(const tm_surface *surface, uint32_t shell,
                          const double point[3])
{
    bool on = false;
    return odd_shells(surface, point, TM_NONE, &on) !=
           odd_shells(surface, point, shell, &on);
}

bool tm_surface_has_mesh(const tm_surface *surface, const double point[3])
{
    bool on = false;
    if (!surface->regions || surface->by_winding || surface->walls)
        return tm_surface_has_inside(surface, point);
    return is_in_box(surface, point) && odd_shells(surface, point, TM_NONE, &on) != 0;
}

/* The generalised winding number: the sum of the solid angles of all triangles, over 4π;
 * see surface.h for the sources. */

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

/* Whether at that distance the point below the centre of a triangle is not inside, or the
 * one above it is. */
static bool is_thin(const tm_surface *surface, size_t t, double distance,
                    double centre[3])
{
    const uint32_t *v = surface->triangle[t];
    double normal[3];
    double above[3];
    double below[3];
    tm_triangle_normal(normal, surface->xyz[v[0]], surface->xyz[v[1]],
                       surface->xyz[v[2]]);
    const double length = tm_norm(normal);
    if (!(length > 0))
        return false;
    for (int i = 0; i < 3; i++) {
        centre[i] =
            (surface->xyz[v[0]][i] + surface->xyz[v[1]][i] + surface->xyz[v[2]][i]) / 3;
        above[i] = centre[i] + distance / length * normal[i];
        below[i] = centre[i] - distance / length * normal[i];
    }
    return !tm_surface_is_beside(surface, t, 0, above) ||
           !tm_surface_is_beside(surface, t, 1, below);
}

bool tm_surface_find_thin(const tm_surface *surface, double most, double centre[3])
{
    for (int halves = 3; halves >= 0; halves--)
        for (size_t t = 0; t < surface->triangles; t++)
            if (is_thin(surface, t, ldexp(most, -halves), centre))
                return true;
    return false;
}
