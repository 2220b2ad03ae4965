/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether the reference covers a triangle within the distance.
 *
 * Seen along the triangle's normal, the triangles of the reference around the one below
 * are cut to it, from one to the next across edges that reach in. All corners of the
 * pieces have to be within the distance of the plane. The signed areas of the pieces sum
 * up to that of the triangle if they cover it once; and if the areas themselves are not
 * much larger, the normals are near.
 *
 * At the border of a patch a triangle may reach beyond the reference: its edge is the
 * chord of a curve there. Then its corners have to be above the reference, and the border
 * that is below the triangle within the distance of one of its edges, with nothing but
 * what is between both uncovered: that is as near. */
#include "envelope_parts.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>
#include <string.h>

/* The true area of what is below may be so many times the triangle's: 48 degrees. */
static const double most_area = 1.5;

/* Areas that differ by this part are the same. */
static const double same_area = 1e-6;

/* A triangle that is lower than this part of its longest edge has no normal. */
static const double least_height = 1e-5;

/* Of the border a shorter piece, by that edge, only touches the triangle. */
static const double least_border = 1e-9;

enum { PIECE_MOST = 10, FLOOD_MOST = 20000, LOOKED_AROUND = 24 };

/* The triangle's own coordinates: u and v in its plane, z off it. */
typedef struct frame {
    double origin[3], axis[3][3];
    double corner[3][2];
    double area2; /* twice its area */
    double longest;
} frame;

typedef double piece[PIECE_MOST][3];

static bool make_frame(const double *const p[3], frame *f)
{
    int longest = 0;
    double length2 = 0, along[3], to[3];
    for (int i = 0; i < 3; i++) {
        double l2 = tm_distance2(p[i], p[(i + 1) % 3]);
        if (l2 > length2) {
            length2 = l2;
            longest = i;
        }
    }
    tm_triangle_normal(f->axis[2], p[0], p[1], p[2]);
    f->area2 = tm_norm(f->axis[2]);
    f->longest = sqrt(length2);
    if (!(f->area2 > least_height * length2))
        return false;
    tm_subtract(along, p[(longest + 1) % 3], p[longest]);
    for (int x = 0; x < 3; x++) {
        f->axis[2][x] /= f->area2;
        f->axis[0][x] = along[x] / f->longest;
    }
    tm_cross(f->axis[1], f->axis[2], f->axis[0]);
    memcpy(f->origin, p[0], sizeof f->origin);
    for (int i = 0; i < 3; i++) {
        tm_subtract(to, p[i], f->origin);
        f->corner[i][0] = tm_dot(to, f->axis[0]);
        f->corner[i][1] = tm_dot(to, f->axis[1]);
    }
    return true;
}

/* How far a point of the frame is inside edge i of the triangle, times its length. */
static inline double inside(const frame *f, int i, const double q[3])
{
    const double *a = f->corner[i], *b = f->corner[(i + 1) % 3];
    return (b[0] - a[0]) * (q[1] - a[1]) - (b[1] - a[1]) * (q[0] - a[0]);
}

static inline void between(const double a[3], const double b[3], double s, double out[3])
{
    for (int x = 0; x < 3; x++)
        out[x] = a[x] + s * (b[x] - a[x]);
}

/* Cuts a polygon of the frame to the triangle; how many corners are left. */
static size_t cut(const frame *f, piece p, size_t count)
{
    piece from;
    for (int i = 0; i < 3 && count > 0; i++) {
        size_t made = 0;
        memcpy(from, p, count * sizeof *from);
        for (size_t k = 0; k < count; k++) {
            const double *a = from[k], *b = from[k + 1 < count ? k + 1 : 0];
            double da = inside(f, i, a), db = inside(f, i, b);
            if (da >= 0)
                memcpy(p[made++], a, sizeof *p);
            if ((da > 0 && db < 0) || (da < 0 && db > 0))
                between(a, b, da / (da - db), p[made++]);
        }
        count = made;
    }
    return count;
}

/* Cuts a segment of the frame to the triangle; false where nothing of it is inside. */
static bool cut_segment(const frame *f, double a[3], double b[3])
{
    double from = 0, to = 1, start[3], end[3];
    for (int i = 0; i < 3; i++) {
        double da = inside(f, i, a), db = inside(f, i, b);
        if (da < 0 && db < 0)
            return false;
        if (da < 0)
            from = fmax(from, da / (da - db));
        if (db < 0)
            to = fmin(to, da / (da - db));
    }
    if (!(from < to))
        return false;
    between(a, b, from, start);
    between(a, b, to, end);
    memcpy(a, start, sizeof start);
    memcpy(b, end, sizeof end);
    return true;
}

/* Twice the vector area of a polygon. */
static void area_of(piece p, size_t count, double area[3])
{
    memset(area, 0, 3 * sizeof *area);
    for (size_t k = 1; k + 1 < count; k++) {
        double normal[3];
        tm_triangle_normal(normal, p[0], p[k], p[k + 1]);
        for (int x = 0; x < 3; x++)
            area[x] += normal[x];
    }
}

/* Whether a piece ab of the border, of a triangle with a third corner c, is within the
 * distance of an edge of the triangle, and what it leaves uncovered is towards that edge.
 */
static bool is_near_edge(const tm_envelope *e, const frame *f, const double a[3],
                         const double b[3], const double c[3])
{
    const double most = e->tolerance * e->tolerance, along = 0.5;
    double side[2] = {b[0] - a[0], b[1] - a[1]};
    double turn = side[0] * (c[1] - a[1]) - side[1] * (c[0] - a[0]);
    double out[2] = {turn > 0 ? side[1] : -side[1], turn > 0 ? -side[0] : side[0]};
    double length = hypot(side[0], side[1]);
    for (int i = 0; i < 3; i++) {
        const double *from = f->corner[i], *to = f->corner[(i + 1) % 3];
        double p[3] = {from[0], from[1], 0}, q[3] = {to[0], to[1], 0};
        double edge[2] = {to[0] - from[0], to[1] - from[1]};
        double same = out[0] * edge[1] - out[1] * edge[0];
        if (same >= along * length * hypot(edge[0], edge[1]) &&
            tm_segment_distance2(a, p, q) <= most &&
            tm_segment_distance2(b, p, q) <= most)
            return true;
    }
    return false;
}

typedef struct search {
    tm_envelope *e;
    frame f;
    bool at_border;
    bool is_covered[3];       /* the corners */
    double area2, true_area2; /* of the pieces: signed, and not */
} search;

/* The triangle of the same patch across edge i of t; TM_NONE. */
static uint32_t neighbour(const tm_surface *reference, uint32_t t, int i)
{
    uint32_t u = reference->across[t][i];
    return u != TM_NONE && reference->patch[u] == reference->patch[t] ? u : TM_NONE;
}

/* Goes on to what is across the edges of triangle t that reach into the triangle. False
 * where the border does too far from its edges, or memory is out. */
static bool go_on(search *s, uint32_t t, piece corner)
{
    const tm_surface *reference = s->e->reference;
    for (int i = 0; i < 3; i++) {
        double a[3], b[3];
        uint32_t across = neighbour(reference, t, i);
        if (across != TM_NONE && tm_tet_is_marked(&s->e->seen, across))
            continue;
        memcpy(a, corner[i], sizeof a);
        memcpy(b, corner[(i + 1) % 3], sizeof b);
        if (!cut_segment(&s->f, a, b))
            continue;
        if (across == TM_NONE) {
            if (hypot(b[0] - a[0], b[1] - a[1]) <= least_border * s->f.longest)
                continue;
            s->at_border = true;
            if (!is_near_edge(s->e, &s->f, a, b, corner[(i + 2) % 3]))
                return false;
        } else {
            tm_tet_mark(&s->e->seen, across);
            if (!tm_append(&s->e->flood, &s->e->flood_count, &s->e->flood_room, across))
                return false;
        }
    }
    return true;
}

/* Notes which corners of the triangle are above one of the reference. */
static void cover_corners(search *s, piece corner)
{
    const double rounding = 1e-6;
    for (int k = 0; k < 3; k++) {
        const double *at = s->f.corner[k];
        double side[3], least = HUGE_VAL, most = -HUGE_VAL;
        for (int i = 0; i < 3; i++) {
            const double *a = corner[i], *b = corner[(i + 1) % 3];
            side[i] = (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]);
            side[i] /= hypot(b[0] - a[0], b[1] - a[1]);
            least = fmin(least, side[i]);
            most = fmax(most, side[i]);
        }
        double off = rounding * s->f.longest;
        s->is_covered[k] |= least >= -off || most <= off;
    }
}

enum answer { REFUSED, APART, OVERLAPS };

/* Cuts triangle t of the reference to the triangle; *part is twice the area left. */
static enum answer look_at(search *s, uint32_t t, double *part)
{
    const tm_surface *reference = s->e->reference;
    piece p, corner;
    double to[3], area[3];
    for (int i = 0; i < 3; i++) {
        tm_subtract(to, reference->xyz[reference->triangle[t][i]], s->f.origin);
        for (int x = 0; x < 3; x++)
            p[i][x] = tm_dot(to, s->f.axis[x]);
    }
    memcpy(corner, p, 3 * sizeof *p);
    size_t count = cut(&s->f, p, 3);
    if (count < 3)
        return APART;
    for (size_t k = 0; k < count; k++)
        if (!(fabs(p[k][2]) <= s->e->tolerance))
            return REFUSED;
    area_of(p, count, area);
    s->area2 += area[2];
    s->true_area2 += tm_norm(area);
    *part = fabs(area[2]);
    cover_corners(s, corner);
    return go_on(s, t, corner) ? OVERLAPS : REFUSED;
}

/* The first triangles may be beside the triangle: then their neighbours are looked at. */
static bool look_around(search *s, uint32_t t)
{
    const tm_surface *reference = s->e->reference;
    for (int i = 0; i < 3; i++) {
        uint32_t across = neighbour(reference, t, i);
        if (across == TM_NONE || !tm_tet_mark(&s->e->seen, across))
            continue;
        if (!tm_append(&s->e->flood, &s->e->flood_count, &s->e->flood_room, across))
            return false;
    }
    return true;
}

/* Goes over the reference from the triangle below. What overlaps is moved to the front of
 * e->flood, that with the largest part to the first place. */
static bool flood(search *s)
{
    tm_envelope *e = s->e;
    size_t found = 0;
    double largest = -1, part = 0;
    for (size_t k = 0; k < e->flood_count; k++) {
        uint32_t t = e->flood[k];
        enum answer answer = k < FLOOD_MOST ? look_at(s, t, &part) : REFUSED;
        if (answer == REFUSED)
            return false;
        if (answer == APART) {
            if (found == 0 && (k >= LOOKED_AROUND || !look_around(s, t)))
                return false;
            continue;
        }
        e->flood[found++] = t;
        if (part <= largest)
            continue;
        largest = part;
        e->flood[found - 1] = e->flood[0];
        e->flood[0] = t;
    }
    e->flood_count = found;
    return found > 0;
}

bool tm_envelope_covers(tm_envelope *e, const tm_covered *triangle)
{
    search s = {.e = e};
    e->flood_count = 0;
    if (!make_frame(triangle->p, &s.f) ||
        !tm_tet_marks_clear(&e->seen, e->reference->triangles) ||
        !tm_append(&e->flood, &e->flood_count, &e->flood_room, triangle->below))
        return false;
    tm_tet_mark(&e->seen, triangle->below);
    if (!flood(&s))
        return false;
    double all = s.f.area2, beyond = s.at_border ? 6 * e->tolerance * s.f.longest : 0;
    double area2 = fabs(s.area2);
    bool corners = s.is_covered[0] && s.is_covered[1] && s.is_covered[2];
    if (s.at_border && !corners)
        return false;
    return s.true_area2 <= most_area * all && area2 <= (1 + same_area) * all &&
           area2 >= (1 - same_area) * all - beyond && area2 > 0;
}
