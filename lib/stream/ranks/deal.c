/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "deal.h"

#include "../../ranks/ranks.h"
#include "../row.h"

#include <stdlib.h>
#include <string.h>

enum { MESSAGE = 1 << 16 };

/* Text of whole lines with `rows` rows or all that there are of the window: its end;
 * *rows gets how many are missing. */
static const char *cut(tm_lines *lines, size_t *rows)
{
    const char *at = lines->at;
    while (at<lines->end && * rows> 0) {
        const char *line = at;
        if (*at != '\n' && *at != '#') {
            while (tm_is_blank(*at))
                at++;
            if (*at != '\n' && !tm_row_begins(at))
                return line;
            *rows -= *at != '\n';
        }
        at = (const char *)memchr(at, '\n', (size_t)(lines->end - at)) + 1;
        lines->line++;
    }
    return at;
}

static void send_text(unsigned to, const char *text, const char *end)
{
    for (; text < end; text += MESSAGE)
        tm_ranks_send(to, text, end - text < MESSAGE ? (size_t)(end - text) : MESSAGE);
}

/* Sends a rank its rows: the number of the line, text, nothing. *left is how many there
 * were not. */
static tm_status send_rows(tm_reader *r, unsigned to, size_t rows, size_t *left)
{
    tm_lines *lines = &r->lines;
    tm_status status = TM_OK;
    *left = rows;
    tm_ranks_send(to, &lines->line, sizeof lines->line);
    while (status == TM_OK && *left > 0) {
        status = tm_lines_fill(lines, r->error);
        if (status != TM_OK || lines->at == lines->end)
            break;
        const char *end = cut(lines, left);
        if (end == lines->at)
            break;
        send_text(to, lines->at, end);
        lines->at = end;
    }
    tm_ranks_send(to, NULL, 0);
    return status;
}

/* Rank 0's own rows, then the others'. What is wrong behind the last row that it has sent
 * is *late, with its error in *cause: others may find something before it. */
static tm_status deal(tm_reader *r, tm_block *block, size_t rows, size_t limit,
                      tm_status *late, tm_error *cause)
{
    const unsigned ranks = tm_ranks_count();
    const size_t own = tm_slice_first(rows, ranks, 1);
    tm_error *error = r->error;
    const tm_status status = tm_reader_read_some(r, block, own, rows, limit);
    r->error = cause;
    for (unsigned to = 1; to < ranks; to++) {
        const size_t first = tm_slice_first(rows, ranks, to);
        const size_t past = tm_slice_first(rows, ranks, to + 1);
        const bool goes_on = status == TM_OK && *late == TM_OK;
        size_t left = 0;
        const tm_status sent = send_rows(r, to, goes_on ? past - first : 0, &left);
        if (*late == TM_OK)
            *late = sent;
        if (*late == TM_OK && left > 0)
            *late = tm_reader_find_row(r, block, past - left, rows);
        if (*late == TM_OK && left > 0)
            *late = tm_fail(cause, TM_ERROR_INTERNAL, "a row was overlooked");
    }
    r->error = error;
    return status;
}

/* What rank 0 has sent. */
typedef struct {
    char text[MESSAGE];
    size_t at, size;
    bool over;
} inbox;

static void open_next(inbox *in)
{
    tm_ranks_receive(0, in->text, MESSAGE, &in->size);
    in->at = 0;
    in->over = in->size == 0;
}

static ptrdiff_t pull(void *from, char *bytes, size_t size)
{
    inbox *in = from;
    if (in->at == in->size && !in->over)
        open_next(in);
    const size_t some = in->size - in->at < size ? in->size - in->at : size;
    memcpy(bytes, in->text + in->at, some);
    in->at += some;
    return (ptrdiff_t)some;
}

static tm_status receive(tm_reader *r, tm_block *block, inbox *in, size_t rows,
                         size_t limit)
{
    const size_t first = tm_slice_first(rows, tm_ranks_count(), tm_rank());
    const size_t past = tm_slice_first(rows, tm_ranks_count(), tm_rank() + 1);
    const tm_lines own = r->lines;
    size_t line = 1, got;
    tm_input input;
    tm_input_open_pull(&input, pull, in, own.name);
    tm_status status = tm_lines_open_input(&r->lines, &input, NULL, r->error);
    tm_ranks_receive(0, &line, sizeof line, &got);
    r->lines.line = line;
    if (status == TM_OK)
        status = tm_reader_read_part(r, block, first, past - first, limit);
    tm_lines_close(&r->lines);
    r->lines = own;
    while (!in->over)
        open_next(in);
    return status;
}

tm_status tm_deal_rows(tm_reader *r, tm_block *block, size_t rows, size_t limit,
                       tm_error *error)
{
    inbox *in = tm_rank() > 0 ? calloc(1, sizeof *in) : NULL;
    if (tm_ranks_any(tm_rank() > 0 && !in)) {
        free(in);
        return tm_fail_memory(error);
    }
    tm_status late = TM_OK;
    tm_error cause;
    tm_status status = tm_rank() == 0 ? deal(r, block, rows, limit, &late, &cause)
                                      : receive(r, block, in, rows, limit);
    free(in);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK && late != TM_OK)
        tm_fail_as(error, &cause);
    return status == TM_OK ? tm_ranks_agree(late, error) : status;
}
