/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "against.h"

#include "../../../lib/mesh/cell_faces.h"
#include "surface_input.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

against against_start(void)
{
    return (against){.feature_angle = TM_FEATURE_ANGLE};
}

void against_option(const filter *f, against *a, int option)
{
    const double straight = 180;
    if (option == AGAINST) {
        a->file = optarg;
    } else {
        a->feature_angle = filter_number(f, "--feature-angle", optarg, 0, straight);
        a->angle_given = true;
    }
}

void against_check(const filter *f, const against *a)
{
    if (a->angle_given && !a->file)
        filter_usage_error(f, "--feature-angle goes with --against");
    if (a->file && strcmp(a->file, "-") == 0)
        filter_usage_error(f, "--against: only the mesh can be standard input");
    filter_other_file(f, "--against", a->file);
}

/* The regions of elements; NULL where there are none. */
static const double *regions_of(const tm_stream *stream, size_t *stride)
{
    const tm_block *block = tm_content_block(stream, tm_content_of(stream));
    if (!block || !block->attribute || block->attributes == 0 ||
        tm_content_of(stream) == TM_CONTENT_POLYHEDRA)
        return NULL;
    *stride = block->attributes;
    return block->attribute;
}

/* Whether a facet is of the surface. */
static bool is_of_surface(const tm_cell_faces *faces, size_t f, const double *region,
                          size_t stride)
{
    const uint32_t *side = faces->side[f];
    if (side[0] == TM_NONE || side[1] == TM_NONE)
        return true;
    if (faces->marker && faces->marker[f] != 0)
        return true;
    return region && region[side[0] * stride] != region[side[1] * stride];
}

/* The facets that are of the surface as fans of triangles; returns how many. */
static size_t list_triangles(const tm_stream *stream, const tm_cell_faces *faces,
                             uint32_t (*triangle)[3], int32_t *marker)
{
    size_t count = 0, stride = 0;
    const double *region = regions_of(stream, &stride);
    for (size_t f = 0; f < faces->facets; f++) {
        if (!is_of_surface(faces, f, region, stride))
            continue;
        const uint32_t *v = faces->node + faces->start[f];
        const size_t corners = faces->start[f + 1] - faces->start[f];
        for (size_t i = 2; i < corners; i++, count++) {
            triangle[count][0] = v[0];
            triangle[count][1] = v[i - 1];
            triangle[count][2] = v[i];
            marker[count] = faces->marker ? faces->marker[f] : 0;
        }
    }
    return count;
}

static tm_status surface_of_mesh(tm_surface *surface, const tm_stream *stream,
                                 tm_error *error)
{
    tm_cell_faces faces;
    *surface = (tm_surface){0};
    tm_status status = tm_cell_faces_find(&faces, stream, error);
    const size_t corners =
        status == TM_OK && faces.facets > 0 ? faces.start[faces.facets] : 0;
    uint32_t(*triangle)[3] = malloc((corners + 1) * sizeof *triangle);
    int32_t *marker = malloc((corners + 1) * sizeof *marker);
    if (status == TM_OK && (!triangle || !marker))
        status = tm_fail_memory(error);
    if (status == TM_OK) {
        const tm_block *node = tm_stream_find(stream, ".node");
        const size_t triangles = list_triangles(stream, &faces, triangle, marker);
        status = tm_surface_of_triangles(
            surface, node ? (const double(*)[3])node->real : NULL, node ? node->count : 0,
            (const uint32_t(*)[3])triangle, faces.marker ? marker : NULL, triangles,
            error);
    }
    free(triangle);
    free(marker);
    tm_cell_faces_free(&faces);
    return status;
}

static void read_surface(const filter *f, tm_surface *surface)
{
    tm_error error;
    tm_polygon_surface polygons;
    tm_stream stream;
    surface_input_read_any(f, &polygons, &stream);
    const tm_status status = polygons.nodes > 0
                                 ? tm_surface_of_polygons(surface, &polygons, &error)
                                 : surface_of_mesh(surface, &stream, &error);
    if (status != TM_OK) {
        if (!error.file[0])
            snprintf(error.file, sizeof error.file, "%s", filter_input_name(f));
        filter_fail(f, &error);
    }
    tm_polygon_surface_free(&polygons);
    tm_stream_free(&stream);
}

void against_measure(const filter *f, against *a, const tm_stream *mesh)
{
    if (!a->file)
        return;
    tm_error error;
    tm_surface of_mesh, surface;
    filter other = *f;
    other.input = a->file;
    read_surface(&other, &surface);
    filter_stage(f, "measuring distances");
    tm_status status = surface_of_mesh(&of_mesh, mesh, &error);
    if (status == TM_OK)
        status =
            tm_surface_compare(&a->found, &of_mesh, &surface, a->feature_angle, &error);
    if (status != TM_OK) {
        if (!error.file[0])
            snprintf(error.file, sizeof error.file, "%s", filter_input_name(f));
        filter_fail(f, &error);
    }
    if (a->found.rough)
        filter_note(f, "%s: rough all over: sharp edges and corners are not compared",
                    a->file);
    tm_surface_free(&of_mesh);
    tm_surface_free(&surface);
}

static double most_of(const tm_distance way[TM_WAYS])
{
    return fmax(way[TM_THERE].most, way[TM_BACK].most);
}

/* Of corners one way counts: those of the surface are there; a curve of the mesh may have
 * more of them, where a short edge of it turns. */
double against_most(const against *a)
{
    return fmax(most_of(a->found.surface),
                fmax(most_of(a->found.curve), a->found.corner[TM_BACK].most));
}

static void point_json(tm_json *json, const char *key, const double point[3])
{
    tm_json_open(json, key, '[');
    for (int k = 0; k < 3; k++)
        tm_json_double(json, NULL, point[k]);
    tm_json_close(json, ']');
}

static void ways_json(tm_json *json, const char *key, const tm_distance way[TM_WAYS])
{
    static const char *const name[TM_WAYS] = {"there", "back"};
    tm_json_open(json, key, '{');
    for (int w = 0; w < TM_WAYS; w++) {
        tm_json_open(json, name[w], '{');
        tm_json_integer(json, "parts", (int64_t)way[w].parts);
        tm_json_double(json, "most", way[w].most);
        tm_json_double(json, "bound", way[w].bound);
        tm_json_double(json, "mean", way[w].mean);
        point_json(json, "at", way[w].at);
        point_json(json, "to", way[w].to);
        tm_json_close(json, '}');
    }
    tm_json_close(json, '}');
}

void against_json(tm_json *json, const against *a)
{
    if (!a->file)
        return;
    tm_json_open(json, "against", '{');
    tm_json_double(json, "most", against_most(a));
    tm_json_double(json, "most_of_diagonal", against_most(a) / a->found.diagonal);
    tm_json_double(json, "diagonal", a->found.diagonal);
    tm_json_double(json, "tolerance", a->found.tolerance);
    ways_json(json, "surface", a->found.surface);
    if (!a->found.rough) {
        ways_json(json, "curves", a->found.curve);
        ways_json(json, "corners", a->found.corner);
    }
    tm_json_close(json, '}');
}

/* "  there  0.00123  0.0005  of the diagonal, mean …, at (x, y, z)" */
static void ways_text(tm_text *text, const char *what, const tm_distance way[TM_WAYS],
                      double diagonal, int label_width)
{
    static const char *const name[TM_WAYS] = {"from", "to"};
    for (int w = 0; w < TM_WAYS; w++) {
        const tm_distance *d = &way[w];
        char label[TM_LABEL_WIDTH];
        if (d->parts == 0)
            continue;
        snprintf(label, sizeof label, "  %s the mesh's %s", name[w], what);
        tm_text_format(text, "%-*s", label_width, label);
        if (isfinite(d->most))
            tm_text_format(text,
                           "%*.4g  %.2g of the diagonal, mean %.2g, at (%g, %g, %g)\n",
                           TM_COLUMN_WIDTH, d->most, d->most / diagonal, d->mean,
                           d->at[0], d->at[1], d->at[2]);
        else
            tm_text_format(text, "%*s\n", TM_COLUMN_WIDTH, "none there");
    }
}

void against_text(tm_text *text, const against *a, int label_width)
{
    const tm_surface_comparison *c = &a->found;
    if (!a->file)
        return;
    tm_text_format(text, "\nlargest distances, proved to within %.2g\n", c->tolerance);
    ways_text(text, "surface", c->surface, c->diagonal, label_width);
    ways_text(text, "sharp edges", c->curve, c->diagonal, label_width);
    ways_text(text, "corners", c->corner, c->diagonal, label_width);
}
