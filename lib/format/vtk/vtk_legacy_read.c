/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_legacy_read.h"

#include "../../base/ids.h"

#include "../../element/shape.h"

#include <string.h>

/* Lists of cells: a number of nodes and the nodes of each, or offsets and connectivity.
 */
typedef struct cell_lists {
    tm_numbers offsets; /* none: the older form */
    tm_numbers items;
    size_t count;
} cell_lists;

typedef struct reader {
    tm_vtk_file file;
    tm_vtk_mesh cells;
    bool grid;       /* else polygons */
    bool has_points; /* POINTS was met */
    bool has_more;   /* something was, behind that */
    cell_lists lists;
    bool has_lists, has_types;
    tm_numbers types;
    tm_vtk_data_list *data; /* of the section that is being read; NULL: of none */
    size_t data_count;
} reader;

/* Words ------------------------------------------------------------------------------ */

tm_status tm_vtk_take_count(tm_vtk_file *file, const char *what, size_t *count)
{
    int64_t value = 0;
    const tm_status status =
        tm_scan_integer(&file->scan, what, 0, INT64_MAX, &value, file->error);
    *count = (size_t)value;
    return status;
}

tm_status tm_vtk_take_type(tm_vtk_file *file, tm_vtk_number *type)
{
    /* a vtkIdType is written as an int; a long has 64 bits, as on Unix */
    static const struct {
        const char *word;
        tm_vtk_number type;
    } types[] = {{"bit", {TM_VTK_BITS, TM_UINT8}},
                 {"char", {TM_VTK_NUMBERS, TM_INT8}},
                 {"signed_char", {TM_VTK_NUMBERS, TM_INT8}},
                 {"unsigned_char", {TM_VTK_NUMBERS, TM_UINT8}},
                 {"short", {TM_VTK_NUMBERS, TM_INT16}},
                 {"unsigned_short", {TM_VTK_NUMBERS, TM_UINT16}},
                 {"int", {TM_VTK_NUMBERS, TM_INT32}},
                 {"unsigned_int", {TM_VTK_NUMBERS, TM_UINT32}},
                 {"vtkIdType", {TM_VTK_NUMBERS, TM_INT32}},
                 {"long", {TM_VTK_NUMBERS, TM_INT64}},
                 {"unsigned_long", {TM_VTK_NUMBERS, TM_UINT64}},
                 {"vtktypeint64", {TM_VTK_NUMBERS, TM_INT64}},
                 {"vtktypeuint64", {TM_VTK_NUMBERS, TM_UINT64}},
                 {"float", {TM_VTK_NUMBERS, TM_FLOAT32}},
                 {"double", {TM_VTK_NUMBERS, TM_FLOAT64}},
                 {"string", {TM_VTK_STRINGS, TM_UINT8}}};
    const tm_word word = tm_scan_word(&file->scan);
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (tm_word_is_like(word, types[i].word)) {
            *type = types[i].type;
            return TM_OK;
        }
    return tm_scan_fail(&file->scan, file->error,
                        "'%.*s' is no type of numbers (such as int, float or double)",
                        tm_word_shown(word), word.begin);
}

void tm_vtk_skip_metadata(tm_vtk_file *file)
{
    do {
        tm_scan_rest(&file->scan);
        tm_scan_end_line(&file->scan);
    } while (tm_scan_more(&file->scan));
}

static tm_status take_bits(tm_vtk_file *file, size_t count, tm_numbers *numbers)
{
    enum { BITS = 8 };
    tm_scan *scan = &file->scan;
    const size_t size = count / BITS + (count % BITS != 0);
    if (size > (size_t)(scan->end - scan->at))
        return tm_scan_fail(scan, file->error, "the file ends in an array of bits");
    scan->at += size;
    return tm_numbers_of_bits(numbers, scan->at - size, count, file->error);
}

tm_status tm_vtk_take_numbers(tm_vtk_file *file, const tm_vtk_number *type, size_t count,
                              const char *what, tm_numbers *numbers)
{
    tm_scan *scan = &file->scan;
    const size_t size = tm_number_size(type->number);
    if (!file->binary)
        return tm_numbers_scan(numbers, scan, type->number, count, what, file->error);
    tm_scan_end_line(scan);
    if (type->kind == TM_VTK_BITS)
        return take_bits(file, count, numbers);
    if (count > (size_t)(scan->end - scan->at) / size)
        return tm_scan_fail(scan, file->error, "the file ends in an array of %zu numbers",
                            count);
    *numbers = (tm_numbers){
        .bytes = scan->at, .count = count, .type = type->number, .big = true};
    scan->at += count * size;
    return TM_OK;
}

/* Sections --------------------------------------------------------------------------- */

static tm_status fail(reader *r, const char *what)
{
    return tm_scan_fail(&r->file.scan, r->file.error, "%s", what);
}

static tm_status take_points(reader *r)
{
    enum { COORDINATES = 3 };
    size_t count = 0;
    tm_vtk_number type = {TM_VTK_NUMBERS, TM_FLOAT32};
    tm_numbers xyz = {0};
    if (r->has_points)
        return fail(r, "a second section POINTS");
    tm_status status = tm_vtk_take_count(&r->file, "the number of points", &count);
    if (status == TM_OK)
        status = tm_vtk_take_type(&r->file, &type);
    if (status == TM_OK && (type.kind != TM_VTK_NUMBERS || count >= TM_IDS))
        status = fail(r, "no points that can be read (numbers, fewer than 2^32)");
    if (status == TM_OK)
        status = tm_vtk_take_numbers(&r->file, &type, COORDINATES * count, "a coordinate",
                                     &xyz);
    if (status == TM_OK)
        status = tm_vtk_add_points(&r->cells, &xyz, r->file.error);
    tm_numbers_free(&xyz);
    r->has_points = true;
    return status;
}

static void lists_free(cell_lists *lists)
{
    tm_numbers_free(&lists->offsets);
    tm_numbers_free(&lists->items);
    *lists = (cell_lists){0};
}

/* "OFFSETS type" or "CONNECTIVITY type", and the numbers. */
static tm_status take_named(reader *r, const char *name, size_t count,
                            tm_numbers *numbers)
{
    tm_vtk_number type = {TM_VTK_NUMBERS, TM_INT64};
    tm_scan *scan = &r->file.scan;
    tm_scan_seek(scan);
    if (!tm_word_is_like(tm_scan_word(scan), name))
        return tm_scan_fail(scan, r->file.error, "%s should be here", name);
    const tm_status status = tm_vtk_take_type(&r->file, &type);
    if (status == TM_OK && type.kind != TM_VTK_NUMBERS)
        return fail(r, "these are no whole numbers");
    return status == TM_OK ? tm_vtk_take_numbers(&r->file, &type, count,
                                                 "a number of a cell", numbers)
                           : status;
}

/* "CELLS n size", and the numbers of either form. */
static tm_status take_lists(reader *r, cell_lists *lists)
{
    static const tm_vtk_number integers = {TM_VTK_NUMBERS, TM_INT32};
    size_t size = 0;
    tm_scan ahead;
    tm_status status = tm_vtk_take_count(&r->file, "the number of cells", &lists->count);
    if (status == TM_OK)
        status = tm_vtk_take_count(&r->file, "the number of numbers", &size);
    if (status != TM_OK)
        return status;
    ahead = r->file.scan;
    tm_scan_end_line(&ahead);
    if (!tm_scan_more(&ahead) || !tm_word_is_like(tm_scan_word(&ahead), "OFFSETS"))
        return tm_vtk_take_numbers(&r->file, &integers, size, "a number of a cell",
                                   &lists->items);
    tm_scan_end_line(&r->file.scan);
    status = take_named(r, "OFFSETS", lists->count, &lists->offsets);
    if (status == TM_OK)
        status = take_named(r, "CONNECTIVITY", size, &lists->items);
    lists->count -= lists->count > 0;
    return status;
}

static tm_status take_cell_types(reader *r)
{
    static const tm_vtk_number integers = {TM_VTK_NUMBERS, TM_INT32};
    size_t count = 0;
    if (r->has_types)
        return fail(r, "a second section CELL_TYPES");
    r->has_types = true;
    const tm_status status = tm_vtk_take_count(&r->file, "the number of types", &count);
    return status == TM_OK ? tm_vtk_take_numbers(&r->file, &integers, count,
                                                 "a type of a cell", &r->types)
                           : status;
}

/* Cells ------------------------------------------------------------------------------ */

/* Where the nodes of cell c are in items, if *at is the end of those before it. */
static tm_status take_range(reader *r, const cell_lists *lists, size_t c, size_t *at,
                            size_t *end)
{
    int64_t first = 0, past = 0;
    const int64_t items = (int64_t)lists->items.count;
    if (lists->offsets.count > 0) {
        if (!tm_numbers_whole(&lists->offsets, c, 0, items, &first) ||
            !tm_numbers_whole(&lists->offsets, c + 1, first, items, &past))
            return tm_fail_at(r->file.error, TM_ERROR_INPUT, r->cells.name, 0, NULL,
                              "cell %zu: its OFFSETS are out of range", c);
        *at = (size_t)first;
        *end = (size_t)past;
        return TM_OK;
    }
    if (!tm_numbers_whole(&lists->items, *at, 0, items - (int64_t)*at - 1, &past))
        return tm_fail_at(r->file.error, TM_ERROR_INPUT, r->cells.name, 0, NULL,
                          "cell %zu: its number of nodes is out of range", c);
    ++*at;
    *end = *at + (size_t)past;
    return TM_OK;
}

/* A polyhedron: how many faces, then of each how many nodes, and which. */
static tm_status add_faces(reader *r, const tm_numbers *items, size_t at, size_t end)
{
    int64_t faces = 0, nodes = 0;
    tm_status status = TM_OK;
    bool right = at < end && tm_numbers_whole(items, at++, 0, INT32_MAX, &faces);
    for (int64_t f = 0; f < faces && right && status == TM_OK; f++) {
        right =
            at < end && tm_numbers_whole(items, at, 0, (int64_t)(end - at) - 1, &nodes);
        if (right)
            status = tm_vtk_add_face(&r->cells, items, at + 1, (size_t)nodes, 0,
                                     r->file.error);
        at += 1 + (size_t)nodes;
    }
    if (status == TM_OK && (!right || at != end))
        status = tm_fail_at(r->file.error, TM_ERROR_INPUT, r->cells.name, 0, NULL,
                            "cell %zu: its faces are not as many as it has numbers",
                            r->cells.cells);
    return status;
}

/* The type of cell c of a grid, or by its number of nodes k. */
static tm_status type_of(reader *r, size_t c, size_t k, const uint8_t by_nodes[],
                         int64_t *type)
{
    enum { MOST = 5 };
    *type = by_nodes ? by_nodes[k < MOST ? k : MOST] : 0;
    if (by_nodes || tm_numbers_whole(&r->types, c, 0, UINT8_MAX, type))
        return TM_OK;
    return tm_fail_at(r->file.error, TM_ERROR_INPUT, r->cells.name, 0, NULL,
                      "cell %zu: its type is no number of VTK's", c);
}

static tm_status add_cells(reader *r, const cell_lists *lists, const uint8_t by_nodes[])
{
    size_t at = 0, end = 0;
    tm_status status = TM_OK;
    for (size_t c = 0; c < lists->count && status == TM_OK; c++, at = end) {
        int64_t type = 0;
        if (at > lists->items.count)
            return fail(r, "there are fewer cells than it says");
        if (at == lists->items.count && lists->offsets.count == 0)
            return tm_fail_at(r->file.error, TM_ERROR_INPUT, r->cells.name, 0, NULL,
                              "there are only %zu of %zu cells", c, lists->count);
        status = take_range(r, lists, c, &at, &end);
        if (status == TM_OK)
            status = type_of(r, c, end - at, by_nodes, &type);
        if (status == TM_OK && type == TM_VTK_POLYHEDRON)
            status = add_faces(r, &lists->items, at, end);
        for (; at < end && status == TM_OK && type != TM_VTK_POLYHEDRON; at++)
            status = tm_vtk_add_node(&r->cells, &lists->items, at, 0, r->file.error);
        if (status == TM_OK)
            status = tm_vtk_end_cell(&r->cells, (uint8_t)type, r->file.error);
    }
    if (status == TM_OK && lists->offsets.count == 0 && end != lists->items.count)
        status =
            tm_fail_at(r->file.error, TM_ERROR_INPUT, r->cells.name, 0, NULL,
                       "there are more numbers than those of %zu cells", lists->count);
    return status;
}

/* Those of a grid, once their types are known. */
static tm_status add_grid(reader *r)
{
    if (!r->has_lists || !r->has_types || r->cells.cells > 0)
        return TM_OK;
    if (r->types.count != r->lists.count)
        return tm_fail_at(r->file.error, TM_ERROR_INPUT, r->cells.name, 0, NULL,
                          "there are %zu types of %zu cells", r->types.count,
                          r->lists.count);
    return add_cells(r, &r->lists, NULL);
}

/* Cells of a file of polygons; *known as tm_vtk_take_data(). */
static tm_status take_polygons(reader *r, tm_word word, bool *known)
{
    static const struct {
        const char *word;
        uint8_t type[6]; /* by the number of nodes; the last: of more */
    } sections[] = {{"VERTICES", {0, TM_VTK_VERTEX, 2, 2, 2, 2}},
                    {"LINES", {0, 0, TM_VTK_LINE, 4, 4, 4}},
                    {"POLYGONS", {0, 0, 0, TM_VTK_TRIANGLE, TM_VTK_QUADRILATERAL, 7}},
                    {"TRIANGLE_STRIPS", {0, 0, 0, 6, 6, 6}}};
    *known = false;
    for (size_t s = 0; s < sizeof sections / sizeof *sections && !r->grid; s++) {
        if (!tm_word_is_like(word, sections[s].word))
            continue;
        cell_lists lists = {0};
        *known = true;
        tm_status status = take_lists(r, &lists);
        if (status == TM_OK)
            status = add_cells(r, &lists, sections[s].type);
        lists_free(&lists);
        return status;
    }
    return TM_OK;
}

/* ------------------------------------------------------------------------------------ */

static tm_status take_head(reader *r)
{
    static const char begin[] = "# vtk DataFile Version";
    tm_scan *scan = &r->file.scan;
    const tm_word first = tm_scan_rest(scan);
    if (first.size < sizeof begin - 1 ||
        memcmp(first.begin, begin, sizeof begin - 1) != 0)
        return fail(r, "is no legacy file of VTK (its first line is '# vtk DataFile "
                       "Version …')");
    tm_scan_end_line(scan);
    tm_scan_end_line(scan); /* the title */
    tm_scan_seek(scan);
    const tm_word form = tm_scan_word(scan);
    r->file.binary = tm_word_is_like(form, "BINARY");
    if (!r->file.binary && !tm_word_is_like(form, "ASCII"))
        return fail(r, "the third line is neither ASCII nor BINARY");
    return TM_OK;
}

static tm_status take_dataset(reader *r)
{
    tm_scan *scan = &r->file.scan;
    const tm_word type = tm_scan_word(scan);
    r->grid = tm_word_is_like(type, "UNSTRUCTURED_GRID");
    if (r->grid || tm_word_is_like(type, "POLYDATA"))
        return TM_OK;
    return tm_scan_fail(scan, r->file.error,
                        "holds '%.*s' (UNSTRUCTURED_GRID or POLYDATA would be right)",
                        tm_word_shown(type), type.begin);
}

/* "POINT_DATA n" or "CELL_DATA n". */
static tm_status begin_data(reader *r, bool points)
{
    const size_t right = points ? r->cells.points : r->cells.cells;
    const tm_status status = tm_vtk_take_count(&r->file, "the count", &r->data_count);
    if (status != TM_OK)
        return status;
    r->data = points ? &r->cells.point_data : &r->cells.cell_data;
    if (r->data_count == right)
        return TM_OK;
    return tm_scan_fail(&r->file.scan, r->file.error,
                        "there are data of %zu %s (there are %zu)", r->data_count,
                        points ? "points" : "cells", right);
}

static tm_status take_section(reader *r, tm_word word)
{
    bool known = true;
    tm_status status = TM_OK;
    r->has_more = r->has_points;
    if (tm_word_is_like(word, "DATASET"))
        return take_dataset(r);
    if (tm_word_is_like(word, "POINTS"))
        return take_points(r);
    if (tm_word_is_like(word, "METADATA")) {
        tm_vtk_skip_metadata(&r->file);
        return TM_OK;
    }
    if (tm_word_is_like(word, "CELLS") && r->grid && !r->has_lists) {
        r->has_lists = true;
        status = take_lists(r, &r->lists);
        return status == TM_OK ? add_grid(r) : status;
    }
    if (tm_word_is_like(word, "CELL_TYPES") && r->grid) {
        status = take_cell_types(r);
        return status == TM_OK ? add_grid(r) : status;
    }
    if (tm_word_is_like(word, "POINT_DATA") || tm_word_is_like(word, "CELL_DATA"))
        return begin_data(r, tm_word_is_like(word, "POINT_DATA"));
    status = take_polygons(r, word, &known);
    if (!known)
        status = tm_vtk_take_data(&r->file, word, r->data, r->data_count, &known);
    if (status == TM_OK && !known)
        status = tm_scan_fail(&r->file.scan, r->file.error,
                              "'%.*s' is no section of such a file", tm_word_shown(word),
                              word.begin);
    return status;
}

static tm_status read_all(reader *r)
{
    tm_status status = take_head(r);
    while (status == TM_OK && tm_scan_seek(&r->file.scan))
        status = take_section(r, tm_scan_word(&r->file.scan));
    if (status == TM_OK && (!r->has_points || r->cells.points == 0))
        status = fail(r, "the file has no POINTS");
    if (status == TM_OK && !r->has_more)
        status = fail(r, "the file ends behind its POINTS");
    if (status == TM_OK && r->has_lists != r->has_types)
        status = fail(r, r->has_lists ? "the file has no CELL_TYPES"
                                      : "the file has no CELLS");
    return status;
}

tm_status tm_vtk_read(tm_stream *stream, const char *bytes, size_t size, const char *name,
                      const tm_vtk_read_options *options, tm_vtk_read_report *report,
                      tm_error *error)
{
    reader r = {.file = {.error = error}};
    *report = (tm_vtk_read_report){0};
    r.file.cells = &r.cells;
    tm_scan_begin(&r.file.scan, bytes, size, name, '\0');
    tm_status status = tm_vtk_mesh_new(&r.cells, name, error);
    if (status == TM_OK)
        status = read_all(&r);
    lists_free(&r.lists);
    tm_numbers_free(&r.types);
    if (status == TM_OK)
        status = tm_vtk_mesh_to_stream(&r.cells, stream, options, report, error);
    tm_vtk_mesh_free(&r.cells);
    return status;
}
