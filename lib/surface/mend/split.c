/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Open edges with nodes of other open edges in their middle: the triangle is divided. */
#include "soup.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A node in the middle of an edge, and how far along. */
typedef struct {
    double along; /* 0 … 1 */
    uint32_t node;
} middle;

typedef struct {
    tm_soup *soup;
    double within;
    uint32_t *open; /* nodes of open edges */
    size_t opens;
    tm_near near;
    middle *found; /* of one edge */
    size_t count, room;
    tm_mended *split;
    tm_error *error;
} splitter;

static int compare_middles(const void *a, const void *b)
{
    const middle *p = a, *q = b;
    if (p->along != q->along)
        return p->along < q->along ? -1 : 1;
    return (p->node > q->node) - (p->node < q->node);
}

/* Takes a node that is in the middle of edge a c of triangle t. */
static bool try_node(splitter *s, const uint32_t *t, uint32_t a, uint32_t c, uint32_t v)
{
    const double(*xyz)[3] = s->soup->xyz;
    double edge[3], to[3], foot2 = 0;
    if (v == t[0] || v == t[1] || v == t[2])
        return true;
    tm_subtract(edge, xyz[c], xyz[a]);
    tm_subtract(to, xyz[v], xyz[a]);
    const double length2 = tm_norm2(edge), along = tm_dot(to, edge) / length2;
    for (int x = 0; x < 3; x++)
        foot2 += (to[x] - along * edge[x]) * (to[x] - along * edge[x]);
    const double end = s->within / sqrt(length2);
    if (!(along > end && along < 1 - end) || foot2 > s->within * s->within)
        return true;
    for (size_t i = 0; i < s->count; i++)
        if (s->found[i].node == v)
            return true;
    void *more = tm_grow(s->found, &s->room, s->count + 1, sizeof *s->found);
    if (!more)
        return false;
    s->found = more;
    s->found[s->count++] = (middle){along, v};
    return true;
}

/* The cells of the grid that an edge's box meets, by axis; false where they are more than
 * nodes. */
static bool count_cells(const splitter *s, const double *a, const double *c, int cells[3])
{
    double all = 1;
    for (int x = 0; x < 3; x++) {
        const double low = fmin(a[x], c[x]) - s->within,
                     high = fmax(a[x], c[x]) + s->within;
        const double number = floor(high / s->near.cell) - floor(low / s->near.cell) + 1;
        all *= number;
        if (!(all < (double)s->opens))
            return false;
        cells[x] = (int)number;
    }
    return true;
}

static bool find_middles(splitter *s, const uint32_t *t, uint32_t a, uint32_t c)
{
    const double *pa = s->soup->xyz[a], *pc = s->soup->xyz[c];
    double low[3];
    int cells[3], offset[3];
    bool ok = true;
    s->count = 0;
    if (!count_cells(s, pa, pc, cells)) {
        for (size_t i = 0; i < s->opens && ok; i++)
            ok = try_node(s, t, a, c, s->open[i]);
        return ok;
    }
    for (int x = 0; x < 3; x++)
        low[x] = fmin(pa[x], pc[x]) - s->within;
    for (offset[0] = 0; offset[0] < cells[0]; offset[0]++)
        for (offset[1] = 0; offset[1] < cells[1]; offset[1]++)
            for (offset[2] = 0; offset[2] < cells[2]; offset[2]++)
                for (uint32_t v = tm_near_first(&s->near, low, offset);
                     v != TM_NONE && ok; v = s->near.next[v])
                    ok = try_node(s, t, a, c, v);
    return ok;
}

/* Finds the nodes in the middle of the first side of triangle t that has some; the side,
 * or 3. Others follow in a later round. */
static unsigned find_side(splitter *s, size_t t, bool *ok)
{
    const uint32_t *node = s->soup->triangle[t];
    s->count = 0;
    for (unsigned i = 0; i < 3; i++) {
        if (!tm_soup_is_open(s->soup, t, i))
            continue;
        *ok = find_middles(s, node, node[i], node[(i + 1) % 3]);
        if (!*ok || s->count > 0)
            return i;
    }
    return 3;
}

/* Puts the pieces of triangle t behind all others: each has the corner opposite. */
static tm_status divide(splitter *s, size_t t, unsigned side)
{
    const int32_t marker = s->soup->marker ? s->soup->marker[t] : 0;
    const uint32_t a = s->soup->triangle[t][side],
                   b = s->soup->triangle[t][(side + 1) % 3];
    const uint32_t opposite = s->soup->triangle[t][(side + 2) % 3];
    tm_status status = TM_OK;
    qsort(s->found, s->count, sizeof *s->found, compare_middles);
    for (size_t i = 0; i <= s->count && status == TM_OK; i++) {
        const uint32_t piece[3] = {opposite, i > 0 ? s->found[i - 1].node : a,
                                   i < s->count ? s->found[i].node : b};
        status = tm_soup_add(s->soup, piece, marker, s->error);
    }
    for (size_t i = 0; i < s->count; i++)
        tm_mend_count(s->split, s->soup->xyz[s->found[i].node]);
    return status;
}

static tm_status divide_all(splitter *s)
{
    const size_t triangles = s->soup->triangles;
    bool *divided = calloc(triangles + 1, sizeof *divided);
    tm_status status = TM_OK;
    if (!divided)
        return tm_fail_memory(s->error);
    for (size_t t = 0; t < triangles && status == TM_OK; t++) {
        bool ok = true;
        const unsigned side = find_side(s, t, &ok);
        if (!ok)
            status = tm_fail_memory(s->error);
        divided[t] = ok && side < 3;
        if (divided[t])
            status = divide(s, t, side);
    }
    if (status == TM_OK)
        tm_soup_drop(s->soup, divided, triangles);
    free(divided);
    return status;
}

/* The mean length of open edges. */
static double mean_length(const tm_soup *soup)
{
    double sum = 0;
    for (size_t t = 0; t < soup->triangles; t++)
        for (unsigned i = 0; i < 3; i++)
            if (tm_soup_is_open(soup, t, i))
                sum += sqrt(tm_distance2(soup->xyz[soup->triangle[t][i]],
                                         soup->xyz[soup->triangle[t][(i + 1) % 3]]));
    return soup->open > 0 ? sum / (double)soup->open : 0;
}

tm_status tm_soup_split(tm_soup *soup, double within, tm_mended *split, tm_error *error)
{
    splitter s = {.soup = soup, .within = within, .split = split, .error = error};
    const double cell = fmax(mean_length(soup), 2 * within);
    tm_status status = TM_OK;
    if (!(cell > 0))
        return TM_OK;
    if (!tm_soup_open_nodes(soup, &s.open, &s.opens) ||
        !tm_near_make(&s.near, soup->xyz, soup->nodes, s.open, s.opens, cell))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = divide_all(&s);
    tm_near_free(&s.near);
    free(s.open);
    free(s.found);
    return status;
}
