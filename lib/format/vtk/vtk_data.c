/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_grid.h"

#include "../../base/array.h"
#include "../../stream/group.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool tm_vtk_column_new(tm_vtk_column *column, const char *name, size_t count,
                       bool integers)
{
    *column = (tm_vtk_column){.count = count};
    snprintf(column->name, sizeof column->name, "%s", name);
    if (integers)
        column->integer = tm_new(count, sizeof *column->integer);
    else
        column->real = tm_new(count, sizeof *column->real);
    return column->real || column->integer;
}

static tm_status take_and_free(tm_vtk_column *column, tm_status status, tm_vtk_take *take,
                               void *context)
{
    if (status == TM_OK)
        status = take(context, column);
    free(column->real);
    free(column->integer);
    return status;
}

tm_status tm_vtk_finish(const tm_vtk_grid *grid, tm_vtk_column *column, int none,
                        tm_status status, tm_vtk_take *take, void *context)
{
    const size_t first = grid->cell->count;
    for (size_t i = 0; i < grid->marked && status == TM_OK; i++) {
        const uint32_t owner = grid->owner[i];
        if (column->real)
            column->real[first + i] = owner == TM_NONE ? none : column->real[owner];
        else
            column->integer[first + i] = owner == TM_NONE ? none : column->integer[owner];
    }
    return take_and_free(column, status, take, context);
}

/* Attributes and markers ----------------------------------------------------------- */

/* Attribute i of the rows, as the first values of a column of `count`; without a name it
 * has its number. */
static bool new_attribute(tm_vtk_column *column, const tm_block *block, size_t i,
                          const char *name, size_t count)
{
    char number[TM_VTK_NAME];
    snprintf(number, sizeof number, "attribute_%zu", i + 1);
    if (!tm_vtk_column_new(column, name ? name : number, count, false))
        return false;
    for (size_t row = 0; row < block->count; row++)
        column->real[row] = block->attribute[row * block->attributes + i];
    return true;
}

tm_status tm_vtk_point_data(const tm_vtk_grid *grid, tm_vtk_take *take, void *context,
                            tm_error *error)
{
    const tm_block *node = grid->node;
    tm_status status = TM_OK;
    tm_vtk_column column;
    for (size_t i = 0; i < node->attributes && status == TM_OK; i++)
        status = new_attribute(&column, node, i, NULL, node->count)
                     ? take_and_free(&column, TM_OK, take, context)
                     : tm_fail_memory(error);
    if (status != TM_OK || !node->marker)
        return status;
    if (!tm_vtk_column_new(&column, "marker", node->count, true))
        return tm_fail_memory(error);
    memcpy(column.integer, node->marker, node->count * sizeof *column.integer);
    return take_and_free(&column, TM_OK, take, context);
}

/* What is before the region is how many tetrahedra a polyhedron was. */
static tm_status write_attributes(const tm_vtk_grid *grid, tm_vtk_take *take,
                                  void *context, tm_error *error)
{
    const tm_block *cell = grid->cell;
    const size_t region = tm_group_region_attribute(cell);
    tm_status status = TM_OK;
    tm_vtk_column column;
    for (size_t i = 0; i < cell->attributes && status == TM_OK; i++) {
        const char *name = i == region ? "region" : i < region ? "tetrahedra" : NULL;
        status = new_attribute(&column, cell, i, name, tm_vtk_cell_count(grid))
                     ? tm_vtk_finish(grid, &column, 0, TM_OK, take, context)
                     : tm_fail_memory(error);
    }
    return status;
}

/* Where a cell can have one: a triangle of a surface, or a marked one. */
static tm_status write_markers(const tm_vtk_grid *grid, tm_vtk_take *take, void *context,
                               tm_error *error)
{
    const size_t cells = grid->cell->count;
    const int32_t *own = grid->content == TM_CONTENT_SURFACE ? grid->cell->marker : NULL;
    tm_vtk_column column;
    if (!own && grid->marked == 0)
        return TM_OK;
    if (!tm_vtk_column_new(&column, "marker", tm_vtk_cell_count(grid), true))
        return tm_fail_memory(error);
    for (size_t c = 0; c < cells; c++)
        column.integer[c] = own ? own[c] : 0;
    for (size_t i = 0; i < grid->marked; i++)
        column.integer[cells + i] =
            grid->part[tm_vtk_part(grid, i)]->marker[grid->row[i]];
    return take_and_free(&column, TM_OK, take, context);
}

tm_status tm_vtk_cell_data(const tm_vtk_grid *grid, tm_vtk_take *take, void *context,
                           tm_error *error)
{
    tm_status status = TM_OK;
    if (grid->content != TM_CONTENT_POINTS)
        status = write_attributes(grid, take, context, error);
    if (status == TM_OK)
        status = write_markers(grid, take, context, error);
    return status;
}
