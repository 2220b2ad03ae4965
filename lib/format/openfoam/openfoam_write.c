/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "openfoam.h"

#include "../../base/array.h"
#include "../../mesh/cell_faces.h"
#include "../../stream/group.h"

#include <stdlib.h>
#include <string.h>

const char *const tm_openfoam_name[TM_OPENFOAM_FILES] = {
    [TM_FOAM_POINTS] = "points",        [TM_FOAM_FACES] = "faces",
    [TM_FOAM_OWNER] = "owner",          [TM_FOAM_NEIGHBOUR] = "neighbour",
    [TM_FOAM_BOUNDARY] = "boundary",    [TM_FOAM_CELL_ZONES] = "cellZones",
    [TM_FOAM_FACE_ZONES] = "faceZones",
};

static const char *const class_name[TM_OPENFOAM_FILES] = {
    [TM_FOAM_POINTS] = "vectorField",        [TM_FOAM_FACES] = "faceList",
    [TM_FOAM_OWNER] = "labelList",           [TM_FOAM_NEIGHBOUR] = "labelList",
    [TM_FOAM_BOUNDARY] = "polyBoundaryMesh", [TM_FOAM_CELL_ZONES] = "regIOobject",
    [TM_FOAM_FACE_ZONES] = "regIOobject",
};

/* A cell, or a face by its place in the file, of a zone; and what zones are sorted by. */
typedef struct zone_member {
    int32_t value; /* region or marker */
    uint32_t label;
} zone_member;

/* The patches or the zones of one kind: their names are different, for OpenFOAM. */
typedef struct name_list {
    tm_group_dimension dimension;
    const char *nameless; /* what stands before the value of one without a name */
    size_t count, room;
    char **name;
    bool failed; /* memory is out */
} name_list;

/* A facet of the boundary; what the patches are sorted by. */
typedef struct boundary_facet {
    int32_t marker;
    uint32_t owner;
    uint32_t facet;
} boundary_facet;

typedef struct writer {
    tm_cell_faces faces;
    const tm_block *node;
    const tm_block *cells;
    const tm_block *group; /* or NULL */
    uint32_t *order;       /* [facets]: those inside, then those of the boundary */
    size_t inside;
    boundary_facet *boundary; /* [facets - inside], sorted */
    size_t patches, cell_zones, face_zones;
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
    if (i == TM_FOAM_OWNER || i == TM_FOAM_NEIGHBOUR)
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

/* Names ---------------------------------------------------------------------------- */

/* Appends what OpenFOAM takes for a word: without blanks and what means something to its
 * dictionaries, not like a number at the front, of less than 1024 bytes. */
static void append_word(tm_text *word, const char *name)
{
    enum { WORD_MAX = 1000, OF_UTF8 = 0xC0, TAIL = 0x80 };
    if (strchr("0123456789+-.", *name))
        tm_text_append(word, "_", 1);
    for (; *name; name++) {
        if (word->size >= WORD_MAX && ((unsigned char)*name & OF_UTF8) != TAIL)
            return;
        tm_text_append(word, strchr(" \t\"'/\\;{}()[]<>#$!*?|&,=:", *name) ? "_" : name,
                       1);
    }
}

static bool is_taken(const name_list *names, const char *name)
{
    bool taken = false;
    for (size_t i = 0; i < names->count && !taken; i++)
        taken = strcmp(names->name[i], name) == 0;
    return taken;
}

/* The name of a patch or zone, which has got none yet. Where two names become one word
 * the later one gets the value behind it. Where memory is out it is "" (and the file
 * fails in free_names()). */
static const char *name_of(const writer *w, name_list *names, int32_t value)
{
    const char *given = tm_group_find(w->group, names->dimension, value);
    tm_text word = {0};
    if (given)
        append_word(&word, given);
    else
        tm_text_format(&word, "%s_%d", names->nameless, (int)value);
    while (!word.failed && is_taken(names, word.byte))
        tm_text_format(&word, "_%d", (int)value);
    char **grown = tm_grow(names->name, &names->room, names->count + 1, sizeof *grown);
    if (grown)
        names->name = grown;
    if (!grown || word.failed) {
        tm_text_free(&word);
        names->failed = true;
        return "";
    }
    return grown[names->count++] = word.byte;
}

static void free_names(writer *w, name_list *names, int file)
{
    for (size_t i = 0; i < names->count; i++)
        free(names->name[i]);
    free(names->name);
    w->file[file].failed |= names->failed;
}

static void write_points(writer *w)
{
    enum { COORDINATES = 3 };
    static const char *const before[COORDINATES] = {"(", " ", " "};
    tm_text *text = &w->file[TM_FOAM_POINTS];
    begin_list(w, TM_FOAM_POINTS, w->points);
    for (size_t v = 0; v < w->node->count; v++) {
        if (w->number[v] == TM_NONE)
            continue;
        for (size_t i = 0; i < COORDINATES; i++) {
            tm_text_append(text, before[i], 1);
            tm_text_double(text, w->node->real[COORDINATES * v + i]);
        }
        tm_text_append(text, ")\n", 2);
    }
    end_list(w, TM_FOAM_POINTS);
}

/* A face turns so that its normal points away from its owner. */
static void write_face(writer *w, size_t f)
{
    const tm_cell_faces *faces = &w->faces;
    size_t begin = faces->start[f], k = faces->start[f + 1] - begin;
    bool turn = faces->side[f][0] > faces->side[f][1];
    tm_text *text = &w->file[TM_FOAM_FACES];
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
    begin_list(w, TM_FOAM_FACES, faces->facets);
    begin_list(w, TM_FOAM_OWNER, faces->facets);
    begin_list(w, TM_FOAM_NEIGHBOUR, w->inside);
    for (size_t i = 0; i < faces->facets; i++) {
        size_t f = w->order[i];
        write_face(w, f);
        tm_text_integer(&w->file[TM_FOAM_OWNER], owner_of(faces, f));
        tm_text_append(&w->file[TM_FOAM_OWNER], "\n", 1);
        if (i >= w->inside)
            continue;
        tm_text_integer(&w->file[TM_FOAM_NEIGHBOUR], neighbour_of(faces, f));
        tm_text_append(&w->file[TM_FOAM_NEIGHBOUR], "\n", 1);
    }
    end_list(w, TM_FOAM_FACES);
    end_list(w, TM_FOAM_OWNER);
    end_list(w, TM_FOAM_NEIGHBOUR);
}

static void write_boundary(writer *w)
{
    name_list names = {.dimension = TM_GROUP_FACES, .nameless = "marker"};
    size_t count = w->faces.facets - w->inside;
    begin_list(w, TM_FOAM_BOUNDARY, w->patches);
    for (size_t begin = 0, end; begin < count; begin = end) {
        int32_t marker = w->boundary[begin].marker;
        for (end = begin; end < count && w->boundary[end].marker == marker; end++)
            ;
        tm_text_format(&w->file[TM_FOAM_BOUNDARY],
                       "    %s\n    {\n        type            patch;\n"
                       "        nFaces          %zu;\n        startFace       %zu;\n"
                       "    }\n",
                       name_of(w, &names, marker), end - begin, w->inside + begin);
    }
    end_list(w, TM_FOAM_BOUNDARY);
    free_names(w, &names, TM_FOAM_BOUNDARY);
}

/* Zones ---------------------------------------------------------------------------- */

static int compare_members(const void *first, const void *second)
{
    const zone_member *a = first, *b = second;
    if (a->value != b->value)
        return a->value < b->value ? -1 : 1;
    return (a->label > b->label) - (a->label < b->label);
}

/* The cells of regions that are not 0, or have a name. */
static size_t list_cells(const writer *w, zone_member *member)
{
    const bool zero = tm_group_find(w->group, TM_GROUP_REGIONS, 0);
    size_t count = 0;
    for (size_t c = 0; c < w->faces.cells; c++) {
        int32_t region;
        if (tm_group_region(w->cells, c, &region) && (region != 0 || zero))
            member[count++] = (zone_member){region, (uint32_t)c};
    }
    return count;
}

/* The faces inside with a marker. */
static size_t list_faces(const writer *w, zone_member *member)
{
    size_t count = 0;
    for (size_t i = 0; i < w->inside && w->faces.marker; i++)
        if (w->faces.marker[w->order[i]] != 0)
            member[count++] = (zone_member){w->faces.marker[w->order[i]], (uint32_t)i};
    return count;
}

static void write_labels(tm_text *text, const zone_member *member, size_t count)
{
    tm_text_format(text, "List<label>\n%zu\n(\n", count);
    for (size_t i = 0; i < count; i++) {
        tm_text_integer(text, member[i].label);
        tm_text_append(text, "\n", 1);
    }
    tm_text_string(text, ")\n;\n");
}

/* No face of a zone turns: its normal points to its neighbour. */
static void write_flips(tm_text *text, size_t count)
{
    tm_text_format(text, "        flipMap         List<bool>\n%zu\n(\n", count);
    for (size_t i = 0; i < count; i++)
        tm_text_string(text, "0\n");
    tm_text_string(text, ")\n;\n");
}

/* Writes the members, sorted, as zones; returns how many zones. */
static size_t write_zones(writer *w, int file, name_list *names, const char *type,
                          const char *labels, zone_member *member, size_t count)
{
    tm_text *text = &w->file[file];
    size_t zones = 0;
    qsort(member, count, sizeof *member, compare_members);
    for (size_t i = 0; i < count; i++)
        zones += i == 0 || member[i - 1].value != member[i].value;
    begin_list(w, file, zones);
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin; end < count && member[end].value == member[begin].value; end++)
            ;
        tm_text_format(text,
                       "    %s\n    {\n        type            %s;\n        %s      ",
                       name_of(w, names, member[begin].value), type, labels);
        write_labels(text, member + begin, end - begin);
        if (file == TM_FOAM_FACE_ZONES)
            write_flips(text, end - begin);
        tm_text_string(text, "    }\n");
    }
    end_list(w, file);
    free_names(w, names, file);
    return zones;
}

static tm_status write_all_zones(writer *w)
{
    name_list cells = {.dimension = TM_GROUP_REGIONS, .nameless = "region"};
    name_list faces = {.dimension = TM_GROUP_FACES, .nameless = "marker"};
    const size_t most = w->faces.cells > w->inside ? w->faces.cells : w->inside;
    zone_member *member = tm_new(most, sizeof *member);
    if (!member)
        return tm_fail_memory(w->error);
    w->cell_zones = write_zones(w, TM_FOAM_CELL_ZONES, &cells, "cellZone", "cellLabels",
                                member, list_cells(w, member));
    w->face_zones = write_zones(w, TM_FOAM_FACE_ZONES, &faces, "faceZone", "faceLabels",
                                member, list_faces(w, member));
    free(member);
    return TM_OK;
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
    status = write_all_zones(w);
    for (int i = 0; i < TM_OPENFOAM_FILES; i++)
        if (w->file[i].failed)
            status = tm_fail_memory(w->error);
    return status;
}

static tm_status measure(const writer *w, tm_poly_finite_volume *measures,
                         bool all_geometry)
{
    const tm_cell_faces *faces = &w->faces;
    const tm_poly_arrays mesh = {.nodes = w->node->count,
                                 .xyz = (const double(*)[3])w->node->real,
                                 .facets = faces->facets,
                                 .side = (const uint32_t(*)[2])faces->side,
                                 .facet_start = faces->start,
                                 .facet_node = faces->node,
                                 .cells = faces->cells,
                                 .cell_start = faces->cell_start,
                                 .cell_facet = faces->cell_facet};
    return all_geometry ? tm_poly_finite_volume_measure(measures, &mesh, 1, w->error)
                        : tm_poly_finite_volume_check(measures, &mesh, w->error);
}

tm_status tm_openfoam_write(tm_text file[TM_OPENFOAM_FILES], const tm_stream *stream,
                            tm_openfoam_counts *counts, tm_poly_finite_volume *measures,
                            bool all_geometry, tm_error *error)
{
    writer w = {.node = tm_stream_find(stream, ".node"),
                .cells = tm_content_block(stream, tm_content_of(stream)),
                .group = tm_stream_find(stream, ".group"),
                .file = file,
                .error = error};
    tm_status status = tm_cell_faces_find(&w.faces, stream, error);
    if (status == TM_OK && w.faces.cells == 0)
        status = tm_fail(error, TM_ERROR_INPUT, "has no cells (.cell, .mix or .ele)");
    if (status == TM_OK)
        status = write_all(&w);
    if (status == TM_OK && measures)
        status = measure(&w, measures, all_geometry);
    *counts = (tm_openfoam_counts){.points = w.points,
                                   .cells = w.faces.cells,
                                   .faces = w.faces.facets,
                                   .patches = w.patches,
                                   .cell_zones = w.cell_zones,
                                   .face_zones = w.face_zones};
    tm_cell_faces_free(&w.faces);
    free(w.order);
    free(w.boundary);
    free(w.number);
    return status;
}
