/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dual.h"

#include "../../base/array.h"
#include "../../tet/mesh_measure.h"
#include "../facets.h"
#include "dual_steps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool allocate(tm_dual *d)
{
    const size_t tets = d->mesh->slots, nodes = d->mesh->nodes;
    d->level = calloc(nodes + 1, sizeof *d->level);
    d->cuts = calloc(4 * tets + 1, sizeof *d->cuts);
    d->touched = calloc(nodes + 1, sizeof *d->touched);
    d->cell = tm_new(4 * tets, sizeof *d->cell);
    d->cell_node = tm_new(4 * tets, sizeof *d->cell_node);
    d->face_point = tm_new(4 * tets, sizeof *d->face_point);
    d->node_point = tm_new(nodes, sizeof *d->node_point);
    d->quad_start = tm_new(nodes + 2, sizeof *d->quad_start);
    d->tet_xyz = tm_new(tets, sizeof *d->tet_xyz);
    d->frozen = calloc(tets + 1, sizeof *d->frozen);
    return d->level && d->cuts && d->touched && d->cell && d->cell_node &&
           d->face_point && d->node_point && d->quad_start && d->tet_xyz && d->frozen;
}

static void free_dual(tm_dual *d)
{
    void *const all[] = {
        d->level,   d->cuts,      d->touched, d->cell,       d->cell_node,  d->wall,
        d->edge,    d->following, d->begins,  d->face_point, d->node_point, d->quad_start,
        d->quad_of, d->point,     d->xyz,     d->tet_xyz,    d->frozen};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    tm_edge_map_free(&d->edge_of);
    tm_dual_forget(d);
    tm_block_clear(&d->facet);
}

/* The cells of the levels that nodes have now, with their facets and points. */
static tm_status build(tm_dual *d, tm_error *error)
{
    tm_status status;
    tm_progress_stage(d->options->progress, "finding cells");
    do {
        status = tm_dual_find_cells(d, error);
        if (status == TM_OK)
            status = tm_dual_find_walls(d, error);
    } while (status == TM_OK && d->again);
    if (status == TM_OK)
        status = tm_dual_place_walls(d, error);
    if (status == TM_OK)
        status = tm_dual_make_facets(d, error);
    return status;
}

/* What is written ------------------------------------------------------------------ */

static int32_t marker_of(const tm_dual *d, const tm_dual_point *point)
{
    if (point->place == TM_DUAL_IN_FACE)
        return d->wall[point->of].marker;
    if (point->place == TM_DUAL_ON_EDGE)
        return d->edge[point->of].marker;
    return point->place == TM_DUAL_AT_NODE ? d->mesh->node_marker[point->of] : 0;
}

/* The attributes of a point, by the tetrahedra that it may have moved in; false where
 * memory is out. O(the tetrahedra at an edge). */
static bool interpolate(const tm_dual *d, size_t p, tm_star *star, double *value)
{
    const tm_tet_mesh *mesh = d->mesh;
    const size_t width = mesh->node_attributes;
    const uint32_t of = d->point[p].of;
    const double *x = d->xyz[p];
    if (d->point[p].place == TM_DUAL_AT_NODE) {
        memcpy(value, mesh->node_attribute + width * of, width * sizeof *value);
    } else if (d->point[p].place == TM_DUAL_IN_TET) {
        tm_tet_interpolate(mesh, &of, 1, x, value);
    } else if (d->point[p].place == TM_DUAL_IN_FACE) {
        const uint32_t half = d->wall[of].half;
        const uint32_t across = tm_tet_across(mesh, half / 4, half % 4);
        const uint32_t side[2] = {half / 4, across / 4};
        tm_tet_interpolate(mesh, side, across == TM_NONE ? 1 : 2, x, value);
    } else {
        const tm_dual_edge *edge = &d->edge[of];
        if (!tm_star_between(mesh, edge->half / 4, edge->node[0], edge->node[1], star))
            return false;
        tm_tet_interpolate(mesh, star->tet, star->size, x, value);
    }
    return true;
}

static tm_status write_nodes(const tm_dual *d, tm_block *node, tm_error *error)
{
    node->attributes = d->mesh->node_attributes;
    node->markers = d->mesh->node_marker != NULL;
    tm_star star = {0};
    tm_status status = tm_block_allocate(node, d->points, 0, error);
    for (size_t p = 0; p < d->points && status == TM_OK; p++) {
        memcpy(node->real + 3 * p, d->xyz[p], sizeof d->xyz[p]);
        if (node->markers)
            node->marker[p] = marker_of(d, &d->point[p]);
        if (node->attributes > 0 &&
            !interpolate(d, p, &star, node->attribute + node->attributes * p))
            status = tm_fail_memory(error);
    }
    tm_star_free(&star);
    return status;
}

/* Whether end i of an edge that .edge has is an edge of facets. */
static bool is_written(const tm_dual *d, const tm_dual_edge *edge, int i)
{
    return edge->listed && edge->real[i] && d->node_point[edge->node[i]] != TM_NONE;
}

/* The halves of the edges of .edge. */
static tm_status write_edges(const tm_dual *d, tm_block *edge, tm_error *error)
{
    size_t count = 0, row = 0;
    for (size_t e = 0; e < d->edges; e++)
        for (int i = 0; i < 2; i++)
            count += is_written(d, &d->edge[e], i);
    edge->markers = d->mesh->edge_markers;
    tm_status status = tm_block_allocate(edge, count, 0, error);
    for (size_t e = 0; e < d->edges && status == TM_OK; e++)
        for (int i = 0; i < 2; i++) {
            if (!is_written(d, &d->edge[e], i))
                continue;
            edge->integer[2 * row] = d->node_point[d->edge[e].node[i]];
            edge->integer[2 * row + 1] = d->edge[e].point;
            if (edge->markers)
                edge->marker[row] = d->edge[e].marker;
            row++;
        }
    return status;
}

static tm_status write_cells(const tm_dual *d, tm_block *cell, tm_error *error)
{
    const tm_tet_mesh *mesh = d->mesh;
    cell->attributes = 1 + mesh->regions;
    tm_status status = tm_cells_from_facets(&d->facet, cell, d->cells, error);
    for (size_t p = 0; p < 4 * mesh->slots && status == TM_OK; p++) {
        double *row = cell->attribute + cell->attributes * d->cell[p];
        if (row[0]++ == 0 && mesh->regions > 0)
            memcpy(row + 1, mesh->region + mesh->regions * (p / 4),
                   mesh->regions * sizeof *row);
    }
    return status;
}

static tm_status write_blocks(tm_dual *d, tm_dual_blocks *made, tm_error *error)
{
    tm_status status = write_nodes(d, &made->node, error);
    if (status == TM_OK)
        status = write_edges(d, &made->edge, error);
    if (status == TM_OK)
        status = write_cells(d, &made->cell, error);
    if (status != TM_OK)
        return status;
    made->facet = d->facet;
    d->facet = (tm_block){.kind = TM_FACET};
    return TM_OK;
}

static void count(const tm_dual *d, tm_dual_report *report)
{
    const tm_tet_mesh *mesh = d->mesh;
    report->cells = d->cells;
    report->facets = d->facets;
    report->nodes = d->points;
    report->cut = d->cut_nodes;
    for (size_t v = 0; v < mesh->nodes && d->level; v++)
        report->taken_apart += d->level[v] == TM_DUAL_PIECES;
    for (size_t e = 0; e < mesh->edges; e++) {
        const tm_marked_edge *edge = &mesh->edge[e];
        report->lost_edges += !edge->gone && edge->marker != 0 &&
                              !tm_edge_map_get(&d->edge_of, edge->node[0], edge->node[1]);
    }
}

tm_status tm_dual_make(tm_dual_blocks *made, const tm_tet_mesh *mesh,
                       const tm_dual_options *options, tm_dual_report *report,
                       tm_error *error)
{
    const double half_turn = 180, pi = acos(-1);
    tm_dual d = {.mesh = mesh,
                 .options = options,
                 .flatness = tm_facet_flatness(mesh),
                 .cosine = cos(options->feature_angle * pi / half_turn),
                 .facet = {.name = ".facet", .kind = TM_FACET, .markers = true}};
    *made = (tm_dual_blocks){.node = {.name = ".node", .kind = TM_NODE},
                             .edge = {.name = ".edge", .kind = TM_EDGE},
                             .facet = {.name = ".facet", .kind = TM_FACET},
                             .cell = {.name = ".cell", .kind = TM_CELL}};
    *report = (tm_dual_report){.tets = mesh->slots};
    tm_status status = allocate(&d) ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        tm_dual_place_tets(&d);
    if (status == TM_OK)
        status = build(&d, error);
    if (status == TM_OK)
        status = tm_dual_flatten(&d, error);
    if (status == TM_OK) {
        tm_dual_place_cuts(&d);
        status = tm_dual_improve(&d, false, report, error);
    }
    for (bool more = true; more && status == TM_OK; more = d.again) {
        if (d.again)
            status = build(&d, error);
        tm_progress_stage(options->progress, "moving points");
        if (status == TM_OK)
            status = tm_dual_improve(&d, true, report, error);
    }
    if (status == TM_OK)
        status = write_blocks(&d, made, error);
    count(&d, report);
    free_dual(&d);
    return status;
}

void tm_dual_blocks_free(tm_dual_blocks *blocks)
{
    tm_block_clear(&blocks->node);
    tm_block_clear(&blocks->edge);
    tm_block_clear(&blocks->facet);
    tm_block_clear(&blocks->cell);
}
