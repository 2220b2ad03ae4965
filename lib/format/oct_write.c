/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writing .oct files. */
#include "oct.h"

#include "../base/array.h"
#include "../base/ids.h"
#include "../element/shape.h"
#include "octant_triangles.h"
#include "../surface/point_table.h"
#include "text_rows.h"

#include <math.h>
#include <stdlib.h>

#define FAIL(block, ...) tm_fail_at(w->error, TM_ERROR_INPUT, NULL, 0, block, __VA_ARGS__)

enum { OCTANT_NUMBERS = 6, ROOT_REALS = 4, TRIANGLE = 3, LEVEL_MAX = 31 };

/* Corners in the order of .m3d, as bits: 1 at the high side in x, 2 in y, 4 in z. */
static const unsigned char corner_place[TM_OCT_CORNERS] = {0, 4, 5, 1, 2, 6, 7, 3};

typedef struct writer {
    const tm_stream *stream;
    const tm_block *octant, *root, *mix, *node, *face;
    double low[3];
    double unit;
    unsigned finest;
    size_t octants;
    tm_octant_box *box;
    uint32_t (*corner)[TM_OCT_CORNERS];
    size_t points, point_room;
    double (*grid)[3]; /* whole numbers of units */
    tm_point_table table;
    size_t edges, edge_room, middle_room;
    uint32_t (*edge)[3]; /* ends and the point in the middle, or 0 */
    double (*middle)[3]; /* of each edge, in units */
    tm_point_table known;
    tm_octant_triangles meet;
    uint32_t *id; /* [octants], NULL where they are not written */
    tm_text *text;
    tm_error *error;
} writer;

/* What must be there --------------------------------------------------------------- */

static tm_status find_blocks(writer *w)
{
    struct {
        const char *name;
        const tm_block **block;
        const char *why;
    } needed[] = {
        {".mix", &w->mix, "the elements of the octants"},
        {".octant", &w->octant, "the octants"},
        {".root", &w->root, "the cubes that the octants are parts of"},
        {"surface.node", &w->node, "the nodes of the surface that octants meet"},
        {"surface.face", &w->face, "the triangles of the surface that octants meet"},
    };
    for (size_t i = 0; i < sizeof needed / sizeof needed[0]; i++) {
        const tm_block *block = tm_stream_find(w->stream, needed[i].name);
        if (!block || block->count == 0)
            return FAIL(needed[i].name, "has no rows in the stream (%s)", needed[i].why);
        *needed[i].block = block;
    }
    return TM_OK;
}

/* The low corner of the brick of root cubes, which are of one size. */
static tm_status find_tree(writer *w)
{
    const double *first = w->root->real;
    w->finest = w->root->integer[0];
    for (int i = 0; i < 3; i++)
        w->low[i] = first[i];
    for (size_t r = 0; r < w->root->count; r++) {
        const double *root = w->root->real + ROOT_REALS * r;
        if (w->root->integer[r] != w->finest || root[3] != first[3])
            return FAIL(".root",
                        "row %zu: its size or finest level is not that of row %u",
                        r + w->stream->base, w->stream->base);
        for (int i = 0; i < 3; i++)
            w->low[i] = fmin(w->low[i], root[i]);
    }
    if (!(first[3] > 0) || w->finest > LEVEL_MAX)
        return FAIL(".root", "a cube of size %g with the finest level %u", first[3],
                    w->finest);
    w->unit = ldexp(first[3], -(int)w->finest);
    for (int i = 0; i < 3; i++)
        if (!isfinite(w->low[i] + ldexp(w->unit, TM_OCTANT_BITS)))
            return FAIL(".root", "a cube of size %g is too large", first[3]);
    return TM_OK;
}

/* Octants are in the tree, and their elements come in the order in which they do. */
static tm_status check_octant(const writer *w, size_t o, uint32_t *elements)
{
    const uint32_t *row = w->octant->integer + OCTANT_NUMBERS * o;
    const uint32_t begin = row[OCTANT_NUMBERS - 2], end = row[OCTANT_NUMBERS - 1];
    const size_t number = o + w->stream->base;
    if (row[0] > w->finest)
        return FAIL(".octant", "row %zu: level %u is finer than the finest, %u", number,
                    row[0], w->finest);
    const uint64_t side = UINT64_C(1) << (w->finest - row[0]);
    for (int i = 0; i < 3; i++) {
        if (row[1 + i] % side != 0)
            return FAIL(".octant", "row %zu: %u is no multiple of its side, %llu", number,
                        row[1 + i], (unsigned long long)side);
        if (row[1 + i] + side >= UINT64_C(1) << TM_OCTANT_BITS)
            return FAIL(".octant",
                        "row %zu: it ends %llu units from the corner (2^%d are "
                        "too many)",
                        number, (unsigned long long)(row[1 + i] + side), TM_OCTANT_BITS);
    }
    if (begin != end && begin != *elements)
        return FAIL(".octant",
                    "row %zu: its elements begin at %zu, but those before end at %zu "
                    "(.oct has them in the order of the octants)",
                    number, begin + (size_t)w->stream->base,
                    *elements + (size_t)w->stream->base);
    *elements += end - begin;
    return TM_OK;
}

static tm_status take_octants(writer *w)
{
    uint32_t elements = 0;
    w->octants = w->octant->count;
    w->box = tm_new(w->octants, sizeof *w->box);
    if (!w->box)
        return tm_fail_memory(w->error);
    for (size_t o = 0; o < w->octants; o++) {
        const uint32_t *row = w->octant->integer + OCTANT_NUMBERS * o;
        tm_status status = check_octant(w, o, &elements);
        if (status != TM_OK)
            return status;
        w->box[o] = (tm_octant_box){{row[1], row[2], row[3]}, w->finest - row[0]};
    }
    if (elements != w->mix->count)
        return FAIL(".octant", "has %u elements of the %zu of .mix", elements,
                    w->mix->count);
    return TM_OK;
}

/* The lattice ---------------------------------------------------------------------- */

static tm_status add_point(writer *w, const double place[3], uint32_t *id)
{
    void *grown = tm_grow(w->grid, &w->point_room, w->points + 1, sizeof *w->grid);
    if (!grown)
        return tm_fail_memory(w->error);
    w->grid = grown;
    if (w->points >= TM_IDS)
        return tm_fail(w->error, TM_ERROR_SYSTEM, "more points than 32 bits can number");
    for (int i = 0; i < 3; i++)
        w->grid[w->points][i] = place[i];
    if (!tm_point_table_join(&w->table, w->grid, (uint32_t)w->points, id))
        return tm_fail_memory(w->error);
    w->points += *id == w->points;
    return TM_OK;
}

static bool is_before(const uint32_t a[3], const uint32_t b[3])
{
    for (int i = 2; i > 0; i--)
        if (a[i] != b[i])
            return a[i] < b[i];
    return a[0] < b[0];
}

/* The first point of all in x, y and z, which is the middle of no edge, for a middle is
 * between two others: it gets the number that stands for none. */
static tm_status add_first_point(writer *w)
{
    const uint32_t *first = w->box[0].anchor;
    uint32_t id;
    for (size_t o = 1; o < w->octants; o++)
        if (is_before(w->box[o].anchor, first))
            first = w->box[o].anchor;
    return add_point(w, (const double[3]){first[0], first[1], first[2]}, &id);
}

static tm_status number_points(writer *w)
{
    w->corner = tm_new(w->octants, sizeof *w->corner);
    if (!w->corner)
        return tm_fail_memory(w->error);
    tm_status status = add_first_point(w);
    for (size_t o = 0; o < w->octants; o++)
        for (int c = 0; c < TM_OCT_CORNERS && status == TM_OK; c++) {
            double place[3];
            for (int i = 0; i < 3; i++)
                place[i] = w->box[o].anchor[i] +
                           ldexp(corner_place[c] >> i & 1, (int)w->box[o].log_side);
            status = add_point(w, place, &w->corner[o][c]);
        }
    return status;
}

/* An edge is known by its middle: where it is along x, the middle is an odd number of
 * halves of its length in x and a multiple of it in y and z, which no other edge's is. */
static tm_status add_edge(writer *w, uint32_t a, uint32_t b)
{
    void *grown = tm_grow(w->edge, &w->edge_room, w->edges + 1, sizeof *w->edge);
    w->edge = grown ? grown : w->edge;
    void *moved = tm_grow(w->middle, &w->middle_room, w->edges + 1, sizeof *w->middle);
    w->middle = moved ? moved : w->middle;
    if (!grown || !moved)
        return tm_fail_memory(w->error);
    if (w->edges >= TM_IDS)
        return tm_fail(w->error, TM_ERROR_SYSTEM, "more edges than 32 bits can number");
    const uint32_t e = (uint32_t)w->edges;
    uint32_t first;
    for (int i = 0; i < 3; i++)
        w->middle[e][i] = (w->grid[a][i] + w->grid[b][i]) / 2;
    if (!tm_point_table_join(&w->known, w->middle, e, &first))
        return tm_fail_memory(w->error);
    if (first != e)
        return TM_OK;
    uint32_t between = tm_point_table_find(&w->table, w->grid, w->middle[e]);
    w->edge[e][0] = a < b ? a : b;
    w->edge[e][1] = a < b ? b : a;
    w->edge[e][2] = between == UINT32_MAX ? 0 : between;
    w->edges++;
    return TM_OK;
}

static tm_status find_edges(writer *w)
{
    const tm_element_shape *hex = &tm_element_shapes[TM_HEX_NODES];
    tm_status status = TM_OK;
    for (size_t o = 0; o < w->octants; o++)
        for (int e = 0; e < hex->edges && status == TM_OK; e++)
            status =
                add_edge(w, w->corner[o][hex->edge[e][0]], w->corner[o][hex->edge[e][1]]);
    return status;
}

static tm_status find_triangles(writer *w)
{
    double(*triangle)[3][3] = tm_new(w->face->count, sizeof *triangle);
    if (!triangle)
        return tm_fail_memory(w->error);
    for (size_t t = 0; t < w->face->count; t++)
        for (int c = 0; c < TRIANGLE; c++) {
            const size_t v = w->face->integer[TRIANGLE * t + (size_t)c];
            const double *xyz = w->node->real + 3 * v;
            for (int i = 0; i < 3; i++)
                triangle[t][c][i] = (xyz[i] - w->low[i]) / w->unit;
        }
    tm_status status = tm_octant_triangles_find(
        &w->meet, w->box, w->octants, (const double(*)[3][3])triangle, w->face->count,
        w->stream->base, w->error);
    free(triangle);
    return status;
}

/* Rows ----------------------------------------------------------------------------- */

static size_t point_room(const void *context, size_t first, size_t past)
{
    (void)context;
    return 3 * (past - first) * TM_NUMBER_ROOM;
}

static char *put_point(const void *context, size_t row, char *to)
{
    const writer *w = context;
    for (int i = 0; i < 3; i++) {
        to = tm_write_double(to, w->low[i] + w->unit * w->grid[row][i]);
        *to++ = i < 2 ? ' ' : '\n';
    }
    return to;
}

static char *put_edge(const void *context, size_t row, char *to)
{
    const uint32_t *edge = ((const writer *)context)->edge[row];
    to = tm_write_uint32(to, edge[0]);
    to = tm_put_number(tm_put_number(to, edge[1]), edge[2]);
    *to++ = '\n';
    return to;
}

static size_t octant_room(const void *context, size_t first, size_t past)
{
    enum { FIXED = TM_OCT_CORNERS + 5 };
    const writer *w = context;
    size_t numbers = FIXED * (past - first);
    for (size_t o = first; o < past; o++)
        numbers += w->meet.count[o];
    return numbers * TM_NUMBER_ROOM;
}

static char *put_octant(const void *context, size_t row, char *to)
{
    const writer *w = context;
    *to++ = '8';
    for (int c = 0; c < TM_OCT_CORNERS; c++)
        to = tm_put_number(to, w->corner[row][c]);
    to = tm_put_number(to, w->octant->integer[OCTANT_NUMBERS * row]);
    if (w->id)
        to = tm_put_number(to, w->id[row]);
    *to++ = '\n';
    to = tm_write_uint32(to, w->meet.count[row]);
    for (size_t i = 0; i < w->meet.count[row]; i++)
        to = tm_put_number(to, w->meet.item[w->meet.start[row] + i]);
    *to++ = '\n';
    return to;
}

static char *put_elements(const void *context, size_t row, char *to)
{
    const uint32_t *octant =
        ((const writer *)context)->octant->integer + OCTANT_NUMBERS * row;
    to = tm_write_uint32(to, octant[OCTANT_NUMBERS - 1] - octant[OCTANT_NUMBERS - 2]);
    *to++ = ' ';
    return to;
}

static tm_status append(writer *w, unsigned threads)
{
    const tm_text_rows points = {w, w->points, point_room, put_point};
    const tm_text_rows edges = {w, w->edges, point_room, put_edge};
    const tm_text_rows octants = {w, w->octants, octant_room, put_octant};
    const tm_text_rows elements = {w, w->octants, point_room, put_elements};
    tm_text_format(w->text, "%zu %zu %zu\n\n", w->points, w->edges, w->octants);
    tm_text_append_rows(w->text, &points, threads);
    tm_text_string(w->text, "\n");
    tm_text_append_rows(w->text, &edges, threads);
    tm_text_string(w->text, "\n");
    tm_text_append_rows(w->text, &octants, threads);
    tm_text_string(w->text, "\nGeometric Transform\n0 0 0\n0 0 0\n\n");
    tm_text_append_rows(w->text, &elements, threads);
    tm_text_string(w->text, "\n");
    return w->text->failed ? tm_fail_memory(w->error) : TM_OK;
}

tm_status tm_oct_write(tm_text *text, const tm_stream *stream, bool ids, unsigned threads,
                       tm_error *error)
{
    writer w = {.stream = stream, .text = text, .error = error};
    tm_status status = find_blocks(&w);
    if (status == TM_OK)
        status = find_tree(&w);
    if (status == TM_OK)
        status = take_octants(&w);
    if (status == TM_OK)
        status = number_points(&w);
    if (status == TM_OK && ids)
        status = tm_octant_ids(&w.id, w.octant, stream->base, error);
    if (status == TM_OK)
        status = find_edges(&w);
    if (status == TM_OK)
        status = find_triangles(&w);
    if (status == TM_OK)
        status = append(&w, threads);
    free(w.box);
    free(w.id);
    free(w.corner);
    free(w.grid);
    free(w.edge);
    free(w.middle);
    tm_point_table_free(&w.known);
    tm_point_table_free(&w.table);
    tm_octant_triangles_free(&w.meet);
    return status;
}
