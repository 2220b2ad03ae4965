/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "lines.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Fits the second-level cache, so that what was read is parsed there. */
enum { WINDOW = 1 << 17 };

/* The bytes that are left in a regular file; 0: not known. */
static size_t size_left(int fd)
{
    struct stat status;
    if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode))
        return 0;
    const off_t at = lseek(fd, 0, SEEK_CUR);
    return at >= 0 && at < status.st_size ? (size_t)(status.st_size - at) : 0;
}

tm_status tm_lines_open(tm_lines *lines, int fd, const char *name,
                        const tm_progress *progress, tm_error *error)
{
    *lines = (tm_lines){.name = name,
                        .capacity = WINDOW,
                        .line = 1,
                        .progress = progress,
                        .progress_at = {.what = "reading", .bytes = true}};
    tm_input_open(&lines->input, fd, name);
    lines->progress_at.of = progress ? size_left(fd) : 0;
    tm_progress_tell(progress, &lines->progress_at);
    lines->buffer = malloc(WINDOW + TM_LINES_SLACK);
    if (!lines->buffer)
        return tm_fail_memory(error);
    memset(lines->buffer, 0, WINDOW + TM_LINES_SLACK);
    lines->at = lines->end = lines->filled = lines->buffer;
    return TM_OK;
}

void tm_lines_close(tm_lines *lines)
{
    tm_input_close(&lines->input);
    free(lines->buffer);
    lines->buffer = NULL;
}

/* Doubles the buffer for a line that does not fit; the line begins it. */
static tm_status widen(tm_lines *lines, tm_error *error)
{
    lines->too_long = lines->capacity >= TM_LINE_MAX;
    if (lines->too_long)
        return tm_fail_at(error, TM_ERROR_INPUT, lines->name, lines->line, NULL,
                          "the line is longer than %zu bytes", TM_LINE_MAX);
    size_t used = (size_t)(lines->filled - lines->buffer);
    size_t capacity = lines->capacity * 2;
    char *moved = realloc(lines->buffer, capacity + TM_LINES_SLACK);
    if (!moved)
        return tm_fail_memory(error);
    memset(moved + lines->capacity, 0, capacity + TM_LINES_SLACK - lines->capacity);
    lines->buffer = moved;
    lines->at = lines->end = moved;
    lines->capacity = capacity;
    lines->filled = moved + used;
    return TM_OK;
}

/* Reads once into the free end of the buffer; sets `end` behind the last line feed. */
static tm_status read_more(tm_lines *lines, tm_error *error)
{
    size_t got, room = lines->capacity - (size_t)(lines->filled - lines->buffer);
    tm_status status = tm_input_read(&lines->input, lines->filled, room, &got, error);
    if (status != TM_OK)
        return status;
    if (got == 0) {
        lines->at_end = true;
        if (lines->filled > lines->at) {
            *lines->filled++ = '\n';
            lines->ended_without_line_feed = true;
        }
        lines->end = lines->filled;
        return TM_OK;
    }
    lines->progress_at.done = lines->input.taken;
    tm_progress_tell(lines->progress, &lines->progress_at);
    char *last = memrchr(lines->filled, '\n', got);
    lines->filled += got;
    if (last)
        lines->end = last + 1;
    return TM_OK;
}

tm_status tm_lines_fill(tm_lines *lines, tm_error *error)
{
    if (lines->at < lines->end || lines->at_end)
        return TM_OK;
    size_t rest = (size_t)(lines->filled - lines->at);
    memmove(lines->buffer, lines->at, rest);
    lines->at = lines->end = lines->buffer;
    lines->filled = lines->buffer + rest;
    tm_status status = TM_OK;
    while (status == TM_OK && lines->at == lines->end && !lines->at_end) {
        if ((size_t)(lines->filled - lines->buffer) == lines->capacity)
            status = widen(lines, error);
        if (status == TM_OK)
            status = read_more(lines, error);
    }
    return status;
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
