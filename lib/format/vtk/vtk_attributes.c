/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_maker.h"

#include "../../base/array.h"
#include "../../element/shape.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A component of an array, or zeros. */
typedef struct column {
    const tm_vtk_data *data; /* NULL: zeros */
    size_t component;
} column;

typedef struct column_list {
    column at[TM_ATTRIBUTES_MAX];
    size_t count;
} column_list;

static const char *name_of(const tm_vtk_maker *m, const tm_vtk_data *data)
{
    return m->cells->names.byte + data->name;
}

static void list_name(const tm_vtk_maker *m, tm_text *text, const tm_vtk_data *data,
                      const char *why)
{
    tm_text_format(text, "%s%s", text->size > 0 ? ", " : "", name_of(m, data));
    if (data->components != 1)
        tm_text_format(text, " (%zu)", data->components);
    if (why)
        tm_text_format(text, " (%s)", why);
}

static bool is_finite(const tm_vtk_data *data, size_t count)
{
    size_t i = 0;
    while (i < count * data->components && isfinite(data->value[i]))
        i++;
    return i == count * data->components;
}

static void add_column(column_list *to, const tm_vtk_data *data, size_t component)
{
    to->at[to->count++] = (column){data, component};
}

/* Adds all components of an array, and its name to a list; or says why not. */
static void add_array(const tm_vtk_maker *m, column_list *to, const tm_vtk_data *data,
                      size_t count, tm_text *names)
{
    if (data->lacks)
        list_name(m, &m->report->left_out, data,
                  data->strings ? "strings" : "not of all pieces");
    else if (data->components > TM_ATTRIBUTES_MAX - to->count)
        list_name(m, &m->report->left_out, data, "more than 1000 attributes");
    else if (!is_finite(data, count))
        list_name(m, &m->report->left_out, data, "not all finite");
    else {
        for (size_t i = 0; i < data->components; i++)
            add_column(to, data, i);
        list_name(m, names, data, NULL);
    }
}

/* Whether the arrays are named as vtu-export names attributes: then that tells nothing.
 */
static bool is_plain(const tm_vtk_maker *m, const column_list *columns)
{
    for (size_t i = 0; i < columns->count; i++) {
        char name[32];
        const tm_vtk_data *data = columns->at[i].data;
        snprintf(name, sizeof name, "attribute_%zu", i + 1);
        if (data && strcmp(name_of(m, data), name) != 0 &&
            strcmp(name_of(m, data), "region") != 0 &&
            strcmp(name_of(m, data), "tetrahedra") != 0)
            return false;
    }
    return true;
}

static tm_status allocate(const tm_vtk_maker *m, tm_block *block,
                          const column_list *columns)
{
    if (columns->count == 0)
        return TM_OK;
    if (block->count > SIZE_MAX / TM_ATTRIBUTES_MAX)
        return tm_fail_memory(m->error);
    block->attribute = tm_new(block->count * columns->count, sizeof *block->attribute);
    block->attributes = columns->count;
    return block->attribute ? TM_OK : tm_fail_memory(m->error);
}

/* Row `row` gets what point or cell i has. */
static void set_row(tm_block *block, size_t row, const column_list *columns, size_t i)
{
    double *to = block->attribute + row * columns->count;
    for (size_t a = 0; a < columns->count; a++) {
        const column *from = &columns->at[a];
        to[a] = from->data
                    ? from->data->value[i * from->data->components + from->component]
                    : 0;
    }
}

/* Nodes ------------------------------------------------------------------------------ */

/* A cell of one point marks it, where points have no markers of their own. */
static tm_status mark_vertices(tm_vtk_maker *m, tm_block *node)
{
    const tm_vtk_mesh *cells = m->cells;
    for (size_t c = 0; c < cells->cells; c++) {
        if (tm_vtk_kept(m, c) != 0)
            continue;
        const int32_t marker = tm_vtk_marker(m, c);
        if (marker == 0 || m->roles.node_marker != TM_VTK_NO_ARRAY) {
            m->report->vertices += m->content != TM_CONTENT_POINTS;
            continue;
        }
        if (!node->marker)
            node->marker = calloc(node->count + 1, sizeof *node->marker);
        if (!node->marker)
            return tm_fail_memory(m->error);
        node->markers = true;
        for (size_t i = cells->nodes.start[c]; i < cells->nodes.start[c + 1]; i++)
            node->marker[cells->nodes.item[i]] = marker;
    }
    return TM_OK;
}

static tm_status mark_nodes(tm_vtk_maker *m, tm_block *node)
{
    const tm_vtk_mesh *cells = m->cells;
    if (m->roles.node_marker == TM_VTK_NO_ARRAY)
        return mark_vertices(m, node);
    const double *value = cells->point_data.array[m->roles.node_marker].value;
    node->marker = calloc(node->count + 1, sizeof *node->marker);
    if (!node->marker)
        return tm_fail_memory(m->error);
    node->markers = true;
    for (size_t v = cells->points; v-- > 0;)
        if (m->number[v] != TM_NONE)
            node->marker[m->number[v]] = (int32_t)value[v];
    return mark_vertices(m, node);
}

static tm_status make_node_attributes(tm_vtk_maker *m, column_list *columns)
{
    const tm_vtk_mesh *cells = m->cells;
    tm_block *node = tm_stream_find(m->stream, ".node");
    columns->count = 0;
    for (size_t i = 0; i < cells->point_data.arrays; i++)
        if (i != m->roles.node_marker &&
            !tm_vtk_is_internal(name_of(m, &cells->point_data.array[i])))
            add_array(m, columns, &cells->point_data.array[i], cells->points,
                      &m->report->node_attributes);
    if (is_plain(m, columns))
        tm_text_free(&m->report->node_attributes);
    const tm_status status = allocate(m, node, columns);
    if (status != TM_OK)
        return status;
    /* backwards: of points in one place the first one's data are the node's */
    for (size_t v = cells->points; v-- > 0 && columns->count > 0;)
        if (m->number[v] != TM_NONE)
            set_row(node, m->number[v], columns, v);
    return mark_nodes(m, node);
}

/* Cells ------------------------------------------------------------------------------ */

/* The number of tetrahedra and the region come first where there is anything. */
static void add_first(const tm_vtk_maker *m, column_list *columns, bool others)
{
    const tm_vtk_data *array = m->cells->cell_data.array;
    const size_t region = m->roles.region, tetrahedra = m->roles.tetrahedra;
    const bool has_region = region != TM_VTK_NO_ARRAY;
    const bool has_tetrahedra = tetrahedra != TM_VTK_NO_ARRAY;
    if (m->content == TM_CONTENT_POLYHEDRA && (others || has_region || has_tetrahedra))
        add_column(columns, has_tetrahedra ? &array[tetrahedra] : NULL, 0);
    if (others || has_region)
        add_column(columns, has_region ? &array[region] : NULL, 0);
}

/* Whether an array of cell data is an attribute, after the region. */
static bool is_other(const tm_vtk_maker *m, size_t i)
{
    const tm_vtk_data *data = &m->cells->cell_data.array[i];
    return i != m->roles.region && i != m->roles.marker &&
           !(i == m->roles.tetrahedra && m->content == TM_CONTENT_POLYHEDRA) &&
           !tm_vtk_is_internal(name_of(m, data)) && !data->measure;
}

static tm_status make_cell_attributes(tm_vtk_maker *m, column_list *columns)
{
    const tm_vtk_mesh *cells = m->cells;
    tm_block *block = tm_content_block(m->stream, m->content);
    tm_text *names = &m->report->cell_attributes;
    size_t row = 0;
    columns->count = 2; /* room for what comes first */
    for (size_t i = 0; i < cells->cell_data.arrays; i++)
        if (is_other(m, i))
            add_array(m, columns, &cells->cell_data.array[i], cells->cells, names);
    column_list first = {.count = 0};
    add_first(m, &first, columns->count > 2);
    memmove(columns->at + first.count, columns->at + 2,
            (columns->count - 2) * sizeof *columns->at);
    memcpy(columns->at, first.at, first.count * sizeof *columns->at);
    columns->count = columns->count - 2 + first.count;
    if (is_plain(m, columns))
        tm_text_free(names);
    const tm_status status = allocate(m, block, columns);
    for (size_t c = 0; c < cells->cells && status == TM_OK && columns->count > 0; c++)
        if (tm_vtk_kept(m, c) == 3)
            set_row(block, row++, columns, c);
    return status;
}

/* A surface's triangles have none. */
static void leave_out_cell_data(tm_vtk_maker *m)
{
    const tm_vtk_data_list *list = &m->cells->cell_data;
    for (size_t i = 0; i < list->arrays; i++)
        if (is_other(m, i))
            list_name(m, &m->report->left_out, &list->array[i], "cell data");
}

static void list_measures(tm_vtk_maker *m)
{
    const tm_vtk_data_list *list = &m->cells->cell_data;
    for (size_t i = 0; i < list->arrays; i++)
        if (list->array[i].measure)
            list_name(m, &m->report->measures, &list->array[i], NULL);
}

tm_status tm_vtk_make_attributes(tm_vtk_maker *m)
{
    column_list *columns = malloc(sizeof *columns);
    if (!columns)
        return tm_fail_memory(m->error);
    tm_status status = make_node_attributes(m, columns);
    if (status == TM_OK && m->volumes > 0)
        status = make_cell_attributes(m, columns);
    else if (status == TM_OK && m->content == TM_CONTENT_SURFACE)
        leave_out_cell_data(m);
    list_measures(m);
    free(columns);
    return status;
}
