/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octant_triangles.h"

#include "../base/array.h"
#include "../geom/vector.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum { CHILDREN = 8 };

static const double touch = 1e-6;

/* An octant's place in Z order: the bits of its coordinates in turn. */
typedef struct place {
    uint64_t key;
    uint32_t octant;
} place;

typedef struct finder {
    tm_octant_triangles *found;
    const tm_octant_box *octant;
    const double (*triangle)[3][3];
    place *place;    /* [octants], in Z order */
    uint32_t *stack; /* the triangles of the cubes above, and of this one */
    size_t stack_room;
    size_t items, item_room;
    tm_error *error;
} finder;

/* Two zeros between each bit and the next. */
static uint64_t spread(uint32_t number)
{
    uint64_t bits = 0;
    for (int i = 0; i < TM_OCTANT_BITS; i++)
        bits |= (uint64_t)(number >> i & 1) << 3 * i;
    return bits;
}

static uint64_t key_of(const uint32_t anchor[3])
{
    return spread(anchor[0]) | spread(anchor[1]) << 1 | spread(anchor[2]) << 2;
}

static int compare(const void *a, const void *b)
{
    const place *p = a, *q = b;
    if (p->key != q->key)
        return p->key < q->key ? -1 : 1;
    return (p->octant > q->octant) - (p->octant < q->octant);
}

/* Triangle and cube ---------------------------------------------------------------- */

/* Whether a plane across `axis` separates a triangle from the cube |x| <= half. */
static bool separates(const double axis[3], const double v[3][3], double half)
{
    double radius = half * (fabs(axis[0]) + fabs(axis[1]) + fabs(axis[2]));
    double p = tm_dot(axis, v[0]), q = tm_dot(axis, v[1]), r = tm_dot(axis, v[2]);
    return fmin(p, fmin(q, r)) > radius || fmax(p, fmax(q, r)) < -radius;
}

/* By the 13 axes that can separate them (S. Gottschalk, M. Lin and D. Manocha, OBBTree,
 * 1996, for a triangle: T. Akenine-Moller, 2001). */
static bool meets(const double triangle[3][3], const uint32_t anchor[3],
                  unsigned log_side)
{
    double v[3][3], normal[3];
    double half = ldexp(1, (int)log_side) / 2;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            v[i][k] = triangle[i][k] - (anchor[k] + half);
    half += touch;
    for (int k = 0; k < 3; k++) {
        const double axis[3] = {k == 0, k == 1, k == 2};
        if (separates(axis, v, half))
            return false;
    }
    tm_triangle_normal(normal, v[0], v[1], v[2]);
    if (separates(normal, v, half))
        return false;
    for (int i = 0; i < 3; i++) {
        double edge[3];
        tm_subtract(edge, v[(i + 1) % 3], v[i]);
        for (int k = 0; k < 3; k++) {
            const double unit[3] = {k == 0, k == 1, k == 2};
            double axis[3];
            tm_cross(axis, unit, edge);
            if (separates(axis, v, half))
                return false;
        }
    }
    return true;
}

/* Down the tree -------------------------------------------------------------------- */

/* Puts those of the triangles `from` … `past` of the stack behind them that meet the
 * cube; *end is where they end. */
static tm_status filter(finder *f, size_t from, size_t past, const uint32_t anchor[3],
                        unsigned log_side, size_t *end)
{
    uint32_t *stack =
        tm_grow(f->stack, &f->stack_room, 2 * past - from, sizeof *f->stack);
    if (!stack)
        return tm_fail_memory(f->error);
    f->stack = stack;
    *end = past;
    for (size_t i = from; i < past; i++)
        if (meets(f->triangle[stack[i]], anchor, log_side))
            stack[(*end)++] = stack[i];
    return TM_OK;
}

static tm_status assign(finder *f, uint32_t octant, size_t from, size_t past)
{
    tm_octant_triangles *found = f->found;
    uint32_t *item =
        tm_grow(found->item, &f->item_room, f->items + past - from, sizeof *item);
    if (!item)
        return tm_fail_memory(f->error);
    found->item = item;
    found->start[octant] = f->items;
    found->count[octant] = (uint32_t)(past - from);
    for (size_t i = from; i < past; i++)
        item[f->items++] = f->stack[i];
    return TM_OK;
}

/* The first of the places lo … hi - 1 that is not before a key, or hi. */
static size_t first_from(const finder *f, size_t lo, size_t hi, uint64_t key)
{
    while (lo < hi) {
        size_t middle = lo + (hi - lo) / 2;
        if (f->place[middle].key < key)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

/* The octants at the places lo … hi - 1 are in this cube, which the triangles from …
 * past - 1 of the stack meet. */
static tm_status descend(finder *f, size_t lo, size_t hi, const uint32_t anchor[3],
                         unsigned log_side, size_t from, size_t past)
{
    tm_status status = TM_OK;
    size_t end = past;
    if (lo == hi || from == past)
        return TM_OK;
    if (hi - lo == 1) {
        uint32_t o = f->place[lo].octant;
        status = filter(f, from, past, f->octant[o].anchor, f->octant[o].log_side, &end);
        return status == TM_OK ? assign(f, o, past, end) : status;
    }
    for (uint32_t c = 0; c < CHILDREN && status == TM_OK; c++) {
        const unsigned log = log_side - 1;
        const uint32_t child[3] = {anchor[0] + ((c & 1) << log),
                                   anchor[1] + ((c >> 1 & 1) << log),
                                   anchor[2] + ((c >> 2) << log)};
        size_t next = first_from(f, lo, hi, key_of(child) + (UINT64_C(1) << 3 * log));
        if (next > lo)
            status = filter(f, from, past, child, log, &end);
        if (next > lo && status == TM_OK)
            status = descend(f, lo, next, child, log, past, end);
        lo = next;
    }
    return status;
}

static tm_status check_overlap(const finder *f, size_t octants, unsigned base)
{
    for (size_t i = 1; i < octants; i++) {
        const place *p = &f->place[i - 1];
        if (f->place[i].key - p->key < UINT64_C(1) << 3 * f->octant[p->octant].log_side)
            return tm_fail_at(f->error, TM_ERROR_INPUT, NULL, 0, ".octant",
                              "octants %zu and %zu overlap", p->octant + (size_t)base,
                              f->place[i].octant + (size_t)base);
    }
    return TM_OK;
}

tm_status tm_octant_triangles_find(tm_octant_triangles *found,
                                   const tm_octant_box *octant, size_t octants,
                                   const double (*triangle)[3][3], size_t triangles,
                                   unsigned base, tm_error *error)
{
    static const uint32_t origin[3] = {0, 0, 0};
    *found = (tm_octant_triangles){calloc(octants + 1, sizeof *found->start),
                                   calloc(octants + 1, sizeof *found->count), NULL};
    finder f = {.found = found,
                .octant = octant,
                .triangle = triangle,
                .place = tm_new(octants, sizeof *f.place),
                .stack = tm_new(triangles, sizeof *f.stack),
                .stack_room = triangles,
                .error = error};
    tm_status status = tm_fail_memory(error);
    if (found->start && found->count && f.place && f.stack) {
        for (size_t o = 0; o < octants; o++)
            f.place[o] = (place){key_of(octant[o].anchor), (uint32_t)o};
        for (size_t t = 0; t < triangles; t++)
            f.stack[t] = (uint32_t)t;
        qsort(f.place, octants, sizeof *f.place, compare);
        status = check_overlap(&f, octants, base);
    }
    if (status == TM_OK)
        status = descend(&f, 0, octants, origin, TM_OCTANT_BITS, 0, triangles);
    free(f.place);
    free(f.stack);
    return status;
}

void tm_octant_triangles_free(tm_octant_triangles *found)
{
    free(found->start);
    free(found->count);
    free(found->item);
    *found = (tm_octant_triangles){0};
}
