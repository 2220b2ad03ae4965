/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Edges on feature curves.
 *
 * A curve between two places is in the tube around an edge if all its nodes there are, as
 * a tube is convex; and as it leads from one end to the other, each plane across the edge
 * meets it: every point of the edge is near it, too. */
#include "envelope_parts.h"

#include "../../geom/vector.h"

#include <math.h>
#include <string.h>

double tm_segment_distance2(const double p[3], const double a[3], const double b[3])
{
    double ab[3], ap[3], off[3];
    tm_subtract(ab, b, a);
    tm_subtract(ap, p, a);
    double length2 = tm_norm2(ab), s = length2 > 0 ? tm_dot(ap, ab) / length2 : 0;
    s = s < 0 ? 0 : s > 1 ? 1 : s;
    for (int x = 0; x < 3; x++)
        off[x] = ap[x] - s * ab[x];
    return tm_norm2(off);
}

double tm_triangle_distance2(const double p[3], const double a[3], const double b[3],
                             const double c[3])
{
    const double *corner[3] = {a, b, c};
    double normal[3], to[3], side[3], across[3];
    bool within = true;
    tm_triangle_normal(normal, a, b, c);
    for (int i = 0; i < 3 && within; i++) {
        tm_subtract(side, corner[(i + 1) % 3], corner[i]);
        tm_subtract(to, p, corner[i]);
        tm_cross(across, normal, side);
        within = tm_dot(across, to) >= 0;
    }
    double size2 = tm_norm2(normal);
    if (within && size2 > 0) {
        tm_subtract(to, p, a);
        double off = tm_dot(to, normal);
        return off * off / size2;
    }
    return fmin(tm_segment_distance2(p, a, b),
                fmin(tm_segment_distance2(p, b, c), tm_segment_distance2(p, c, a)));
}

size_t tm_envelope_segments(const tm_envelope *envelope, uint32_t curve)
{
    const size_t *start = envelope->reference->curve_start;
    return start[curve + 1] - start[curve] - 1;
}

bool tm_envelope_is_closed(const tm_envelope *envelope, uint32_t curve)
{
    return envelope->closed[curve];
}

uint32_t tm_envelope_begins(const tm_envelope *envelope, uint32_t curve)
{
    const tm_surface *reference = envelope->reference;
    return reference->origin[reference->curve_node[reference->curve_start[curve]]];
}

/* Node k of a curve; of a closed one it goes round. */
static const double *node_of(const tm_envelope *e, uint32_t curve, size_t k)
{
    const tm_surface *reference = e->reference;
    size_t segments = tm_envelope_segments(e, curve);
    size_t at = k > segments ? k - segments : k;
    return reference->xyz[reference->curve_node[reference->curve_start[curve] + at]];
}

bool tm_envelope_allows_edge(const tm_envelope *envelope, uint32_t curve, double from,
                             double to, const double p[3], const double q[3])
{
    const double most = envelope->tolerance * envelope->tolerance;
    const double *before = p;
    double edge[3], along[3];
    tm_subtract(edge, q, p);
    for (size_t k = (size_t)floor(from) + 1; (double)k < to; k++) {
        const double *at = node_of(envelope, curve, k);
        tm_subtract(along, at, before);
        if (!(tm_dot(along, edge) > 0) || tm_segment_distance2(at, p, q) > most)
            return false;
        before = at;
    }
    tm_subtract(along, q, before);
    return tm_dot(along, edge) > 0;
}

double tm_envelope_onto_curve(const tm_envelope *envelope, uint32_t curve, double from,
                              double to, double p[3])
{
    double best = HUGE_VAL, place = from, found[3] = {0, 0, 0};
    for (size_t k = (size_t)floor(from); (double)k < to; k++) {
        const double *a = node_of(envelope, curve, k),
                     *b = node_of(envelope, curve, k + 1);
        double ab[3], ap[3], q[3];
        tm_subtract(ab, b, a);
        tm_subtract(ap, p, a);
        double s = tm_dot(ap, ab) / tm_norm2(ab);
        s = fmin(fmax(s, fmax(from - (double)k, 0)), fmin(to - (double)k, 1));
        for (int x = 0; x < 3; x++)
            q[x] = a[x] + s * ab[x];
        double distance2 = tm_distance2(p, q);
        if (!(distance2 < best))
            continue;
        best = distance2;
        place = (double)k + s;
        memcpy(found, q, sizeof found);
    }
    memcpy(p, found, sizeof found);
    return place;
}
