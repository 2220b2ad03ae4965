/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_seeds.h"

#include "../base/array.h"
#include "../base/hash.h"
#include "../geom/vector.h"
#include "surface_tree.h"

#include <stdlib.h>
#include <string.h>

/* A triangle beside a part, and on which side of it that is: before (0) or behind (1). */
typedef struct candidate {
    double area2;
    uint32_t triangle;
    int behind;
} candidate;

enum { CANDIDATES = 8 };

typedef struct finder {
    const tm_surface *surface;
    const tm_polygon_surface *polygons;
    size_t parts;
    tm_surface_seed *seed;
    uint64_t *bits; /* [components]: what a shell adds along a ray */
    uint64_t *sum;  /* [components]: that of what is behind it */
    double *volume; /* [components]: by the file's faces */
} finder;

/* Which triangles bound a part --------------------------------------------------------
 */

static void offer(candidate *list, candidate new)
{
    for (int i = 0; i < CANDIDATES; i++)
        if (new.area2 > list[i].area2) {
            const candidate old = list[i];
            list[i] = new;
            new = old;
        }
}

/* Fills list[parts][CANDIDATES], the largest first. */
static void list_candidates(const finder *f, candidate *list)
{
    const tm_surface *s = f->surface;
    for (uint32_t t = 0; t < s->triangles; t++) {
        const uint32_t *v = s->triangle[t];
        double normal[3];
        tm_triangle_normal(normal, s->xyz[v[0]], s->xyz[v[1]], s->xyz[v[2]]);
        const double area2 = tm_norm2(normal);
        for (int behind = 0; behind < 2; behind++) {
            /* Without walls shells were turned by how deep they are: either side. */
            const uint32_t part = s->walls ? s->side[t][behind] : s->shell[t] + 1;
            if (part > 0)
                offer(list + (size_t)CANDIDATES * (part - 1),
                      (candidate){area2, t, behind});
        }
    }
}

/* Where a point is --------------------------------------------------------------------
 */

static uint64_t bits_of(const tm_surface *surface, uint32_t t, const void *context)
{
    const uint64_t *bits = context;
    return bits[surface->shell[t]];
}

/* Of each shell, what a ray from right behind it adds up to: the shells around it, and
 * itself. */
static bool add_up(finder *f)
{
    const tm_surface *s = f->surface;
    bool *done = calloc(s->components + 1, sizeof *done);
    for (uint32_t k = 0; k < s->components; k++)
        f->bits[k] = tm_hash(0, k) | 1;
    for (size_t t = 0; t < s->triangles && done; t++) {
        const uint32_t k = s->shell[t];
        const double *p = s->xyz[s->triangle[t][0]];
        bool on = false;
        if (done[k])
            continue;
        tm_surface_ray_is_odd(s, p, k, &on); /* on another shell: another node */
        const uint64_t others = tm_surface_sum_along_ray(s, p, k, bits_of, f->bits);
        f->sum[k] = others ^ f->bits[k];
        f->seed[k].nested = others != 0;
        f->seed[k].inward = f->seed[k].nested && f->volume[k] < 0;
        done[k] = !on;
    }
    const bool ok = done != NULL;
    free(done);
    return ok;
}

static bool is_in(const finder *f, size_t part, const double p[3])
{
    const tm_surface *s = f->surface;
    if (s->walls)
        return tm_surface_region_at(s, p) == part + 1;
    return tm_surface_sum_along_ray(s, p, TM_NONE, bits_of, f->bits) == f->sum[part];
}

/* Which way the file's faces look -----------------------------------------------------
 */

static double facet_volume(const finder *f, size_t facet)
{
    const tm_polygon_surface *p = f->polygons;
    const size_t polygon = p->facet_start[facet];
    const uint32_t *node = p->item + p->start[polygon];
    const size_t k = p->start[polygon + 1] - p->start[polygon];
    double sum = 0;
    for (size_t i = 2; i < k; i++)
        sum += tm_tet_volume(p->xyz[0], p->xyz[node[0]], p->xyz[node[i - 1]],
                             p->xyz[node[i]]);
    return sum;
}

static bool add_volumes(finder *f)
{
    const tm_surface *s = f->surface;
    bool *met = calloc(f->polygons->facets + 1, sizeof *met);
    for (size_t t = 0; t < s->triangles && met; t++) {
        const size_t facet = s->facet[t];
        if (!met[facet])
            f->volume[s->shell[t]] += facet_volume(f, facet);
        met[facet] = true;
    }
    const bool ok = met != NULL;
    free(met);
    return ok;
}

/* Of a surface with walls, a part is nested that one shell alone bounds, from within one
 * other part. */
static bool find_nested_cells(finder *f)
{
    const tm_surface *s = f->surface;
    enum { UNKNOWN, ONE, SEVERAL };
    uint32_t *shell = tm_new(f->parts, sizeof *shell);
    uint32_t *beyond = tm_new(f->parts, sizeof *beyond);
    uint8_t *state = calloc(f->parts + 1, sizeof *state);
    const bool ok = shell && beyond && state;
    for (size_t h = 0; h < 2 * s->triangles && ok; h++) {
        const uint32_t cell = s->side[h / 2][h % 2], other = s->side[h / 2][1 - h % 2];
        const uint32_t k = s->shell[h / 2];
        if (cell == 0)
            continue;
        const size_t part = cell - 1;
        if (state[part] == UNKNOWN) {
            state[part] = ONE;
            shell[part] = k;
            beyond[part] = other;
        } else if (shell[part] != k || beyond[part] != other) {
            state[part] = SEVERAL;
        }
    }
    for (size_t part = 0; part < f->parts && ok; part++) {
        f->seed[part].nested = state[part] == ONE && beyond[part] != 0;
        f->seed[part].inward = f->seed[part].nested && f->volume[shell[part]] < 0;
    }
    free(shell);
    free(beyond);
    free(state);
    return ok;
}

/* The points --------------------------------------------------------------------------
 */

/* The point at a distance from the middle of the candidate. */
static void step_from(const finder *f, const candidate *from, double distance,
                      double p[3])
{
    const tm_surface *s = f->surface;
    const uint32_t *v = s->triangle[from->triangle];
    double normal[3];
    tm_triangle_normal(normal, s->xyz[v[0]], s->xyz[v[1]], s->xyz[v[2]]);
    const double step = (from->behind ? -distance : distance) / tm_norm(normal);
    for (int i = 0; i < 3; i++)
        p[i] =
            (s->xyz[v[0]][i] + s->xyz[v[1]][i] + s->xyz[v[2]][i]) / 3 + step * normal[i];
}

/* Steps that become shorter, until some are in the part. */
static void try_candidate(finder *f, size_t part, const candidate *from, double diagonal)
{
    enum { HALVINGS = 48, FOUND_MOST = 3 };
    tm_surface_seed *seed = &f->seed[part];
    double p[3];
    int found = 0;
    for (int i = 1; i <= HALVINGS && found < FOUND_MOST; i++) {
        diagonal /= 2;
        step_from(f, from, diagonal, p);
        if (!is_in(f, part, p))
            continue;
        tm_surface_point at = {.triangle = TM_NONE};
        tm_surface_closest(f->surface, p, TM_NONE, &at);
        found++;
        if (at.distance2 > seed->clearance) {
            seed->clearance = at.distance2;
            memcpy(seed->point, p, sizeof p);
        }
    }
}

static bool find_points(finder *f)
{
    const double diagonal = sqrt(tm_distance2(f->surface->low, f->surface->high));
    candidate *list = calloc(CANDIDATES * f->parts + 1, sizeof *list);
    if (!list)
        return false;
    list_candidates(f, list);
    for (size_t part = 0; part < f->parts; part++) {
        const candidate *at = list + CANDIDATES * part;
        for (int i = 0; i < CANDIDATES && at[i].area2 > 0; i++)
            try_candidate(f, part, &at[i], diagonal);
        f->seed[part].clearance = sqrt(f->seed[part].clearance);
    }
    free(list);
    return true;
}

tm_status tm_surface_find_seeds(const tm_surface *surface,
                                const tm_polygon_surface *polygons, tm_surface_seed *seed,
                                tm_error *error)
{
    finder f = {.surface = surface,
                .polygons = polygons,
                .parts = tm_surface_seeds(surface),
                .seed = seed};
    f.bits = tm_new(surface->components, sizeof *f.bits);
    f.sum = tm_new(surface->components, sizeof *f.sum);
    f.volume = calloc(surface->components + 1, sizeof *f.volume);
    memset(seed, 0, f.parts * sizeof *seed);
    bool ok = f.bits && f.sum && f.volume && add_volumes(&f);
    ok = ok && (surface->walls ? find_nested_cells(&f) : add_up(&f));
    ok = ok && find_points(&f);
    free(f.bits);
    free(f.sum);
    free(f.volume);
    return ok ? TM_OK : tm_fail_memory(error);
}
