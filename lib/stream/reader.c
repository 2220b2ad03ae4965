/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stream's reader: lines into blocks. Rows are parsed by row.c; what refers from
 * one block to another is checked by references.c when all is read. */
#include "stream.h"

#include "../base/ids.h"

#include "../number/number.h"
#include "block.h"
#include "reader.h"
#include "row.h"
#include "row_chunks.h"
#include "sniff.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of a window that all threads read at a time, at most; and below which starting
 * them costs more than they save. */
enum { CHUNKS_OF_THREAD = 4, STEP_MAX = 1 << 24, WORTH_THREADS = 1 << 16 };

static const char magic[] = "termesh 1\n";

typedef tm_reader reader;

#define FAIL(r, block, ...)                                                              \
    tm_fail_at((r)->error, TM_ERROR_INPUT, (r)->lines.name, (r)->lines.line, block,      \
               __VA_ARGS__)

static void next_line(reader *r)
{
    const char *feed = memchr(r->lines.at, '\n', (size_t)(r->lines.end - r->lines.at));
    r->lines.at = feed + 1;
    r->lines.line++;
}

/* Goes to the next line that is no comment and not blank; at == end where there is
 * none. Blanks before its first character are skipped. */
static tm_status next_content(reader *r)
{
    for (;;) {
        tm_status status = tm_lines_fill(&r->lines, r->error);
        if (status != TM_OK || r->lines.at == r->lines.end)
            return status;
        const char *at = r->lines.at;
        while (tm_is_blank(*at))
            at++;
        if (*at != '\n' && *r->lines.at != '#')
            return TM_OK;
        next_line(r);
    }
}

/* What the file is instead of a stream. */
static tm_status fail_magic(reader *r)
{
    const char *at = r->lines.at;
    size_t filled = (size_t)(r->lines.filled - at), size = sizeof magic - 1;
    if (r->lines.ended_without_line_feed)
        filled--;
    const size_t mark = tm_byte_order_mark(at, filled);
    if (filled - mark >= size && memcmp(at + mark, "termesh 1\r\n", size + 1) == 0)
        return FAIL(r, NULL, "the lines end in CR LF (LF alone)");
    if (mark > 0 && filled - mark >= size && memcmp(at + mark, magic, size) == 0)
        return FAIL(r, NULL, "begins with a byte order mark: a stream has none");
    const tm_look look = tm_look_at(at, filled);
    return FAIL(r, NULL,
                "no termesh stream (its first line is 'termesh 1'); looks like %s%s%s",
                look.what, look.advice ? ": " : "", look.advice ? look.advice : "");
}

/* The first line. Only as much is read of a file that is something else as its look
 * needs. */
static tm_status read_magic(reader *r)
{
    size_t size = sizeof magic - 1;
    tm_status status = TM_OK;
    /* A binary file may be one long line: then there is no first line to look at. */
    tm_error too_long;
    if (tm_lines_fill(&r->lines, &too_long) != TM_OK) {
        if (!r->lines.too_long)
            return tm_fail_as(r->error, &too_long);
        r->lines.end = r->lines.filled;
    }
    size_t there = (size_t)(r->lines.end - r->lines.at);
    if (there < size || memcmp(r->lines.at, magic, size) != 0)
        return fail_magic(r);
    next_line(r);
    return status;
}

static tm_status read_history(reader *r)
{
    for (;;) {
        tm_status status = tm_lines_fill(&r->lines, r->error);
        if (status != TM_OK || r->lines.at == r->lines.end || *r->lines.at != '#')
            return status;
        const char *begin = r->lines.at;
        next_line(r);
        tm_text_append(&r->stream->history, begin, (size_t)(r->lines.at - begin));
        if (r->stream->history.failed)
            return tm_fail_memory(r->error);
    }
}

/* Copies the block name that the line holds; false where it holds none. A name is
 * [part].suffix, of letters, digits, '-' and '_'. */
static bool block_name(const char *at, char name[TM_BLOCK_NAME])
{
    size_t size = 0, dots = 0;
    for (; size < TM_BLOCK_NAME - 1; size++) {
        char c = at[size];
        if (c == '.')
            dots++;
        else if (!isalnum((unsigned char)c) && c != '-' && c != '_')
            break;
        name[size] = c;
    }
    name[size] = '\0';
    const char *rest = at + size;
    while (tm_is_blank(*rest))
        rest++;
    return dots == 1 && size > 1 && name[size - 1] != '.' && *rest == '\n' &&
           !isdigit((unsigned char)name[0]);
}

/* The count and the numbers after it. */
static tm_status read_header(reader *r, tm_block *block, size_t *rows)
{
    const tm_block_shape *shape = tm_block_shape_of(block->kind);
    tm_status status = next_content(r);
    if (status != TM_OK)
        return status;
    if (r->lines.at == r->lines.end)
        return FAIL(r, block->name, "truncated: the header is missing");
    const char *at = r->lines.at;
    for (size_t i = 0; i <= shape->headers; i++) {
        int64_t number;
        while (tm_is_blank(*at))
            at++;
        at = tm_read_int64(at, r->lines.end, &number);
        if (!at || (*at != '\n' && !tm_is_blank(*at)))
            return FAIL(r, block->name, "the header is not %zu whole numbers",
                        shape->headers + 1);
        int is = i == 0 ? 0 : shape->header[i - 1];
        if (i == 0 && (number < 0 || number >= TM_IDS))
            return FAIL(r, block->name, "a count of %lld (0…%lld)", (long long)number,
                        (long long)TM_IDS - 1);
        if (is == TM_HEADER_ATTRIBUTES && (number < 0 || number > TM_ATTRIBUTES_MAX))
            return FAIL(r, block->name, "%lld attributes (0…%d)", (long long)number,
                        TM_ATTRIBUTES_MAX);
        if (is == TM_HEADER_MARKERS && number != 0 && number != 1)
            return FAIL(r, block->name, "the header says %lld for markers (0 or 1)",
                        (long long)number);
        if (is == TM_HEADER_ZERO && number != 0)
            return FAIL(r, block->name, "the header says %lld (0)", (long long)number);
        if (is > 0 && number != is)
            return FAIL(r, block->name, "the header says %lld (%d)", (long long)number,
                        is);
        if (i == 0)
            *rows = (size_t)number;
        else if (is == TM_HEADER_ATTRIBUTES)
            block->attributes = (size_t)number;
        else if (is == TM_HEADER_MARKERS)
            block->markers = number == 1;
    }
    while (tm_is_blank(*at))
        at++;
    if (*at != '\n') {
        char text[TM_QUOTE_CHARS];
        return FAIL(r, block->name, "'%s' after the header's %zu numbers",
                    tm_lines_quote(at, text), shape->headers + 1);
    }
    next_line(r);
    return TM_OK;
}

/* How many nodes the indices of a block may name: those of its own part, which come
 * before it. */
static tm_status find_limit(reader *r, const tm_block *block, size_t *limit)
{
    char name[TM_BLOCK_NAME + 8];
    size_t part = (size_t)(strrchr(block->name, '.') - block->name);
    memcpy(name, block->name, part);
    memcpy(name + part, ".node", sizeof ".node");
    const tm_block *nodes = tm_block_names_find(&r->names, name);
    *limit = nodes ? tm_block_names_rows(&r->names, nodes) : 0;
    bool refers = block->kind == TM_ELE || block->kind == TM_FACE ||
                  block->kind == TM_EDGE || block->kind == TM_MIX ||
                  block->kind == TM_FACET;
    if (refers && !nodes)
        return FAIL(r, block->name, "comes before %s, whose nodes it names", name);
    return TM_OK;
}

static tm_status missing_row(reader *r, const tm_block *block, size_t row, size_t rows)
{
    char text[TM_QUOTE_CHARS];
    if (r->lines.at == r->lines.end)
        return FAIL(r, block->name, "truncated: row %zu of %zu is missing", row + 1,
                    rows);
    return FAIL(r, block->name, "row %zu of %zu is missing: '%s' follows", row + 1, rows,
                tm_lines_quote(r->lines.at, text));
}

/* The number of the first row of the first .node is the stream's index base; where that
 * has no row, of the next block that has one. */
static tm_status read_base(reader *r, const tm_block *block)
{
    int64_t number;
    char text[TM_QUOTE_CHARS];
    const char *at = r->lines.at;
    while (tm_is_blank(*at))
        at++;
    if (block->kind != TM_NODE && !tm_block_names_find(&r->names, ".node"))
        return FAIL(r, block->name,
                    "comes before the nodes, whose first number is the "
                    "index base of the stream");
    if (!tm_read_int64(at, r->lines.end, &number) || number < 0 || number > 1)
        return FAIL(r, block->name, "the first row's number is '%s' (0 or 1)",
                    tm_lines_quote(at, text));
    r->stream->base = (unsigned)number;
    r->base_known = true;
    return TM_OK;
}

/* Goes to the next row. Nearly always it is there. */
static inline tm_status next_row(reader *r)
{
    if (r->lines.at < r->lines.end && *r->lines.at >= '0' && *r->lines.at <= '9')
        return TM_OK;
    return next_content(r);
}

tm_status tm_reader_next_row(reader *r)
{
    return next_row(r);
}

tm_status tm_reader_find_row(reader *r, const tm_block *block, size_t row, size_t rows)
{
    tm_status status = next_row(r);
    if (status == TM_OK && (r->lines.at == r->lines.end || !tm_row_begins(r->lines.at)))
        status = missing_row(r, block, row, rows);
    if (status == TM_OK && !r->base_known)
        status = read_base(r, block);
    return status;
}

static void read_ahead(void *context)
{
    reader *r = context;
    tm_lines_read_ahead(&r->lines, r->step);
}

/* Reads rows by several threads while more of the file comes in: what is in the window,
 * or up to a line that is no row. Then lines are read one by one to the window's end. */
static tm_status read_chunks(reader *r, tm_row_context *context)
{
    tm_lines *lines = &r->lines;
    tm_block *block = context->block;
    const size_t before = block->count;
    if (!tm_lines_room(lines, 2 * r->step))
        return tm_fail_memory(r->error);
    if ((size_t)(lines->end - lines->at) < r->step)
        tm_lines_read_ahead(lines, r->step);
    const char *end = lines->end, *next = lines->at;
    /* what is looked at behind the last row is not what is being read */
    if (!lines->at_end) {
        const ptrdiff_t still = lines->filled - lines->at - TM_LINES_SLACK;
        end = still > 0 ? memrchr(lines->at, '\n', (size_t)still) : NULL;
        end = end ? end + 1 : lines->at;
    }
    r->one_by_one = true;
    if (end == lines->at)
        return TM_OK;
    if (!tm_row_chunks_read(context, lines->at, end, r->threads, read_ahead, r, &next))
        return tm_fail_memory(r->error);
    tm_lines_tell(lines);
    r->one_by_one = next < end;
    lines->at = next;
    lines->line += block->count - before;
    return TM_OK;
}

/* One row, or as many as are in the form in which they are written. */
static tm_status read_some_rows(reader *r, tm_row_context *context)
{
    tm_block *block = context->block;
    const size_t before = block->count;
    if (!tm_row_reserve(context, 1))
        return tm_fail_memory(r->error);
    r->lines.at = tm_row_read_plain(context, r->lines.at, r->lines.end, context->room);
    r->lines.line += block->count - before;
    if (block->count > before)
        return TM_OK;
    const char *after = tm_row_read(context, r->lines.at, r->lines.end);
    if (!after)
        return context->problem.status == TM_ERROR_SYSTEM
                   ? tm_fail_memory(r->error)
                   : FAIL(r, block->name, "%s", context->problem.what);
    r->lines.at = after;
    r->lines.line++;
    block->count++;
    return TM_OK;
}

/* Whether what is in the window is worth more than one thread. Names of groups are read
 * by one: they are put into one text. */
static bool worth_threads(const reader *r, const tm_block *block)
{
    return r->threads > 1 && block->kind != TM_GROUP && !r->one_by_one &&
           r->lines.end - r->lines.at >= WORTH_THREADS;
}

/* Gives back the room of a block's arrays that its rows did not need. */
static void trim(tm_block *block)
{
    if (block->start && block->start[block->count] > 0) {
        size_t items = block->start[block->count];
        uint32_t *item = realloc(block->item, items * sizeof *item);
        block->item = item ? item : block->item;
    }
}

/* A block without rows, and what is known of those that come. */
static tm_status begin_rows(reader *r, tm_row_context *context)
{
    tm_block *block = context->block;
    context->shape = tm_block_shape_of(block->kind);
    if (!tm_block_resize(block, 0))
        return tm_fail_memory(r->error);
    if (block->start)
        block->start[0] = 0;
    r->one_by_one = false;
    return TM_OK;
}

static tm_status read_next_rows(reader *r, tm_row_context *context)
{
    context->base = r->stream->base;
    return worth_threads(r, context->block) ? read_chunks(r, context)
                                            : read_some_rows(r, context);
}

tm_status tm_reader_read_some(reader *r, tm_block *block, size_t some, size_t rows,
                              size_t limit)
{
    tm_row_context context = {.block = block, .rows = some, .limit = limit};
    tm_status status = begin_rows(r, &context);
    while (status == TM_OK && block->count < some) {
        if (r->lines.at == r->lines.end)
            r->one_by_one = false;
        status = tm_reader_find_row(r, block, block->count, rows);
        if (status == TM_OK)
            status = read_next_rows(r, &context);
    }
    if (status == TM_OK)
        trim(block);
    return status;
}

tm_status tm_reader_read_part(reader *r, tm_block *block, size_t before, size_t most,
                              size_t limit)
{
    tm_row_context context = {
        .block = block, .before = before, .rows = most, .limit = limit};
    tm_status status = begin_rows(r, &context);
    while (status == TM_OK) {
        if (r->lines.at == r->lines.end)
            r->one_by_one = false;
        status = next_row(r);
        if (status != TM_OK || r->lines.at == r->lines.end)
            break;
        if (!tm_row_begins(r->lines.at))
            return missing_row(r, block, before + block->count, before + most);
        if (block->count == most)
            return FAIL(r, block->name, "more rows than the %zu that its header says",
                        before + most);
        status = read_next_rows(r, &context);
    }
    if (status == TM_OK)
        trim(block);
    return status;
}

static tm_status read_unknown(reader *r, tm_block *block)
{
    char name[TM_BLOCK_NAME];
    for (;;) {
        tm_status status = tm_lines_fill(&r->lines, r->error);
        if (status != TM_OK || r->lines.at == r->lines.end ||
            block_name(r->lines.at, name))
            return status;
        const char *begin = r->lines.at;
        next_line(r);
        tm_text_append(&block->text, begin, (size_t)(r->lines.at - begin));
        if (block->text.failed)
            return tm_fail_memory(r->error);
    }
}

tm_status tm_reader_read_block(reader *r, tm_block *block, size_t rows, size_t limit)
{
    if (block->kind == TM_UNKNOWN)
        return read_unknown(r, block);
    return tm_reader_read_some(r, block, rows, rows, limit);
}

static tm_status begin_block(reader *r, const char *name)
{
    if (tm_block_names_find(&r->names, name))
        return FAIL(r, name, "a second block of that name");
    tm_block *block = tm_stream_add(r->stream, name);
    if (!block || !tm_block_names_add(&r->names))
        return tm_fail_memory(r->error);
    size_t rows = 0, limit = 0;
    tm_status status = find_limit(r, block, &limit);
    if (status != TM_OK)
        return status;
    next_line(r);
    if (block->kind != TM_UNKNOWN)
        status = read_header(r, block, &rows);
    return status == TM_OK ? r->read_block(r, block, rows, limit) : status;
}

/* After .end only blank lines and comments. */
static tm_status read_end(reader *r)
{
    next_line(r);
    tm_status status = next_content(r);
    char text[TM_QUOTE_CHARS];
    if (status == TM_OK && r->lines.at != r->lines.end)
        return FAIL(r, ".end", "'%s' follows (nothing may)",
                    tm_lines_quote(r->lines.at, text));
    return status;
}

static tm_status read_blocks(reader *r)
{
    for (;;) {
        char name[TM_BLOCK_NAME], text[32];
        tm_status status = next_content(r);
        if (status != TM_OK)
            return status;
        if (r->lines.at == r->lines.end)
            return FAIL(r, NULL, "truncated: the stream has no .end");
        if (!block_name(r->lines.at, name)) {
            size_t blocks = r->stream->blocks;
            const tm_block *last = blocks ? &r->stream->block[blocks - 1] : NULL;
            if (last && tm_row_begins(r->lines.at))
                return FAIL(r, last->name, "more rows than the %zu that its header says",
                            tm_block_names_rows(&r->names, last));
            return FAIL(r, NULL, "'%s' is not the name of a block",
                        tm_lines_quote(r->lines.at, text));
        }
        if (strcmp(name, ".end") == 0)
            return read_end(r);
        status = begin_block(r, name);
        if (status != TM_OK)
            return status;
    }
}

void tm_reader_init(reader *r, tm_stream *stream, unsigned threads, tm_error *error)
{
    const size_t step = CHUNKS_OF_THREAD * (size_t)threads * TM_CHUNK_BYTES;
    *r = (reader){.stream = stream,
                  .names = {.stream = stream},
                  .threads = threads,
                  .step = step < STEP_MAX ? step : STEP_MAX,
                  .error = error,
                  .read_block = tm_reader_read_block};
}

void tm_reader_free(reader *r)
{
    tm_block_names_free(&r->names);
    tm_lines_close(&r->lines);
}

tm_status tm_reader_read(reader *r)
{
    tm_status status = read_magic(r);
    if (status == TM_OK)
        status = read_history(r);
    if (status == TM_OK)
        status = read_blocks(r);
    if (status == TM_OK)
        status = tm_stream_check_references(&r->names, r->lines.name, r->error);
    return status;
}

tm_status tm_stream_read(tm_stream *stream, int fd, const char *name, unsigned threads,
                         tm_error *error)
{
    tm_error unused;
    reader r;
    tm_reader_init(&r, stream, threads, error ? error : &unused);
    tm_status status = tm_lines_open(&r.lines, fd, name, stream->progress, r.error);
    if (status == TM_OK)
        status = tm_reader_read(&r);
    tm_reader_free(&r);
    if (status != TM_OK)
        tm_stream_free(stream);
    return status;
}
