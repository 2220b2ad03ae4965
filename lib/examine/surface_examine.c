/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_examine.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "../surface/surface_parts.h"
#include "../surface/surface_seeds.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* By counting --------------------------------------------------------------------------
 */

static void measure_faces(tm_surface_examination *found,
                          const tm_polygon_surface *surface)
{
    for (size_t t = 0; t < surface->facets; t++) {
        const uint32_t *v = surface->item + 3 * t;
        const double(*xyz)[3] = (const double(*)[3])surface->xyz;
        double normal[3];
        tm_triangle_normal(normal, xyz[v[0]], xyz[v[1]], xyz[v[2]]);
        found->area += tm_norm(normal) / 2;
        if (tm_is_flat(xyz[v[0]], xyz[v[1]], xyz[v[2]]) && found->degenerate++ == 0)
            found->first.degenerate = (uint32_t)t;
    }
}

static bool count_repeated(tm_surface_examination *found,
                           const tm_polygon_surface *surface)
{
    uint32_t *node = tm_new(surface->nodes, sizeof *node);
    bool *gone = calloc(surface->facets + 1, sizeof *gone);
    for (size_t v = 0; v < surface->nodes && node; v++)
        node[v] = (uint32_t)v;
    const bool done =
        node && gone &&
        tm_surface_find_duplicates(surface, node, 3, gone, &found->repeated_faces);
    for (size_t t = surface->facets; done && t-- > 0;)
        if (gone[t])
            found->first.repeated = (uint32_t)t;
    free(node);
    free(gone);
    return done;
}

/* By the surface that is made of them --------------------------------------------------
 */

/* Of each shell: how many triangles turn as they did, and how many do not. */
typedef struct turns {
    size_t not_given, given;
    bool said;
} turns;

static void note_turned(tm_surface_examination *found, uint32_t row)
{
    if (found->turned_faces++ == 0 || row < found->first.turned_face)
        found->first.turned_face = row;
}

/* A shell of which most triangles look inward, though it is within no other one. */
static void note_shell(tm_surface_examination *found, turns *of, uint32_t row)
{
    if (!of->said && found->turned_shells++ == 0)
        found->first.turned_shell = row;
    of->said = true;
}

static bool count_turned(tm_surface_examination *found, const tm_polygon_surface *surface,
                         const tm_surface *built, const tm_surface_seed *seed)
{
    turns *shell = calloc(built->components + 1, sizeof *shell);
    for (size_t t = 0; t < built->triangles && shell; t++)
        if (tm_surface_is_as_given(built, surface, t))
            shell[built->shell[t]].given++;
        else
            shell[built->shell[t]].not_given++;
    for (size_t t = 0; t < built->triangles && shell; t++) {
        turns *of = &shell[built->shell[t]];
        const bool given = tm_surface_is_as_given(built, surface, t);
        const bool most = of->given >= of->not_given;
        if (built->walls ? built->side[t][0] == 0 && !given : given != most)
            note_turned(found, built->facet[t]);
        else if (seed && !built->walls && !seed[built->shell[t]].nested && !most)
            note_shell(found, of, built->facet[t]);
    }
    const bool done = shell != NULL;
    free(shell);
    return done;
}

/* Within the outermost shells. */
static void measure_volume(tm_surface_examination *found, const tm_surface *built,
                           const tm_surface_seed *seed)
{
    for (size_t t = 0; t < built->triangles; t++) {
        const uint32_t *v = built->triangle[t];
        const double *origin = built->xyz[built->triangle[0][0]];
        if (built->walls ? built->side[t][0] == 0 : !seed[built->shell[t]].nested)
            found->volume += tm_tet_volume(origin, built->xyz[v[0]], built->xyz[v[1]],
                                           built->xyz[v[2]]);
    }
}

static tm_status examine_closed(tm_surface_examination *found,
                                const tm_polygon_surface *surface,
                                const tm_surface *built, tm_error *error)
{
    const size_t parts = tm_surface_seeds(built);
    tm_surface_seed *seed = tm_new(parts, sizeof *seed);
    tm_status status =
        seed ? tm_surface_find_seeds(built, surface, seed, error) : tm_fail_memory(error);
    found->regions = parts;
    for (size_t p = 0; p < parts && status == TM_OK; p++)
        found->nested += seed[p].nested;
    if (status == TM_OK && !count_turned(found, surface, built, seed))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        measure_volume(found, built, seed);
    free(seed);
    return status;
}

/* Crossings by rows of .face. */
static tm_status examine_open(tm_surface_examination *found,
                              const tm_polygon_surface *surface, const tm_surface *built,
                              tm_error *error)
{
    tm_status status =
        tm_surface_list_crossings(built, &found->crossing, &found->crossings, error);
    for (size_t c = 0; c < found->crossings; c++)
        for (int i = 0; i < 2; i++)
            found->crossing[c].triangle[i] = built->facet[found->crossing[c].triangle[i]];
    if (status == TM_OK && !count_turned(found, surface, built, NULL))
        status = tm_fail_memory(error);
    return status;
}

static tm_status build_and_examine(tm_surface_examination *found,
                                   const tm_polygon_surface *surface, tm_error *error)
{
    tm_surface_options options = {
        .feature_angle = TM_FEATURE_ANGLE, .regions = true, .walls = true};
    tm_surface built;
    tm_error why;
    tm_status status = tm_surface_build(&built, surface, &options, &why);
    const bool closed = status == TM_OK;
    if (status == TM_ERROR_INPUT) {
        snprintf(found->problem, sizeof found->problem, "%s", why.what);
        tm_surface_free(&built);
        options =
            (tm_surface_options){.feature_angle = TM_FEATURE_ANGLE, .lenient = true};
        status = tm_surface_build(&built, surface, &options, &why);
        if (status == TM_ERROR_INPUT) {
            tm_surface_free(&built);
            return TM_OK; /* nothing is left, which the problem says */
        }
    }
    found->components = built.components;
    found->euler = built.euler;
    if (status != TM_OK)
        status = tm_fail_as(error, &why);
    else
        status = closed ? examine_closed(found, surface, &built, error)
                        : examine_open(found, surface, &built, error);
    tm_surface_free(&built);
    return status;
}

tm_status tm_surface_examine(tm_surface_examination *found,
                             const tm_polygon_surface *surface, tm_error *error)
{
    *found =
        (tm_surface_examination){.nodes = surface->nodes, .triangles = surface->facets};
    tm_status status = tm_surface_find_defects(surface, &found->defects, error);
    if (status == TM_OK && !count_repeated(found, surface))
        status = tm_fail_memory(error);
    measure_faces(found, surface);
    if (status == TM_OK)
        status = build_and_examine(found, surface, error);
    return status;
}

void tm_surface_examination_free(tm_surface_examination *found)
{
    free(found->crossing);
    *found = (tm_surface_examination){0};
}

bool tm_surface_examination_is_good(const tm_surface_examination *found)
{
    return found->defects.open_edges + found->defects.duplicate_nodes +
                   found->repeated_faces + found->degenerate + found->turned_faces +
                   found->turned_shells + found->crossings ==
               0 &&
           !found->problem[0];
}
