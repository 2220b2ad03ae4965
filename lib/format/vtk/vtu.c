/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_grid.h"

#include "../../base/array.h"
#include "vtu_array.h"

#include <stdlib.h>

typedef struct writer {
    tm_vtk_grid grid;
    tm_vtu_arrays arrays;
    tm_error *error;
} writer;

/* Data of points and cells --------------------------------------------------------- */

static tm_status write_column(void *context, const tm_vtk_column *column)
{
    if (column->real)
        return tm_vtu_write_array(context, column->name, TM_VTU_FLOAT64, 1, column->real,
                                  column->count);
    return tm_vtu_write_array(context, column->name, TM_VTU_INT32, 1, column->integer,
                              column->count);
}

static tm_status write_point_data(writer *w)
{
    return tm_vtk_point_data(&w->grid, write_column, &w->arrays, w->error);
}

static tm_status write_cell_data(writer *w)
{
    const tm_status status =
        tm_vtk_cell_data(&w->grid, write_column, &w->arrays, w->error);
    return status == TM_OK ? tm_vtk_quality(&w->grid, write_column, &w->arrays, w->error)
                           : status;
}

/* Cells ---------------------------------------------------------------------------- */

/* Whole numbers, of 64 bits only where 32 are too few. */
typedef struct integers {
    bool wide;
    void *number;
    size_t count;
} integers;

static bool integers_new(integers *array, size_t count, bool wide)
{
    *array = (integers){wide, tm_new(count, wide ? sizeof(int64_t) : sizeof(int32_t)), 0};
    return array->number != NULL;
}

static void append(integers *array, int64_t value)
{
    if (array->wide)
        ((int64_t *)array->number)[array->count++] = value;
    else
        ((int32_t *)array->number)[array->count++] = (int32_t)value;
}

/* faces and face_offsets of polyhedra only. */
typedef struct cell_arrays {
    integers connectivity, offsets, faces, face_offsets;
    unsigned char *type;
} cell_arrays;

static void end_cell(cell_arrays *a)
{
    append(&a->offsets, (int64_t)a->connectivity.count);
}

static void append_cell(cell_arrays *a, const uint32_t *node, size_t k)
{
    for (size_t i = 0; i < k; i++)
        append(&a->connectivity, node[i]);
    end_cell(a);
}

static void append_points(const tm_vtk_grid *grid, cell_arrays *a)
{
    for (uint32_t v = 0; v < grid->node->count; v++)
        append_cell(a, &v, 1);
}

/* The rows of .face, .ele or .mix. */
static void append_elements(const tm_vtk_grid *grid, cell_arrays *a)
{
    for (size_t c = 0; c < grid->cell->count; c++) {
        size_t k;
        const uint32_t *node = tm_row_nodes(grid->cell, c, &k);
        append_cell(a, node, k);
    }
}

/* The faces of polyhedron c, all outward: how many, then each with its size before it.
 * Its nodes, each once: seen[v] is c + 1 for those that were there. */
static void append_polyhedron(const tm_cell_faces *faces, cell_arrays *a, size_t c,
                              uint32_t *seen)
{
    size_t begin = faces->cell_start[c], end = faces->cell_start[c + 1];
    append(&a->faces, (int64_t)(end - begin));
    for (size_t i = begin; i < end; i++) {
        size_t f = faces->cell_facet[i], k = faces->start[f + 1] - faces->start[f];
        const uint32_t *node = faces->node + faces->start[f];
        bool outward = tm_facet_is_outward(faces, f, c);
        append(&a->faces, (int64_t)k);
        for (size_t j = 0; j < k; j++) {
            uint32_t v = node[outward ? j : k - 1 - j];
            append(&a->faces, v);
            if (seen[v] != c + 1)
                append(&a->connectivity, v);
            seen[v] = (uint32_t)(c + 1);
        }
    }
    append(&a->face_offsets, (int64_t)a->faces.count);
    end_cell(a);
}

static tm_status append_polyhedra(const writer *w, cell_arrays *a)
{
    uint32_t *seen = calloc(w->grid.node->count, sizeof *seen);
    if (!seen)
        return tm_fail_memory(w->error);
    for (size_t c = 0; c < w->grid.faces.cells; c++)
        append_polyhedron(&w->grid.faces, a, c, seen);
    free(seen);
    return TM_OK;
}

/* Beside polyhedra these say that they are none. */
static void append_marked(const tm_vtk_grid *grid, cell_arrays *a)
{
    for (size_t i = 0, k; i < grid->marked; i++) {
        const uint32_t *node = tm_vtk_marked_nodes(grid, i, &k);
        append_cell(a, node, k);
        if (grid->content == TM_CONTENT_POLYHEDRA)
            append(&a->face_offsets, -1);
    }
}

static tm_status append_cells(const writer *w, cell_arrays *a)
{
    const tm_vtk_grid *grid = &w->grid;
    tm_status status = TM_OK;
    if (grid->content == TM_CONTENT_POLYHEDRA)
        status = append_polyhedra(w, a);
    else if (grid->content == TM_CONTENT_POINTS)
        append_points(grid, a);
    else
        append_elements(grid, a);
    if (status != TM_OK)
        return status;
    append_marked(grid, a);
    for (size_t c = 0; c < tm_vtk_cell_count(grid); c++)
        a->type[c] = tm_vtk_type(grid, c);
    return TM_OK;
}

/* How many numbers the connectivity holds at most, and the faces of polyhedra. */
static void count_numbers(const tm_vtk_grid *grid, size_t *connectivity, size_t *faces)
{
    const tm_cell_faces *cf = &grid->faces;
    *faces = 0;
    if (grid->content == TM_CONTENT_POINTS) {
        *connectivity = grid->node->count;
    } else if (grid->content == TM_CONTENT_POLYHEDRA) {
        *faces = cf->cells;
        *connectivity = 0;
        for (size_t i = 0; i < cf->cell_start[cf->cells]; i++) {
            size_t f = cf->cell_facet[i], k = cf->start[f + 1] - cf->start[f];
            *faces += k + 1;
            *connectivity += k;
        }
    } else {
        *connectivity = grid->cell->start
                            ? grid->cell->start[grid->cell->count]
                            : grid->cell->count * tm_block_integers(grid->cell->kind);
    }
    for (size_t i = 0, k; i < grid->marked; i++) {
        tm_vtk_marked_nodes(grid, i, &k);
        *connectivity += k;
    }
}

static tm_status write_integers(writer *w, const char *name, const integers *array)
{
    return tm_vtu_write_array(&w->arrays, name, array->wide ? TM_VTU_INT64 : TM_VTU_INT32,
                              1, array->number, array->count);
}

static tm_status write_cell_arrays(writer *w, const cell_arrays *a)
{
    tm_status status = write_integers(w, "connectivity", &a->connectivity);
    if (status == TM_OK)
        status = write_integers(w, "offsets", &a->offsets);
    if (status == TM_OK)
        status = tm_vtu_write_array(&w->arrays, "types", TM_VTU_UINT8, 1, a->type,
                                    tm_vtk_cell_count(&w->grid));
    if (w->grid.content != TM_CONTENT_POLYHEDRA || status != TM_OK)
        return status;
    status = write_integers(w, "faces", &a->faces);
    return status == TM_OK ? write_integers(w, "faceoffsets", &a->face_offsets) : status;
}

static tm_status write_cells(writer *w)
{
    size_t connectivity, faces, cells = tm_vtk_cell_count(&w->grid);
    count_numbers(&w->grid, &connectivity, &faces);
    bool wide = w->grid.node->count > INT32_MAX || connectivity + faces > INT32_MAX;
    cell_arrays a = {.type = tm_new(cells, sizeof *a.type)};
    bool made = integers_new(&a.connectivity, connectivity, wide);
    made &= integers_new(&a.offsets, cells, wide);
    made &= integers_new(&a.faces, faces, wide);
    made &= integers_new(&a.face_offsets, faces > 0 ? cells : 0, wide);
    tm_status status = made && a.type ? append_cells(w, &a) : tm_fail_memory(w->error);
    if (status == TM_OK)
        status = write_cell_arrays(w, &a);
    free(a.connectivity.number);
    free(a.offsets.number);
    free(a.faces.number);
    free(a.face_offsets.number);
    free(a.type);
    return status;
}

/* ---------------------------------------------------------------------------------- */

static tm_status write_section(writer *w, const char *name, tm_status (*write)(writer *w))
{
    tm_text_format(w->arrays.xml, "      <%s>\n", name);
    tm_status status = write(w);
    tm_text_format(w->arrays.xml, "      </%s>\n", name);
    return status;
}

static tm_status write_points(writer *w)
{
    const tm_block *node = w->grid.node;
    return tm_vtu_write_array(&w->arrays, "Points", TM_VTU_FLOAT64, 3, node->real,
                              3 * node->count);
}

/* Strings are the numbers of their bytes, with 0 behind each. */
static void write_names(const writer *w, tm_text *xml)
{
    const size_t names = tm_vtk_names(&w->grid);
    tm_text name = {0};
    if (names == 0)
        return;
    tm_text_format(xml,
                   "    <FieldData>\n"
                   "      <DataArray type=\"String\" Name=\"group_names\" "
                   "NumberOfTuples=\"%zu\" format=\"ascii\">\n",
                   names);
    for (size_t g = 0; g < names; g++) {
        name.size = 0;
        tm_vtk_name(&w->grid, g, &name);
        for (size_t i = 0; i < name.size; i++)
            tm_text_format(xml, "%d ", (unsigned char)name.byte[i]);
        tm_text_string(xml, "0\n");
    }
    tm_text_string(xml, "      </DataArray>\n    </FieldData>\n");
    xml->failed |= name.failed;
    tm_text_free(&name);
}

static tm_status write_piece(writer *w, tm_text *xml)
{
    const tm_text *data = &w->arrays.data;
    tm_text_string(xml, "<?xml version=\"1.0\"?>\n"
                        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                        "byte_order=\"LittleEndian\" header_type=\"UInt64\" "
                        "compressor=\"vtkZLibDataCompressor\">\n"
                        "  <UnstructuredGrid>\n");
    write_names(w, xml);
    tm_text_format(xml, "    <Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n",
                   w->grid.node->count, tm_vtk_cell_count(&w->grid));
    tm_status status = write_section(w, "PointData", write_point_data);
    if (status == TM_OK)
        status = write_section(w, "CellData", write_cell_data);
    if (status == TM_OK)
        status = write_section(w, "Points", write_points);
    if (status == TM_OK)
        status = write_section(w, "Cells", write_cells);
    tm_text_string(xml, "    </Piece>\n"
                        "  </UnstructuredGrid>\n"
                        "  <AppendedData encoding=\"raw\">\n"
                        "   _");
    tm_text_append(xml, data->byte ? data->byte : "", data->size);
    tm_text_string(xml, "\n  </AppendedData>\n</VTKFile>\n");
    if (status == TM_OK && xml->failed)
        status = tm_fail_memory(w->error);
    return status;
}

tm_status tm_vtu_write(tm_text *text, const tm_stream *stream,
                       const tm_vtk_options *options, unsigned threads, tm_error *error)
{
    writer w = {.arrays = {.threads = threads, .xml = text, .error = error},
                .error = error};
    tm_status status = tm_vtk_grid_find(&w.grid, stream, options, threads, error);
    if (status == TM_OK)
        status = write_piece(&w, text);
    tm_vtk_grid_free(&w.grid);
    tm_text_free(&w.arrays.data);
    return status;
}
