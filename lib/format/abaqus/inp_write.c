/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "abaqus.h"

#include "../../base/array.h"
#include "../../element/shape.h"
#include "../../mesh/cell_faces.h"
#include "../../mesh/face_table.h"
#include "../../stream/group.h"
#include "../text_rows.h"
#include "inp_names.h"
#include "inp_text.h"
#include "inp_types.h"

#include <stdlib.h>
#include <string.h>

/* Numbers on a line of a set: at most sixteen. */
enum { COORDINATES = 3, TRIANGLE = 3, PER_LINE = 16, NO_MARKER = 0 };

/* A member of a set: a row, and of a face the number of the element's. */
typedef struct member {
    int32_t value;
    uint32_t item;
    uint8_t face;
} member;

typedef struct writer {
    tm_text *text;
    const tm_stream *stream;
    const tm_block *node, *cell; /* cell: .ele, .mix or .face; NULL for points */
    const tm_block *group;
    tm_content content;
    unsigned threads;
    member *list; /* of the sets that are being written */
    size_t count, room;
    size_t *loose;
    tm_error *error;
} writer;

/* Nodes and elements ---------------------------------------------------------------- */

static size_t row_room(const void *context, size_t first, size_t past)
{
    (void)context;
    return (past - first) * (1 + TM_ELEMENT_NODES) * (TM_NUMBER_ROOM + 1);
}

/* CalculiX reads twenty letters of a number: an exponent must be among them, other digits
 * may be cut off. */
enum { READ = 20, PLAIN_ROOM = 400 };

/* Below this a number may have an exponent below 0. */
static const double small = 1e-3;

static size_t node_room(const void *context, size_t first, size_t past)
{
    const tm_block *node = context;
    size_t room = row_room(NULL, first, past);
    for (size_t i = COORDINATES * first; i < COORDINATES * past; i++)
        if (node->real[i] < small && node->real[i] > -small)
            room += PLAIN_ROOM;
    return room;
}

/* An exponent for the zeros that a number ends with. */
static char *put_zeros(char *end)
{
    int zeros = 0;
    for (; end[-1] == '0'; end--)
        zeros++;
    *end = 'e';
    return tm_write_int64(end + 1, zeros);
}

/* A number with all its digits, "1.25e-9" as "0.00000000125" and "1.25e30" as "125e28"
 * where it would be too long. */
static char *put_real(char *to, double real)
{
    char *end = tm_write_double(to, real), digits[TM_DOUBLE_CHARS + 1];
    const size_t size = (size_t)(end - to);
    const char *e = memchr(to, 'e', size);
    if (size <= READ || (!e && memchr(to, '.', size)))
        return end;
    if (!e)
        return put_zeros(end);
    size_t count = 0;
    const int exponent = atoi(e + 1);
    const bool negative = *to == '-';
    for (const char *c = to + negative; c < e; c++)
        if (*c != '.')
            digits[count++] = *c;
    to += negative;
    if (exponent < 0) {
        memcpy(to, "0.", 2);
        to += 2;
        memset(to, '0', (size_t)-exponent - 1);
        to += -exponent - 1;
        memcpy(to, digits, count);
        return to + count;
    }
    memcpy(to, digits, count);
    to[count] = 'e';
    return tm_write_int64(to + count + 1, exponent + 1 - (int)count);
}

static char *put_node(const void *context, size_t row, char *to)
{
    const tm_block *node = context;
    to = tm_write_uint32(to, (uint32_t)row + 1);
    for (size_t i = 0; i < COORDINATES; i++) {
        *to++ = ',';
        *to++ = ' ';
        to = put_real(to, node->real[COORDINATES * row + i]);
    }
    *to++ = '\n';
    return to;
}

/* The elements of so many nodes. */
typedef struct of_type {
    const tm_block *cell;
    size_t nodes;
    uint32_t *row; /* [count] */
    size_t count, room;
} of_type;

static char *put_element(const void *context, size_t i, char *to)
{
    const of_type *of = context;
    const uint8_t *mirror = tm_element_shapes[TM_WEDGE_NODES].mirror;
    size_t k;
    const uint32_t *node = tm_row_nodes(of->cell, of->row[i], &k);
    to = tm_write_uint32(to, of->row[i] + 1);
    for (size_t j = 0; j < k; j++) {
        *to++ = ',';
        *to++ = ' ';
        to = tm_write_uint32(to, node[k == TM_WEDGE_NODES ? mirror[j] : j] + 1);
    }
    *to++ = '\n';
    return to;
}

static tm_status write_type(writer *w, size_t nodes, const char *type)
{
    of_type of = {.cell = w->cell, .nodes = nodes};
    bool done = true;
    for (size_t r = 0, k; r < w->cell->count && done; r++) {
        tm_row_nodes(w->cell, r, &k);
        if (k == nodes)
            done = tm_append(&of.row, &of.count, &of.room, (uint32_t)r);
    }
    if (done && of.count > 0) {
        const tm_text_rows rows = {&of, of.count, row_room, put_element};
        tm_text_format(w->text, "*ELEMENT, TYPE=%s, ELSET=Eall\n", type);
        tm_text_append_rows(w->text, &rows, w->threads);
    }
    free(of.row);
    return done ? TM_OK : tm_fail_memory(w->error);
}

/* All names, as comments: a set's name may have fewer letters. */
static void write_names(writer *w)
{
    for (size_t g = 0; w->group && g < w->group->count; g++)
        tm_text_format(w->text, TM_INP_OWN " %d %d %s\n",
                       (int)tm_group_dimension_of(w->group, g),
                       (int)tm_group_value(w->group, g), tm_group_name(w->group, g));
}

static tm_status write_mesh(writer *w)
{
    const tm_text_rows nodes = {w->node, w->node->count, node_room, put_node};
    tm_text_string(w->text, TM_INP_OWN "\n");
    write_names(w);
    tm_text_string(w->text, "*NODE, NSET=Nall\n");
    tm_text_append_rows(w->text, &nodes, w->threads);
    if (!w->cell)
        return TM_OK;
    tm_status status = write_type(w, TRIANGLE, "S3");
    if (status == TM_OK)
        status = write_type(w, TM_TET_NODES, "C3D4");
    if (status == TM_OK)
        status = write_type(w, TM_PYRAMID_NODES, "C3D5");
    if (status == TM_OK)
        status = write_type(w, TM_WEDGE_NODES, "C3D6");
    if (status == TM_OK)
        status = write_type(w, TM_HEX_NODES, "C3D8");
    return status;
}

/* Members --------------------------------------------------------------------------- */

static tm_status add_member(writer *w, int32_t value, uint32_t item, int face)
{
    member *moved = tm_grow(w->list, &w->room, w->count + 1, sizeof *moved);
    if (!moved)
        return tm_fail_memory(w->error);
    w->list = moved;
    moved[w->count++] = (member){value, item, (uint8_t)face};
    return TM_OK;
}

/* A value of 0 is one only where it has a name. */
static bool is_set(const writer *w, tm_group_dimension dimension, int32_t value)
{
    return value != NO_MARKER || tm_group_find(w->group, dimension, value);
}

static tm_status list_marked(writer *w, const tm_block *block,
                             tm_group_dimension dimension)
{
    tm_status status = TM_OK;
    const bool zero = is_set(w, dimension, NO_MARKER);
    for (size_t r = 0; block->marker && r < block->count && status == TM_OK; r++)
        if (block->marker[r] != NO_MARKER || zero)
            status = add_member(w, block->marker[r], (uint32_t)r, 0);
    return status;
}

static tm_status list_regions(writer *w)
{
    tm_status status = TM_OK;
    const bool zero = is_set(w, TM_GROUP_REGIONS, NO_MARKER);
    for (size_t r = 0; r < w->cell->count && status == TM_OK; r++) {
        int32_t region = NO_MARKER;
        if (tm_group_region(w->cell, r, &region) && (region != NO_MARKER || zero))
            status = add_member(w, region, (uint32_t)r, 0);
    }
    return status;
}

/* The rows of .face or .facet, of which the first is the view's row `first`, as faces of
 * elements. */
static tm_status list_faces(writer *w, const tm_mesh_view *view, const uint32_t *mate,
                            const tm_block *block, size_t first)
{
    const bool is_tet = !view->start;
    const bool zero = is_set(w, TM_GROUP_FACES, NO_MARKER);
    tm_status status = TM_OK;
    for (size_t r = 0; block && block->marker && r < block->count && status == TM_OK;
         r++) {
        const uint32_t half = mate[tm_half_faces(view) + first + r];
        if (block->marker[r] == NO_MARKER && (!zero || half == TM_NONE))
            continue;
        if (half == TM_NONE) {
            ++*w->loose;
            continue;
        }
        const size_t per = is_tet ? TM_TET_NODES : TM_ELEMENT_NODES;
        const uint32_t e = half / (uint32_t)per;
        size_t k, f = 0;
        tm_row_nodes(w->cell, e, &k);
        while (tm_half_face(view, e, f) != half)
            f++;
        status = add_member(w, block->marker[r], e, tm_inp_face_number(k, f));
    }
    return status;
}

static tm_status list_all_faces(writer *w)
{
    const bool is_mixed = w->content == TM_CONTENT_MIXED;
    const tm_mesh_view view =
        is_mixed ? tm_mesh_view_of_mixed(w->stream) : tm_mesh_view_of_tets(w->stream);
    uint32_t *mate = NULL;
    tm_status status = tm_face_mates(&mate, &view, w->error);
    if (status == TM_OK && view.faces > 0)
        status = list_faces(w, &view, mate, tm_stream_find(w->stream, ".face"), 0);
    if (status == TM_OK && is_mixed)
        status =
            list_faces(w, &view, mate, tm_stream_find(w->stream, ".facet"), view.faces);
    free(mate);
    return status;
}

/* Sets ------------------------------------------------------------------------------ */

static int compare_members(const void *a, const void *b)
{
    const member *p = a, *q = b;
    if (p->value != q->value)
        return p->value < q->value ? -1 : 1;
    return p->item != q->item ? (p->item < q->item ? -1 : 1)
                              : (p->face > q->face) - (p->face < q->face);
}

/* Members first … past - 1, sixteen on a line, or a face on each. */
static void write_members(writer *w, size_t first, size_t past, bool faces)
{
    char number[2 * TM_NUMBER_ROOM];
    for (size_t i = first; i < past; i++) {
        char *end = tm_write_uint32(number, w->list[i].item + 1);
        if (faces) {
            memcpy(end, ", S", sizeof ", S" - 1);
            end += sizeof ", S" - 1;
            *end++ = (char)('0' + w->list[i].face);
            *end++ = '\n';
        } else {
            *end++ = i + 1 < past ? ',' : '\n';
            if (i + 1 < past)
                *end++ = (i - first) % PER_LINE == PER_LINE - 1 ? '\n' : ' ';
        }
        tm_text_append(w->text, number, (size_t)(end - number));
    }
}

/* The sets of a dimension, by ascending values. */
static void write_sets(writer *w, tm_group_dimension dimension, const char *keyword,
                       const tm_inp_names *names)
{
    const bool faces = dimension == TM_GROUP_FACES && w->content != TM_CONTENT_SURFACE;
    for (size_t first = 0, past; first < w->count; first = past) {
        const int32_t value = w->list[first].value;
        for (past = first + 1; past < w->count && w->list[past].value == value;)
            past++;
        tm_text_format(w->text, TM_INP_OWN " %d %d\n%s=%s\n", (int)dimension, (int)value,
                       keyword, tm_inp_name_of(names, value));
        write_members(w, first, past, faces);
    }
}

/* Members first … past - 1, of a value that stands for several sets, become those of each
 * of these, behind the others. */
static tm_status join_parts(writer *w, tm_group_dimension dimension, size_t first,
                            size_t past)
{
    int32_t *part = NULL;
    size_t parts = 0;
    const char *name = tm_group_find(w->group, dimension, w->list[first].value);
    tm_status status =
        name ? tm_group_parts(w->group, dimension, name, &part, &parts, w->error) : TM_OK;
    for (size_t i = first; i < past && parts > 0 && status == TM_OK; i++) {
        const member moved = w->list[i];
        w->list[i].value = part[0];
        for (size_t p = 1; p < parts && status == TM_OK; p++)
            status = add_member(w, part[p], moved.item, moved.face);
    }
    free(part);
    return status;
}

static void sort_members(writer *w)
{
    if (w->count > 0)
        qsort(w->list, w->count, sizeof *w->list, compare_members);
}

static tm_status join_all_parts(writer *w, tm_group_dimension dimension)
{
    const size_t count = w->count;
    tm_status status = TM_OK;
    sort_members(w);
    for (size_t first = 0, past; first < count && status == TM_OK; first = past) {
        const int32_t value = w->list[first].value;
        for (past = first + 1; past < count && w->list[past].value == value;)
            past++;
        status = join_parts(w, dimension, first, past);
    }
    if (w->count > count)
        sort_members(w);
    return status;
}

/* The members of each value of a dimension. */
static tm_status list_members(writer *w, tm_group_dimension dimension)
{
    w->count = 0;
    if (dimension == TM_GROUP_NODES)
        return list_marked(w, w->node, dimension);
    if (!w->cell || dimension == TM_GROUP_EDGES)
        return TM_OK;
    if (dimension == TM_GROUP_REGIONS)
        return w->content == TM_CONTENT_SURFACE ? TM_OK : list_regions(w);
    return w->content == TM_CONTENT_SURFACE ? list_marked(w, w->cell, dimension)
                                            : list_all_faces(w);
}

static tm_status name_values(writer *w, tm_group_dimension dimension, tm_inp_names *names)
{
    tm_status status = TM_OK;
    for (size_t i = 0; i < w->count && status == TM_OK; i++)
        if (i == 0 || w->list[i].value != w->list[i - 1].value)
            status = tm_inp_names_add(
                names, dimension, w->list[i].value,
                tm_group_find(w->group, dimension, w->list[i].value), w->error);
    tm_inp_names_end(names);
    return status;
}

static tm_status write_groups(writer *w)
{
    static const tm_group_dimension order[] = {TM_GROUP_REGIONS, TM_GROUP_FACES,
                                               TM_GROUP_NODES};
    tm_status status = TM_OK;
    for (size_t i = 0; i < sizeof order / sizeof *order && status == TM_OK; i++) {
        const tm_group_dimension d = order[i];
        const char *keyword = d == TM_GROUP_NODES ? "*NSET, NSET" : "*ELSET, ELSET";
        if (d == TM_GROUP_FACES && w->content != TM_CONTENT_SURFACE)
            keyword = "*SURFACE, TYPE=ELEMENT, NAME";
        tm_inp_names names = {0};
        status = list_members(w, d);
        if (status == TM_OK)
            status = join_all_parts(w, d);
        if (status == TM_OK)
            status = name_values(w, d, &names);
        if (status == TM_OK)
            write_sets(w, d, keyword, &names);
        tm_inp_names_free(&names);
    }
    return status;
}

tm_status tm_abaqus_write(tm_text *text, const tm_stream *stream, unsigned threads,
                          size_t *loose, tm_error *error)
{
    const tm_content content = tm_content_of(stream);
    writer w = {.text = text,
                .stream = stream,
                .node = tm_stream_find(stream, ".node"),
                .group = tm_stream_find(stream, ".group"),
                .content = content,
                .threads = threads,
                .loose = loose,
                .error = error};
    *loose = 0;
    if (content == TM_CONTENT_NOTHING || content == TM_CONTENT_POLYHEDRA)
        return tm_fail(error, TM_ERROR_INPUT,
                       "holds no points, surface or elements (.node with .face, .ele or "
                       ".mix)");
    if (content != TM_CONTENT_POINTS)
        w.cell = tm_content_block(stream, content);
    tm_status status = write_mesh(&w);
    if (status == TM_OK)
        status = write_groups(&w);
    tm_text_string(text, TM_INP_OWN " end\n");
    if (status == TM_OK && text->failed)
        status = tm_fail_memory(error);
    free(w.list);
    return status;
}
