/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen_attributes.h"

#include "../../../lib/surface/measure/surface_evaluate.h"
#include "../../../lib/tet/evaluate.h"

#include <stdlib.h>

/* The nodes that the surface has already; *unknown is how many it has not. */
static bool *find_known(const filter *f, const tm_polygon_surface *surface,
                        const tm_block *node, size_t *unknown)
{
    bool *known = calloc(node->count + 1, sizeof *known);
    if (!known || !tm_surface_find_known(surface, node, known, unknown))
        filter_fail_memory(f);
    return known;
}

/* Those that are in tetrahedra with known nodes become their mean, as long as that makes
 * any known. */
static void spread_means(const tm_stream *mesh, bool *known)
{
    enum { CORNERS = 4 };
    tm_block *node = tm_stream_find(mesh, ".node");
    const tm_block *ele = tm_stream_find(mesh, ".ele");
    const size_t k = node->attributes;
    for (bool again = true; again;) {
        again = false;
        for (size_t t = 0; t < ele->count; t++) {
            const uint32_t *v = ele->integer + CORNERS * t;
            size_t count = 0;
            for (int i = 0; i < CORNERS; i++)
                count += known[v[i]];
            for (int i = 0; i < CORNERS && count > 0; i++) {
                if (known[v[i]])
                    continue;
                for (size_t a = 0; a < k; a++) {
                    double sum = 0;
                    for (int c = 0; c < CORNERS; c++)
                        sum += known[v[c]] ? node->attribute[k * v[c] + a] : 0;
                    node->attribute[k * v[i] + a] = sum / (double)count;
                }
                again = known[v[i]] = true;
                count++;
            }
        }
    }
}

/* The tetrahedra of the surface's nodes, as far as there are such. */
static tm_status fill_coarsely(const filter *f, const tetgen_request *r,
                               const tm_polygon_surface *polygons,
                               const tm_surface *surface, tm_tet_mesh *coarse,
                               tm_error *error)
{
    /* M: facets of one plane, but with other values, are not joined. */
    const tetgen_request plain = {
        .program = r->program, .more = "-M", .timeout = r->timeout};
    filter quiet = *f;
    tm_stream stream;
    size_t unknown;
    quiet.verbosity = -1;
    tm_stream_init(&stream);
    *coarse = (tm_tet_mesh){0};
    tm_status status = tetgen_run(&quiet, &plain, polygons, &stream, error);
    if (status == TM_OK) {
        tm_block *node = tm_stream_find(&stream, ".node");
        bool *known = find_known(f, polygons, node, &unknown);
        if (surface)
            tm_surface_evaluate(surface, polygons, node, known);
        spread_means(&stream, known);
        free(known);
        status = tm_tet_mesh_from_stream(coarse, &stream, f->threads, error);
    }
    tm_stream_free(&stream);
    return status;
}

static void interpolate(const filter *f, const tetgen_request *r,
                        const tm_polygon_surface *polygons, const tm_surface *surface,
                        tm_stream *mesh, bool *known, size_t unknown)
{
    tm_block *node = tm_stream_find(mesh, ".node");
    tm_tet_mesh coarse;
    tm_error error;
    if (surface)
        tm_surface_evaluate(surface, polygons, node, known);
    const tm_status status = fill_coarsely(f, r, polygons, surface, &coarse, &error);
    if (status != TM_OK)
        filter_note(f, "the attributes of nodes inside stay 0, of %zu new nodes: %s",
                    unknown, error.what);
    else if (tm_tet_evaluate(&coarse, node, tm_stream_find(mesh, ".ele"), known,
                             &error) != TM_OK)
        filter_fail(f, &error);
    tm_tet_mesh_free(&coarse);
}

void tetgen_interpolate(const filter *f, const tetgen_request *r,
                        const tm_polygon_surface *polygons, tm_stream *mesh)
{
    const tm_surface_options options = {
        .feature_angle = TM_FEATURE_ANGLE, .lenient = true, .regions = true};
    const tm_block *node = tm_stream_find(mesh, ".node");
    const tm_block *ele = tm_stream_find(mesh, ".ele");
    if (polygons->attributes == 0 || polygons->facets == 0 || !ele ||
        node->attributes != polygons->attributes)
        return;
    size_t unknown;
    bool *known = find_known(f, polygons, node, &unknown);
    if (unknown > 0) {
        filter_stage(f, "interpolating");
        tm_polygon_surface faces = *polygons;
        faces.regions = faces.holes = 0;
        tm_surface surface;
        tm_error error;
        const tm_status status = tm_surface_build(&surface, &faces, &options, &error);
        if (status == TM_ERROR_SYSTEM)
            filter_fail(f, &error);
        interpolate(f, r, polygons, status == TM_OK ? &surface : NULL, mesh, known,
                    unknown);
        tm_surface_free(&surface);
    }
    free(known);
}

void tetgen_interpolate_refined(const filter *f, tm_stream *tets, tm_stream *mesh)
{
    tm_block *node = tm_stream_find(mesh, ".node");
    const tm_block *ele = tm_stream_find(mesh, ".ele");
    tm_tet_mesh coarse;
    tm_error error;
    if (node->attributes == 0 || !ele)
        return;
    tm_status status = tm_tet_mesh_from_stream(&coarse, tets, f->threads, &error);
    if (status == TM_OK)
        status = tm_tet_evaluate(&coarse, node, ele, NULL, &error);
    tm_tet_mesh_free(&coarse);
    if (status != TM_OK)
        filter_fail(f, &error);
}
