/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gmsh_stream.h"

#include "../../../lib/base/array.h"
#include "../../../lib/element/shape.h"
#include "../../../lib/examine/mixed_volume.h"
#include "../../../lib/format/tetgen.h"
#include "../../../lib/geom/vector.h"
#include "../../../lib/mesh/face_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TRIANGLE = 3, QUADRILATERAL = 4 };

typedef struct maker {
    tm_stream *stream;
    gmsh_mesh mesh;
    gmsh_sets sets;
    gmsh_done *done;
    tm_error *error;
} maker;

static tm_status add_block(maker *make, const char *name, tm_block **block)
{
    *block = tm_stream_add(make->stream, name);
    return *block ? TM_OK : tm_fail_memory(make->error);
}

static int32_t value_of(const maker *make, const gmsh_elements *elements, size_t e)
{
    return make->sets.set[elements->set[e]].value;
}

/* Nodes ---------------------------------------------------------------------------- */

/* Only points of physical groups give their nodes a marker: others are where the geometry
 * has a corner. */
static bool is_marked(const maker *make, size_t point)
{
    return make->sets.set[make->mesh.of[GMSH_POINTS].set[point]].groups > 0;
}

static tm_status make_nodes(maker *make)
{
    const gmsh_elements *points = &make->mesh.of[GMSH_POINTS];
    tm_block *node;
    tm_status status = add_block(make, ".node", &node);
    if (status != TM_OK)
        return status;
    for (size_t p = 0; p < points->elements; p++)
        node->markers |= is_marked(make, p);
    status = tm_block_allocate(node, make->mesh.nodes, 0, make->error);
    if (status != TM_OK)
        return status;
    for (size_t v = 0; v < node->count; v++)
        for (size_t i = 0; i < 3; i++) {
            if (!isfinite(make->mesh.xyz[v][i]))
                return tm_fail(make->error, TM_ERROR_INPUT,
                               "a coordinate of node %zu, in the order of their numbers, "
                               "is not finite",
                               v + 1);
            node->real[3 * v + i] = make->mesh.xyz[v][i];
        }
    for (size_t p = 0; p < points->elements && node->markers; p++)
        if (is_marked(make, p))
            node->marker[points->node[p]] = value_of(make, points, p);
    make->done->nodes = node->count;
    return TM_OK;
}

/* Cells ---------------------------------------------------------------------------- */

static bool has_only_tetrahedra(const gmsh_elements *cells)
{
    for (size_t c = 0; c < cells->elements; c++)
        if (cells->count[c] != TM_TET_NODES)
            return false;
    return true;
}

static void set_regions(const maker *make, tm_block *block)
{
    for (size_t c = 0; c < block->count; c++)
        block->attribute[c] = value_of(make, &make->mesh.of[GMSH_CELLS], c);
}

static tm_status make_tetrahedra(maker *make)
{
    const gmsh_elements *cells = &make->mesh.of[GMSH_CELLS];
    tm_block *ele;
    tm_status status = add_block(make, ".ele", &ele);
    if (status != TM_OK)
        return status;
    ele->attributes = 1;
    status = tm_block_allocate(ele, cells->elements, 0, make->error);
    if (status != TM_OK)
        return status;
    memcpy(ele->integer, cells->node, TM_TET_NODES * ele->count * sizeof *ele->integer);
    set_regions(make, ele);
    const tm_turned turned = tm_tetgen_orient(tm_stream_find(make->stream, ".node"), ele);
    make->done->turned = turned.turned;
    make->done->flat = turned.flat;
    return TM_OK;
}

/* The triangle 0 1 2 of a wedge turns the other way in Gmsh, see shape.h. */
static void set_cell(maker *make, const tm_block *mix, size_t c, size_t at)
{
    const gmsh_elements *cells = &make->mesh.of[GMSH_CELLS];
    const size_t count = cells->count[c];
    uint32_t *node = mix->item + at;
    memcpy(node, cells->node + c * cells->width, count * sizeof *node);
    if (count == TM_WEDGE_NODES)
        tm_mixed_mirror(node, count);
    const double volume =
        tm_mixed_volume((const double(*)[3])make->mesh.xyz, node, count);
    make->done->flat += volume == 0;
    if (volume < 0) {
        tm_mixed_mirror(node, count);
        make->done->turned++;
    }
}

static tm_status make_mixed(maker *make)
{
    const gmsh_elements *cells = &make->mesh.of[GMSH_CELLS];
    tm_block *mix;
    size_t items = 0;
    for (size_t c = 0; c < cells->elements; c++)
        items += cells->count[c];
    tm_status status = add_block(make, ".mix", &mix);
    if (status != TM_OK)
        return status;
    mix->attributes = 1;
    status = tm_block_allocate(mix, cells->elements, items, make->error);
    if (status != TM_OK)
        return status;
    for (size_t c = 0; c < cells->elements; c++) {
        mix->start[c + 1] = mix->start[c] + cells->count[c];
        set_cell(make, mix, c, mix->start[c]);
    }
    set_regions(make, mix);
    return TM_OK;
}

/* Faces ---------------------------------------------------------------------------- */

/* The corners of the two triangles of a quadrilateral, along its shorter diagonal. */
static const uint8_t halves[2][2][TRIANGLE] = {{{0, 1, 2}, {0, 2, 3}},
                                               {{0, 1, 3}, {1, 2, 3}}};

static unsigned diagonal(const maker *make, const uint32_t *node)
{
    const double(*x)[3] = (const double(*)[3])make->mesh.xyz;
    return tm_distance2(x[node[1]], x[node[3]]) < tm_distance2(x[node[0]], x[node[2]]);
}

static tm_status make_triangles(maker *make)
{
    const gmsh_elements *faces = &make->mesh.of[GMSH_FACES];
    tm_block *face;
    for (size_t f = 0; f < faces->elements; f++)
        make->done->halved += faces->count[f] == QUADRILATERAL;
    tm_status status = add_block(make, ".face", &face);
    if (status != TM_OK)
        return status;
    face->markers = true;
    status =
        tm_block_allocate(face, faces->elements + make->done->halved, 0, make->error);
    if (status != TM_OK)
        return status;
    size_t row = 0;
    for (size_t f = 0; f < faces->elements; f++) {
        const uint32_t *node = faces->node + f * faces->width;
        const bool is_whole = faces->count[f] == TRIANGLE;
        const unsigned along = is_whole ? 0 : diagonal(make, node);
        for (size_t half = 0; half < (is_whole ? 1 : 2); half++, row++) {
            for (size_t i = 0; i < TRIANGLE; i++)
                face->integer[TRIANGLE * row + i] = node[halves[along][half][i]];
            face->marker[row] = value_of(make, faces, f);
        }
    }
    return TM_OK;
}

/* The faces as the facets of a view of the cells. */
static tm_mesh_view view_faces(const maker *make, size_t *start, uint32_t *node)
{
    const gmsh_elements *faces = &make->mesh.of[GMSH_FACES];
    tm_mesh_view view = tm_mesh_view_of_mixed(make->stream);
    start[0] = 0;
    for (size_t f = 0; f < faces->elements; f++) {
        start[f + 1] = start[f] + faces->count[f];
        memcpy(node + start[f], faces->node + f * faces->width,
               faces->count[f] * sizeof *node);
    }
    view.facets = faces->elements;
    view.facet_start = start;
    view.facet_node = node;
    return view;
}

/* The facet on half face `half`: outward for the lesser of the two elements. */
static void set_facet(tm_block *facet, const tm_mesh_view *view, uint32_t half,
                      uint32_t mate)
{
    uint32_t node[QUADRILATERAL];
    const size_t count = tm_half_face_nodes(view, half, node), row = facet->count++;
    facet->integer[2 * row] = half / TM_ELEMENT_NODES;
    facet->integer[2 * row + 1] =
        mate == half || mate == TM_NONE ? TM_NONE : mate / TM_ELEMENT_NODES;
    facet->start[row + 1] = facet->start[row] + count;
    memcpy(facet->item + facet->start[row], node, count * sizeof *node);
}

static tm_status make_facets_of(maker *make, const tm_mesh_view *view)
{
    const gmsh_elements *faces = &make->mesh.of[GMSH_FACES];
    uint32_t *mate = NULL;
    tm_block *facet = NULL;
    tm_status status = tm_face_mates(&mate, view, make->error);
    if (status == TM_OK)
        status = add_block(make, ".facet", &facet);
    if (status == TM_OK) {
        facet->markers = true;
        status = tm_block_allocate(facet, faces->elements,
                                   view->facet_start[faces->elements], make->error);
    }
    const size_t first_row = tm_half_faces(view) + view->faces;
    if (status == TM_OK)
        facet->count = 0;
    for (size_t f = 0; status == TM_OK && f < faces->elements; f++) {
        const uint32_t half = mate[first_row + f];
        if (half == TM_NONE) {
            make->done->loose++;
            continue;
        }
        facet->marker[facet->count] = value_of(make, faces, f);
        set_facet(facet, view, half, mate[half]);
    }
    free(mate);
    return status;
}

static tm_status make_facets(maker *make)
{
    const gmsh_elements *faces = &make->mesh.of[GMSH_FACES];
    size_t *start = tm_new(faces->elements + 1, sizeof *start);
    uint32_t *node = tm_new(faces->elements * faces->width, sizeof *node);
    tm_status status = tm_fail_memory(make->error);
    if (start && node) {
        const tm_mesh_view view = view_faces(make, start, node);
        status = make_facets_of(make, &view);
    }
    free(start);
    free(node);
    return status;
}

/* Edges ---------------------------------------------------------------------------- */

static tm_status make_edges(maker *make)
{
    const gmsh_elements *lines = &make->mesh.of[GMSH_LINES];
    tm_block *edge;
    tm_status status = add_block(make, ".edge", &edge);
    if (status != TM_OK)
        return status;
    edge->markers = true;
    status = tm_block_allocate(edge, lines->elements, 0, make->error);
    for (size_t e = 0; e < lines->elements && status == TM_OK; e++) {
        memcpy(edge->integer + 2 * e, lines->node + 2 * e, 2 * sizeof *edge->integer);
        edge->marker[e] = value_of(make, lines, e);
    }
    return status;
}

/* ---------------------------------------------------------------------------------- */

/* Which sets the values are for. */
static tm_status give_values(maker *make, tm_block *group)
{
    for (int d = 0; d < GMSH_DIMENSIONS; d++) {
        const gmsh_elements *elements = &make->mesh.of[d];
        for (size_t e = 0; e < elements->elements; e++)
            make->sets.set[elements->set[e]].is_used = d > 0 || is_marked(make, e);
    }
    const tm_status status = gmsh_sets_name(&make->sets, group, make->error);
    for (size_t s = 0; s < make->sets.sets; s++)
        make->done->several += make->sets.set[s].is_used && make->sets.set[s].groups > 1;
    make->done->renumbered = make->sets.renumbered;
    make->done->names = group->count;
    return status;
}

static tm_status make_blocks(maker *make, const tm_block *group)
{
    const gmsh_mesh *mesh = &make->mesh;
    tm_status status = make_nodes(make);
    const bool is_mixed = !has_only_tetrahedra(&mesh->of[GMSH_CELLS]);
    if (status == TM_OK && mesh->of[GMSH_CELLS].elements > 0)
        status = is_mixed ? make_mixed(make) : make_tetrahedra(make);
    if (status == TM_OK && mesh->of[GMSH_FACES].elements > 0)
        status = is_mixed ? make_facets(make) : make_triangles(make);
    if (status == TM_OK && mesh->of[GMSH_LINES].elements > 0)
        status = make_edges(make);
    if (status == TM_OK)
        status = tm_group_to_stream(group, make->stream, ".group", make->error);
    return status;
}

tm_status gmsh_to_stream(tm_stream *stream, const gmsh_model *model,
                         const gmsh_model *swapped, gmsh_done *done, tm_error *error)
{
    maker make = {.stream = stream, .done = done, .error = error};
    tm_block group = {0};
    *done = (gmsh_done){0};
    tm_group_init(&group, ".group");
    tm_status status = gmsh_sets_of_entities(&make.sets, model, swapped, error);
    if (status == TM_OK)
        status = gmsh_mesh_take(&make.mesh, model, &make.sets, error);
    if (status == TM_OK)
        status = give_values(&make, &group);
    if (status == TM_OK)
        status = make_blocks(&make, &group);
    done->cells = make.mesh.of[GMSH_CELLS].elements;
    done->faces = make.mesh.of[GMSH_FACES].elements;
    done->edges = make.mesh.of[GMSH_LINES].elements;
    done->repeated = make.mesh.repeated;
    done->degenerate = make.mesh.degenerate;
    done->high_order = make.mesh.high_order;
    done->between = make.mesh.between;
    gmsh_mesh_free(&make.mesh);
    gmsh_sets_free(&make.sets);
    tm_group_free(&group);
    return status;
}
