/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_cells.h"

#include "../../base/array.h"
#include "../../base/ids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COORDINATES = 3 };

tm_status tm_vtk_mesh_new(tm_vtk_mesh *cells, const char *name, tm_error *error)
{
    *cells = (tm_vtk_mesh){.name = name};
    const bool done = tm_lists_begin(&cells->nodes) && tm_lists_begin(&cells->faces);
    return done ? TM_OK : tm_fail_memory(error);
}

static void free_list(tm_vtk_data_list *list)
{
    for (size_t i = 0; i < list->arrays; i++)
        free(list->array[i].value);
    free(list->array);
}

void tm_vtk_mesh_free(tm_vtk_mesh *cells)
{
    free(cells->xyz);
    free(cells->piece_start);
    free(cells->type);
    tm_lists_free(&cells->nodes);
    tm_lists_free(&cells->faces);
    free_list(&cells->point_data);
    free_list(&cells->cell_data);
    tm_text_free(&cells->names);
    tm_text_free(&cells->groups);
    *cells = (tm_vtk_mesh){0};
}

void tm_vtk_read_report_free(tm_vtk_read_report *report)
{
    tm_text_free(&report->node_attributes);
    tm_text_free(&report->cell_attributes);
    tm_text_free(&report->left_out);
    tm_text_free(&report->measures);
    tm_text_free(&report->names);
}

/* Points and cells ------------------------------------------------------------------ */

tm_status tm_vtk_begin_piece(tm_vtk_mesh *cells, tm_error *error)
{
    void *room = tm_grow(cells->piece_start, &cells->piece_room, cells->pieces + 1,
                         sizeof *cells->piece_start);
    if (!room)
        return tm_fail_memory(error);
    cells->piece_start = room;
    cells->piece_start[cells->pieces++] = cells->points;
    return TM_OK;
}

tm_status tm_vtk_add_points(tm_vtk_mesh *cells, const tm_numbers *xyz, tm_error *error)
{
    const size_t count = xyz->count / COORDINATES, past = cells->points + count;
    if (past >= TM_IDS)
        return tm_fail_at(error, TM_ERROR_INPUT, cells->name, 0, NULL,
                          "more points than 32 bits can number");
    void *room = tm_grow(cells->xyz, &cells->point_room, past, sizeof *cells->xyz);
    if (!room)
        return tm_fail_memory(error);
    cells->xyz = room;
    double *to = cells->xyz[cells->points];
    for (size_t i = 0; i < COORDINATES * count; i++) {
        to[i] = tm_numbers_real(xyz, i);
        if (!isfinite(to[i]))
            return tm_fail_at(error, TM_ERROR_INPUT, cells->name, 0, NULL,
                              "point %zu: a coordinate is no finite number",
                              cells->points - cells->first_point + i / COORDINATES);
    }
    cells->points = past;
    return TM_OK;
}

/* The point that number i stands for, from `first` on. */
static tm_status take_point(const tm_vtk_mesh *cells, const tm_numbers *numbers, size_t i,
                            size_t first, uint32_t *point, tm_error *error)
{
    int64_t value = 0;
    const int64_t points = (int64_t)(cells->points - first);
    if (!tm_numbers_whole(numbers, i, 0, points - 1, &value))
        return tm_fail_at(error, TM_ERROR_INPUT, cells->name, 0, NULL,
                          "cell %zu: the number of a point is %.17g (there are %zu)",
                          cells->cells - cells->first_cell, tm_numbers_real(numbers, i),
                          (size_t)points);
    *point = (uint32_t)(first + (size_t)value);
    return TM_OK;
}

tm_status tm_vtk_add_node(tm_vtk_mesh *cells, const tm_numbers *numbers, size_t i,
                          size_t first, tm_error *error)
{
    uint32_t *node = tm_lists_room(&cells->nodes, cells->open + 1);
    if (!node)
        return tm_fail_memory(error);
    return take_point(cells, numbers, i, first, &node[cells->open++], error);
}

tm_status tm_vtk_end_cell(tm_vtk_mesh *cells, uint8_t type, tm_error *error)
{
    const size_t c = cells->cells;
    if (c + 1 >= TM_IDS)
        return tm_fail_at(error, TM_ERROR_INPUT, cells->name, 0, NULL,
                          "more cells than 32 bits can number");
    void *types = tm_grow(cells->type, &cells->type_room, c + 1, sizeof *cells->type);
    cells->type = types ? types : cells->type;
    if (!types || !tm_lists_end(&cells->nodes, cells->open) ||
        !tm_lists_end(&cells->faces, cells->open_faces))
        return tm_fail_memory(error);
    cells->type[c] = type;
    cells->open = cells->open_faces = 0;
    cells->cells++;
    return TM_OK;
}

tm_status tm_vtk_add_face(tm_vtk_mesh *cells, const tm_numbers *numbers, size_t i,
                          size_t nodes, size_t first, tm_error *error)
{
    enum { TRIANGLE = 3 };
    if (nodes < TRIANGLE || nodes > numbers->count - i)
        return tm_fail_at(
            error, TM_ERROR_INPUT, cells->name, 0, NULL,
            "cell %zu: a face has %zu nodes (3 or more, as many as there are)",
            cells->cells - cells->first_cell, nodes);
    uint32_t *face = tm_lists_room(&cells->faces, cells->open_faces + 1 + nodes);
    if (!face)
        return tm_fail_memory(error);
    face += cells->open_faces;
    face[0] = (uint32_t)nodes;
    tm_status status = TM_OK;
    for (size_t j = 0; j < nodes && status == TM_OK; j++)
        status = take_point(cells, numbers, i + j, first, &face[1 + j], error);
    cells->open_faces += 1 + nodes;
    return status;
}

/* Data ------------------------------------------------------------------------------ */

tm_vtk_data *tm_vtk_data_named(tm_vtk_mesh *cells, tm_vtk_data_list *list,
                               const char *name, bool is_new)
{
    for (size_t i = 0; i < list->arrays; i++)
        if (strcmp(cells->names.byte + list->array[i].name, name) == 0)
            return &list->array[i];
    if (!is_new)
        return NULL;
    void *room = tm_grow(list->array, &list->room, list->arrays + 1, sizeof *list->array);
    if (!room)
        return NULL;
    list->array = room;
    tm_vtk_data *data = &list->array[list->arrays];
    *data = (tm_vtk_data){.name = cells->names.size};
    tm_text_string(&cells->names, name);
    tm_text_append(&cells->names, "", 1);
    if (cells->names.failed)
        return NULL;
    list->arrays++;
    return data;
}

tm_status tm_vtk_add_values(tm_vtk_data *data, size_t done, const tm_numbers *numbers,
                            tm_error *error)
{
    const size_t before = done * data->components;
    void *room =
        tm_grow(data->value, &data->room, before + numbers->count, sizeof *data->value);
    if (!room)
        return tm_fail_memory(error);
    data->value = room;
    for (size_t i = 0; i < numbers->count; i++)
        data->value[before + i] = tm_numbers_real(numbers, i);
    return TM_OK;
}
