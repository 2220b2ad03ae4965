/* SPDX-License-Identifier: GPL-3.0-or-later */
/* By way of VTK's grid. */
#include "../../base/array.h"
#include "../../element/shape.h"
#include "../vtk/vtk_cells.h"
#include "medit_input.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COORDINATES = 3, NODES_MAX = 27 };

typedef struct reader {
    tm_medit_input input;
    tm_vtk_mesh grid;
    double *vertex_ref; /* [grid.points] */
    double *ref;        /* [grid.cells] */
    size_t xyz_room, vertex_room, ref_room;
    bool has_vertices;
    tm_medit_report *report;
    tm_error *error;
} reader;

/* Sections -------------------------------------------------------------------------- */

static tm_status take_vertex(reader *r)
{
    const size_t v = r->grid.points;
    int64_t ref = 0;
    double(*xyz)[COORDINATES] = tm_grow(r->grid.xyz, &r->xyz_room, v + 1, sizeof *xyz);
    if (xyz)
        r->grid.xyz = xyz;
    double *refs = tm_grow(r->vertex_ref, &r->vertex_room, v + 1, sizeof *refs);
    if (refs)
        r->vertex_ref = refs;
    if (!xyz || !refs)
        return tm_fail_memory(r->error);
    xyz[v][COORDINATES - 1] = 0;
    tm_status status = TM_OK;
    for (int i = 0; i < r->input.dimension && status == TM_OK; i++)
        status = tm_medit_real(&r->input, "a coordinate", &xyz[v][i]);
    if (status == TM_OK)
        status = tm_medit_integer(&r->input, "the reference of a vertex", INT32_MIN,
                                  INT32_MAX, &ref);
    refs[v] = (double)ref;
    r->grid.points++;
    return status;
}

static tm_status take_vertices(reader *r)
{
    size_t count = 0;
    if (r->has_vertices)
        return tm_medit_fail(&r->input, "a second section Vertices");
    tm_status status = tm_medit_count(&r->input, COORDINATES, &count);
    for (size_t v = 0; v < count && status == TM_OK; v++)
        status = take_vertex(r);
    r->has_vertices = true;
    return status;
}

static tm_status take_element(reader *r, const tm_medit_section *section)
{
    int64_t value = 0;
    tm_status status = TM_OK;
    uint32_t *node = tm_lists_room(&r->grid.nodes, section->nodes);
    double *refs = tm_grow(r->ref, &r->ref_room, r->grid.cells + 1, sizeof *refs);
    if (refs)
        r->ref = refs;
    if (!node || !refs)
        return tm_fail_memory(r->error);
    for (size_t i = 0; i < section->nodes && status == TM_OK; i++) {
        status = tm_medit_integer(&r->input, "the number of a vertex", 1,
                                  (int64_t)r->grid.points, &value);
        node[i] = (uint32_t)(value - 1);
    }
    if (status == TM_OK)
        status = tm_medit_integer(&r->input, "a reference", INT32_MIN, INT32_MAX, &value);
    if (status != TM_OK)
        return status;
    refs[r->grid.cells] = (double)value;
    if (section->vtk == TM_VTK_WEDGE)
        tm_mixed_mirror(node, TM_WEDGE_NODES);
    r->grid.open = section->nodes;
    return tm_vtk_end_cell(&r->grid, section->vtk, r->error);
}

static tm_status take_elements(reader *r, const tm_medit_section *section)
{
    size_t count = 0;
    tm_status status = tm_medit_count(&r->input, section->nodes, &count);
    if (status == TM_OK && count > 0 && !r->has_vertices)
        return tm_medit_fail(&r->input, "%s are before Vertices", section->word);
    for (size_t e = 0; e < count && status == TM_OK; e++)
        status = take_element(r, section);
    return status;
}

/* Corners, ridges and what is required: how many, and that they are there. */
static tm_status take_marks(reader *r, const tm_medit_section *section)
{
    size_t count = 0;
    int64_t value;
    tm_text *marks = &r->report->marks;
    tm_status status = tm_medit_count(&r->input, 1, &count);
    for (size_t i = 0; i < count && status == TM_OK; i++)
        status = tm_medit_integer(&r->input, "a number", 0, INT32_MAX, &value);
    if (status == TM_OK && count > 0)
        tm_text_format(marks, "%s%zu %s", marks->size > 0 ? ", " : "", count,
                       section->marks);
    return status;
}

static tm_status take_section(reader *r, const tm_medit_section *section,
                              const char *name)
{
    tm_text *others = &r->report->sections;
    if (section && section->code == TM_MEDIT_VERTICES)
        return take_vertices(r);
    if (section && section->nodes > 0)
        return take_elements(r, section);
    if (section && section->marks)
        return take_marks(r, section);
    tm_text_format(others, "%s%s", others->size > 0 ? ", " : "", name);
    return TM_OK;
}

static tm_status take_sections(reader *r)
{
    char name[TM_MEDIT_NAME];
    const tm_medit_section *section = NULL;
    tm_status status = TM_OK;
    while (status == TM_OK) {
        status = tm_medit_next(&r->input, &section, name);
        if (status != TM_OK || (section && section->code == TM_MEDIT_END))
            break;
        status = take_section(r, section, name);
    }
    if (status == TM_OK && r->grid.points == 0)
        status = tm_medit_fail(&r->input, "has no vertices");
    return status;
}

/* Names and references -------------------------------------------------------------- */

/* Comments of medit-export are what VTK's group_names are. */
static void find_names(reader *r)
{
    static const char own[] = "# termesh ";
    const char *at = r->input.begin, *end = r->input.end;
    while (!r->input.binary && at < end) {
        const char *line = at, *feed = memchr(at, '\n', (size_t)(end - at));
        at = feed ? feed + 1 : end;
        const char *past = feed ? feed : end;
        if ((size_t)(past - line) < sizeof own || memcmp(line, own, sizeof own - 1) != 0)
            continue;
        past -= past[-1] == '\r';
        line += sizeof own - 1;
        tm_text_append(&r->grid.groups, line, (size_t)(past - line));
        tm_text_append(&r->grid.groups, "", 1);
    }
}

/* Whether a cell of dimension 3, or one of the others, has a reference. */
static bool has_references(const reader *r, bool volumes)
{
    for (size_t c = 0; c < r->grid.cells; c++)
        if (r->ref[c] != 0 && (tm_vtk_dimension(r->grid.type[c]) == 3) == volumes)
            return true;
    return false;
}

/* Makes an array of data of *value, which is then the grid's. */
static tm_status add_data(reader *r, tm_vtk_data_list *list, const char *name,
                          size_t components, double **value)
{
    tm_vtk_data *data = tm_vtk_data_named(&r->grid, list, name, true);
    if (!data)
        return tm_fail_memory(r->error);
    data->components = components;
    data->value = *value;
    *value = NULL;
    return TM_OK;
}

static tm_status add_references(reader *r)
{
    const bool regions = has_references(r, true), markers = has_references(r, false);
    bool nodes = false;
    tm_status status = TM_OK;
    for (size_t v = 0; v < r->grid.points; v++)
        nodes |= r->vertex_ref[v] != 0;
    if (nodes)
        status = add_data(r, &r->grid.point_data, "medit:ref", 1, &r->vertex_ref);
    if (status == TM_OK && (regions || markers))
        status = add_data(r, &r->grid.cell_data,
                          !markers   ? "region"
                          : !regions ? "marker"
                                     : "medit:ref",
                          1, &r->ref);
    return status;
}

/* The solution ---------------------------------------------------------------------- */

/* Value k of the solution, of `numbers` in all of which `first` are before it. */
static tm_status add_value(reader *r, size_t k, const double *value, size_t numbers,
                           size_t first, size_t components)
{
    char name[TM_MEDIT_NAME];
    double *own = tm_new(r->grid.points * components, sizeof *own);
    if (!own)
        return tm_fail_memory(r->error);
    for (size_t v = 0; v < r->grid.points; v++)
        memcpy(own + v * components, value + v * numbers + first,
               components * sizeof *own);
    snprintf(name, sizeof name, "solution_%zu", k + 1);
    const tm_status status = add_data(r, &r->grid.point_data, name, components, &own);
    free(own);
    return status;
}

static tm_status add_solution(reader *r, const tm_medit_bytes *bytes)
{
    double *value = NULL;
    tm_medit_kind *kind = NULL;
    size_t kinds = 0, numbers = 0, first = 0;
    int dimension = 0;
    tm_status status =
        tm_medit_read_solution(bytes, r->grid.points, &value, &kind, &kinds, &dimension,
                               &r->report->sections, r->error);
    for (size_t k = 0; k < kinds && status == TM_OK; k++)
        numbers += tm_medit_numbers_of(kind[k], dimension);
    for (size_t k = 0; k < kinds && status == TM_OK; k++) {
        const size_t components = tm_medit_numbers_of(kind[k], dimension);
        status = add_value(r, k, value, numbers, first, components);
        first += components;
    }
    free(value);
    free(kind);
    return status;
}

/* ------------------------------------------------------------------------------------ */

void tm_medit_report_free(tm_medit_report *report)
{
    tm_text_free(&report->marks);
    tm_text_free(&report->sections);
    tm_text_free(&report->attributes);
}

static tm_status make_stream(reader *r, tm_stream *stream)
{
    static const tm_vtk_read_options options = {.threads = 1};
    tm_vtk_read_report grid = {0};
    tm_medit_report *report = r->report;
    const tm_status status =
        tm_vtk_mesh_to_stream(&r->grid, stream, &options, &grid, r->error);
    report->turned = grid.turned;
    report->cut = grid.cut;
    report->higher_order = grid.higher_order;
    report->middle_nodes = grid.middle_nodes;
    report->loose = grid.loose;
    report->attributes = grid.node_attributes;
    grid.node_attributes = (tm_text){0};
    tm_vtk_read_report_free(&grid);
    stream->base = 1;
    return status;
}

tm_status tm_medit_read(tm_stream *stream, const tm_medit_bytes *mesh,
                        const tm_medit_bytes *solution, tm_medit_report *report,
                        tm_error *error)
{
    reader r = {.report = report, .error = error};
    *report = (tm_medit_report){0};
    tm_status status = tm_vtk_mesh_new(&r.grid, mesh->name, error);
    if (status == TM_OK)
        status = tm_medit_begin(&r.input, mesh, error);
    if (status == TM_OK)
        status = take_sections(&r);
    if (status == TM_OK)
        status = add_references(&r);
    if (status == TM_OK && solution)
        status = add_solution(&r, solution);
    if (status == TM_OK) {
        find_names(&r);
        status = r.grid.groups.failed ? tm_fail_memory(error) : make_stream(&r, stream);
    }
    if (status == TM_OK && (report->marks.failed || report->sections.failed)) {
        tm_stream_free(stream);
        status = tm_fail_memory(error);
    }
    tm_vtk_mesh_free(&r.grid);
    free(r.vertex_ref);
    free(r.ref);
    return status;
}
