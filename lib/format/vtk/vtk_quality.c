/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_grid.h"

#include "../../base/parallel.h"
#include "../../element/jens.h"
#include "../../element/tet_quality.h"
#include "../../examine/poly/poly_statistics.h"

#include <math.h>

/* Elements that one thread measures at a time. */
enum { CHUNK = 8192 };

typedef struct measuring {
    const tm_vtk_grid *grid;
    double (*measure)(const double (*xyz)[3], const uint32_t *node, size_t k);
    double *value;
} measuring;

static double dihedral_quality(const double (*xyz)[3], const uint32_t *node, size_t k)
{
    (void)k;
    return tm_sine2_to_degrees(
        tm_tet_sine2(xyz[node[0]], xyz[node[1]], xyz[node[2]], xyz[node[3]]));
}

static double jens(const double (*xyz)[3], const uint32_t *node, size_t k)
{
    return tm_jens(k, xyz, node);
}

static void measure_chunk(void *context, size_t chunk)
{
    const measuring *m = context;
    const tm_block *cell = m->grid->cell;
    const double(*xyz)[3] = (const double(*)[3])m->grid->node->real;
    const size_t first = chunk * CHUNK;
    const size_t end = cell->count - first < CHUNK ? cell->count : first + CHUNK;
    for (size_t c = first, k; c < end; c++) {
        const uint32_t *node = tm_row_nodes(cell, c, &k);
        m->value[c] = m->measure(xyz, node, k);
    }
}

static tm_status write_measure(const tm_vtk_grid *grid, const char *name,
                               double (*measure)(const double (*xyz)[3],
                                                 const uint32_t *node, size_t k),
                               tm_vtk_take *take, void *context, tm_error *error)
{
    tm_vtk_column column;
    if (!tm_vtk_column_new(&column, name, tm_vtk_cell_count(grid), false))
        return tm_fail_memory(error);
    measuring m = {grid, measure, column.real};
    tm_parallel(grid->threads, (grid->cell->count + CHUNK - 1) / CHUNK, measure_chunk,
                &m);
    return tm_vtk_finish(grid, &column, 0, TM_OK, take, context);
}

/* The rows of .octant: level x y z and their elements, from one up to another one. An
 * element is of one octant. */
static tm_status write_levels(const tm_vtk_grid *grid, tm_vtk_take *take, void *context,
                              tm_error *error)
{
    const tm_block *octant = tm_stream_find(grid->stream, ".octant");
    enum { LEVEL = 0, BEGIN = 4, END = 5 };
    const size_t integers = tm_block_integers(TM_OCTANT);
    tm_vtk_column column;
    if (!octant)
        return TM_OK;
    if (!tm_vtk_column_new(&column, "level", tm_vtk_cell_count(grid), true))
        return tm_fail_memory(error);
    for (size_t e = 0; e < grid->cell->count; e++)
        column.integer[e] = -1;
    for (size_t o = 0; o < octant->count; o++) {
        const uint32_t *row = octant->integer + integers * o;
        for (size_t e = row[BEGIN]; e < row[END] && column.integer[e] == -1; e++)
            column.integer[e] = (int32_t)row[LEVEL];
    }
    return tm_vtk_finish(grid, &column, -1, TM_OK, take, context);
}

static tm_status write_of_polyhedra(const tm_vtk_grid *grid, tm_vtk_take *take,
                                    void *context, tm_error *error)
{
    const tm_poly_arrays mesh = tm_poly_arrays_of(grid->stream);
    tm_vtk_column volume = {.count = 0}, radius = {.count = 0};
    const size_t cells = tm_vtk_cell_count(grid);
    tm_status status = TM_OK;
    if (!tm_vtk_column_new(&volume, "volume", cells, false) ||
        !tm_vtk_column_new(&radius, "kernel_radius", cells, false))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status =
            tm_poly_measure_each(volume.real, radius.real, &mesh, grid->threads, error);
    for (size_t c = 0; c < mesh.cells && status == TM_OK; c++) {
        if (!isfinite(volume.real[c]) || !isfinite(radius.real[c]))
            volume.real[c] = radius.real[c] = 0; /* coordinates are too large */
    }
    status = tm_vtk_finish(grid, &volume, 0, status, take, context);
    return tm_vtk_finish(grid, &radius, 0, status, take, context);
}

tm_status tm_vtk_quality(const tm_vtk_grid *grid, tm_vtk_take *take, void *context,
                         tm_error *error)
{
    tm_status status = TM_OK;
    if (!grid->options.quality)
        return status;
    switch (grid->content) {
    case TM_CONTENT_TETRAHEDRA:
        return write_measure(grid, "dihedral_quality", dihedral_quality, take, context,
                             error);
    case TM_CONTENT_MIXED:
        status = write_measure(grid, "jens", jens, take, context, error);
        return status == TM_OK ? write_levels(grid, take, context, error) : status;
    case TM_CONTENT_POLYHEDRA:
        return write_of_polyhedra(grid, take, context, error);
    default:
        return TM_OK;
    }
}
