/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file as whole lines in memory, a window at a time; for lib/stream/ only. */
#ifndef TM_STREAM_LINES_H
#define TM_STREAM_LINES_H

#include "../base/error.h"
#include "../text/input.h"
#include "../base/progress.h"

#include <stdbool.h>
#include <stddef.h>

/* Bytes after `end` that may be read (not used): rows are looked at through a window. */
enum { TM_ROW_WINDOW = 48, TM_LINES_SLACK = 2 * TM_ROW_WINDOW };

/* The window holds whole lines: [at, end), and end[-1] is a line feed. Only the last
 * line of a file may lack its own; it is given one. */
typedef struct tm_lines {
    tm_input input;
    const char *name;
    char *buffer;
    size_t capacity;
    const char *at;  /* begin of the next line */
    const char *end; /* past the last whole line */
    char *filled;    /* past the last byte that was read */
    bool at_end;     /* the file has no more */
    bool ended_without_line_feed;
    bool too_long;   /* a line was */
    size_t line;     /* number of the line at `at`, from 1 */
    tm_status ahead; /* how tm_lines_read_ahead() ended, and why: */
    tm_error ahead_error;
    const tm_progress *progress;
    tm_progress_at progress_at; /* bytes read, of those of a regular file */
} tm_lines;

tm_status tm_lines_open(tm_lines *lines, int fd, const char *name,
                        const tm_progress *progress, tm_error *error);
void tm_lines_close(tm_lines *lines);

/* The same of what an input gives that is open. */
tm_status tm_lines_open_input(tm_lines *lines, const tm_input *input,
                              const tm_progress *progress, tm_error *error);

/* The byte of the descriptor, read from its begin on, that the line at `at` begins with.
 */
size_t tm_lines_place(const tm_lines *lines);

/* Goes on with the line of a regular file that begins with that byte, which is `more`
 * lines on. */
tm_status tm_lines_skip(tm_lines *lines, size_t place, size_t more, tm_error *error);

/* Makes at < end, reading more if there is none; at == end then means the end of the
 * file. A line of over TM_LINE_MAX bytes is an error. */
tm_status tm_lines_fill(tm_lines *lines, tm_error *error);

/* Makes room for `bytes` more, which may move what the window holds. False where memory
 * is out. */
bool tm_lines_room(tm_lines *lines, size_t bytes);

/* Reads up to so many bytes more, of which there is room, behind those that there are and
 * leaves these alone: others may look at them, up to TM_LINES_SLACK bytes before
 * `filled`. What is wrong is said by tm_lines_fill() when all before it is used up. */
void tm_lines_read_ahead(tm_lines *lines, size_t bytes);

/* Tells how far the reading is. */
void tm_lines_tell(tm_lines *lines);

static inline bool tm_is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Copies the line at `at` for a message: its first bytes, as \x1b
 * those that are not printable. Returns text. */
enum { TM_QUOTE_CHARS = 32 };
const char *tm_lines_quote(const char *at, char text[TM_QUOTE_CHARS]);

/* The longest line that is read: a polyhedron of a million facets has room. */
#define TM_LINE_MAX ((size_t)1 << 24)

#endif
