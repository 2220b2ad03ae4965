/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "lines.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Fits the second-level cache, so that what was read is parsed there. */
enum { WINDOW = 1 << 17 };

/* Behind the buffer: the line feed that the last line may lack, and what is looked at. */
enum { SPARE = 1 + TM_LINES_SLACK };

/* The bytes that are left in a regular file; 0: not known. */
static size_t size_left(int fd)
{
    struct stat status;
    if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode))
        return 0;
    const off_t at = lseek(fd, 0, SEEK_CUR);
    return at >= 0 && at < status.st_size ? (size_t)(status.st_size - at) : 0;
}

tm_status tm_lines_open_input(tm_lines *lines, const tm_input *input,
                              const tm_progress *progress, tm_error *error)
{
    *lines = (tm_lines){.input = *input,
                        .name = input->name,
                        .capacity = WINDOW,
                        .line = 1,
                        .progress = progress,
                        .progress_at = {.what = "reading", .bytes = true}};
    lines->buffer = malloc(WINDOW + SPARE);
    if (!lines->buffer)
        return tm_fail_memory(error);
    lines->at = lines->end = lines->filled = lines->buffer;
    return TM_OK;
}

tm_status tm_lines_open(tm_lines *lines, int fd, const char *name,
                        const tm_progress *progress, tm_error *error)
{
    tm_input input;
    tm_input_open(&input, fd, name);
    const tm_status status = tm_lines_open_input(lines, &input, progress, error);
    lines->progress_at.of = progress ? size_left(fd) : 0;
    tm_progress_tell(progress, &lines->progress_at);
    return status;
}

void tm_lines_close(tm_lines *lines)
{
    tm_input_close(&lines->input);
    free(lines->buffer);
    lines->buffer = NULL;
}

/* A buffer of that size, with what the window holds in front. */
static bool move(tm_lines *lines, size_t capacity)
{
    const size_t rest = (size_t)(lines->filled - lines->at);
    const size_t whole = (size_t)(lines->end - lines->at);
    memmove(lines->buffer, lines->at, rest);
    char *moved = lines->buffer;
    if (capacity > lines->capacity)
        moved = realloc(lines->buffer, capacity + SPARE);
    if (moved) {
        lines->buffer = moved;
        lines->capacity = capacity;
    }
    lines->at = lines->buffer;
    lines->end = lines->at + whole;
    lines->filled = lines->buffer + rest;
    return moved;
}

size_t tm_lines_place(const tm_lines *lines)
{
    const size_t ahead = (size_t)(lines->filled - lines->at);
    return lines->input.taken - ahead + lines->ended_without_line_feed;
}

tm_status tm_lines_skip(tm_lines *lines, size_t place, size_t more, tm_error *error)
{
    if (lseek(lines->input.fd, (off_t)place, SEEK_SET) < 0)
        return tm_fail_at(error, TM_ERROR_SYSTEM, lines->name, 0, NULL, "cannot seek: %s",
                          strerror(errno));
    lines->at = lines->end = lines->filled = lines->buffer;
    lines->input.taken = place;
    lines->at_end = lines->ended_without_line_feed = false;
    lines->line += more;
    return TM_OK;
}

bool tm_lines_room(tm_lines *lines, size_t bytes)
{
    const size_t rest = (size_t)(lines->filled - lines->at);
    const size_t free = lines->capacity - (size_t)(lines->filled - lines->buffer);
    const size_t needed = rest + bytes;
    return free >= bytes ||
           move(lines, needed > lines->capacity ? 2 * needed : lines->capacity);
}

/* Doubles the buffer for a line that does not fit; the line begins it. */
static tm_status widen(tm_lines *lines, tm_error *error)
{
    lines->too_long = lines->capacity >= TM_LINE_MAX;
    if (lines->too_long)
        return tm_fail_at(error, TM_ERROR_INPUT, lines->name, lines->line, NULL,
                          "the line is longer than %zu bytes", TM_LINE_MAX);
    return move(lines, lines->capacity * 2) ? TM_OK : tm_fail_memory(error);
}

/* Reads once into the free end of the buffer, at most so many bytes; sets `end` behind
 * the last line feed. */
static tm_status read_more(tm_lines *lines, size_t most, tm_error *error)
{
    size_t got;
    tm_status status = tm_input_read(&lines->input, lines->filled, most, &got, error);
    if (status != TM_OK)
        return status;
    const char *last = got ? memrchr(lines->filled, '\n', got) : NULL;
    lines->filled += got;
    if (got == 0)
        lines->at_end = true;
    if (got == 0 && lines->filled > lines->end) {
        *lines->filled++ = '\n';
        lines->ended_without_line_feed = true;
        last = lines->filled - 1;
    }
    if (last)
        lines->end = last + 1;
    memset(lines->filled, 0, (size_t)TM_LINES_SLACK);
    return TM_OK;
}

void tm_lines_tell(tm_lines *lines)
{
    lines->progress_at.done = lines->input.taken;
    tm_progress_tell(lines->progress, &lines->progress_at);
}

tm_status tm_lines_fill(tm_lines *lines, tm_error *error)
{
    if (lines->at < lines->end || lines->at_end)
        return TM_OK;
    if (lines->ahead != TM_OK)
        return tm_fail_as(error, &lines->ahead_error);
    move(lines, lines->capacity);
    tm_status status = TM_OK;
    while (status == TM_OK && lines->at == lines->end && !lines->at_end) {
        size_t room = lines->capacity - (size_t)(lines->filled - lines->buffer);
        if (room == 0)
            status = widen(lines, error);
        else
            status = read_more(lines, room, error);
        tm_lines_tell(lines);
    }
    return status;
}

void tm_lines_read_ahead(tm_lines *lines, size_t bytes)
{
    const char *full = lines->filled + bytes;
    while (lines->ahead == TM_OK && !lines->at_end && lines->filled + 1 < full)
        lines->ahead =
            read_more(lines, (size_t)(full - lines->filled), &lines->ahead_error);
}

const char *tm_lines_quote(const char *at, char text[TM_QUOTE_CHARS])
{
    enum { MOST = 24 };
    size_t size = 0;
    for (; size < MOST && *at != '\n'; at++) {
        if (isprint((unsigned char)*at))
            text[size++] = *at;
        else
            size += (size_t)snprintf(text + size, TM_QUOTE_CHARS - size, "\\x%02x",
                                     (unsigned char)*at);
    }
    memcpy(text + size, size >= MOST ? "…" : "", size >= MOST ? sizeof "…" : 1);
    return text;
}
