/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shelling.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "../tet/operation/ball.h"
#include "../geom/kernel.h"

#include <stdlib.h>
#include <string.h>

/* The kernel's ball has at least this part of the piece's extent as its radius. */
static const double least_ball = 1e-4;

void tm_shelling_free(tm_shelling *s)
{
    free(s->piece);
    free(s->node_piece);
    free(s->member);
    free(s->queue);
    free(s->plane);
    free(s->xyz);
    tm_star_free(&s->star);
    *s = (tm_shelling){0};
}

/* Scales the nodes, by powers of two, so that no side of the box around them is less than
 * half of the longest: stars stay stars. */
static bool scale(tm_shelling *s)
{
    const tm_tet_mesh *mesh = s->mesh;
    double low[3], high[3], most = 0, by[3];
    s->xyz = tm_new(mesh->nodes, sizeof *s->xyz);
    for (int x = 0; x < 3; x++) {
        low[x] = HUGE_VAL;
        high[x] = -HUGE_VAL;
        for (size_t v = 0; v < mesh->nodes; v++) {
            low[x] = fmin(low[x], mesh->xyz[v][x]);
            high[x] = fmax(high[x], mesh->xyz[v][x]);
        }
        most = fmax(most, high[x] - low[x]);
    }
    for (int x = 0; x < 3; x++)
        by[x] = high[x] > low[x] ? ldexp(1, ilogb(most / (high[x] - low[x]))) : 1;
    for (size_t v = 0; v < mesh->nodes && s->xyz; v++)
        for (int x = 0; x < 3; x++)
            s->xyz[v][x] = by[x] * mesh->xyz[v][x];
    return s->xyz;
}

tm_status tm_shelling_start(tm_shelling *s, const tm_tet_mesh *mesh,
                            const tm_poly_options *options, tm_error *error)
{
    *s = (tm_shelling){.mesh = mesh, .options = options};
    s->piece = tm_new(mesh->slots, sizeof *s->piece);
    s->node_piece = tm_new(mesh->nodes, sizeof *s->node_piece);
    if (!s->piece || !s->node_piece || !scale(s))
        return tm_fail_memory(error);
    for (size_t t = 0; t < mesh->slots; t++)
        s->piece[t] = TM_NONE;
    for (size_t v = 0; v < mesh->nodes; v++)
        s->node_piece[v] = TM_NONE;
    return TM_OK;
}

static bool push_neighbours(tm_shelling *s, uint32_t t)
{
    uint32_t *queue = tm_grow(s->queue, &s->queue_room, s->queued + 4, sizeof *queue);
    if (!queue)
        return false;
    s->queue = queue;
    for (int i = 0; i < 4; i++) {
        uint32_t across = s->mesh->neighbour[t][i];
        if (!(across & TM_FACE_BIT) && s->piece[across / 4] != s->id)
            queue[s->queued++] = across / 4;
    }
    return true;
}

static bool add(tm_shelling *s, uint32_t t)
{
    uint32_t *member = tm_grow(s->member, &s->member_room, s->size + 1, sizeof *member);
    if (!member)
        return false;
    s->member = member;
    member[s->size++] = t;
    s->piece[t] = s->id;
    for (int i = 0; i < 4; i++) {
        uint32_t v = s->mesh->tet[t][i];
        s->node_piece[v] = s->id;
        for (int x = 0; x < 3 && s->options->star; x++) {
            s->low[x] = fmin(s->low[x], s->xyz[v][x]);
            s->high[x] = fmax(s->high[x], s->xyz[v][x]);
        }
    }
    return push_neighbours(s, t);
}

static void begin(tm_shelling *s, uint32_t id, uint32_t t)
{
    s->id = id;
    s->size = s->queued = 0;
    s->depth = -1; /* no centre */
    memcpy(s->origin, s->xyz[s->mesh->tet[t][0]], sizeof s->origin);
    for (int x = 0; x < 3; x++) {
        s->low[x] = HUGE_VAL;
        s->high[x] = -HUGE_VAL;
    }
}

bool tm_shelling_begin(tm_shelling *s, uint32_t id, uint32_t t)
{
    begin(s, id, t);
    return add(s, t);
}

bool tm_shelling_resume(tm_shelling *s, uint32_t id, const uint32_t *member, size_t size)
{
    begin(s, id, member[0]);
    for (size_t k = 0; k < size; k++)
        if (!add(s, member[k]))
            return false;
    return true;
}

/* Whether a tetrahedron of the piece is at the edge of t between corners i and j; also
 * where that cannot be told. */
static bool has_edge(tm_shelling *s, uint32_t t, unsigned i, unsigned j, bool *memory)
{
    const uint32_t *n = s->mesh->tet[t];
    unsigned e = 0;
    while (!((tm_edge_corner[e][0] == i && tm_edge_corner[e][1] == j) ||
             (tm_edge_corner[e][0] == j && tm_edge_corner[e][1] == i)))
        e++;
    if (tm_edge_map_get(&s->mesh->locked, n[i], n[j]))
        return true;
    if (!tm_star_around(s->mesh, t, e, &s->star)) {
        *memory = false;
        return true;
    }
    for (size_t k = 0; k < s->star.size; k++)
        if (s->piece[s->star.tet[k]] == s->id)
            return true;
    return false;
}

/* Whether what t shares with the piece is a disc. */
static bool meets_in_disc(tm_shelling *s, uint32_t t, bool *memory)
{
    unsigned shared[4], shares = 0;
    for (unsigned i = 0; i < 4; i++) {
        uint32_t across = s->mesh->neighbour[t][i];
        bool is_constrained = across & TM_FACE_BIT;
        if (is_constrained)
            across = tm_tet_across(s->mesh, t, i);
        bool is_in = across != TM_NONE && s->piece[across / 4] == s->id;
        if (is_in && is_constrained)
            return false; /* the face would be inside */
        if (is_in)
            shared[shares++] = i;
    }
    if (shares == 1)
        return s->node_piece[s->mesh->tet[t][shared[0]]] != s->id;
    if (shares == 2)
        return !has_edge(s, t, shared[0], shared[1], memory);
    return shares == 3 && !s->options->no_swallow;
}

/* The outer plane of face i of t, its normal of unit length; false where it has none. */
static bool plane_of(const tm_shelling *s, uint32_t t, uint32_t i, double plane[4])
{
    uint32_t n[3];
    double a[3];
    const double(*xyz)[3] = (const double(*)[3])s->xyz;
    tm_tet_face_below(s->mesh, t, i, n);
    tm_triangle_normal(plane, xyz[n[0]], xyz[n[2]], xyz[n[1]]);
    tm_subtract(a, xyz[n[0]], s->origin);
    double length = tm_norm(plane);
    for (int x = 0; x < 3; x++)
        plane[x] /= length;
    plane[3] = tm_dot(plane, a);
    return length > 0;
}

/* Whether face i of t is on the boundary of the piece and t. */
static bool is_outer(const tm_shelling *s, uint32_t t, uint32_t i, uint32_t added)
{
    uint32_t across = s->mesh->neighbour[t][i];
    return across & TM_FACE_BIT || (s->piece[across / 4] != s->id && across / 4 != added);
}

/* How deep the centre is inside of all faces, those of t with them. */
static double depth_with(const tm_shelling *s, uint32_t t)
{
    double plane[4], depth = s->depth;
    for (uint32_t i = 0; i < 4; i++)
        if (is_outer(s, t, i, t))
            depth = plane_of(s, t, i, plane)
                        ? fmin(depth, plane[3] - tm_dot(plane, s->centre))
                        : -1;
    return depth;
}

/* Collects the planes of the piece and t. */
static bool collect_planes(tm_shelling *s, uint32_t t, size_t *count, bool *memory)
{
    double(*plane)[4] =
        tm_grow(s->plane, &s->plane_room, 4 * (s->size + 1), sizeof *plane);
    *count = 0;
    if (!plane) {
        *memory = false;
        return false;
    }
    s->plane = plane;
    for (size_t k = 0; k <= s->size; k++) {
        uint32_t u = k < s->size ? s->member[k] : t;
        for (uint32_t i = 0; i < 4; i++)
            if (is_outer(s, u, i, t) && !plane_of(s, u, i, plane[(*count)++]))
                return false;
    }
    return true;
}

/* How large the piece is with t: the diagonal of a box around it. */
static double extent_with(const tm_shelling *s, uint32_t t)
{
    double extent2 = 0;
    for (int x = 0; x < 3; x++) {
        double low = s->low[x], high = s->high[x];
        for (int i = 0; i < 4; i++) {
            low = fmin(low, s->xyz[s->mesh->tet[t][i]][x]);
            high = fmax(high, s->xyz[s->mesh->tet[t][i]][x]);
        }
        extent2 += (high - low) * (high - low);
    }
    return sqrt(extent2);
}

/* Whether the piece with t is a star. */
static bool stays_star(tm_shelling *s, uint32_t t, bool *memory)
{
    double least = least_ball * extent_with(s, t), centre[3], radius;
    size_t count;
    double depth = depth_with(s, t);
    if (depth >= least) {
        s->depth = depth;
        return true;
    }
    if (!collect_planes(s, t, &count, memory) ||
        !tm_kernel_ball((const double(*)[4])s->plane, count, centre, &radius) ||
        radius < least)
        return false;
    memcpy(s->centre, centre, sizeof centre);
    s->depth = radius;
    return true;
}

/* Whether t can be added. */
static bool fits(tm_shelling *s, uint32_t t, bool *memory)
{
    return meets_in_disc(s, t, memory) && (!s->options->star || stays_star(s, t, memory));
}

static size_t most_tets(const tm_shelling *s)
{
    return s->options->max_tets ? s->options->max_tets : SIZE_MAX;
}

bool tm_shelling_grow(tm_shelling *s, uint32_t *label, uint32_t name)
{
    bool memory = true;
    for (size_t next = 0; next < s->queued && s->size < most_tets(s); next++) {
        uint32_t t = s->queue[next];
        if (label[t] != name || s->piece[t] == s->id || !fits(s, t, &memory)) {
            if (!memory)
                return false;
            continue;
        }
        label[t] = TM_NONE;
        if (!add(s, t))
            return false;
    }
    return true;
}

/* Takes the last tetrahedra out again, down to the piece as it was. */
static void undo(tm_shelling *s, const tm_shelling *was, uint32_t old,
                 uint32_t stamp[TM_SHELLING_ADD][4])
{
    while (s->size > was->size) {
        uint32_t t = s->member[--s->size];
        s->piece[t] = old;
        for (int i = 3; i >= 0; i--)
            s->node_piece[s->mesh->tet[t][i]] = stamp[s->size - was->size][i];
    }
    s->queued = was->queued;
    s->depth = was->depth;
    memcpy(s->centre, was->centre, sizeof s->centre);
    memcpy(s->low, was->low, sizeof s->low);
    memcpy(s->high, was->high, sizeof s->high);
}

bool tm_shelling_add(tm_shelling *s, const uint32_t *tet, size_t count, bool *taken)
{
    tm_shelling was = *s;
    uint32_t stamp[TM_SHELLING_ADD][4], old = s->piece[tet[0]];
    bool memory = true, any = true;
    *taken = false;
    if (s->size + count > most_tets(s))
        return true;
    while (any && s->size < was.size + count) {
        any = false;
        for (size_t k = 0; k < count; k++) {
            if (s->piece[tet[k]] == s->id || !fits(s, tet[k], &memory))
                continue;
            for (int i = 0; i < 4; i++)
                stamp[s->size - was.size][i] = s->node_piece[s->mesh->tet[tet[k]][i]];
            if (!add(s, tet[k]))
                return false;
            any = true;
        }
    }
    *taken = s->size == was.size + count;
    if (!*taken)
        undo(s, &was, old, stamp);
    return memory;
}
