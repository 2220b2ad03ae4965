/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_format.h"

#include "../base/array.h"
#include "../base/ids.h"
#include "../element/shape.h"
#include "../mesh/cell_faces.h"
#include "scan.h"
#include "text_rows.h"

#include <stdlib.h>
#include <string.h>

enum { COORDINATES = 3, NODES_MAX = 8, WEDGE = 6, CONSTANTS = 3 };

static const char material[] = " 1000.0 0.45 1.0";
static const double constant[CONSTANTS] = {1000, 0.45, 1};

/* The letter of an element of k nodes. */
static const char letter_of[NODES_MAX + 1] = {
    [4] = 'T', [5] = 'P', [WEDGE] = 'R', [NODES_MAX] = 'H'};

/* The node i of an element of k nodes is this one in .mix, and back: wedges turn the
 * other way here. */
static size_t node_of(size_t k, size_t i)
{
    return k == WEDGE ? tm_element_shapes[WEDGE].mirror[i] : i;
}

/* Reading -------------------------------------------------------------------------- */

typedef enum m3d_form { M3D, MVM } m3d_form;

typedef struct reader {
    tm_scan scan;
    m3d_form form;
    bool has_nodes, has_elements;
    size_t nodes, node_room;
    double (*xyz)[COORDINATES];
    size_t elements, element_room;
    size_t *start; /* [elements + 1] */
    size_t item_room;
    uint32_t *item;
    size_t materials;
    tm_error *error;
} reader;

static tm_status read_node(reader *r)
{
    if (r->nodes >= TM_IDS)
        return tm_scan_fail(&r->scan, r->error, "more nodes than 32 bits can number");
    void *grown = tm_grow(r->xyz, &r->node_room, r->nodes + 1, sizeof *r->xyz);
    if (!grown)
        return tm_fail_memory(r->error);
    r->xyz = grown;
    tm_status status = TM_OK;
    double flag;
    if (r->form == M3D)
        status =
            tm_scan_next_double(&r->scan, "the number before a node", &flag, r->error);
    for (int i = 0; i < COORDINATES && status == TM_OK; i++)
        status =
            tm_scan_next_double(&r->scan, "a coordinate", &r->xyz[r->nodes][i], r->error);
    r->nodes++;
    return status;
}

static tm_status read_nodes(reader *r, int64_t count)
{
    tm_status status = TM_OK;
    for (int64_t v = 0; v < count && status == TM_OK; v++)
        status = read_node(r);
    r->has_nodes = true;
    return status;
}

/* How many nodes the next word is a letter for; 0 where it is none. */
static size_t read_letter(reader *r)
{
    tm_scan_seek(&r->scan);
    tm_word word = tm_scan_word(&r->scan);
    for (size_t k = 1; k <= NODES_MAX && word.size == 1; k++)
        if (letter_of[k] != '\0' && letter_of[k] == *word.begin)
            return k;
    tm_scan_fail(&r->scan, r->error,
                 word.size > 0 ? "'%.*s' is no element (T, P, R or H)"
                               : "the file ends where an element should be%.*s",
                 tm_word_shown(word), word.begin);
    return 0;
}

static tm_status read_material(reader *r)
{
    bool differs = false;
    for (int i = 0; i < CONSTANTS; i++) {
        double value;
        tm_status status =
            tm_scan_next_double(&r->scan, "a constant of the material", &value, r->error);
        if (status != TM_OK)
            return status;
        differs |= value != constant[i];
    }
    r->materials += differs;
    return TM_OK;
}

static tm_status read_element(reader *r)
{
    size_t e = r->elements, begin = r->start[e];
    size_t *start = tm_grow(r->start, &r->element_room, e + 2, sizeof *r->start);
    r->start = start ? start : r->start;
    uint32_t *item = tm_grow(r->item, &r->item_room, begin + NODES_MAX, sizeof *r->item);
    r->item = item ? item : r->item;
    if (!start || !item)
        return tm_fail_memory(r->error);
    size_t k = read_letter(r);
    if (k == 0)
        return TM_ERROR_INPUT;
    for (size_t i = 0; i < k; i++) {
        int64_t node;
        tm_status status =
            tm_scan_next_integer(&r->scan, "node", 0, UINT32_MAX - 1, &node, r->error);
        if (status != TM_OK)
            return status;
        item[begin + node_of(k, i)] = (uint32_t)node;
    }
    start[e + 1] = begin + k;
    r->elements++;
    return r->form == M3D ? read_material(r) : TM_OK;
}

static tm_status read_elements(reader *r, int64_t count)
{
    if (count >= TM_IDS)
        return tm_scan_fail(&r->scan, r->error, "more elements than 32 bits can number");
    tm_status status = TM_OK;
    for (int64_t e = 0; e < count && status == TM_OK; e++)
        status = read_element(r);
    r->has_elements = true;
    return status;
}

static tm_status read_count(reader *r, const char *what, int64_t *count)
{
    return tm_scan_next_integer(&r->scan, what, 0, INT64_MAX, count, r->error);
}

/* A section that is known, or nothing where `word` begins none. */
static tm_status read_section(reader *r, tm_word word)
{
    int64_t count;
    bool nodes = tm_word_is(word, "[Nodes,"), elements = tm_word_is(word, "[Elements,");
    if (!nodes && !elements)
        return TM_OK;
    if (nodes ? r->has_nodes : r->has_elements)
        return tm_scan_fail(&r->scan, r->error, "a second section %.*s",
                            tm_word_shown(word) - 2, word.begin + 1);
    tm_scan_end_line(&r->scan);
    tm_status status = read_count(r, "the number of rows", &count);
    if (status != TM_OK)
        return status;
    return nodes ? read_nodes(r, count) : read_elements(r, count);
}

static tm_status read_mvm(reader *r)
{
    int64_t nodes, elements;
    tm_status status = read_count(r, "the number of nodes", &nodes);
    if (status == TM_OK)
        status = read_count(r, "the number of elements", &elements);
    if (status == TM_OK)
        status = read_nodes(r, nodes);
    if (status == TM_OK)
        status = read_elements(r, elements);
    if (status == TM_OK && tm_scan_seek(&r->scan))
        status = tm_scan_no_more(&r->scan, "the last element", r->error);
    return status;
}

static tm_status read_all(reader *r)
{
    if (!tm_scan_seek(&r->scan))
        return tm_scan_fail(&r->scan, r->error, "is empty");
    tm_word word = tm_scan_word(&r->scan);
    if (tm_word_is(word, "MIXED")) {
        r->form = MVM;
        return read_mvm(r);
    }
    if (*word.begin != '[')
        return tm_scan_fail(&r->scan, r->error,
                            "begins with neither a section such as [Nodes, "
                            "ARRAY1<STRING>] nor MIXED");
    tm_status status = read_section(r, word);
    while (status == TM_OK && tm_scan_seek(&r->scan))
        status = read_section(r, tm_scan_word(&r->scan));
    if (status == TM_OK && !(r->has_nodes && r->has_elements))
        return tm_fail_at(r->error, TM_ERROR_INPUT, r->scan.name, 0, NULL,
                          "has no section [%s, ARRAY1<STRING>]",
                          r->has_nodes ? "Elements" : "Nodes");
    return status;
}

static tm_status check_items(const reader *r)
{
    for (size_t e = 0; e < r->elements; e++)
        for (size_t i = r->start[e]; i < r->start[e + 1]; i++)
            if (r->item[i] >= r->nodes)
                return tm_fail_at(r->error, TM_ERROR_INPUT, r->scan.name, 0, NULL,
                                  "element %zu: node %u is out of range (below %zu)", e,
                                  r->item[i], r->nodes);
    return TM_OK;
}

/* The arrays become those of the blocks. */
static tm_status give(reader *r, tm_stream *stream)
{
    stream->base = 0;
    tm_block *node = tm_stream_add(stream, ".node");
    if (!node)
        return tm_fail_memory(r->error);
    node->count = r->nodes;
    node->real = r->xyz ? (double *)r->xyz : tm_new(0, 1);
    r->xyz = NULL;
    tm_block *mix = tm_stream_add(stream, ".mix");
    if (!mix)
        return tm_fail_memory(r->error);
    mix->count = r->elements;
    mix->start = r->start;
    mix->item = r->item ? r->item : tm_new(0, 1);
    r->start = NULL;
    r->item = NULL;
    return TM_OK;
}

tm_status tm_m3d_read(tm_stream *stream, const char *bytes, size_t size, const char *name,
                      size_t *materials, tm_error *error)
{
    reader r = {.form = M3D, .error = error, .element_room = 1};
    r.start = calloc(1, sizeof *r.start);
    if (!r.start)
        return tm_fail_memory(error);
    tm_scan_begin(&r.scan, bytes, size, name, '\0');
    tm_status status = read_all(&r);
    if (status == TM_OK)
        status = check_items(&r);
    if (status == TM_OK)
        status = give(&r, stream);
    if (status != TM_OK)
        tm_stream_free(stream);
    *materials = r.materials;
    free(r.xyz);
    free(r.start);
    free(r.item);
    return status;
}

/* Writing -------------------------------------------------------------------------- */

typedef struct elements {
    const tm_block *block;
    const char *after;
} elements;

static size_t room(const void *context, size_t first, size_t past)
{
    (void)context;
    return (past - first) * (2 + sizeof material + NODES_MAX * TM_NUMBER_ROOM);
}

static char *put_element(const void *context, size_t row, char *to)
{
    const elements *all = context;
    size_t k, length = strlen(all->after);
    const uint32_t *node = tm_row_nodes(all->block, row, &k);
    *to++ = letter_of[k];
    for (size_t i = 0; i < k; i++)
        to = tm_put_number(to, node[node_of(k, i)]);
    memcpy(to, all->after, length);
    to += length;
    *to++ = '\n';
    return to;
}

static tm_status write_form(tm_text *text, const tm_stream *stream, m3d_form form,
                            unsigned threads, tm_error *error)
{
    tm_content content = tm_content_of(stream);
    if (content != TM_CONTENT_MIXED && content != TM_CONTENT_TETRAHEDRA)
        return tm_fail(error, TM_ERROR_INPUT, "has no elements (.mix or .ele)");
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *block = tm_content_block(stream, content);
    elements all = {block, form == M3D ? material : ""};
    const tm_text_rows rows = {&all, block->count, room, put_element};
    if (form == M3D)
        tm_text_format(text, "[Nodes, ARRAY1<STRING>]\n%zu\n\n", node->count);
    else
        tm_text_format(text, "MIXED\n%zu %zu\n\n", node->count, block->count);
    tm_text_append_points(text, node->real, node->count, form == M3D ? "1 " : "",
                          threads);
    if (form == M3D)
        tm_text_format(text, "\n[Elements, ARRAY1<STRING>]\n%zu\n\n", block->count);
    tm_text_append_rows(text, &rows, threads);
    return text->failed ? tm_fail_memory(error) : TM_OK;
}

tm_status tm_m3d_write(tm_text *text, const tm_stream *stream, unsigned threads,
                       tm_error *error)
{
    return write_form(text, stream, M3D, threads, error);
}

tm_status tm_mvm_write(tm_text *text, const tm_stream *stream, unsigned threads,
                       tm_error *error)
{
    return write_form(text, stream, MVM, threads, error);
}
