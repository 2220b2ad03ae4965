/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "openfoam_zones.h"

#include "../../base/array.h"
#include "../../base/ids.h"
#include "../../mesh/elements_of_cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COORDINATES = 3, TRIANGLE = 3, TETRAHEDRON = 4 };

typedef struct reader {
    const tm_openfoam_file *file;
    tm_stream *stream;
    tm_error *error;
    size_t points, faces, inside, cells;
} reader;

tm_status tm_openfoam_begin(tm_foam *foam, const tm_openfoam_file *file, tm_error *error)
{
    const char *bytes = file->bytes.byte ? file->bytes.byte : "";
    return tm_foam_begin(foam, bytes, file->bytes.size, file->path, error);
}

/* Points ---------------------------------------------------------------------------- */

static tm_status read_points(reader *r)
{
    tm_foam foam;
    tm_numbers xyz = {0};
    tm_block *node = tm_stream_add(r->stream, ".node");
    if (!node)
        return tm_fail_memory(r->error);
    tm_status status = tm_openfoam_begin(&foam, &r->file[TM_FOAM_POINTS], r->error);
    if (status == TM_OK)
        status = tm_foam_points(&foam, &xyz, r->error);
    if (status == TM_OK)
        status = tm_foam_end(&foam, r->error);
    r->points = xyz.count / COORDINATES;
    if (status == TM_OK)
        status = tm_block_allocate(node, r->points, 0, r->error);
    for (size_t i = 0; i < xyz.count && status == TM_OK; i++) {
        node->real[i] = tm_numbers_real(&xyz, i);
        if (!isfinite(node->real[i]))
            status = tm_fail_at(r->error, TM_ERROR_INPUT, foam.scan.name, 0, NULL,
                                "point %zu: a coordinate is no finite number",
                                i / COORDINATES);
    }
    tm_numbers_free(&xyz);
    return status;
}

/* Faces ----------------------------------------------------------------------------- */

/* Appends a face of the labels first … first + k - 1. */
static tm_status add_face(reader *r, tm_lists *faces, const tm_numbers *labels,
                          size_t first, size_t k)
{
    const char *path = r->file[TM_FOAM_FACES].path;
    if (k < TRIANGLE)
        return tm_fail_at(r->error, TM_ERROR_INPUT, path, 0, NULL,
                          "face %zu has %zu points (3 or more)", faces->count, k);
    uint32_t *node = tm_lists_room(faces, k);
    if (!node)
        return tm_fail_memory(r->error);
    for (size_t i = 0; i < k; i++) {
        int64_t v = 0;
        if (!tm_numbers_whole(labels, first + i, 0, (int64_t)r->points - 1, &v))
            return tm_fail_at(r->error, TM_ERROR_INPUT, path, 0, NULL,
                              "face %zu: point %.17g is out of range (there are %zu)",
                              faces->count, tm_numbers_real(labels, first + i),
                              r->points);
        node[i] = (uint32_t)v;
    }
    return tm_lists_end(faces, k) ? TM_OK : tm_fail_memory(r->error);
}

/* Where each face begins in a list of all their labels, and that list. */
static tm_status read_compact(reader *r, tm_foam *foam, tm_lists *faces)
{
    const size_t most = TM_IDS - 1;
    tm_numbers start = {0}, labels = {0};
    tm_status status = tm_foam_labels(foam, "starts of faces", most, &start, r->error);
    if (status == TM_OK)
        status =
            tm_foam_labels(foam, "labels of points", SIZE_MAX >> 1, &labels, r->error);
    for (size_t f = 0; f + 1 < start.count && status == TM_OK; f++) {
        int64_t first = 0, past = 0;
        if (!tm_numbers_whole(&start, f, 0, (int64_t)labels.count, &first) ||
            !tm_numbers_whole(&start, f + 1, first, (int64_t)labels.count, &past))
            status =
                tm_fail_at(r->error, TM_ERROR_INPUT, foam->scan.name, 0, NULL,
                           "face %zu does not begin and end in the list of labels", f);
        else
            status = add_face(r, faces, &labels, (size_t)first, (size_t)(past - first));
    }
    tm_numbers_free(&start);
    tm_numbers_free(&labels);
    return status;
}

/* N(4(0 1 2 3) …) */
static tm_status read_lists(reader *r, tm_foam *foam, tm_lists *faces)
{
    size_t count = 0;
    tm_status status =
        tm_foam_count(foam, "the number of faces", UINT32_MAX - 1, &count, r->error);
    if (status == TM_OK)
        status = tm_foam_expect(foam, '(', r->error);
    for (size_t f = 0; f < count && status == TM_OK; f++) {
        tm_numbers labels = {0};
        status = tm_foam_labels(foam, "labels of points", r->points, &labels, r->error);
        if (status == TM_OK)
            status = add_face(r, faces, &labels, 0, labels.count);
        tm_numbers_free(&labels);
    }
    return status == TM_OK ? tm_foam_expect(foam, ')', r->error) : status;
}

/* Makes the lists the rows of .facet, without sides. */
static tm_status add_facets(reader *r, tm_lists *faces)
{
    tm_block *facet = tm_stream_add(r->stream, ".facet");
    if (!facet)
        return tm_fail_memory(r->error);
    facet->count = r->faces = faces->count;
    facet->start = faces->start;
    facet->item = faces->item ? faces->item : tm_new(0, 1);
    faces->start = NULL;
    faces->item = NULL;
    facet->integer = tm_new(2 * r->faces, sizeof *facet->integer);
    if (!facet->item || !facet->integer)
        return tm_fail_memory(r->error);
    memset(facet->integer, UINT8_MAX, 2 * r->faces * sizeof *facet->integer);
    return TM_OK;
}

static tm_status read_faces(reader *r)
{
    tm_foam foam;
    tm_lists faces = {0};
    tm_status status = tm_openfoam_begin(&foam, &r->file[TM_FOAM_FACES], r->error);
    if (status == TM_OK && !tm_lists_begin(&faces))
        status = tm_fail_memory(r->error);
    if (status == TM_OK)
        status =
            foam.compact ? read_compact(r, &foam, &faces) : read_lists(r, &foam, &faces);
    if (status == TM_OK)
        status = tm_foam_end(&foam, r->error);
    if (status == TM_OK)
        status = add_facets(r, &faces);
    tm_lists_free(&faces);
    return status;
}

/* Cells ----------------------------------------------------------------------------- */

/* Side 0 or 1 of the faces, in their order, and how many cells there are by it. Each cell
 * has four faces, of which another one may have each: so that there are fewer than faces.
 */
static tm_status read_side(reader *r, tm_openfoam_kind kind, size_t *count)
{
    const size_t side = kind == TM_FOAM_NEIGHBOUR;
    uint32_t *integer = tm_stream_find(r->stream, ".facet")->integer;
    tm_foam foam;
    tm_numbers cells = {0};
    tm_status status = tm_openfoam_begin(&foam, &r->file[kind], r->error);
    if (status == TM_OK)
        status = tm_foam_labels(&foam, "labels of cells", r->faces, &cells, r->error);
    if (status == TM_OK)
        status = tm_foam_end(&foam, r->error);
    *count = 0;
    for (size_t f = 0; f < cells.count && status == TM_OK; f++) {
        int64_t c = 0;
        /* -1: in old files, of the boundary */
        if (!tm_numbers_whole(&cells, f, side ? -1 : 0, (int64_t)r->faces - 1, &c))
            status = tm_fail_at(r->error, TM_ERROR_INPUT, foam.scan.name, 0, NULL,
                                "face %zu: cell %.17g is out of range (0 to %zu)", f,
                                tm_numbers_real(&cells, f), r->faces - 1);
        integer[2 * f + side] = (uint32_t)c;
        if (c >= 0 && status == TM_OK) {
            *count = f + 1;
            r->cells = (size_t)c >= r->cells ? (size_t)c + 1 : r->cells;
        }
    }
    tm_numbers_free(&cells);
    return status;
}

static tm_status read_sides(reader *r)
{
    size_t owners = 0;
    tm_status status = read_side(r, TM_FOAM_OWNER, &owners);
    if (status == TM_OK)
        status = read_side(r, TM_FOAM_NEIGHBOUR, &r->inside);
    if (status == TM_OK && owners != r->faces)
        status =
            tm_fail_at(r->error, TM_ERROR_INPUT, r->file[TM_FOAM_OWNER].path, 0, NULL,
                       "there are owners of %zu faces (of %zu)", owners, r->faces);
    const uint32_t *side = tm_stream_find(r->stream, ".facet")->integer;
    for (size_t f = 0; f < r->inside && status == TM_OK; f++)
        if (side[2 * f + 1] == TM_NONE || side[2 * f + 1] == side[2 * f])
            status = tm_fail_at(r->error, TM_ERROR_INPUT, r->file[TM_FOAM_NEIGHBOUR].path,
                                0, NULL, "face %zu has not two cells", f);
    return status;
}

/* The faces of each cell, in their order. */
static tm_status make_cells(reader *r)
{
    tm_block *cell = tm_stream_add(r->stream, ".cell");
    if (!cell)
        return tm_fail_memory(r->error);
    tm_status status = tm_block_allocate(cell, r->cells, r->faces + r->inside, r->error);
    const uint32_t *side = tm_stream_find(r->stream, ".facet")->integer;
    const size_t sides = 2 * r->faces;
    if (status != TM_OK)
        return status;
    for (size_t i = 0; i < sides; i++)
        if (side[i] != TM_NONE)
            cell->start[side[i] + 1]++;
    for (size_t c = 0; c < r->cells; c++) {
        if (cell->start[c + 1] < TETRAHEDRON)
            return tm_fail_at(r->error, TM_ERROR_INPUT, r->file[TM_FOAM_OWNER].path, 0,
                              NULL, "cell %zu has %zu faces (4 or more)", c,
                              cell->start[c + 1]);
        cell->start[c + 1] += cell->start[c];
    }
    /* from the end of each list, which start[c] is then, to its begin */
    for (size_t c = r->cells; c > 0; c--)
        cell->start[c] = cell->start[c - 1];
    for (size_t i = 0; i < sides; i++)
        if (side[i] != TM_NONE)
            cell->item[cell->start[side[i] + 1]++] = (uint32_t)(i / 2);
    cell->start[0] = 0;
    return TM_OK;
}

/* ----------------------------------------------------------------------------------- */

static tm_status read_mesh(reader *r)
{
    for (tm_openfoam_kind kind = 0; kind <= TM_FOAM_BOUNDARY; kind++)
        if (!r->file[kind].path)
            return tm_fail(r->error, TM_ERROR_INPUT, "the file %s is missing",
                           tm_openfoam_name[kind]);
    tm_status status = read_points(r);
    if (status == TM_OK)
        status = read_faces(r);
    if (status == TM_OK)
        status = read_sides(r);
    if (status == TM_OK && r->cells == 0)
        status = tm_fail_at(r->error, TM_ERROR_INPUT, r->file[TM_FOAM_OWNER].path, 0,
                            NULL, "there are no cells");
    return status == TM_OK ? make_cells(r) : status;
}

tm_status tm_openfoam_read(tm_stream *stream,
                           const tm_openfoam_file file[TM_OPENFOAM_FILES], bool elements,
                           tm_openfoam_report *report, tm_error *error)
{
    reader r = {.file = file, .stream = stream, .error = error};
    *report = (tm_openfoam_report){0};
    tm_status status = read_mesh(&r);
    if (status == TM_OK)
        status = tm_openfoam_read_zones(stream, file, r.inside, report, error);
    if (status == TM_OK && elements)
        status = tm_elements_of_cells(stream, &report->not_elements, error);
    if (status != TM_OK)
        tm_stream_free(stream);
    stream->base = 0;
    return status;
}

void tm_openfoam_report_free(tm_openfoam_report *report)
{
    tm_text_free(&report->type_names);
}
