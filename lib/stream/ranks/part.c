/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "part.h"

#include "../../base/array.h"
#include "../../number/number.h"
#include "../../ranks/ranks.h"
#include "../row.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WINDOW = 1 << 18 };

/* A regular file that is looked at window by window. */
typedef struct {
    int fd;
    const char *name;
    char *window; /* WINDOW bytes */
    tm_error *error;
} looker;

/* Up to WINDOW bytes from `at` on, fewer at the end of the file only. */
static tm_status look(const looker *l, size_t at, size_t *got)
{
    *got = 0;
    while (*got < WINDOW) {
        const ssize_t some =
            pread(l->fd, l->window + *got, WINDOW - *got, (off_t)(at + *got));
        if (some < 0 && errno != EINTR)
            return tm_fail_at(l->error, TM_ERROR_SYSTEM, l->name, 0, NULL,
                              "cannot read: %s", strerror(errno));
        if (some == 0)
            break;
        *got += some > 0 ? (size_t)some : 0;
    }
    return TM_OK;
}

/* The begin of the first line that does not begin before `at`; `past` is known to be one,
 * or the end. */
static tm_status next_line(const looker *l, size_t at, size_t begin, size_t past,
                           size_t *line)
{
    size_t got;
    *line = at <= begin ? begin : past;
    for (size_t from = at - 1; at > begin && from < past; from += got) {
        const tm_status status = look(l, from, &got);
        if (status != TM_OK || got == 0)
            return status;
        const char *feed = memchr(l->window, '\n', got);
        if (!feed)
            continue;
        const size_t found = from + (size_t)(feed - l->window) + 1;
        *line = found < past ? found : past;
        break;
    }
    return TM_OK;
}

static bool add_place(tm_block_places *p, size_t *room, size_t place)
{
    size_t *grown = tm_grow(p->place, room, p->count + 1, sizeof *grown);
    if (!grown)
        return false;
    p->place = grown;
    grown[p->count++] = place;
    return true;
}

/* Whether a line may be the name of a block: it begins as no row and no comment does.
 * What is none is in a block of unknown kind, or an error, which is found when all before
 * it is read. */
static bool may_be_name(char c)
{
    return c == '.' || c == '_' || c == '-' || (c >= 'a' && c <= 'z') ||
           (c >= 'A' && c <= 'Z');
}

/* Those in a window of `got` bytes from byte `at` of the file on; the first one is behind
 * a line feed. */
static bool find_in_window(tm_block_places *p, size_t *room, const char *window,
                           size_t got, size_t at)
{
    const char *end = window + got;
    for (const char *feed = window;; feed++) {
        feed = memchr(feed, '\n', (size_t)(end - feed));
        if (!feed || feed + 1 == end)
            return true;
        if (may_be_name(feed[1]) && !add_place(p, room, at + (size_t)(feed + 1 - window)))
            return false;
    }
}

/* Those that begin in bytes from … past-1. */
static tm_status find_places(tm_block_places *p, const looker *l, size_t from,
                             size_t past)
{
    size_t room = 0, got = 0;
    for (size_t at = from > 0 ? from - 1 : 0; at + 1 < past; at += got - 1) {
        const tm_status status = look(l, at, &got);
        if (status != TM_OK || got < 2)
            return status;
        if (got > past - at)
            got = past - at;
        if (!find_in_window(p, &room, l->window, got, at))
            return tm_fail_memory(l->error);
    }
    return TM_OK;
}

tm_status tm_block_places_find(tm_block_places *p, int fd, size_t size, const char *name,
                               tm_error *error)
{
    const unsigned ranks = tm_ranks_count(), rank = tm_rank();
    const size_t part = size / ranks;
    const size_t past = rank + 1 == ranks ? size : (rank + 1) * part;
    looker l = {.fd = fd, .name = name, .window = malloc(WINDOW), .error = error};
    *p = (tm_block_places){0};
    tm_status status =
        l.window ? find_places(p, &l, rank * part, past) : tm_fail_memory(error);
    free(l.window);
    status = tm_ranks_agree(status, error);
    void *all = NULL;
    size_t count = 0;
    if (status == TM_OK)
        status =
            tm_ranks_gather(p->place, p->count, sizeof *p->place, &all, &count, error);
    free(p->place);
    *p = (tm_block_places){.place = all, .count = all ? count : 0, .size = size};
    return status;
}

void tm_block_places_free(tm_block_places *p)
{
    free(p->place);
    *p = (tm_block_places){0};
}

size_t tm_block_places_next(const tm_block_places *p, size_t from)
{
    size_t begin = 0, end = p->count;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (p->place[middle] < from)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin < p->count ? p->place[begin] : p->size;
}

/* How many lines of the file begin before a byte at which one does. */
static size_t lines_before(const looker *l, size_t past)
{
    size_t got, lines = 0;
    for (size_t at = 0; at < past; at += got) {
        if (look(l, at, &got) != TM_OK || got == 0)
            break;
        const char *end = l->window + (got < past - at ? got : past - at);
        for (const char *feed = l->window;
             (feed = memchr(feed, '\n', (size_t)(end - feed))); feed++)
            lines++;
    }
    return lines;
}

/* What this rank reads. */
typedef struct {
    tm_reader *reader;
    looker look;
    tm_block *block;
    size_t begin, past; /* bytes */
    size_t rows, limit;
    size_t before; /* rows */
    size_t lines;
} part;

static tm_status open_part(part *p)
{
    tm_input input;
    tm_reader *r = p->reader;
    if (lseek(p->look.fd, (off_t)p->begin, SEEK_SET) < 0)
        return tm_fail_at(p->look.error, TM_ERROR_SYSTEM, p->look.name, 0, NULL,
                          "cannot seek: %s", strerror(errno));
    tm_input_open_part(&input, p->look.fd, p->past - p->begin, p->look.name);
    return tm_lines_open_input(&r->lines, &input, NULL, p->look.error);
}

/* Reads the rows, of which the first is row p->before of all. */
static tm_status read_from(part *p)
{
    tm_reader *r = p->reader;
    tm_status status = open_part(p);
    if (status != TM_OK)
        return status;
    const size_t most = p->rows > p->before ? p->rows - p->before : 0;
    status = tm_reader_read_part(r, p->block, p->before, most, p->limit);
    p->lines = r->lines.line - 1;
    if (status != TM_OK)
        tm_error_add_lines(lines_before(&p->look, p->begin), r->error);
    tm_lines_close(&r->lines);
    return status;
}

/* The row that the first one of the part says that it is; SIZE_MAX where it says nothing
 * that can be, or there is none. */
static tm_status row_said(part *p, size_t *row)
{
    tm_reader *r = p->reader;
    int64_t number = 0;
    const unsigned base = r->stream->base;
    *row = SIZE_MAX;
    tm_status status = open_part(p);
    if (status != TM_OK)
        return status;
    status = tm_reader_next_row(r);
    const char *at = r->lines.at;
    while (status == TM_OK && at < r->lines.end && tm_is_blank(*at))
        at++;
    if (status == TM_OK && at < r->lines.end &&
        tm_read_int64(at, r->lines.end, &number) && number >= (int64_t)base &&
        (uint64_t)number - base < p->rows)
        *row = (size_t)number - base;
    tm_lines_close(&r->lines);
    return status;
}

/* Each reads what its first row says that it is. Where that is not so, or says nothing,
 * it is read again as what it has to be, which finds out why. */
static tm_status read_parts(part *p, tm_error *error)
{
    tm_status status = row_said(p, &p->before);
    const bool guessed = p->before != SIZE_MAX;
    if (status == TM_OK && guessed)
        status = read_from(p);
    status = tm_ranks_agree(status, error);
    if (status != TM_OK)
        return status;
    const size_t right = tm_ranks_before(p->block->count, NULL);
    if (!guessed || right != p->before) {
        p->before = right;
        status = read_from(p);
    }
    return tm_ranks_agree(status, error);
}

tm_status tm_part_read(tm_reader *r, int fd, tm_block *block, size_t begin, size_t past,
                       size_t rows, size_t limit, size_t *before, size_t *lines,
                       tm_error *error)
{
    const unsigned ranks = tm_ranks_count(), rank = tm_rank();
    const size_t size = (past - begin) / ranks;
    const tm_lines own = r->lines; /* rank 0 goes on with them */
    part p = {.reader = r,
              .look = {fd, own.name, malloc(WINDOW), error},
              .block = block,
              .rows = rows,
              .limit = limit};
    tm_status status = p.look.window ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = next_line(&p.look, begin + rank * size, begin, past, &p.begin);
    if (status == TM_OK && rank + 1 < ranks)
        status = next_line(&p.look, begin + (rank + 1) * size, begin, past, &p.past);
    else
        p.past = past;
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = read_parts(&p, error);
    *before = p.before;
    *lines = p.lines;
    tm_ranks_sum(lines, 1);
    free(p.look.window);
    r->lines = own;
    return status;
}
