/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_format.h"

#include "../base/array.h"
#include "../mesh/cell_faces.h"

#include <stdlib.h>
#include <string.h>

enum { POINTS, FACES, OWNER, NEIGHBOUR, BOUNDARY };

const char *const tm_openfoam_name[TM_OPENFOAM_FILES] = {
    [POINTS] = "points",       [FACES] = "faces",       [OWNER] = "owner",
    [NEIGHBOUR] = "neighbour", [BOUNDARY] = "boundary",
};

static const char *const class_name[TM_OPENFOAM_FILES] = {
    [POINTS] = "vectorField",        [FACES] = "faceList",
    [OWNER] = "labelList",           [NEIGHBOUR] = "labelList",
    [BOUNDARY] = "polyBoundaryMesh",
};

/* A facet of the boundary; what the patches are sorted by. */
typedef struct boundary_facet {
    int32_t marker;
    uint32_t owner;
    uint32_t facet;
} boundary_facet;

typedef struct writer {
    tm_cell_faces faces;
    const tm_block *node;
    uint32_t *order; /* [facets]: those inside, then those of the boundary */
    size_t inside;
    boundary_facet *boundary; /* [facets - inside], sorted */
    size_t patches;
    uint32_t *number; /* [nodes]: in the file; TM_NONE for those that are left out */
    size_t points;
    tm_text *file;
    tm_error *error;
} writer;

static uint32_t owner_of(const tm_cell_faces *faces, size_t f)
{
    const uint32_t *side = faces->side[f];
    return side[0] < side[1] ? side[0] : side[1];
}

static uint32_t neighbour_of(const tm_cell_faces *faces, size_t f)
{
    const uint32_t *side = faces->side[f];
    return side[0] < side[1] ? side[1] : side[0];
}

/* The order of faces --------------------------------------------------------------- */

/* Sorts count facets by the key, which is below keys, from one array into the other. */
static void sort_by(const tm_cell_faces *faces, const uint32_t *from, uint32_t *to,
                    size_t count, size_t *begin, size_t keys,
                    uint32_t (*key)(const tm_cell_faces *faces, size_t f))
{
    memset(begin, 0, (keys + 1) * sizeof *begin);
    for (size_t i = 0; i < count; i++)
        begin[key(faces, from[i]) + 1]++;
    for (size_t k = 0; k < keys; k++)
        begin[k + 1] += begin[k];
    for (size_t i = 0; i < count; i++)
        to[begin[key(faces, from[i])]++] = from[i];
}

static tm_status order_inside(writer *w)
{
    const tm_cell_faces *faces = &w->faces;
    uint32_t *other = tm_new(faces->facets, sizeof *other);
    size_t *begin = tm_new(faces->cells + 1, sizeof *begin);
    if (other && begin) {
        for (size_t f = 0; f < faces->facets; f++)
            if (faces->side[f][1] != TM_NONE)
                w->order[w->inside++] = (uint32_t)f;
        sort_by(faces, w->order, other, w->inside, begin, faces->cells, neighbour_of);
        sort_by(faces, other, w->order, w->inside, begin, faces->cells, owner_of);
    }
    free(begin);
    tm_status status = other && begin ? TM_OK : tm_fail_memory(w->error);
    free(other);
    return status;
}

static int compare(const void *first, const void *second)
{
    const boundary_facet *a = first, *b = second;
    if (a->marker != b->marker)
        return a->marker < b->marker ? -1 : 1;
    if (a->owner != b->owner)
        return a->owner < b->owner ? -1 : 1;
    return (a->facet > b->facet) - (a->facet < b->facet);
}

static tm_status order_boundary(writer *w)
{
    const tm_cell_faces *faces = &w->faces;
    size_t count = faces->facets - w->inside, at = 0;
    w->boundary = tm_new(count, sizeof *w->boundary);
    if (!w->boundary)
        return tm_fail_memory(w->error);
    for (size_t f = 0; f < faces->facets; f++)
        if (faces->side[f][1] == TM_NONE)
            w->boundary[at++] = (boundary_facet){faces->marker ? faces->marker[f] : 0,
                                                 faces->side[f][0], (uint32_t)f};
    qsort(w->boundary, count, sizeof *w->boundary, compare);
    for (size_t i = 0; i < count; i++) {
        w->order[w->inside + i] = w->boundary[i].facet;
        w->patches += i == 0 || w->boundary[i - 1].marker != w->boundary[i].marker;
    }
    return TM_OK;
}

static tm_status number_points(writer *w)
{
    const tm_cell_faces *faces = &w->faces;
    size_t nodes = w->node->count;
    w->number = tm_new(nodes, sizeof *w->number);
    if (!w->number)
        return tm_fail_memory(w->error);
    memset(w->number, UINT8_MAX, nodes * sizeof *w->number);
    for (size_t i = 0; i < faces->start[faces->facets]; i++)
        w->number[faces->node[i]] = 0;
    for (size_t v = 0; v < nodes; v++)
        if (w->number[v] != TM_NONE)
            w->number[v] = (uint32_t)w->points++;
    return TM_OK;
}

/* The files ------------------------------------------------------------------------ */

/* The head of a file and the count of the list that follows. */
static void begin_list(writer *w, int i, size_t count)
{
    tm_text *text = &w->file[i];
    tm_text_format(text,
                   "FoamFile\n{\n    version     2.0;\n    format      ascii;\n"
                   "    class       %s;\n",
                   class_name[i]);
    if (i == OWNER || i == NEIGHBOUR)
        tm_text_format(text,
                       "    note        \"nPoints: %zu nCells: %zu nFaces: %zu "
                       "nInternalFaces: %zu\";\n",
                       w->points, w->faces.cells, w->faces.facets, w->inside);
    tm_text_format(text,
                   "    location    \"constant/polyMesh\";\n    object      %s;\n}\n\n"
                   "%zu\n(\n",
                   tm_openfoam_name[i], count);
}

static void end_list(writer *w, int i)
{
    tm_text_string(&w->file[i], ")\n");
}

static void write_points(writer *w)
{
    enum { COORDINATES = 3 };
    static const char *const before[COORDINATES] = {"(", " ", " "};
    tm_text *text = &w->file[POINTS];
    begin_list(w, POINTS, w->points);
    for (size_t v = 0; v < w->node->count; v++) {
        if (w->number[v] == TM_NONE)
            continue;
        for (size_t i = 0; i < COORDINATES; i++) {
            tm_text_append(text, before[i], 1);
            tm_text_double(text, w->node->real[COORDINATES * v + i]);
        }
        tm_text_append(text, ")\n", 2);
    }
    end_list(w, POINTS);
}

/* A face turns so that its normal points away from its owner. */
static void write_face(writer *w, size_t f)
{
    const tm_cell_faces *faces = &w->faces;
    size_t begin = faces->start[f], k = faces->start[f + 1] - begin;
    bool turn = faces->side[f][0] > faces->side[f][1];
    tm_text *text = &w->file[FACES];
    tm_text_integer(text, (int64_t)k);
    for (size_t i = 0; i < k; i++) {
        uint32_t v = faces->node[begin + (turn && i > 0 ? k - i : i)];
        tm_text_append(text, i == 0 ? "(" : " ", 1);
        tm_text_integer(text, w->number[v]);
    }
    tm_text_append(text, ")\n", 2);
}

static void write_faces(writer *w)
{
    const tm_cell_faces *faces = &w->faces;
    begin_list(w, FACES, faces->facets);
    begin_list(w, OWNER, faces->facets);
    begin_list(w, NEIGHBOUR, w->inside);
    for (size_t i = 0; i < faces->facets; i++) {
        size_t f = w->order[i];
        write_face(w, f);
        tm_text_integer(&w->file[OWNER], owner_of(faces, f));
        tm_text_append(&w->file[OWNER], "\n", 1);
        if (i >= w->inside)
            continue;
        tm_text_integer(&w->file[NEIGHBOUR], neighbour_of(faces, f));
        tm_text_append(&w->file[NEIGHBOUR], "\n", 1);
    }
    end_list(w, FACES);
    end_list(w, OWNER);
    end_list(w, NEIGHBOUR);
}

static void write_boundary(writer *w)
{
    size_t count = w->faces.facets - w->inside;
    begin_list(w, BOUNDARY, w->patches);
    for (size_t begin = 0, end; begin < count; begin = end) {
        int32_t marker = w->boundary[begin].marker;
        for (end = begin; end < count && w->boundary[end].marker == marker; end++)
            ;
        tm_text_format(&w->file[BOUNDARY],
                       "    marker_%d\n    {\n        type            patch;\n"
                       "        nFaces          %zu;\n        startFace       %zu;\n"
                       "    }\n",
                       (int)marker, end - begin, w->inside + begin);
    }
    end_list(w, BOUNDARY);
}

/* ---------------------------------------------------------------------------------- */

static tm_status write_all(writer *w)
{
    w->order = tm_new(w->faces.facets, sizeof *w->order);
    tm_status status = w->order ? order_inside(w) : tm_fail_memory(w->error);
    if (status == TM_OK)
        status = order_boundary(w);
    if (status == TM_OK)
        status = number_points(w);
    if (status != TM_OK)
        return status;
    write_points(w);
    write_faces(w);
    write_boundary(w);
    for (int i = 0; i < TM_OPENFOAM_FILES; i++)
        if (w->file[i].failed)
            status = tm_fail_memory(w->error);
    return status;
}

tm_status tm_openfoam_write(tm_text file[TM_OPENFOAM_FILES], const tm_stream *stream,
                            tm_openfoam_counts *counts, tm_error *error)
{
    writer w = {.node = tm_stream_find(stream, ".node"), .file = file, .error = error};
    tm_status status = tm_cell_faces_find(&w.faces, stream, error);
    if (status == TM_OK && w.faces.cells == 0)
        status = tm_fail(error, TM_ERROR_INPUT, "has no cells (.cell, .mix or .ele)");
    if (status == TM_OK)
        status = write_all(&w);
    *counts = (tm_openfoam_counts){w.points, w.faces.cells, w.faces.facets, w.patches};
    tm_cell_faces_free(&w.faces);
    free(w.order);
    free(w.boundary);
    free(w.number);
    return status;
}
