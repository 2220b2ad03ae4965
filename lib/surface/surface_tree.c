/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_tree.h"

#include "../base/array.h"
#include "../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEAF_MOST = 4,   /* triangles of a leaf */
    BINS = 16,       /* candidates of a split are their borders */
    BALANCED_AT = 40 /* below this depth boxes are halved by number */
};

typedef struct box {
    double low[3], high[3];
} box;

typedef struct builder {
    tm_surface_tree *tree;
    const box *bounds; /* [triangles] */
    uint32_t *order;   /* triangles, leaf by leaf */
    uint32_t *aside;   /* room for a partition */
} builder;

static const box empty = {{HUGE_VAL, HUGE_VAL, HUGE_VAL},
                          {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};

static void extend(box *b, const box *by)
{
    for (int i = 0; i < 3; i++) {
        b->low[i] = by->low[i] < b->low[i] ? by->low[i] : b->low[i];
        b->high[i] = by->high[i] > b->high[i] ? by->high[i] : b->high[i];
    }
}

/* Half its area; 0 for an empty box. */
static double area(const box *b)
{
    double x = b->high[0] - b->low[0], y = b->high[1] - b->low[1];
    double z = b->high[2] - b->low[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
}

static double middle(const box *b, int axis)
{
    return b->low[axis] / 2 + b->high[axis] / 2;
}

typedef struct split {
    int axis;
    double low, scale; /* bin = (middle - low) * scale */
    int bin;           /* the first of the second half */
    double cost;
} split;

static int bin_of(const split *s, const box *b)
{
    int bin = (int)((middle(b, s->axis) - s->low) * s->scale);
    return bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
}

/* The best of the borders along s->axis. */
static void try_axis(const builder *b, size_t first, size_t count, split *s)
{
    box bin[BINS], right[BINS];
    size_t number[BINS] = {0}, before = 0;
    for (int i = 0; i < BINS; i++)
        bin[i] = empty;
    for (size_t i = first; i < first + count; i++) {
        int k = bin_of(s, &b->bounds[b->order[i]]);
        extend(&bin[k], &b->bounds[b->order[i]]);
        number[k]++;
    }
    right[BINS - 1] = bin[BINS - 1];
    for (int i = BINS - 1; i > 0; i--) {
        right[i - 1] = right[i];
        extend(&right[i - 1], &bin[i - 1]);
    }
    box left = empty;
    s->cost = HUGE_VAL;
    for (int i = 1; i < BINS; i++) {
        extend(&left, &bin[i - 1]);
        before += number[i - 1];
        double cost =
            area(&left) * (double)before + area(&right[i]) * (double)(count - before);
        if (before > 0 && before < count && cost < s->cost) {
            s->cost = cost;
            s->bin = i;
        }
    }
}

/* The best split of all axes; cost infinite where all middles are the same. */
static split find_split(const builder *b, size_t first, size_t count)
{
    box middles = empty;
    for (size_t i = first; i < first + count; i++) {
        box at;
        for (int k = 0; k < 3; k++)
            at.low[k] = at.high[k] = middle(&b->bounds[b->order[i]], k);
        extend(&middles, &at);
    }
    split best = {.cost = HUGE_VAL};
    for (int axis = 0; axis < 3; axis++) {
        double width = middles.high[axis] - middles.low[axis];
        split s = {.axis = axis, .low = middles.low[axis], .scale = BINS / width};
        if (!(width > 0) || isinf(s.scale))
            continue;
        try_axis(b, first, count, &s);
        if (s.cost < best.cost)
            best = s;
    }
    return best;
}

/* Moves the first half of the split to the front, keeping the order; its size. */
static size_t partition(builder *b, size_t first, size_t count, const split *s)
{
    size_t left = 0, right = 0;
    for (size_t i = first; i < first + count; i++) {
        uint32_t t = b->order[i];
        if (bin_of(s, &b->bounds[t]) < s->bin)
            b->order[first + left++] = t;
        else
            b->aside[right++] = t;
    }
    memcpy(b->order + first + left, b->aside, right * sizeof *b->aside);
    return left;
}

static void build_node(builder *b, uint32_t n, size_t first, size_t count, int depth)
{
    tm_tree_node *node = &b->tree->node[n];
    box bounds = empty;
    for (size_t i = first; i < first + count; i++)
        extend(&bounds, &b->bounds[b->order[i]]);
    memcpy(node->low, bounds.low, sizeof bounds.low);
    memcpy(node->high, bounds.high, sizeof bounds.high);
    node->patch = TM_NONE;
    node->unused = 0;
    if (count <= LEAF_MOST) {
        node->first = (uint32_t)first;
        node->count = (uint32_t)count;
        return;
    }
    size_t left = count / 2;
    split s = {.cost = HUGE_VAL};
    if (depth < BALANCED_AT)
        s = find_split(b, first, count);
    if (s.cost < HUGE_VAL)
        left = partition(b, first, count, &s);
    node->count = 0;
    node->first = (uint32_t)b->tree->nodes;
    b->tree->nodes += 2;
    uint32_t child = node->first;
    build_node(b, child, first, left, depth + 1);
    build_node(b, child + 1, first + left, count - left, depth + 1);
}

static box bounds_of(const tm_surface *surface, size_t t)
{
    box b = empty;
    for (int i = 0; i < 3; i++) {
        const double *p = surface->xyz[surface->triangle[t][i]];
        box at;
        memcpy(at.low, p, sizeof at.low);
        memcpy(at.high, p, sizeof at.high);
        extend(&b, &at);
    }
    return b;
}

/* Whether the height of a triangle is less than 1e-7 of its longest edge. */
static bool is_thin(const double corner[3][3])
{
    const double least = 1e-14; /* squared */
    double normal[3], longest2 = 0;
    tm_triangle_normal(normal, corner[0], corner[1], corner[2]);
    for (int i = 0; i < 3; i++)
        longest2 = fmax(longest2, tm_distance2(corner[i], corner[(i + 1) % 3]));
    return !(tm_norm2(normal) > least * longest2 * longest2);
}

static uint32_t common_patch(const tm_surface_tree *tree, const tm_tree_node *node)
{
    if (node->count == 0) {
        uint32_t patch = tree->node[node->first].patch;
        return patch == tree->node[node->first + 1].patch ? patch : TM_NONE;
    }
    uint32_t patch = tree->triangle[node->first].patch;
    for (uint32_t i = 1; i < node->count; i++)
        if (tree->triangle[node->first + i].patch != patch)
            return TM_NONE;
    return patch;
}

void tm_surface_tree_refresh(tm_surface *surface)
{
    tm_surface_tree *tree = surface->tree;
    for (size_t i = 0; i < surface->triangles; i++) {
        tm_tree_triangle *triangle = &tree->triangle[i];
        const uint32_t *v = surface->triangle[triangle->id];
        for (int k = 0; k < 3; k++)
            memcpy(triangle->corner[k], surface->xyz[v[k]], sizeof *triangle->corner);
        triangle->patch =
            surface->patch ? surface->patch[triangle->id] & (TM_NONE >> 1) : 0;
        triangle->thin = is_thin((const double(*)[3])triangle->corner);
    }
    /* Children come after their parents. */
    for (size_t n = tree->nodes; n-- > 0;)
        tree->node[n].patch = common_patch(tree, &tree->node[n]);
}

static unsigned thinnest_axis(const tm_surface *surface)
{
    unsigned best = 2;
    for (unsigned i = 0; i < 3; i++)
        if (surface->high[i] - surface->low[i] < surface->high[best] - surface->low[best])
            best = i;
    return best;
}

static bool allocate(tm_surface_tree *tree, size_t triangles)
{
    size_t line = sizeof(tm_tree_node);
    tree->node = aligned_alloc(line, 2 * triangles * line);
    tree->triangle = tm_new(triangles, sizeof *tree->triangle);
    tree->slot = tm_new(triangles, sizeof *tree->slot);
    return tree->node && tree->triangle && tree->slot;
}

tm_status tm_surface_tree_build(tm_surface *surface, tm_error *error)
{
    size_t n = surface->triangles;
    surface->tree = calloc(1, sizeof *surface->tree);
    box *bounds = tm_new(n, sizeof *bounds);
    builder b = {surface->tree, bounds, tm_new(n, sizeof *b.order),
                 tm_new(n, sizeof *b.aside)};
    bool done = b.tree && bounds && b.order && b.aside && allocate(b.tree, n > 0 ? n : 1);
    if (done) {
        for (size_t t = 0; t < n; t++) {
            bounds[t] = bounds_of(surface, t);
            b.order[t] = (uint32_t)t;
        }
        b.tree->nodes = 1;
        build_node(&b, 0, 0, n, 0);
        for (size_t i = 0; i < n; i++) {
            b.tree->triangle[i].id = b.order[i];
            b.tree->slot[b.order[i]] = (uint32_t)i;
        }
        b.tree->axis = thinnest_axis(surface);
        tm_surface_tree_refresh(surface);
    }
    free(bounds);
    free(b.order);
    free(b.aside);
    return done ? TM_OK : tm_fail_memory(error);
}

void tm_surface_tree_free(tm_surface_tree *tree)
{
    if (!tree)
        return;
    free(tree->node);
    free(tree->triangle);
    free(tree->slot);
    free(tree->dipole);
    free(tree->curve_box);
    free(tree);
}

/* Whether triangles meet a box: they do not where one of 13 axes separates both, the
 * normals of box and triangle and the products of their edges (T. Akenine-Möller, Fast
 * 3D triangle-box overlap testing, Journal of Graphics Tools 6, 2001). Every comparison
 * leaves room for its rounding: "yes" may be wrong by that, "no" is right. */

/* Above all roundings of one axis, per size of what is summed. */
static const double rounding = 0x1p-49;

typedef struct cube {
    const double *low, *high;
    double centre[3], half[3];
} cube;

static cube make_cube(const double low[3], const double high[3])
{
    cube c = {.low = low, .high = high};
    for (int i = 0; i < 3; i++) {
        c.centre[i] = low[i] / 2 + high[i] / 2;
        c.half[i] =
            (high[i] / 2 - low[i] / 2) + rounding * fmax(fabs(low[i]), fabs(high[i]));
    }
    return c;
}

/* The axes edge × unit vector, for one edge of a triangle, whose corners p and q (one of
 * the edge, and the one opposite) are relative to the centre. */
static inline bool edge_separates(const cube *c, const double e[3], const double p[3],
                                  const double q[3], double size)
{
    for (int i = 0; i < 3; i++) {
        int j = i == 2 ? 0 : i + 1, k = i == 0 ? 2 : i - 1;
        double sp = e[k] * p[j] - e[j] * p[k];
        double sq = e[k] * q[j] - e[j] * q[k];
        double ej = fabs(e[j]), ek = fabs(e[k]);
        double reach = ek * c->half[j] + ej * c->half[k] + rounding * size * (ej + ek);
        double low = sp < sq ? sp : sq, high = sp < sq ? sq : sp;
        if (low > reach || high < -reach)
            return true;
    }
    return false;
}

static bool meets(const cube *c, const double corner[3][3])
{
    bool within[3] = {true, true, true};
    for (int i = 0; i < 3; i++) {
        double a = corner[0][i], b = corner[1][i], d = corner[2][i];
        if ((a < c->low[i] && b < c->low[i] && d < c->low[i]) ||
            (a > c->high[i] && b > c->high[i] && d > c->high[i]))
            return false;
        within[0] &= c->low[i] <= a && a <= c->high[i];
        within[1] &= c->low[i] <= b && b <= c->high[i];
        within[2] &= c->low[i] <= d && d <= c->high[i];
    }
    if (within[0] || within[1] || within[2])
        return true;
    double p[3][3], e[3][3], normal[3], size = 0;
    for (int k = 0; k < 3; k++)
        tm_subtract(p[k], corner[k], c->centre);
    for (int k = 0; k < 3; k++) {
        tm_subtract(e[k], corner[k == 2 ? 0 : k + 1], corner[k]);
        size = fmax(size, fmax(fabs(p[k][0]), fmax(fabs(p[k][1]), fabs(p[k][2]))));
    }
    tm_cross(normal, e[0], e[1]);
    double n0 = fabs(normal[0]), n1 = fabs(normal[1]), n2 = fabs(normal[2]);
    double edges = (fabs(e[0][0]) + fabs(e[0][1]) + fabs(e[0][2])) *
                   (fabs(e[1][0]) + fabs(e[1][1]) + fabs(e[1][2]));
    double reach =
        n0 * c->half[0] + n1 * c->half[1] + n2 * c->half[2] + rounding * size * edges;
    if (fabs(tm_dot(normal, p[0])) > reach)
        return false;
    return !edge_separates(c, e[0], p[0], p[2], size) &&
           !edge_separates(c, e[1], p[1], p[0], size) &&
           !edge_separates(c, e[2], p[2], p[1], size);
}

static inline bool overlaps(const tm_tree_node *node, const double low[3],
                            const double high[3])
{
    return node->low[0] <= high[0] && low[0] <= node->high[0] &&
           node->low[1] <= high[1] && low[1] <= node->high[1] &&
           node->low[2] <= high[2] && low[2] <= node->high[2];
}

bool tm_surface_meets_box(const tm_surface *surface, const double low[3],
                          const double high[3])
{
    const tm_surface_tree *tree = surface->tree;
    cube c = make_cube(low, high);
    uint32_t stack[TM_TREE_DEPTH];
    size_t height = 0;
    if (overlaps(&tree->node[0], low, high))
        stack[height++] = 0;
    while (height > 0) {
        const tm_tree_node *node = &tree->node[stack[--height]];
        if (node->count == 0) {
            if (overlaps(&tree->node[node->first + 1], low, high))
                stack[height++] = node->first + 1;
            if (overlaps(&tree->node[node->first], low, high))
                stack[height++] = node->first;
        }
        for (uint32_t i = 0; i < node->count; i++)
            if (meets(&c, (const double(*)[3])tree->triangle[node->first + i].corner))
                return true;
    }
    return false;
}

size_t tm_surface_cull(const tm_surface *surface, const uint32_t *list, size_t count,
                       const double low[3], const double high[3], uint32_t *kept)
{
    const tm_surface_tree *tree = surface->tree;
    cube c = make_cube(low, high);
    size_t number = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t t = list[i];
        const tm_tree_triangle *triangle = &tree->triangle[tree->slot[t]];
        if (meets(&c, (const double(*)[3])triangle->corner))
            kept[number++] = t;
    }
    return number;
}
