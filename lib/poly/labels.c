/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How tetrahedra are joined to regions: the modes of the partition. */
#include "best_faces.h"
#include "compact.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../base/parallel.h"
#include "../geom/vector.h"
#include "../tet/mesh_measure.h"
#include "../tet/operation/ball.h"
#include "item_sets.h"

#include <stdlib.h>

/* By longest edges ----------------------------------------------------------------- */

/* A *fan* is a maximal set of tetrahedra around one edge, each reached from the next
 * through a face, whose longest edge that is. At each of its two ends is a face, and
 * beyond it a tetrahedron that has a longer edge; the one with the longest is the
 * *outlet* of the fan. Edges become longer along outlets, so fans are the nodes of a
 * forest; its trees are the regions. A root is a fan around a terminal edge.
 *
 * All of it is in one array: up[t] is a tetrahedron of its fan with a lower number, of
 * the first one the outlet, or itself.
 */

/* So many tetrahedra are a thread's work at a time. */
enum { CHUNK = 8192 };

typedef struct {
    const tm_tet_mesh *mesh;
    uint8_t *longest; /* [tetrahedra]: an edge, 0 … 5 */
    uint32_t *up;     /* [tetrahedra] */
} forest;

/* The nodes of the longest edge of t. */
static uint64_t longest_key(const forest *s, uint32_t t)
{
    const uint32_t *n = s->mesh->tet[t];
    const uint8_t *corner = tm_edge_corner[s->longest[t]];
    return tm_edge_key(n[corner[0]], n[corner[1]]);
}

/* From tetrahedron `first`, whose fan is around ab with that key, through the faces that
 * have ab and are opposite corner `behind` first. Returns what is across the fan's end,
 * TM_NONE at a kept face or where the fan is closed, or, with *lower, the first one of
 * the fan with a lower number. */
static uint32_t walk_fan(const forest *s, uint32_t first, uint32_t behind, uint64_t key,
                         bool *lower)
{
    const uint32_t corners = 0 + 1 + 2 + 3;
    uint32_t a = (uint32_t)(key >> 32), b = (uint32_t)key, t = first;
    for (;;) {
        uint32_t across = s->mesh->neighbour[t][behind];
        if (across & TM_FACE_BIT || across / 4 == first)
            return TM_NONE;
        t = across / 4;
        if (longest_key(s, t) != key)
            return t;
        *lower = t < first;
        if (*lower)
            return t;
        behind = corners - across % 4 - tm_tet_corner(s->mesh, t, a) -
                 tm_tet_corner(s->mesh, t, b);
    }
}

/* A tetrahedron of the fan of t with a lower number, or t and what is beyond both ends.
 */
static uint32_t find_fan(const forest *s, uint32_t t, uint32_t end[2])
{
    const uint64_t key = longest_key(s, t);
    const uint8_t *corner = tm_edge_corner[s->longest[t]];
    for (int i = 0; i < 2; i++) {
        bool lower = false;
        end[i] = walk_fan(s, t, corner[2 + i], key, &lower);
        if (lower)
            return end[i];
    }
    return t;
}

/* Which of what is beyond the ends has the longest edge; TM_NONE: neither is there. */
static uint32_t outlet_of(const forest *s, const uint32_t end[2])
{
    tm_edge_rank rank[2];
    if (end[0] == TM_NONE || end[1] == TM_NONE)
        return end[end[0] == TM_NONE];
    for (int i = 0; i < 2; i++)
        tm_longest_edge(s->mesh, end[i], &rank[i]);
    return end[tm_edge_is_longer(&rank[1], &rank[0])];
}

static void find_longest(void *context, size_t from, size_t to)
{
    const forest *s = context;
    tm_edge_rank rank;
    for (uint32_t t = (uint32_t)from; t < to; t++)
        s->longest[t] = (uint8_t)tm_longest_edge(s->mesh, t, &rank);
}

static void find_fans(void *context, size_t from, size_t to)
{
    const forest *s = context;
    uint32_t end[2];
    for (uint32_t t = (uint32_t)from; t < to; t++)
        s->up[t] = find_fan(s, t, end);
}

static void find_outlets(void *context, size_t from, size_t to)
{
    const forest *s = context;
    for (uint32_t t = (uint32_t)from; t < to; t++) {
        uint32_t end[2] = {TM_NONE, TM_NONE}, up = find_fan(s, t, end);
        if (up == t)
            up = outlet_of(s, end);
        s->up[t] = up == TM_NONE ? t : up;
    }
}

static void shorten_ways(void *context, size_t from, size_t to)
{
    const forest *s = context;
    for (uint32_t t = (uint32_t)from; t < to; t++)
        tm_set_root_shared(s->up, t);
}

static void find_roots(void *context, size_t from, size_t to)
{
    const forest *s = context;
    for (uint32_t t = (uint32_t)from; t < to; t++)
        tm_set_put_root_shared(s->up, t);
}

static bool find_longest_edges(forest *s, const tm_poly_options *options)
{
    s->longest = tm_new(s->mesh->slots, sizeof *s->longest);
    if (s->longest)
        tm_parallel_runs(options->threads, s->mesh->slots, CHUNK, find_longest, s);
    return s->longest;
}

tm_status tm_poly_outlets(const tm_tet_mesh *mesh, const tm_poly_options *options,
                          uint32_t *up, size_t *regions, tm_error *error)
{
    forest s = {.mesh = mesh, .up = up};
    const bool done = find_longest_edges(&s, options);
    if (done)
        tm_parallel_runs(options->threads, mesh->slots, CHUNK, find_outlets, &s);
    free(s.longest);
    *regions = mesh->slots;
    return done ? TM_OK : tm_fail_memory(error);
}

static tm_status label_terminal(const tm_tet_mesh *mesh, const tm_poly_options *options,
                                uint32_t *label, size_t *regions, tm_error *error)
{
    forest s = {.mesh = mesh, .up = label};
    const tm_status status = tm_poly_outlets(mesh, options, label, regions, error);
    if (status == TM_OK) {
        tm_parallel_runs(options->threads, mesh->slots, CHUNK, shorten_ways, &s);
        tm_parallel_runs(options->threads, mesh->slots, CHUNK, find_roots, &s);
    }
    return status == TM_OK ? tm_number_sets(label, mesh->slots, regions, error) : status;
}

/* All fans around one edge are one region, as far as the mesh's regions allow. */
static tm_status label_longest_edge(const tm_tet_mesh *mesh,
                                    const tm_poly_options *options, uint32_t *label,
                                    size_t *regions, tm_error *error)
{
    forest s = {.mesh = mesh, .up = label};
    tm_edge_map first = {0}; /* the first tetrahedron with this longest edge */
    const bool done =
        find_longest_edges(&s, options) && tm_edge_map_reserve(&first, mesh->slots);
    if (done)
        tm_parallel_runs(options->threads, mesh->slots, CHUNK, find_fans, &s);
    *regions = 0;
    for (uint32_t t = 0; t < mesh->slots && done; t++) {
        if (label[t] != t) {
            label[t] = label[label[t]]; /* that is named */
            continue;
        }
        uint64_t key = longest_key(&s, t);
        uint32_t a = (uint32_t)(key >> 32), b = (uint32_t)key;
        uint32_t *other = tm_edge_map_get(&first, a, b);
        if (other && tm_tet_same_region(mesh, *other, t)) {
            label[t] = label[*other];
            continue;
        }
        label[t] = (uint32_t)(*regions)++;
        if (!other)
            tm_edge_map_put(&first, a, b, t);
    }
    tm_edge_map_free(&first);
    free(s.longest);
    return done ? TM_OK : tm_fail_memory(error);
}

/* By circumscribed spheres --------------------------------------------------------- */

/* From seeds by growing circumradius, tetrahedra are flooded whose circumcentre is in the
 * sphere of the seed. */

typedef struct {
    double radius2;
    uint32_t t;
} seed;

/* The circumcentre; false in a flat tetrahedron. */
static bool circumcentre(const tm_tet_mesh *mesh, uint32_t t, double centre[3],
                         double *radius2)
{
    const uint32_t *n = mesh->tet[t];
    double u[3], v[3], w[3], vw[3], wu[3], uv[3];
    tm_subtract(u, mesh->xyz[n[1]], mesh->xyz[n[0]]);
    tm_subtract(v, mesh->xyz[n[2]], mesh->xyz[n[0]]);
    tm_subtract(w, mesh->xyz[n[3]], mesh->xyz[n[0]]);
    tm_cross(vw, v, w);
    tm_cross(wu, w, u);
    tm_cross(uv, u, v);
    double determinant = 2 * tm_dot(u, vw);
    *radius2 = 0;
    for (int x = 0; x < 3; x++) {
        double to = (tm_norm2(u) * vw[x] + tm_norm2(v) * wu[x] + tm_norm2(w) * uv[x]) /
                    determinant;
        centre[x] = mesh->xyz[n[0]][x] + to;
        *radius2 += to * to;
    }
    return determinant > 0 && isfinite(*radius2);
}

static int by_radius(const void *a, const void *b)
{
    const seed *s = a, *r = b;
    if (s->radius2 != r->radius2)
        return s->radius2 < r->radius2 ? -1 : 1;
    return (s->t > r->t) - (s->t < r->t);
}

/* Floods from one seed; `queue` has room for all tetrahedra. */
static void flood(const tm_tet_mesh *mesh, uint32_t t, uint32_t name, uint32_t *label,
                  uint32_t *queue)
{
    double centre[3], radius2, other[3], other2;
    size_t count = 0;
    bool has_sphere = circumcentre(mesh, t, centre, &radius2);
    label[t] = name;
    queue[count++] = t;
    for (size_t next = 0; next < count && has_sphere; next++)
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t across = mesh->neighbour[queue[next]][i];
            if (across & TM_FACE_BIT || label[across / 4] != TM_NONE ||
                !circumcentre(mesh, across / 4, other, &other2) ||
                tm_distance2(centre, other) >= radius2)
                continue;
            label[across / 4] = name;
            queue[count++] = across / 4;
        }
}

static tm_status label_cavity(const tm_tet_mesh *mesh, const tm_poly_options *options,
                              uint32_t *label, size_t *regions, tm_error *error)
{
    (void)options;
    seed *seeds = tm_new(mesh->slots, sizeof *seeds);
    uint32_t *queue = tm_new(mesh->slots, sizeof *queue);
    bool done = seeds && queue;
    for (uint32_t t = 0; t < mesh->slots && done; t++) {
        double centre[3];
        seeds[t].t = t;
        if (!circumcentre(mesh, t, centre, &seeds[t].radius2))
            seeds[t].radius2 = HUGE_VAL;
        label[t] = TM_NONE;
    }
    if (done)
        qsort(seeds, mesh->slots, sizeof *seeds, by_radius);
    *regions = 0;
    for (size_t k = 0; k < mesh->slots && done; k++)
        if (label[seeds[k].t] == TM_NONE)
            flood(mesh, seeds[k].t, (uint32_t)(*regions)++, label, queue);
    free(seeds);
    free(queue);
    return done ? TM_OK : tm_fail_memory(error);
}

const tm_poly_mode_row tm_poly_modes[TM_POLY_MODES] = {
    [TM_POLY_TERMINAL] = {"terminal", label_terminal},
    [TM_POLY_EDGE] = {"edge", label_longest_edge},
    [TM_POLY_FACE] = {"face", tm_poly_faces},
    [TM_POLY_TERMINAL_FACE] = {"terminal-face", tm_poly_terminal_faces},
    [TM_POLY_CAVITY] = {"cavity", label_cavity},
    [TM_POLY_COMPACT] = {"compact", tm_poly_compact},
};
