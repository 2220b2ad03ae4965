/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_cells.h"

#include "../../base/ids.h"
#include "vtu_xml.h"

#include "../../element/shape.h"

#include <limits.h>
#include <string.h>

enum { COORDINATES = 3 };

typedef struct reader {
    tm_vtu_file file;
    tm_vtk_mesh cells;
    const tm_vtk_read_options *options;
    tm_error *error;
    size_t piece;
    size_t points, cells_of_piece; /* of the piece, as it says */
    size_t first_point, first_cell;
} reader;

/* The arrays of Cells. Those of polyhedra are of one of two layouts, or of none: the
 * older one is a list, how many faces, and of each how many nodes and which, and where
 * that of a cell ends; the other one (VTK 9.4) two levels of lists with their ends. */
typedef struct cell_arrays {
    tm_numbers types, connectivity, offsets;
    tm_numbers faces, face_offsets; /* face_offsets: [cells], or [faces] of the newer */
    tm_numbers polyhedra, polyhedron_offsets;
} cell_arrays;

static tm_status read_numbers(reader *r, const tm_vtu_entry *entry, size_t count,
                              tm_numbers *numbers)
{
    return tm_vtu_numbers(&r->file, entry, count, r->options->threads, numbers, r->error);
}

/* The array of Cells of that name; `count` SIZE_MAX: as many as the last one of `ends`
 * says, of which those that are negative say nothing. */
static tm_status read_cell_array(reader *r, const char *name, size_t count,
                                 const tm_numbers *ends, tm_numbers *numbers)
{
    const tm_vtu_entry *entry = tm_vtu_find(&r->file, r->piece, TM_VTU_CELLS, name);
    if (count == 0)
        return TM_OK;
    if (count == SIZE_MAX) {
        int64_t end = 0;
        for (size_t i = ends->count; i-- > 0 && end <= 0;)
            if (!tm_numbers_whole(ends, i, -1, INT64_MAX, &end))
                end = 0;
        count = end > 0 ? (size_t)end : 0;
    }
    if (!entry && count > 0)
        return tm_fail_at(r->error, TM_ERROR_INPUT, r->file.name, 0, NULL,
                          "piece %zu has no array '%s' in Cells", r->piece, name);
    return count > 0 ? read_numbers(r, entry, count, numbers) : TM_OK;
}

static bool has(const reader *r, const char *name)
{
    return tm_vtu_find(&r->file, r->piece, TM_VTU_CELLS, name) != NULL;
}

static tm_status read_faces(reader *r, cell_arrays *a)
{
    const size_t cells = r->cells_of_piece;
    tm_status status = TM_OK;
    if (has(r, "polyhedron_offsets")) {
        status =
            read_cell_array(r, "polyhedron_offsets", cells, NULL, &a->polyhedron_offsets);
        if (status == TM_OK)
            status = read_cell_array(r, "polyhedron_to_faces", SIZE_MAX,
                                     &a->polyhedron_offsets, &a->polyhedra);
        /* a face may be of two cells: there are at most as many as of cells */
        const tm_vtu_entry *entry =
            tm_vtu_find(&r->file, r->piece, TM_VTU_CELLS, "face_offsets");
        if (status == TM_OK && entry)
            status = tm_vtu_all(&r->file, entry, a->polyhedra.count, &a->face_offsets,
                                r->error);
        if (status == TM_OK)
            status = read_cell_array(r, "face_connectivity", SIZE_MAX, &a->face_offsets,
                                     &a->faces);
    } else if (has(r, "faceoffsets")) {
        status = read_cell_array(r, "faceoffsets", cells, NULL, &a->face_offsets);
        if (status == TM_OK)
            status = read_cell_array(r, "faces", SIZE_MAX, &a->face_offsets, &a->faces);
    }
    return status;
}

static tm_status read_cell_arrays(reader *r, cell_arrays *a)
{
    const size_t cells = r->cells_of_piece;
    tm_status status = read_cell_array(r, "types", cells, NULL, &a->types);
    if (status == TM_OK)
        status = read_cell_array(r, "offsets", cells, NULL, &a->offsets);
    if (status == TM_OK)
        status =
            read_cell_array(r, "connectivity", SIZE_MAX, &a->offsets, &a->connectivity);
    return status == TM_OK ? read_faces(r, a) : status;
}

/* Cells ------------------------------------------------------------------------------ */

static tm_status fail_cell(reader *r, const char *what)
{
    return tm_fail_at(r->error, TM_ERROR_INPUT, r->file.name, 0, NULL, "cell %zu: %s",
                      r->cells.cells - r->cells.first_cell, what);
}

/* The end of list i, not before where the one before it ends. */
static tm_status take_end(reader *r, const tm_numbers *ends, size_t i, size_t begin,
                          size_t most, size_t *end, const char *what)
{
    int64_t value = 0;
    if (i >= ends->count ||
        !tm_numbers_whole(ends, i, (int64_t)begin, (int64_t)most, &value))
        return fail_cell(r, what);
    *end = (size_t)value;
    return TM_OK;
}

/* The faces of a cell, in the older layout, faces[*at …]. */
static tm_status add_listed_faces(reader *r, const cell_arrays *a, size_t c, size_t *at)
{
    static const char wrong[] = "its faces are not as 'faceoffsets' and 'faces' say";
    int64_t end = 0, faces = 0, nodes = 0;
    size_t i = *at;
    if (c >= a->face_offsets.count ||
        !tm_numbers_whole(&a->face_offsets, c, -1, (int64_t)a->faces.count, &end))
        return fail_cell(r, wrong);
    if (end <= (int64_t)*at)
        return TM_OK;
    if (!tm_numbers_whole(&a->faces, i++, 0, end, &faces))
        return fail_cell(r, wrong);
    for (int64_t f = 0; f < faces; f++) {
        if ((int64_t)i >= end ||
            !tm_numbers_whole(&a->faces, i, 0, end - (int64_t)i - 1, &nodes))
            return fail_cell(r, wrong);
        const tm_status status = tm_vtk_add_face(&r->cells, &a->faces, i + 1,
                                                 (size_t)nodes, r->first_point, r->error);
        if (status != TM_OK)
            return status;
        i += 1 + (size_t)nodes;
    }
    *at = (size_t)end;
    return i == *at ? TM_OK : fail_cell(r, wrong);
}

/* The same in the newer layout. */
static tm_status add_numbered_faces(reader *r, const cell_arrays *a, size_t c, size_t *at)
{
    static const char wrong[] = "its faces are not as 'polyhedron_offsets' and what "
                                "belongs to it say";
    size_t end = 0;
    tm_status status =
        take_end(r, &a->polyhedron_offsets, c, *at, a->polyhedra.count, &end, wrong);
    for (; status == TM_OK && *at < end; ++*at) {
        size_t begin = 0, past = 0, face = 0;
        status = take_end(r, &a->polyhedra, *at, 0, SIZE_MAX >> 1, &face, wrong);
        if (status == TM_OK && face > 0)
            status =
                take_end(r, &a->face_offsets, face - 1, 0, a->faces.count, &begin, wrong);
        if (status == TM_OK)
            status =
                take_end(r, &a->face_offsets, face, begin, a->faces.count, &past, wrong);
        if (status == TM_OK)
            status = tm_vtk_add_face(&r->cells, &a->faces, begin, past - begin,
                                     r->first_point, r->error);
    }
    return status;
}

static tm_status add_faces(reader *r, const cell_arrays *a, size_t c, size_t *at)
{
    if (a->polyhedron_offsets.count > 0)
        return add_numbered_faces(r, a, c, at);
    return a->face_offsets.count > 0 ? add_listed_faces(r, a, c, at) : TM_OK;
}

static tm_status add_cells(reader *r, const cell_arrays *a)
{
    size_t begin = 0, face = 0;
    tm_status status = TM_OK;
    for (size_t c = 0; c < r->cells_of_piece && status == TM_OK; c++) {
        size_t end = begin;
        int64_t type = 0;
        status = take_end(r, &a->offsets, c, begin, a->connectivity.count, &end,
                          "its end in 'offsets' is out of range");
        if (status == TM_OK && !tm_numbers_whole(&a->types, c, 0, UINT8_MAX, &type))
            status = fail_cell(r, "its type is no number of VTK's");
        for (size_t i = begin; i < end && status == TM_OK; i++)
            status =
                tm_vtk_add_node(&r->cells, &a->connectivity, i, r->first_point, r->error);
        if (status == TM_OK)
            status = add_faces(r, a, c, &face);
        if (status == TM_OK)
            status = tm_vtk_end_cell(&r->cells, (uint8_t)type, r->error);
        begin = end;
    }
    return status;
}

static tm_status read_cells(reader *r)
{
    cell_arrays a = {0};
    tm_status status = read_cell_arrays(r, &a);
    if (status == TM_OK)
        status = add_cells(r, &a);
    tm_numbers_free(&a.types);
    tm_numbers_free(&a.connectivity);
    tm_numbers_free(&a.offsets);
    tm_numbers_free(&a.faces);
    tm_numbers_free(&a.face_offsets);
    tm_numbers_free(&a.polyhedra);
    tm_numbers_free(&a.polyhedron_offsets);
    return status;
}

/* Points and data ---------------------------------------------------------------------
 */

static tm_status read_points(reader *r)
{
    const tm_vtu_entry *entry = tm_vtu_find(&r->file, r->piece, TM_VTU_POINTS, NULL);
    tm_numbers xyz = {0};
    if (r->points == 0)
        return TM_OK;
    if (!entry)
        return tm_fail_at(r->error, TM_ERROR_INPUT, r->file.name, 0, NULL,
                          "piece %zu has no Points", r->piece);
    if (entry->components != COORDINATES)
        return tm_vtu_fail(&r->file, entry, r->error,
                           "has %zu components (points have 3)", entry->components);
    if (r->points >= TM_IDS)
        return tm_fail_at(r->error, TM_ERROR_INPUT, r->file.name, 0, NULL,
                          "piece %zu: more points than 32 bits can number", r->piece);
    tm_status status = read_numbers(r, entry, COORDINATES * r->points, &xyz);
    if (status == TM_OK)
        status = tm_vtk_add_points(&r->cells, &xyz, r->error);
    tm_numbers_free(&xyz);
    return status;
}

/* The arrays of the first piece that has any points or cells are those of the file. */
static tm_status add_names(reader *r, tm_vtu_section section, tm_vtk_data_list *list)
{
    const tm_vtu_file *file = &r->file;
    for (size_t i = tm_vtu_first(file, r->piece);
         i < file->entries && file->entry[i].piece == r->piece; i++) {
        const tm_vtu_entry *entry = &file->entry[i];
        if (entry->section != section)
            continue;
        if (list->arrays == TM_ATTRIBUTES_MAX)
            return tm_vtu_fail(file, entry, r->error, "there are more than %d arrays",
                               TM_ATTRIBUTES_MAX);
        tm_vtk_data *data =
            tm_vtk_data_named(&r->cells, list, tm_vtu_name(file, entry), true);
        if (!data)
            return tm_fail_memory(r->error);
        data->components = entry->components;
        data->strings = entry->strings;
    }
    return TM_OK;
}

static tm_status read_data(reader *r, tm_vtu_section section, tm_vtk_data_list *list,
                           size_t done, size_t count)
{
    tm_status status = done == 0 ? add_names(r, section, list) : TM_OK;
    tm_vtk_find_measures(&r->cells, r->options);
    for (size_t i = 0; i < list->arrays && status == TM_OK && count > 0; i++) {
        tm_vtk_data *data = &list->array[i];
        tm_numbers numbers = {0};
        const tm_vtu_entry *entry =
            tm_vtu_find(&r->file, r->piece, section, r->cells.names.byte + data->name);
        data->lacks |= !entry || entry->strings ||
                       entry->components != data->components || data->components == 0;
        if (data->lacks || data->measure)
            continue;
        if (data->components > SIZE_MAX / 8 / count)
            return tm_vtu_fail(&r->file, entry, r->error,
                               "has more numbers than memory can hold");
        status = read_numbers(r, entry, data->components * count, &numbers);
        if (status == TM_OK)
            status = tm_vtk_add_values(data, done, &numbers, r->error);
        tm_numbers_free(&numbers);
    }
    return status;
}

/* Appends the bytes of a string, which are numbers: as char, signed or not, has them. */
static tm_status take_string(reader *r, const tm_vtu_entry *entry,
                             const tm_numbers *bytes, tm_text *text)
{
    for (size_t b = 0; b < bytes->count; b++) {
        int64_t value;
        if (!tm_numbers_whole(bytes, b, SCHAR_MIN, UCHAR_MAX, &value))
            return tm_vtu_fail(&r->file, entry, r->error,
                               "number %zu of a string is %.17g (0…255 would be right)",
                               b, tm_numbers_real(bytes, b));
        const char byte = (char)(unsigned char)value;
        tm_text_append(text, &byte, 1);
    }
    return TM_OK;
}

/* The names of groups, see vtk.h. */
static tm_status read_groups(reader *r)
{
    const tm_vtu_file *file = &r->file;
    tm_text *groups = &r->cells.groups;
    for (size_t i = 0; i < file->entries; i++) {
        const tm_vtu_entry *entry = &file->entry[i];
        tm_numbers bytes;
        if (!entry->strings || entry->section != TM_VTU_FIELD_DATA ||
            strcmp(tm_vtu_name(file, entry), "group_names") != 0 || groups->size > 0)
            continue;
        tm_status status =
            tm_vtu_all(file, entry, (size_t)(file->end - file->bytes), &bytes, r->error);
        if (status == TM_OK)
            status = take_string(r, entry, &bytes, groups);
        tm_numbers_free(&bytes);
        if (status != TM_OK)
            return status;
        tm_text_append(groups, "", 1);
    }
    return groups->failed ? tm_fail_memory(r->error) : TM_OK;
}

/* ------------------------------------------------------------------------------------ */

static tm_status read_piece(reader *r)
{
    tm_vtk_mesh *cells = &r->cells;
    r->points = r->file.piece[r->piece].points;
    r->cells_of_piece = r->file.piece[r->piece].cells;
    r->first_point = cells->points;
    r->first_cell = cells->cells;
    tm_status status = tm_vtk_begin_piece(cells, r->error);
    if (status == TM_OK)
        status = read_points(r);
    if (status == TM_OK)
        status = read_cells(r);
    if (status == TM_OK)
        status = read_data(r, TM_VTU_POINT_DATA, &cells->point_data, r->first_point,
                           r->points);
    if (status == TM_OK)
        status = read_data(r, TM_VTU_CELL_DATA, &cells->cell_data, r->first_cell,
                           r->cells_of_piece);
    return status;
}

/* The file's elements, which are known. */
static tm_status read_pieces(reader *r)
{
    if (r->file.pieces == 0)
        return tm_fail_at(r->error, TM_ERROR_INPUT, r->file.name, 0, NULL,
                          "has no element Piece");
    r->cells.name = r->file.name;
    r->cells.first_point = r->cells.points;
    r->cells.first_cell = r->cells.cells;
    tm_status status = read_groups(r);
    for (r->piece = 0; r->piece < r->file.pieces && status == TM_OK; r->piece++)
        status = read_piece(r);
    return status;
}

/* The file of a piece in a list. */
static tm_status read_source(reader *r, const char *source)
{
    tm_text name = {0}, bytes = {0};
    tm_status status =
        r->options->load(r->options->context, source, &name, &bytes, r->error);
    if (status == TM_OK && name.failed)
        status = tm_fail_memory(r->error);
    if (status == TM_OK)
        status = tm_vtu_file_read(&r->file, bytes.byte, bytes.size, name.byte, r->error);
    if (status == TM_OK && r->file.is_list)
        status = tm_fail_at(r->error, TM_ERROR_INPUT, name.byte, 0, NULL,
                            "is a list of pieces, and so no piece");
    if (status == TM_OK)
        status = read_pieces(r);
    tm_vtu_file_free(&r->file);
    tm_text_free(&name);
    tm_text_free(&bytes);
    return status;
}

static tm_status read_sources(reader *r, const tm_vtu_file *list)
{
    tm_status status = TM_OK;
    if (list->pieces == 0)
        return tm_fail_at(r->error, TM_ERROR_INPUT, list->name, 0, NULL,
                          "has no element Piece");
    for (size_t i = 0; i < list->pieces && status == TM_OK; i++)
        status = read_source(r, list->names.byte + list->piece[i].source);
    return status;
}

/* The files of a list, one after the other. */
static tm_status read_list(reader *r)
{
    tm_vtu_file list = r->file;
    tm_status status;
    r->file = (tm_vtu_file){0};
    if (r->options->load)
        status = read_sources(r, &list);
    else
        status = tm_fail_at(r->error, TM_ERROR_INPUT, list.name, 0, NULL,
                            "is a list of other files");
    r->cells.name = list.name;
    tm_vtu_file_free(&list);
    return status;
}

tm_status tm_vtu_read(tm_stream *stream, const char *bytes, size_t size, const char *name,
                      const tm_vtk_read_options *options, tm_vtk_read_report *report,
                      tm_error *error)
{
    reader r = {.options = options, .error = error};
    *report = (tm_vtk_read_report){0};
    tm_status status = tm_vtk_mesh_new(&r.cells, name, error);
    if (status == TM_OK)
        status = tm_vtu_file_read(&r.file, bytes, size, name, error);
    if (status == TM_OK)
        status = r.file.is_list ? read_list(&r) : read_pieces(&r);
    tm_vtu_file_free(&r.file);
    if (status == TM_OK && r.cells.points == 0)
        status = tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL, "has no points");
    if (status == TM_OK)
        status = tm_vtk_mesh_to_stream(&r.cells, stream, options, report, error);
    tm_vtk_mesh_free(&r.cells);
    return status;
}
