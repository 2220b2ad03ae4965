/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "join_octants.h"

#include "../../base/array.h"
#include "../../mesh/cell_faces.h"
#include "../../tet/mesh_measure.h"
#include "../facets.h"
#include "../join_cells.h"
#include "octant_faces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST = 4, PAST };

enum { FIT_ROUNDS = 18 };

typedef struct {
    tm_stream *stream;
    tm_cell_faces faces;
    bool *outer;     /* [nodes]: on the surface: on the boundary, or between regions */
    uint32_t *label; /* [elements]: its polyhedron */
    size_t cells;
    tm_block facet, cell;
} joining;

static void free_joining(joining *j)
{
    tm_cell_faces_free(&j->faces);
    tm_block_clear(&j->facet); /* what has not been put into the stream */
    tm_block_clear(&j->cell);
    free(j->outer);
    free(j->label);
}

/* Whether the attribute of .node can be where nodes are (termesh-stream(5)): not 0 of all
 * on the boundary. */
static bool are_places(const tm_block *node, const bool *boundary)
{
    const double most = 3; /* at a corner */
    if (node->attributes != 1)
        return false;
    for (size_t v = 0; v < node->count; v++) {
        const double place = fabs(node->attribute[v]);
        if (place != rint(place) || place > most || (boundary[v] && place == 0))
            return false;
    }
    return true;
}

static bool find_outer(joining *j)
{
    const tm_cell_faces *faces = &j->faces;
    const tm_block *node = tm_stream_find(j->stream, ".node");
    j->outer = calloc(node->count + 1, sizeof *j->outer);
    for (size_t f = 0; f < faces->facets && j->outer; f++)
        for (size_t i = faces->start[f]; i < faces->start[f + 1]; i++)
            j->outer[faces->node[i]] |= faces->side[f][1] == TM_NONE;
    if (j->outer && are_places(node, j->outer))
        for (size_t v = 0; v < node->count; v++)
            j->outer[v] = node->attribute[v] != 0;
    return j->outer;
}

/* One label for the inner elements of each octant, one for each other element. */
static bool label_elements(joining *j)
{
    const tm_block *mix = tm_stream_find(j->stream, ".mix");
    const tm_block *octant = tm_stream_find(j->stream, ".octant");
    uint32_t *of = tm_new(mix->count, sizeof *of);
    uint32_t *label_of = tm_new(octant->count, sizeof *label_of);
    j->label = tm_new(mix->count, sizeof *j->label);
    const bool done = of && label_of && j->label;
    for (size_t e = 0; e < mix->count && done; e++)
        of[e] = TM_NONE;
    for (uint32_t o = 0; o < octant->count && done; o++) {
        const uint32_t *row = octant->integer + tm_block_integers(TM_OCTANT) * o;
        label_of[o] = TM_NONE;
        for (uint32_t e = row[FIRST]; e < row[PAST]; e++)
            of[e] = tm_element_has(mix, e, j->outer) ? TM_NONE : o;
    }
    for (size_t e = 0; e < mix->count && done; e++) {
        const uint32_t o = of[e];
        const bool first = o == TM_NONE || label_of[o] == TM_NONE;
        j->label[e] = first ? (uint32_t)j->cells++ : label_of[o];
        if (o != TM_NONE)
            label_of[o] = j->label[e];
    }
    free(of);
    free(label_of);
    return done;
}

static tm_status level_faces(joining *j, tm_octant_join *report, tm_error *error)
{
    const tm_block *root = tm_stream_find(j->stream, ".root");
    tm_block *node = tm_stream_find(j->stream, ".node");
    tm_octant_points points;
    if (!root)
        return TM_OK;
    tm_status status =
        tm_octant_points_make(&points, tm_stream_find(j->stream, ".mix"),
                              tm_stream_find(j->stream, ".octant"), root, error);
    if (status == TM_OK)
        status = tm_octant_faces_level(&points, (double(*)[3])node->real, node->count,
                                       j->outer, &report->levelled, error);
    tm_octant_points_free(&points);
    return status;
}

static tm_status make_cells(joining *j, tm_octant_join *report, tm_error *error)
{
    const tm_block *mix = tm_stream_find(j->stream, ".mix");
    const tm_block *node = tm_stream_find(j->stream, ".node");
    const double(*xyz)[3] = (const double(*)[3])node->real;
    const double flatness[2] = {HUGE_VAL, tm_flatness(xyz, node->count)};
    j->facet = (tm_block){.name = ".facet", .kind = TM_FACET};
    j->cell =
        (tm_block){.name = ".cell", .kind = TM_CELL, .attributes = 1 + mix->attributes};
    const tm_status status = tm_join_cells(&j->faces, xyz, flatness, j->label, j->cells,
                                           &j->facet, &j->cell, &report->joined, error);
    if (status != TM_OK)
        return status;
    tm_cells_count_elements(&j->cell, j->label, mix->count, mix->attribute,
                            mix->attributes);
    report->elements = mix->count;
    report->polyhedra = j->cells;
    report->facets = j->facet.count;
    return TM_OK;
}

static bool is_replaced(const tm_block *block, const void *context)
{
    static const char *const name[] = {".mix", ".face", ".facet", ".octant", ".root"};
    (void)context;
    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        if (strcmp(block->name, name[i]) == 0)
            return true;
    return false;
}

static tm_status put_cells(joining *j, tm_error *error)
{
    tm_stream_remove_if(j->stream, is_replaced, NULL);
    const tm_status status = tm_stream_put(j->stream, &j->facet, error);
    return status == TM_OK ? tm_stream_put(j->stream, &j->cell, error) : status;
}

tm_status tm_join_octants(tm_stream *stream, tm_octant_join *report, tm_error *error)
{
    joining j = {.stream = stream};
    *report = (tm_octant_join){0};
    tm_status status = tm_cell_faces_find(&j.faces, stream, error);
    if (status == TM_OK && (!find_outer(&j) || !label_elements(&j)))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = level_faces(&j, report, error);
    if (status == TM_OK)
        status = make_cells(&j, report, error);
    if (status == TM_OK)
        status = put_cells(&j, error);
    if (status == TM_OK) {
        const tm_poly_arrays arrays = tm_poly_arrays_of(stream);
        double(*xyz)[3] = (double(*)[3])tm_stream_find(stream, ".node")->real;
        const tm_fit_options options = {
            .fixed = j.outer, .convex = true, .rounds = FIT_ROUNDS};
        status = tm_polyhedra_fit(&arrays, xyz, &options, &report->fit, error);
    }
    free_joining(&j);
    return status;
}
