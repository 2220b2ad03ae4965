/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_piece.h"

#include "../../base/array.h"
#include "../../mesh/cell_faces.h"
#include "../../ranks/ranks.h"
#include "vtk_grid.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 3 };
static const char *const part_name[PARTS] = {".face", ".facet", ".edge"};

/* Marked rows of a part, with the nodes of the whole. */
typedef struct {
    size_t rows, items;
    uint32_t *length; /* [rows] */
    uint32_t *item;
    int32_t *marker; /* [rows] */
    double *owner;   /* [rows]: the first cell that has all its nodes, INFINITY of none */
} marked;

typedef struct {
    tm_slices *slices;
    tm_stream *piece;
    tm_content content;
    tm_slice slice; /* of the cells */
    size_t cell;    /* their block of the piece; .node for points */
    marked part[PARTS];
    tm_error *error;
} maker;

/* What tm_content_of() says of the whole. */
static tm_content content_of(const tm_slices *slices)
{
    static const char *const block[] = {[TM_CONTENT_POINTS] = ".node",
                                        [TM_CONTENT_SURFACE] = ".face",
                                        [TM_CONTENT_TETRAHEDRA] = ".ele",
                                        [TM_CONTENT_MIXED] = ".mix",
                                        [TM_CONTENT_POLYHEDRA] = ".cell"};
    tm_content content = TM_CONTENT_POLYHEDRA;
    tm_slice slice = {0, 0};
    while (content > TM_CONTENT_NOTHING &&
           (!tm_slices_find(slices, block[content], &slice) || slice.total == 0))
        content--;
    return content;
}

/* Puts a block of the slices into the piece; it leaves an empty one. */
static tm_block *take(maker *m, const char *name, tm_slice *slice)
{
    tm_block *from = tm_slices_find(m->slices, name, slice);
    tm_block *to = tm_stream_add(m->piece, name);
    if (!from || !to)
        return NULL;
    *to = *from;
    const tm_block empty = {.kind = from->kind};
    char kept[TM_BLOCK_NAME];
    memcpy(kept, from->name, sizeof kept);
    *from = empty;
    memcpy(from->name, kept, sizeof kept);
    return to;
}

static const tm_block *cells_of(const maker *m)
{
    return &m->piece->block[m->cell];
}

/* Marked rows ----------------------------------------------------------------------- */

static tm_status share(void **array, size_t count, size_t size, size_t *total,
                       tm_error *error)
{
    void *all;
    const tm_status status = tm_ranks_share(*array, count, size, &all, total, error);
    free(*array);
    *array = all;
    return status;
}

static bool collect_own(marked *p, const tm_block *block)
{
    size_t room = 0;
    p->length = tm_new(block->count, sizeof *p->length);
    p->marker = tm_new(block->count, sizeof *p->marker);
    for (size_t r = 0, k; p->length && p->marker && r < block->count; r++) {
        if (block->marker[r] == 0)
            continue;
        const uint32_t *node = tm_row_nodes(block, r, &k);
        uint32_t *grown = tm_grow(p->item, &room, p->items + k, sizeof *grown);
        if (!grown)
            return false;
        p->item = grown;
        memcpy(grown + p->items, node, k * sizeof *node);
        p->items += k;
        p->marker[p->rows] = block->marker[r];
        p->length[p->rows++] = (uint32_t)k;
    }
    return p->length && p->marker;
}

/* Those of all ranks, on each. */
static tm_status collect(maker *m, int part)
{
    tm_slice slice;
    marked *p = &m->part[part];
    const tm_block *block = tm_slices_find(m->slices, part_name[part], &slice);
    const bool facets_of_none = part == 1 && m->content != TM_CONTENT_MIXED;
    const bool is_content = part == 0 && m->content == TM_CONTENT_SURFACE;
    if (!block || !block->markers || facets_of_none || is_content)
        return TM_OK;
    tm_status status = tm_ranks_enough(collect_own(p, block), m->error);
    size_t rows = p->rows;
    if (status == TM_OK)
        status = share((void **)&p->length, p->rows, sizeof *p->length, &rows, m->error);
    if (status == TM_OK)
        status = share((void **)&p->marker, p->rows, sizeof *p->marker, NULL, m->error);
    if (status == TM_OK)
        status = share((void **)&p->item, p->items, sizeof *p->item, &p->items, m->error);
    p->rows = rows;
    return status;
}

/* A cell of the piece that has a node of the whole. */
typedef struct {
    uint32_t node, row;
} row_at;

static int compare_rows(const void *a, const void *b)
{
    const row_at *p = a, *q = b;
    if (p->node != q->node)
        return p->node < q->node ? -1 : 1;
    return (p->row > q->row) - (p->row < q->row);
}

static row_at *list_rows(const tm_block *block, size_t *count)
{
    size_t k = 0;
    *count = 0;
    for (size_t r = 0; r < block->count; r++) {
        tm_row_nodes(block, r, &k);
        *count += k;
    }
    row_at *at = tm_new(*count, sizeof *at);
    row_at *to = at;
    for (size_t r = 0; at && r < block->count; r++) {
        const uint32_t *node = tm_row_nodes(block, r, &k);
        for (size_t i = 0; i < k; i++)
            *to++ = (row_at){node[i], (uint32_t)r};
    }
    if (at)
        qsort(at, *count, sizeof *at, compare_rows);
    return at;
}

/* The first row with all these nodes, or TM_NONE. */
static uint32_t row_with(const tm_block *block, const row_at *at, size_t count,
                         const uint32_t *wanted, size_t nodes)
{
    size_t begin = 0, end = count, k;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (at[middle].node < *wanted)
            begin = middle + 1;
        else
            end = middle;
    }
    for (; begin < count && at[begin].node == *wanted; begin++) {
        const uint32_t *node = tm_row_nodes(block, at[begin].row, &k);
        if (tm_vtk_has_all(node, k, wanted, nodes))
            return at[begin].row;
    }
    return TM_NONE;
}

/* Which cell has a marked row first, of this rank's. Of points none has. */
static bool find_own_owners(maker *m, marked *p)
{
    size_t count = 0;
    const bool points = m->content == TM_CONTENT_POINTS;
    row_at *at = points ? tm_new(0, sizeof *at) : list_rows(cells_of(m), &count);
    p->owner = tm_new(p->rows, sizeof *p->owner);
    const uint32_t *item = p->item;
    for (size_t r = 0; at && p->owner && r < p->rows; item += p->length[r++]) {
        const uint32_t row = row_with(cells_of(m), at, count, item, p->length[r]);
        p->owner[r] = row == TM_NONE ? INFINITY : (double)(m->slice.before + row);
    }
    free(at);
    return at && p->owner;
}

static tm_status find_owners(maker *m, marked *p)
{
    if (p->rows == 0)
        return TM_OK;
    const tm_status status = tm_ranks_enough(find_own_owners(m, p), m->error);
    if (status == TM_OK)
        tm_ranks_least(p->owner, p->rows);
    return status;
}

static bool is_own(const maker *m, double owner)
{
    if (owner == INFINITY)
        return tm_rank() == 0;
    return owner >= (double)m->slice.before &&
           owner < (double)(m->slice.before + cells_of(m)->count);
}

/* The rows that are this rank's, as a block of the piece. */
static bool add_marked(maker *m, int part)
{
    const marked *p = &m->part[part];
    size_t rows = 0, items = 0;
    for (size_t r = 0; r < p->rows; r++)
        if (is_own(m, p->owner[r])) {
            rows++;
            items += p->length[r];
        }
    if (p->rows == 0)
        return true;
    tm_block *block = tm_stream_add(m->piece, part_name[part]);
    if (!block)
        return false;
    block->markers = true;
    if (tm_block_allocate(block, rows, items, NULL) != TM_OK)
        return false;
    const uint32_t *item = p->item;
    size_t at = 0, to = 0;
    for (size_t r = 0; r < p->rows; item += p->length[r++]) {
        if (!is_own(m, p->owner[r]))
            continue;
        uint32_t *node = block->start ? block->item : block->integer;
        memcpy(node + to, item, p->length[r] * sizeof *node);
        to += p->length[r];
        block->marker[at++] = p->marker[r];
        if (block->start) {
            block->start[at] = to;
            block->integer[2 * at - 2] = 0;
            block->integer[2 * at - 1] = TM_NONE;
        }
    }
    return true;
}

static tm_status add_all_marked(maker *m)
{
    tm_status status = TM_OK;
    bool done = true;
    for (int part = 0; part < PARTS && status == TM_OK; part++) {
        status = collect(m, part);
        if (status == TM_OK)
            status = find_owners(m, &m->part[part]);
        done = done && status == TM_OK && add_marked(m, part);
        free(m->part[part].length);
        free(m->part[part].item);
        free(m->part[part].marker);
        free(m->part[part].owner);
        m->part[part] = (marked){0};
    }
    return status == TM_OK ? tm_ranks_enough(done, m->error) : status;
}

/* Nodes ----------------------------------------------------------------------------- */

/* Where a block names nodes. */
static uint32_t *items_of(tm_block *block, size_t *count)
{
    *count = block->start ? block->start[block->count]
                          : block->count * tm_block_integers(block->kind);
    return block->start ? block->item : block->integer;
}

static bool names_nodes(const tm_block *block)
{
    return block->kind == TM_ELE || block->kind == TM_FACE || block->kind == TM_EDGE ||
           block->kind == TM_MIX || block->kind == TM_FACET;
}

/* All nodes that the piece names; from the list to the blocks where `back`. */
static void copy_items(const tm_stream *piece, uint32_t *list, bool back)
{
    for (size_t b = 0; b < piece->blocks; b++) {
        size_t count;
        if (!names_nodes(&piece->block[b]))
            continue;
        uint32_t *item = items_of(&piece->block[b], &count);
        if (count > 0 && item && list)
            memcpy(back ? item : list, back ? list : item, count * sizeof *item);
        list += count;
    }
}

/* An array of .node, of the nodes with these numbers. */
static tm_status fetch(const maker *m, void **array, const void *own, size_t size,
                       size_t total, const uint32_t *number, size_t count)
{
    *array = tm_new(count, size);
    const tm_status status = tm_ranks_enough(*array != NULL, m->error);
    return status == TM_OK
               ? tm_slices_fetch(own, total, size, number, count, *array, m->error)
               : status;
}

static tm_status add_nodes(maker *m)
{
    tm_slice slice = {0, 0};
    size_t items = 0, count, nodes = 0;
    uint32_t *number = NULL;
    for (size_t b = 0; b < m->piece->blocks; b++)
        if (names_nodes(&m->piece->block[b])) {
            items_of(&m->piece->block[b], &count);
            items += count;
        }
    uint32_t *list = tm_new(items, sizeof *list);
    tm_status status = tm_ranks_enough(list != NULL, m->error);
    if (status == TM_OK) {
        copy_items(m->piece, list, false);
        status = tm_ranks_agree(
            tm_slices_localize(list, items, &number, &nodes, m->error), m->error);
    }
    if (status == TM_OK)
        copy_items(m->piece, list, true);
    free(list);
    const tm_block *from = tm_slices_find(m->slices, ".node", &slice);
    tm_block *node = tm_stream_find(m->piece, ".node");
    node->count = nodes;
    if (status == TM_OK && from) {
        void *real, *attribute = NULL, *marker = NULL;
        node->attributes = from->attributes;
        node->markers = from->markers;
        status =
            fetch(m, &real, from->real, 3 * sizeof(double), slice.total, number, nodes);
        if (status == TM_OK && from->attributes > 0)
            status = fetch(m, &attribute, from->attribute,
                           from->attributes * sizeof(double), slice.total, number, nodes);
        if (status == TM_OK && from->markers)
            status = fetch(m, &marker, from->marker, sizeof(int32_t), slice.total, number,
                           nodes);
        node->real = real;
        node->attribute = attribute;
        node->marker = marker;
    }
    free(number);
    return status;
}

/* Octants and names ----------------------------------------------------------------- */

enum { LEVEL = 0, BEGIN = 4, END = 5, INTEGERS = 6 };

/* The octants that have some of a rank's elements go to it. */
static tm_status send_octants(const maker *m, const tm_block *from, size_t total,
                              uint32_t (**got)[INTEGERS], size_t *count)
{
    const unsigned ranks = tm_ranks_count();
    size_t *send = calloc((size_t)ranks + 1, sizeof *send), room = 0, octants = 0;
    uint32_t(*list)[INTEGERS] = NULL;
    bool done = send != NULL;
    for (unsigned r = 0; r < ranks && done; r++) {
        const size_t first = tm_slice_first(total, ranks, r);
        const size_t past = tm_slice_first(total, ranks, r + 1);
        for (size_t o = 0; o < from->count && done; o++) {
            const uint32_t *row = from->integer + INTEGERS * o;
            if (row[BEGIN] >= past || row[END] <= first)
                continue;
            void *grown = tm_grow(list, &room, octants + 1, sizeof *list);
            done = grown != NULL;
            list = done ? grown : list;
            if (done)
                memcpy(list[octants++], row, sizeof *list);
            send[r]++;
        }
    }
    void *all = NULL;
    tm_status status = tm_ranks_enough(done, m->error);
    if (status == TM_OK)
        status = tm_ranks_exchange(list, send, sizeof *list, &all, send, m->error);
    *count = 0;
    for (unsigned r = 0; r < ranks && status == TM_OK; r++)
        *count += send[r];
    *got = all;
    free(list);
    free(send);
    return status;
}

static tm_status add_octants(maker *m)
{
    tm_slice slice;
    size_t count;
    uint32_t(*octant)[INTEGERS];
    const tm_block *from = tm_slices_find(m->slices, ".octant", &slice);
    if (!from || m->content != TM_CONTENT_MIXED)
        return TM_OK;
    const tm_status status = send_octants(m, from, m->slice.total, &octant, &count);
    if (status != TM_OK)
        return status;
    tm_block *block = tm_stream_add(m->piece, ".octant");
    const size_t first = m->slice.before, past = first + cells_of(m)->count;
    for (size_t o = 0; o < count; o++) {
        const uint32_t *row = octant[o];
        octant[o][BEGIN] = (uint32_t)((row[BEGIN] > first ? row[BEGIN] : first) - first);
        octant[o][END] = (uint32_t)((row[END] < past ? row[END] : past) - first);
    }
    if (block) {
        block->count = count;
        block->integer = (uint32_t *)octant;
    } else {
        free(octant);
    }
    return tm_ranks_enough(block != NULL, m->error);
}

/* Names are in rank 0's piece. */
static tm_status add_names(maker *m)
{
    tm_slice slice;
    const bool has = tm_rank() == 0 && tm_slices_find(m->slices, ".group", &slice);
    return tm_ranks_enough(!has || take(m, ".group", &slice) != NULL, m->error);
}

/* The cells; of points this rank's slice of .node is all that there is. */
static tm_status add_cells(maker *m)
{
    const char *name = m->content == TM_CONTENT_SURFACE ? ".face" : ".mix";
    const bool points = m->content <= TM_CONTENT_POINTS;
    m->cell = points ? 0 : 1;
    if (m->content == TM_CONTENT_TETRAHEDRA)
        name = ".ele";
    const bool done = (points || tm_stream_add(m->piece, ".node")) &&
                      take(m, points ? ".node" : name, &m->slice);
    return tm_ranks_enough(done, m->error);
}

tm_status tm_vtk_piece_make(tm_stream *piece, tm_slices *slices,
                            const tm_vtk_options *options, tm_error *error)
{
    maker m = {
        .slices = slices, .piece = piece, .content = content_of(slices), .error = error};
    piece->base = slices->stream.base;
    tm_status status = add_cells(&m);
    if (status == TM_OK && options->boundary && m.content != TM_CONTENT_POINTS)
        status = add_all_marked(&m);
    if (status == TM_OK && m.content != TM_CONTENT_POINTS)
        status = add_nodes(&m);
    if (status == TM_OK)
        status = add_octants(&m);
    if (status == TM_OK)
        status = add_names(&m);
    if (status != TM_OK)
        tm_stream_free(piece);
    return status;
}

/* The file of all pieces ------------------------------------------------------------ */

/* Appends the arrays of a section of one piece, as those that each piece has. */
static void put_section(tm_text *text, const char *vtu, const char *name)
{
    static const char array[] = "        <DataArray ";
    char begin[64], end[64];
    snprintf(begin, sizeof begin, "      <%s>\n", name);
    snprintf(end, sizeof end, "      </%s>\n", name);
    const char *at = strstr(vtu, begin);
    const char *past = at ? strstr(at, end) : NULL;
    tm_text_format(text, "    <P%s>\n", name);
    for (at = past ? strstr(at, array) : NULL; at && at < past; at = strstr(at, array)) {
        at += sizeof array - 1;
        const char *what = strstr(at, "format=");
        tm_text_string(text, "      <PDataArray ");
        tm_text_append(text, at, (size_t)(what - at));
        tm_text_string(text, "/>\n");
    }
    tm_text_format(text, "    </P%s>\n", name);
}

/* A name in the quotes of XML. */
static void put_name(tm_text *text, const char *name)
{
    static const char *const named[] = {
        ['&'] = "&amp;", ['<'] = "&lt;", ['>'] = "&gt;", ['"'] = "&quot;"};
    for (; *name; name++) {
        const unsigned char c = (unsigned char)*name;
        if (c < sizeof named / sizeof *named && named[c])
            tm_text_string(text, named[c]);
        else
            tm_text_append(text, name, 1);
    }
}

tm_status tm_pvtu_write(tm_text *text, const tm_text *vtu, const char *const *source,
                        size_t pieces, tm_error *error)
{
    tm_text_string(text, "<?xml version=\"1.0\"?>\n"
                         "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" "
                         "byte_order=\"LittleEndian\" header_type=\"UInt64\" "
                         "compressor=\"vtkZLibDataCompressor\">\n"
                         "  <PUnstructuredGrid GhostLevel=\"0\">\n");
    put_section(text, vtu->byte, "PointData");
    put_section(text, vtu->byte, "CellData");
    put_section(text, vtu->byte, "Points");
    for (size_t i = 0; i < pieces; i++) {
        tm_text_string(text, "    <Piece Source=\"");
        put_name(text, source[i]);
        tm_text_string(text, "\"/>\n");
    }
    tm_text_string(text, "  </PUnstructuredGrid>\n</VTKFile>\n");
    return text->failed ? tm_fail_memory(error) : TM_OK;
}
