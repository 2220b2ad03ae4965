/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shells: that the triangles of each turn the same way, and which region each is around.
 */
#include "surface_parts.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "surface_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tm_surface_turn_triangle(tm_surface *surface, uint32_t t)
{
    uint32_t *v = surface->triangle[t], *across = surface->across[t];
    uint32_t node = v[1], beyond = across[0];
    v[1] = v[2];
    v[2] = node;
    across[0] = across[2];
    across[2] = beyond;
}

typedef enum turning { SAME, OPPOSITE } turning;

/* Whether t and its neighbour across edge i have the edge in opposite directions. */
static turning compare(const tm_surface *surface, uint32_t t, unsigned i)
{
    uint32_t n = surface->across[t][i];
    unsigned k = tm_surface_side(surface, n, t);
    return surface->triangle[n][(k + 1) % 3] == surface->triangle[t][i] ? SAME : OPPOSITE;
}

static void cut(tm_surface *surface, uint32_t t, unsigned i)
{
    uint32_t n = surface->across[t][i];
    surface->across[n][tm_surface_side(surface, n, t)] = TM_NONE;
    surface->across[t][i] = TM_NONE;
    surface->open_edges += 2;
}

static tm_status fail_twisted(const tm_surface *surface, uint32_t t, unsigned i,
                              unsigned base, tm_error *error)
{
    const uint32_t *v = surface->triangle[t];
    const double *a = surface->xyz[v[i]], *b = surface->xyz[v[(i + 1) % 3]];
    return tm_fail(error, TM_ERROR_INPUT,
                   "the surface has one side only (cannot be oriented): at the edge "
                   "between nodes %zu (%g, %g, %g) and %zu (%g, %g, %g) both sides meet",
                   (size_t)surface->origin[v[i]] + base, a[0], a[1], a[2],
                   (size_t)surface->origin[v[(i + 1) % 3]] + base, b[0], b[1], b[2]);
}

/* Gives t's neighbours that have none the shell of t, turned as t is. */
static tm_status spread(tm_surface *surface, uint32_t t, bool lenient, unsigned base,
                        uint32_t *stack, size_t *height, tm_error *error)
{
    for (unsigned i = 0; i < 3; i++) {
        uint32_t n = surface->across[t][i];
        if (n == TM_NONE)
            continue;
        turning turned = compare(surface, t, i);
        if (surface->shell[n] == TM_NONE) {
            if (turned == OPPOSITE)
                tm_surface_turn_triangle(surface, n);
            surface->turned |= turned == OPPOSITE;
            surface->shell[n] = surface->shell[t];
            stack[(*height)++] = n;
        } else if (turned == OPPOSITE) {
            if (!lenient)
                return fail_twisted(surface, t, i, base, error);
            cut(surface, t, i);
        }
    }
    return TM_OK;
}

tm_status tm_surface_orient(tm_surface *surface, bool lenient, unsigned base,
                            tm_error *error)
{
    uint32_t *stack = tm_new(surface->triangles, sizeof *stack);
    surface->shell = tm_new(surface->triangles, sizeof *surface->shell);
    tm_status status = stack && surface->shell ? TM_OK : tm_fail_memory(error);
    for (size_t t = 0; t < surface->triangles && status == TM_OK; t++)
        surface->shell[t] = TM_NONE;
    for (size_t t = 0; t < surface->triangles && status == TM_OK; t++) {
        if (surface->shell[t] != TM_NONE)
            continue;
        size_t height = 1;
        stack[0] = (uint32_t)t;
        surface->shell[t] = (uint32_t)surface->components++;
        while (height > 0 && status == TM_OK) {
            uint32_t next = stack[--height];
            status = spread(surface, next, lenient, base, stack, &height, error);
        }
    }
    free(stack);
    return status;
}

/* Six times the volumes between the triangles of a shell and its first node. */
static void add_volumes(const tm_surface *surface, const uint32_t *first, double *volume,
                        double *rounding)
{
    const double part = 0x1p-48;
    for (size_t t = 0; t < surface->triangles; t++) {
        uint32_t s = surface->shell[t];
        const uint32_t *v = surface->triangle[t];
        double one =
            tm_tet_volume(surface->xyz[surface->triangle[first[s]][0]],
                          surface->xyz[v[0]], surface->xyz[v[1]], surface->xyz[v[2]]);
        volume[s] += one;
        rounding[s] += fabs(one) * part;
    }
}

/* Whether a shell is inside: an odd number of other shells is around most of it. Where
 * they neither cross nor have holes all points say the same, and a few are asked. Points
 * on another shell say nothing. */
static tm_status find_nesting(const tm_surface *surface, const size_t *size, bool *nested,
                              tm_error *error)
{
    const size_t points = 32;
    int *votes = calloc(surface->components, sizeof *votes);
    size_t *met = calloc(surface->components, sizeof *met);
    for (size_t t = 0; t < surface->triangles && votes && met; t++) {
        uint32_t s = surface->shell[t];
        bool on = false;
        if (met[s]++ % (size[s] / points + 1) != 0)
            continue;
        bool odd =
            tm_surface_ray_is_odd(surface, surface->xyz[surface->triangle[t][0]], s, &on);
        if (!on)
            votes[s] += odd ? 1 : -1;
    }
    for (size_t s = 0; s < surface->components && votes && met; s++)
        nested[s] = votes[s] > 0;
    tm_status status = votes && met ? TM_OK : tm_fail_memory(error);
    free(votes);
    free(met);
    return status;
}

static void turn_shells(tm_surface *surface, const double *volume, const double *rounding,
                        const bool *nested)
{
    for (size_t t = 0; t < surface->triangles; t++) {
        uint32_t s = surface->shell[t];
        if (fabs(volume[s]) <= rounding[s] || (volume[s] < 0) == nested[s])
            continue;
        tm_surface_turn_triangle(surface, (uint32_t)t);
        surface->turned = true;
    }
}

tm_status tm_surface_turn(tm_surface *surface, tm_error *error)
{
    size_t shells = surface->components;
    uint32_t *first = tm_new(shells, sizeof *first);
    size_t *size = calloc(shells, sizeof *size);
    double *volume = calloc(shells, sizeof *volume);
    double *rounding = calloc(shells, sizeof *rounding);
    bool *nested = calloc(shells, sizeof *nested);
    tm_status status = TM_OK;
    if (!first || !size || !volume || !rounding || !nested)
        status = tm_fail_memory(error);
    if (status == TM_OK) {
        for (size_t t = surface->triangles; t-- > 0;) {
            first[surface->shell[t]] = (uint32_t)t;
            size[surface->shell[t]]++;
        }
        add_volumes(surface, first, volume, rounding);
        if (shells > 1)
            status = find_nesting(surface, size, nested, error);
    }
    if (status == TM_OK) {
        turn_shells(surface, volume, rounding, nested);
        tm_surface_tree_refresh(surface);
    }
    free(first);
    free(size);
    free(volume);
    free(rounding);
    free(nested);
    return status;
}

/* Shells within shells: which region each is around. -------------------------------- */

void tm_surface_shell_volumes(const tm_surface *surface, double *volume)
{
    memset(volume, 0, surface->components * sizeof *volume);
    for (size_t t = 0; t < surface->triangles; t++) {
        const uint32_t *v = surface->triangle[t];
        volume[surface->shell[t]] +=
            tm_tet_volume(surface->xyz[surface->triangle[0][0]], surface->xyz[v[0]],
                          surface->xyz[v[1]], surface->xyz[v[2]]);
    }
}

/* The innermost shell around a point: the smallest; TM_NONE where there is none. The
 * context is the volumes of shells. */
static uint32_t shell_around(const tm_surface *surface, const double point[3],
                             const void *context)
{
    const double *volume = context;
    uint32_t least = TM_NONE;
    for (uint32_t s = 0; s < surface->components; s++)
        if (tm_surface_is_within(surface, s, point) &&
            (least == TM_NONE || fabs(volume[s]) < fabs(volume[least])))
            least = s;
    return least;
}

static tm_status find_holes(tm_surface *surface, const tm_polygon_surface *polygons,
                            const double *volume, tm_error *error)
{
    surface->hole = tm_new(polygons->holes, sizeof *surface->hole);
    if (!surface->hole)
        return tm_fail_memory(error);
    for (size_t h = 0; h < polygons->holes; h++) {
        const double *p = polygons->hole[h];
        const uint32_t s = shell_around(surface, p, volume);
        if (s == TM_NONE)
            continue;
        if (volume[s] > 0)
            return tm_fail(error, TM_ERROR_INPUT,
                           "hole %zu, at (%g, %g, %g), is in a region that is outermost, "
                           "or within two others: that cannot be left empty",
                           h + 1, p[0], p[1], p[2]);
        memcpy(surface->hole[surface->holes++], p, sizeof *surface->hole);
    }
    return TM_OK;
}

tm_status tm_surface_find_regions(tm_surface *surface, const tm_polygon_surface *polygons,
                                  tm_error *error)
{
    double *volume = tm_new(surface->components, sizeof *volume);
    if (!volume)
        return tm_fail_memory(error);
    tm_surface_shell_volumes(surface, volume);
    tm_status status = TM_OK;
    surface->regions = true;
    if (polygons->regions > 0)
        status = tm_surface_number_regions(surface, polygons, surface->components,
                                           shell_around, volume, error);
    if (status == TM_OK && polygons->holes > 0)
        status = find_holes(surface, polygons, volume, error);
    free(volume);
    return status;
}
