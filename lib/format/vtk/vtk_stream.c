/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_maker.h"

#include "../../base/array.h"
#include "../../stream/group.h"
#include "../../surface/point_table.h"

#include <stdlib.h>
#include <string.h>

enum { COORDINATES = 3, GHOST = 1 /* vtkDataSetAttributes::DUPLICATECELL */ };

/* Which cells and points ------------------------------------------------------------ */

static void keep_cells(tm_vtk_maker *m)
{
    tm_vtk_mesh *cells = m->cells;
    const tm_vtk_data *ghost =
        tm_vtk_data_named(cells, &cells->cell_data, "vtkGhostType", false);
    const bool has_ghosts = ghost && ghost->components == 1 && !ghost->lacks;
    for (size_t c = 0; c < cells->cells; c++) {
        const double mark = has_ghosts ? ghost->value[c] : 0;
        const bool is_ghost = mark >= 0 && mark <= UINT8_MAX && ((int)mark & GHOST);
        const bool is_empty = cells->type[c] == TM_VTK_EMPTY;
        const int dimension = tm_vtk_dimension(cells->type[c]);
        m->keep[c] = !is_ghost && !is_empty;
        m->report->empty += is_empty;
        m->report->ghosts += is_ghost && !is_empty;
        m->volumes += m->keep[c] && dimension == 3;
        m->others += m->keep[c] && dimension == 2;
    }
}

/* What is in one place in two pieces is the same point: number[v] is the first. */
static tm_status weld_pieces(tm_vtk_maker *m)
{
    tm_vtk_mesh *cells = m->cells;
    tm_point_table table = {0};
    bool done = true;
    for (size_t v = 0; v < cells->points; v++)
        m->number[v] = (uint32_t)v;
    for (size_t p = 0; p < cells->pieces && cells->pieces > 1 && done; p++) {
        const size_t begin = cells->piece_start[p];
        const size_t end =
            p + 1 < cells->pieces ? cells->piece_start[p + 1] : cells->points;
        for (size_t v = begin; v < end; v++) {
            const uint32_t first = tm_point_table_find(&table, cells->xyz, cells->xyz[v]);
            m->number[v] = first == UINT32_MAX ? (uint32_t)v : first;
            m->report->joined += first != UINT32_MAX;
        }
        for (size_t v = begin; v < end && done; v++) {
            uint32_t first;
            if (m->number[v] == v)
                done = tm_point_table_join(&table, cells->xyz, (uint32_t)v, &first);
        }
    }
    tm_point_table_free(&table);
    return done ? TM_OK : tm_fail_memory(m->error);
}

/* number[v], the first point in v's place, becomes its node. */
static void number_nodes(tm_vtk_maker *m, const bool *middle)
{
    for (size_t v = 0; v < m->cells->points; v++) {
        const uint32_t first = m->number[v];
        if (first != v) {
            m->number[v] = m->number[first];
            continue;
        }
        m->number[v] = middle[v] ? TM_NONE : (uint32_t)m->nodes++;
        m->report->middle_nodes += middle[v];
    }
}

/* A point is a middle one only if all in its place are. */
static void join_middles(const tm_vtk_maker *m, bool *middle)
{
    for (size_t v = 0; v < m->cells->points; v++)
        if (!middle[v])
            middle[m->number[v]] = false;
}

static tm_status find_nodes(tm_vtk_maker *m)
{
    tm_vtk_mesh *cells = m->cells;
    bool *middle = calloc(cells->points + 1, sizeof *middle);
    m->number = tm_new(cells->points, sizeof *m->number);
    m->keep = tm_new(cells->cells, sizeof *m->keep);
    tm_status status = middle && m->number && m->keep ? TM_OK : tm_fail_memory(m->error);
    if (status == TM_OK)
        status = tm_vtk_take_corners(cells, middle, &m->report->higher_order, m->error);
    if (status == TM_OK)
        status = weld_pieces(m);
    if (status == TM_OK) {
        keep_cells(m);
        join_middles(m, middle);
        number_nodes(m, middle);
    }
    free(middle);
    return status;
}

/* All lists name nodes. */
static void renumber(tm_vtk_maker *m)
{
    tm_vtk_mesh *cells = m->cells;
    for (size_t i = 0; i < cells->nodes.start[cells->cells]; i++)
        cells->nodes.item[i] = m->number[cells->nodes.item[i]];
    for (size_t i = 0; i < cells->faces.start[cells->cells];)
        for (size_t k = cells->faces.item[i++]; k > 0; k--, i++)
            cells->faces.item[i] = m->number[cells->faces.item[i]];
}

static tm_status make_nodes(tm_vtk_maker *m)
{
    const tm_vtk_mesh *cells = m->cells;
    tm_block *node = tm_stream_add(m->stream, ".node");
    if (!node)
        return tm_fail_memory(m->error);
    const tm_status status = tm_block_allocate(node, m->nodes, 0, m->error);
    /* backwards: of points in one place the first one's coordinates are the node's */
    for (size_t v = cells->points; v-- > 0 && status == TM_OK;)
        if (m->number[v] != TM_NONE)
            memcpy(node->real + (size_t)COORDINATES * m->number[v], cells->xyz[v],
                   sizeof *cells->xyz);
    return status;
}

/* Names ----------------------------------------------------------------------------- */

/* "2 3 inlet" as a row of .group; what is no such string is none. */
static tm_status add_group(tm_block *group, const char *text, tm_error *error)
{
    char *end;
    const long dimension = strtol(text, &end, 10);
    if (end == text || *end != ' ' || dimension < 0 || dimension >= TM_GROUP_DIMENSIONS)
        return TM_OK;
    char *name;
    const long value = strtol(end, &name, 10);
    if (name == end || *name != ' ' || value < INT32_MIN || value > INT32_MAX)
        return TM_OK;
    tm_text clean = {0};
    tm_status status = TM_OK;
    tm_group_clean(&clean, name, strlen(name));
    if (clean.failed)
        status = tm_fail_memory(error);
    else if (clean.size > 0)
        status = tm_group_add(group, (tm_group_dimension)dimension, (int32_t)value,
                              clean.byte, error);
    tm_text_free(&clean);
    return status;
}

static tm_status make_groups(tm_vtk_maker *m)
{
    const tm_text *groups = &m->cells->groups;
    tm_block group;
    tm_group_init(&group, ".group");
    tm_status status = TM_OK;
    for (size_t i = 0; i < groups->size && status == TM_OK;
         i += strlen(groups->byte + i) + 1)
        status = add_group(&group, groups->byte + i, m->error);
    if (status == TM_OK)
        status = tm_group_check(&group, 0, m->cells->name, m->error);
    if (status == TM_OK)
        status = tm_group_to_stream(&group, m->stream, ".group", m->error);
    tm_group_free(&group);
    return status;
}

/* ----------------------------------------------------------------------------------- */

/* What the cells make; the names of arrays are kept for the report. */
static void note_roles(tm_vtk_maker *m)
{
    const tm_vtk_mesh *cells = m->cells;
    tm_vtk_read_report *report = m->report;
    tm_text_append(&report->names, cells->names.byte ? cells->names.byte : "",
                   cells->names.size);
    if (m->roles.region != TM_VTK_NO_ARRAY)
        report->region =
            report->names.byte + cells->cell_data.array[m->roles.region].name;
    if (m->roles.marker != TM_VTK_NO_ARRAY)
        report->marker =
            report->names.byte + cells->cell_data.array[m->roles.marker].name;
}

static tm_status make_all(tm_vtk_maker *m, const tm_vtk_read_options *options)
{
    tm_status status = find_nodes(m);
    tm_vtk_find_measures(m->cells, options);
    if (status == TM_OK)
        status = tm_vtk_find_roles(m->cells, m->keep, options, &m->roles, m->error);
    if (status != TM_OK)
        return status;
    note_roles(m);
    renumber(m);
    status = make_nodes(m);
    if (status == TM_OK)
        status = tm_vtk_make_elements(m);
    if (status == TM_OK)
        status = tm_vtk_make_polygons(m);
    if (status == TM_OK)
        status = tm_vtk_make_lines(m);
    if (status == TM_OK)
        status = tm_vtk_make_attributes(m);
    if (status == TM_OK)
        status = make_groups(m);
    return status;
}

tm_status tm_vtk_mesh_to_stream(tm_vtk_mesh *cells, tm_stream *stream,
                                const tm_vtk_read_options *options,
                                tm_vtk_read_report *report, tm_error *error)
{
    tm_vtk_maker m = {.cells = cells, .stream = stream, .report = report, .error = error};
    tm_status status = make_all(&m, options);
    if (status == TM_OK && (report->names.failed || report->left_out.failed ||
                            report->node_attributes.failed ||
                            report->cell_attributes.failed || report->measures.failed))
        status = tm_fail_memory(error);
    if (status != TM_OK)
        tm_stream_free(stream);
    stream->base = 0;
    free(m.keep);
    free(m.number);
    return status;
}
