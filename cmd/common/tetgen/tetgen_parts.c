/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen_parts.h"

#include "../../../lib/base/array.h"
#include "../../../lib/surface/surface_seeds.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

_Noreturn static void fail_at_point(const filter *f, const char *what, const double p[3])
{
    tm_error error;
    tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
               "%s, at (%g, %g, %g), is outside the surface", what, p[0], p[1], p[2]);
    filter_fail(f, &error);
}

static void succeed(const filter *f, tm_status status, const tm_error *error)
{
    if (status != TM_OK)
        filter_fail(f, error);
}

/* The points that were given -----------------------------------------------------------
 */

static void add_given(const filter *f, const tetgen_parts *parts,
                      tm_polygon_surface *surface)
{
    tm_error error;
    double next = 0;
    for (size_t h = 0; h < parts->given.holes; h++)
        succeed(f, tm_polygon_surface_add_hole(surface, parts->given.hole[h], &error),
                &error);
    for (size_t i = 0; i < surface->regions; i++)
        next = fmax(next, floor(surface->region[i].attribute));
    for (size_t i = 0; i < parts->given.regions; i++)
        if (!isnan(parts->given.region[i].attribute))
            next = fmax(next, floor(parts->given.region[i].attribute));
    for (size_t i = 0; i < parts->given.regions; i++) {
        tm_region region = parts->given.region[i];
        if (isnan(region.attribute))
            region.attribute = next += 1;
        succeed(f, tm_polygon_surface_add_region(surface, &region, &error), &error);
    }
}

static void check_given(const filter *f, const tetgen_parts *parts,
                        const tm_surface *built)
{
    for (size_t h = 0; h < parts->given.holes; h++)
        if (!tm_surface_has_mesh(built, parts->given.hole[h]))
            fail_at_point(f, "the hole", parts->given.hole[h]);
    for (size_t i = 0; i < parts->given.regions; i++)
        if (!tm_surface_has_mesh(built, parts->given.region[i].point))
            fail_at_point(f, "the region", parts->given.region[i].point);
}

/* TetGen would give the number of a second region in a part to one tetrahedron. Of the
 * surface, that *faces is without holes, each part keeps the first one. */
static void drop_repeated(const filter *f, const tm_polygon_surface *faces,
                          const tm_surface_options *options, tm_polygon_surface *surface)
{
    tm_error error;
    tm_surface built;
    tm_polygon_surface numbered = *faces;
    size_t kept = 0;
    bool *is_first = tm_new(surface->regions, sizeof *is_first);
    numbered.region = tm_new(surface->regions, sizeof *numbered.region);
    if (!is_first || !numbered.region)
        filter_fail_memory(f);
    for (size_t i = 0; i < surface->regions; i++) {
        is_first[i] = false;
        numbered.region[i] = surface->region[i];
        numbered.region[i].attribute = (double)i;
    }
    succeed(f, tm_surface_build(&built, &numbered, options, &error), &error);
    for (size_t p = 0; p < tm_surface_seeds(&built); p++)
        if (built.region[p] < (double)surface->regions)
            is_first[(size_t)built.region[p]] = true;
    for (size_t i = 0; i < surface->regions; i++)
        if (is_first[i])
            surface->region[kept++] = surface->region[i];
    filter_leave_out(f, "%zu regions that are in one with another before",
                     surface->regions - kept);
    surface->regions = kept;
    tm_surface_free(&built);
    free(numbered.region);
    free(is_first);
}

static void check_numbers(const filter *f, const tm_polygon_surface *surface)
{
    tm_error error;
    for (size_t i = 0; i < surface->regions; i++)
        if (fabs(surface->region[i].attribute) > INT32_MAX) {
            tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
                       "a region has the number %.17g, which TetGen has no place for "
                       "(%d..%d)",
                       surface->region[i].attribute, -INT32_MAX, INT32_MAX);
            filter_fail(f, &error);
        }
}

/* The parts ----------------------------------------------------------------------------
 */

/* What becomes of parts within others: how many there are of one kind, and one place. */
typedef struct nested {
    size_t count;
    double place[3];
} nested;

static void add_nested(nested *of, const tm_surface_seed *seed)
{
    if (of->count++ == 0)
        memcpy(of->place, seed->point, sizeof of->place);
}

static void say(const filter *f, const nested *of, const char *one, const char *several,
                const char *becomes)
{
    if (of->count > 0)
        filter_note(f, "%s: %zu %s, %s(%g, %g, %g): %s", filter_input_name(f), of->count,
                    of->count > 1 ? several : one, of->count > 1 ? "such as at " : "at ",
                    of->place[0], of->place[1], of->place[2], becomes);
}

/* Without --regions and --cavities, of a surface that knows nothing of them. */
static void say_filled(const filter *f, const tm_surface_seed *seed, size_t count)
{
    nested all = {0};
    for (size_t p = 0; p < count; p++)
        if (seed[p].nested)
            add_nested(&all, &seed[p]);
    say(f, &all, "shell is within another", "shells are within others",
        "filled as all the rest (--regions numbers it, --cavities leaves empty what "
        "looks inward)");
}

/* --cavities: holes, and with --regions numbers for what is left. */
static void add_parts(const filter *f, const tetgen_parts *parts, const tm_surface *built,
                      const tm_surface_seed *seed, tm_polygon_surface *surface)
{
    nested empty = {0}, filled = {0}, thin = {0};
    double number = 0;
    tm_error error;
    for (size_t p = 0; p < tm_surface_seeds(built); p++) {
        const bool is_hole = parts->cavities && seed[p].inward;
        if (seed[p].nested)
            add_nested(is_hole ? &empty : &filled, &seed[p]);
        tm_region region = {.attribute = built->region ? built->region[p] : number + 1,
                            .max_volume = -1};
        memcpy(region.point, seed[p].point, sizeof region.point);
        number += !is_hole;
        if (!(seed[p].clearance > 0))
            add_nested(&thin, &seed[p]);
        else if (is_hole)
            succeed(f, tm_polygon_surface_add_hole(surface, seed[p].point, &error),
                    &error);
        else if (parts->regions)
            succeed(f, tm_polygon_surface_add_region(surface, &region, &error), &error);
    }
    say(f, &empty, "shell within another looks inward",
        "shells within others look inward", "left empty");
    say(f, &filled, "shell is within another", "shells are within others",
        parts->regions ? "a region (--cavities leaves empty what looks inward)"
                       : "filled, as it looks outward");
    if (thin.count > 0)
        filter_note(f, "parts so thin that no point in them was found: %zu", thin.count);
}

void tetgen_find_parts(const filter *f, const tetgen_parts *parts,
                       tm_polygon_surface *surface, tm_error *why)
{
    const tm_surface_options options = {
        .feature_angle = TM_FEATURE_ANGLE, .regions = true, .walls = true};
    const bool knows = surface->holes + surface->regions > 0;
    add_given(f, parts, surface);
    const bool numbered = parts->regions || parts->given.regions > 0;
    tm_surface built;
    tm_polygon_surface faces = *surface;
    faces.holes = faces.regions = 0;
    tm_status status = tm_surface_build(&built, &faces, &options, why);
    if (status == TM_OK && numbered && surface->regions > 0) {
        check_given(f, parts, &built);
        tm_surface_free(&built);
        faces.regions = surface->regions;
        status = tm_surface_build(&built, &faces, &options, why);
    }
    if (status == TM_OK && built.repeated_regions > 0)
        drop_repeated(f, &faces, &options, surface);
    if (status == TM_ERROR_INPUT && !parts->cavities) {
        if (parts->regions)
            filter_note(f, "%s: TetGen numbers the regions, as %s", filter_input_name(f),
                        why->what);
    } else if (status != TM_OK) {
        snprintf(why->file, sizeof why->file, "%s", filter_input_name(f));
        filter_fail(f, why);
    } else {
        tm_surface_seed *seed = tm_new(tm_surface_seeds(&built), sizeof *seed);
        why->status = TM_OK;
        check_given(f, parts, &built);
        if (!seed)
            filter_fail_memory(f);
        succeed(f, tm_surface_find_seeds(&built, &faces, seed, why), why);
        if (parts->regions || parts->cavities)
            add_parts(f, parts, &built, seed, surface);
        else if (!knows && parts->given.holes + parts->given.regions == 0)
            say_filled(f, seed, tm_surface_seeds(&built));
        free(seed);
    }
    tm_surface_free(&built);
    if (numbered)
        check_numbers(f, surface);
}
