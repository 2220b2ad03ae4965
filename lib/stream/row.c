/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One row of a block from text. Most of a mesh is small whole numbers with one blank
 * between them: those are read eight bytes at a time. */
#include "row.h"

#include "../base/array.h"
#include "../number/digits.h"
#include "../number/number.h"
#include "block.h"
#include "group_names.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

bool tm_row_reserve(tm_row_context *c, size_t more)
{
    enum { FIRST = 1024 };
    const size_t left = c->rows - c->block->count;
    const size_t needed = c->block->count + (more < left ? more : left);
    if (needed <= c->room)
        return true;
    size_t room = 2 * c->room + FIRST;
    room = room < needed ? needed : room;
    room = room < c->rows ? room : c->rows;
    if (!tm_block_resize(c->block, room))
        return false;
    c->room = room;
    return true;
}

bool tm_row_begins(const char *at)
{
    while (tm_is_blank(*at))
        at++;
    return isdigit((unsigned char)*at) || *at == '-' || *at == '+';
}

/* The number of the row that is read. */
static inline size_t number_of_row(const tm_row_context *c)
{
    return c->block->count + c->before + c->base;
}

/* The field at `at`, for a message. */
static const char *field(const char *at, char text[TM_QUOTE_CHARS])
{
    tm_lines_quote(at, text);
    text[strcspn(text, " ")] = '\0';
    return text;
}

#define FAIL(c, ...) (tm_fail(&(c)->problem, TM_ERROR_INPUT, __VA_ARGS__), (char *)NULL)

/* Says why no number, or not all of the field, could be read. */
static const char *fail_field(tm_row_context *c, const char *at, const char *what)
{
    char text[TM_QUOTE_CHARS];
    size_t row = number_of_row(c);
    if (*at == '\n')
        return FAIL(c, "row %zu ends before its %s", row, what);
    if (*at == '\r')
        return FAIL(c, "the line ends in CR LF (LF alone; the importers take CR)");
    if (*at == '#')
        return FAIL(c, "a comment behind a row's numbers (on a line of its own)");
    return FAIL(c, "row %zu: '%s' is not a %s", row, field(at, text), what);
}

/* Reads one to seven digits that a blank or the line's end follows: the usual case.
 * Returns what follows them, or NULL for anything else. */
static inline const char *short_number(const char *at, uint64_t *value)
{
    uint64_t word = tm_word_load(at);
    int digits = tm_word_digits(word);
    if (digits == 0 || digits == TM_WORD_BYTES || (unsigned char)at[digits] > ' ')
        return NULL;
    *value = tm_word_value(word, digits);
    return at + digits;
}

/* A whole number of any length, after blanks. */
static inline const char *whole(tm_row_context *c, const char *at, const char *end,
                                int64_t *value, const char *what)
{
    while (tm_is_blank(*at))
        at++;
    uint64_t small;
    const char *after = short_number(at, &small);
    if (after) {
        *value = (int64_t)small;
        return after;
    }
    after = tm_read_int64(at, end, value);
    if (!after || (*after != '\n' && !tm_is_blank(*after)))
        return fail_field(c, after && *after <= ' ' ? after : at, what);
    return after;
}

static inline const char *index_of(tm_row_context *c, const char *at, const char *end,
                                   uint32_t *index)
{
    int64_t number;
    at = whole(c, at, end, &number, "node number");
    if (!at)
        return NULL;
    uint64_t zero_based = (uint64_t)number - c->base;
    if (zero_based >= c->limit) {
        if (c->limit == 0)
            return FAIL(c, "node %lld is out of range (there are none)",
                        (long long)number);
        return FAIL(c, "node %lld is out of range (%u..%zu)", (long long)number, c->base,
                    c->limit - 1 + c->base);
    }
    *index = (uint32_t)zero_based;
    return at;
}

/* An index into another block, checked when that is read; -1 where it may be none. */
static const char *reference(tm_row_context *c, const char *at, const char *end,
                             bool may_be_none, uint32_t *index)
{
    int64_t number;
    at = whole(c, at, end, &number, "number");
    if (!at)
        return NULL;
    if (may_be_none && number == -1) {
        *index = TM_NONE;
        return at;
    }
    number -= c->base;
    if (number < 0 || number >= TM_NONE)
        return FAIL(c, "row %zu: %lld is out of range", number_of_row(c),
                    (long long)(number + c->base));
    *index = (uint32_t)number;
    return at;
}

static const char *reals(tm_row_context *c, const char *at, const char *end, double *real,
                         size_t count)
{
    char text[TM_QUOTE_CHARS];
    for (size_t i = 0; i < count; i++) {
        while (tm_is_blank(*at))
            at++;
        const char *after = tm_read_double(at, end, &real[i]);
        if (!after || (*after != '\n' && !tm_is_blank(*after)))
            return fail_field(c, after && *after < ' ' ? after : at, "finite number");
        if (!isfinite(real[i]))
            return FAIL(c, "row %zu: '%s' is too large for a double", number_of_row(c),
                        field(at, text));
        at = after;
    }
    return at;
}

/* The dimension of a row of .group; the other integer, where its name is, comes with
 * that. */
static const char *dimension(tm_row_context *c, const char *at, const char *end,
                             uint32_t *to)
{
    int64_t number;
    at = whole(c, at, end, &number, "dimension");
    if (at && (number < 0 || number >= TM_GROUP_DIMENSIONS))
        return FAIL(c,
                    "row %zu: %lld is no dimension (0 nodes, 1 edges, 2 faces, 3 "
                    "regions)",
                    number_of_row(c), (long long)number);
    *to = (uint32_t)number;
    return at;
}

/* The fixed integers of a row of .octant, .root and .facet. */
static const char *mixed_integers(tm_row_context *c, const char *at, const char *end,
                                  uint32_t *to, size_t width)
{
    tm_block_kind kind = c->block->kind;
    unsigned base = c->base;
    for (size_t i = 0; i < width && at; i++) {
        bool plain = kind == TM_ROOT || (kind == TM_OCTANT && i < TM_OCTANT_PLAIN);
        c->base = plain ? 0 : base;
        at = reference(c, at, end, kind == TM_FACET && i == 1, &to[i]);
        c->base = base;
    }
    return at;
}

/* The fixed integers of a row: of most kinds they are nodes. */
static inline const char *integers(tm_row_context *c, const char *at, const char *end,
                                   size_t width)
{
    tm_block_kind kind = c->block->kind;
    uint32_t *to = c->block->integer + c->block->count * width;
    if (kind == TM_GROUP)
        return dimension(c, at, end, to);
    if (kind != TM_ELE && kind != TM_FACE && kind != TM_EDGE)
        return mixed_integers(c, at, end, to, width);
    for (size_t i = 0; i < width && at; i++)
        at = index_of(c, at, end, &to[i]);
    return at;
}

/* k and k indices. An element of .mix has 4, 5, 6 or 8 nodes, a facet 3, a cell 4. */
static const char *list(tm_row_context *c, const char *at, const char *end)
{
    tm_block *block = c->block;
    int64_t count;
    at = whole(c, at, end, &count, "count");
    if (!at)
        return NULL;
    bool is_element = count == 4 || count == 5 || count == 6 || count == 8;
    if (block->kind == TM_MIX && !is_element)
        return FAIL(c, "row %zu: an element of %lld nodes (4, 5, 6 or 8)",
                    block->count + c->base, (long long)count);
    int64_t least = block->kind == TM_FACET ? 3 : 4;
    if (count < least || count > end - at)
        return FAIL(c, "row %zu: a list of %lld (%lld or more, all on the line)",
                    block->count + c->base, (long long)count, (long long)least);
    const size_t begin = c->items;
    uint32_t *item =
        tm_grow(block->item, &c->item_room, begin + (size_t)count, sizeof *item);
    if (!item) {
        tm_fail_memory(&c->problem);
        return NULL;
    }
    block->item = item;
    for (size_t i = 0; i < (size_t)count && at; i++)
        at = block->kind == TM_CELL ? reference(c, at, end, false, &item[begin + i])
                                    : index_of(c, at, end, &item[begin + i]);
    block->start[block->count + 1] = c->items = begin + (size_t)count;
    return at;
}

static const char *marker(tm_row_context *c, const char *at, const char *end)
{
    int64_t number;
    at = whole(c, at, end, &number, "marker");
    if (at && (number < INT32_MIN || number > INT32_MAX))
        return FAIL(c, "row %zu: the marker %lld does not fit 32 bits", number_of_row(c),
                    (long long)number);
    if (at)
        c->block->marker[c->block->count] = (int32_t)number;
    return at;
}

static const char *row_number(tm_row_context *c, const char *at, const char *end)
{
    int64_t number;
    size_t right = number_of_row(c);
    at = whole(c, at, end, &number, "number");
    if (at && (uint64_t)number != right)
        return FAIL(c, "row %zu is numbered %lld (rows are numbered without a gap)",
                    right, (long long)number);
    return at;
}

const char *tm_row_read(tm_row_context *c, const char *at, const char *end)
{
    tm_block *block = c->block;
    const tm_block_shape *shape = c->shape;
    size_t row = block->count;
    at = row_number(c, at, end);
    if (at && shape->reals)
        at = reals(c, at, end, block->real + row * shape->reals, shape->reals);
    if (at && shape->integers)
        at = integers(c, at, end, shape->integers);
    if (at && shape->list)
        at = list(c, at, end);
    if (at && block->attributes)
        at = reals(c, at, end, block->attribute + row * block->attributes,
                   block->attributes);
    if (at && block->markers)
        at = marker(c, at, end);
    if (at && block->kind == TM_GROUP)
        return tm_group_row_name(c, at, memchr(at, '\n', (size_t)(end - at)));
    if (at && *at == '\n')
        return at + 1;
    while (at && tm_is_blank(*at))
        at++;
    if (at && *at != '\n') {
        char text[TM_QUOTE_CHARS];
        if (*at == '#' || *at == '\r')
            return fail_field(c, at, "");
        return FAIL(c, "row %zu: '%s' after the last number that its header says",
                    number_of_row(c), field(at, text));
    }
    return at ? at + 1 : NULL;
}
