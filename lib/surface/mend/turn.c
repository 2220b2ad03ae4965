/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles that are joined turn the same way; a closed piece outward, unless an odd
 * number of others is around it: then it may be a hole, as it was given. */
#include "soup.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    size_t first, end; /* its triangles: order[first … end) */
    size_t flips;
    bool closed, orientable;
    double volume;
    tm_soup_box box;
} piece;

typedef struct {
    tm_soup *soup;
    uint32_t *order; /* [triangles]: piece by piece */
    bool *met, *flip;
    piece *pieces;
    size_t count, room;
} turner;

/* The triangle beyond side i of triangle t, where the edge has two; and whether it turns
 * the other way. */
static uint32_t across(const turner *w, uint32_t t, unsigned i, bool *against)
{
    const tm_polygon_edges *edges = &w->soup->edges;
    const size_t e = edges->edge_of[3 * (size_t)t + i], at = edges->start[e];
    if (edges->start[e + 1] - at != 2)
        return TM_NONE;
    *against = edges->ascending[at] == edges->ascending[at + 1];
    return edges->polygon[at] == t ? edges->polygon[at + 1] : edges->polygon[at];
}

/* Finds the piece of triangle t, and which of it would be turned to turn as t does. */
static void flood(turner *w, piece *p, uint32_t t)
{
    w->met[t] = true;
    w->order[p->end++] = t;
    for (size_t k = p->first; k < p->end; k++) {
        const uint32_t at = w->order[k];
        p->flips += w->flip[at];
        for (unsigned i = 0; i < 3; i++) {
            bool against = false;
            const uint32_t next = across(w, at, i, &against);
            p->closed &= next != TM_NONE;
            if (next == TM_NONE)
                continue;
            const bool flip = w->flip[at] != against;
            if (!w->met[next]) {
                w->met[next] = true;
                w->flip[next] = flip;
                w->order[p->end++] = next;
            } else if (w->flip[next] != flip) {
                p->orientable = false;
            }
        }
    }
}

static void measure(const turner *w, piece *p)
{
    const double(*xyz)[3] = w->soup->xyz;
    const double *origin = xyz[w->soup->triangle[w->order[p->first]][0]];
    for (size_t k = p->first; k < p->end; k++) {
        const uint32_t t = w->order[k], *v = w->soup->triangle[t];
        const double inward = tm_tet_volume(xyz[v[0]], xyz[v[1]], xyz[v[2]], origin);
        p->volume += w->flip[t] ? inward : -inward;
        for (int i = 0; i < 3; i++)
            tm_soup_put_in_box(&p->box, xyz[v[i]]);
    }
}

static void invert(const turner *w, piece *p)
{
    for (size_t k = p->first; k < p->end; k++)
        w->flip[w->order[k]] = !w->flip[w->order[k]];
    p->flips = p->end - p->first - p->flips;
    p->volume = -p->volume;
}

/* Whether a point is in a closed piece: by the solid angle that this has there (A. van
 * Oosterom and J. Strackee, The solid angle of a plane triangle, 1983). */
static bool is_in(const turner *w, const piece *p, const double place[3])
{
    const double two_pi = 6.28318530717958647693;
    double sum = 0;
    for (int x = 0; x < 3; x++)
        if (place[x] < p->box.low[x] || place[x] > p->box.high[x])
            return false;
    for (size_t k = p->first; k < p->end; k++) {
        const uint32_t t = w->order[k], *v = w->soup->triangle[t];
        double a[3], b[3], c[3], cross[3];
        tm_subtract(a, w->soup->xyz[v[0]], place);
        tm_subtract(b, w->soup->xyz[v[1]], place);
        tm_subtract(c, w->soup->xyz[v[2]], place);
        const double la = tm_norm(a), lb = tm_norm(b), lc = tm_norm(c);
        tm_cross(cross, b, c);
        const double angle =
            2 * atan2(tm_dot(a, cross), la * lb * lc + tm_dot(a, b) * lc +
                                            tm_dot(b, c) * la + tm_dot(c, a) * lb);
        sum += w->flip[t] ? -angle : angle;
    }
    return fabs(sum) > two_pi;
}

static bool is_nested(const turner *w, const piece *p)
{
    const double *place = w->soup->xyz[w->soup->triangle[w->order[p->first]][0]];
    bool odd = false;
    for (size_t i = 0; i < w->count; i++)
        if (&w->pieces[i] != p && w->pieces[i].closed && is_in(w, &w->pieces[i], place))
            odd = !odd;
    return odd;
}

static void turn_piece(const turner *w, const piece *p, tm_mended *turned)
{
    for (size_t k = p->first; k < p->end && p->flips > 0; k++) {
        uint32_t *v = w->soup->triangle[w->order[k]];
        if (!w->flip[w->order[k]])
            continue;
        const uint32_t second = v[1];
        v[1] = v[2];
        v[2] = second;
    }
    if (p->flips > 0)
        tm_mend_count(turned, w->soup->xyz[w->soup->triangle[w->order[p->first]][0]]);
}

static tm_status find_pieces(turner *w, tm_error *error)
{
    size_t end = 0;
    for (uint32_t t = 0; t < w->soup->triangles; t++) {
        if (w->met[t])
            continue;
        void *more = tm_grow(w->pieces, &w->room, w->count + 1, sizeof *w->pieces);
        if (!more)
            return tm_fail_memory(error);
        w->pieces = more;
        piece *p = &w->pieces[w->count++];
        *p = (piece){.first = end,
                     .end = end,
                     .closed = true,
                     .orientable = true,
                     .box = TM_SOUP_NO_BOX};
        flood(w, p, t);
        measure(w, p);
        if (2 * p->flips > p->end - p->first)
            invert(w, p);
        end = p->end;
    }
    return TM_OK;
}

tm_status tm_soup_turn(tm_soup *soup, tm_mended *turned, bool *closed, tm_error *error)
{
    const size_t triangles = soup->triangles;
    turner w = {.soup = soup,
                .order = tm_new(triangles, sizeof *w.order),
                .met = calloc(triangles + 1, sizeof *w.met),
                .flip = calloc(triangles + 1, sizeof *w.flip)};
    tm_status status = w.order && w.met && w.flip ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = find_pieces(&w, error);
    for (size_t i = 0; i < w.count && status == TM_OK; i++) {
        piece *p = &w.pieces[i];
        if (p->orientable && p->closed && p->volume < 0 && !is_nested(&w, p))
            invert(&w, p);
    }
    for (size_t i = 0; i < w.count && status == TM_OK; i++)
        if (w.pieces[i].orientable)
            turn_piece(&w, &w.pieces[i], turned);
    *closed = status == TM_OK;
    for (size_t i = 0; i < w.count && *closed; i++)
        *closed = w.pieces[i].orientable && w.pieces[i].closed;
    free(w.order);
    free(w.met);
    free(w.flip);
    free(w.pieces);
    return status;
}
