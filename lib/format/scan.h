/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Words and numbers of a text in memory, line by line, with messages that name file,
 * line, and what would be right. A line ends in LF, CR LF or CR; a comment sign ends it
 * early. Nothing at or after `end` is read. */
#ifndef TM_FORMAT_SCAN_H
#define TM_FORMAT_SCAN_H

#include "../base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct tm_scan {
    const char *at;   /* next byte of the line that is being read */
    const char *end;  /* past the last byte of the text */
    const char *name; /* the file's, for messages */
    size_t line;      /* from 1 */
    char comment;     /* begins a comment; '\0': there are none */
} tm_scan;

/* A word: bytes without blanks. Not NUL-terminated. */
typedef struct tm_word {
    const char *begin;
    size_t size;
} tm_word;

/* Behind a byte order mark of UTF-8, if there is one. */
void tm_scan_begin(tm_scan *scan, const char *bytes, size_t size, const char *name,
                   char comment);

/* Skips blanks; true where the line has another word. */
bool tm_scan_more(tm_scan *scan);

/* Goes behind the end of the line. */
void tm_scan_end_line(tm_scan *scan);

/* Goes to the next word, across lines; false at the end of the text. */
bool tm_scan_seek(tm_scan *scan);

/* The next word of the line; an empty one where the line has no more. */
tm_word tm_scan_word(tm_scan *scan);

/* The rest of the line, with what else would be a comment; then comes its end. */
tm_word tm_scan_rest(tm_scan *scan);

/* The next word of the line as a number. `what` says in messages what it stands for:
 * "the x coordinate". Only finite numbers are taken; an exponent may begin with D, as
 * Fortran writes it. */
tm_status tm_scan_double(tm_scan *scan, const char *what, double *value, tm_error *error);
tm_status tm_scan_integer(tm_scan *scan, const char *what, int64_t lo, int64_t hi,
                          int64_t *value, tm_error *error);

/* The same where a whole number may be written as a real one: 1.0, 1e0, 1.0D0. */
tm_status tm_scan_whole(tm_scan *scan, const char *what, int64_t lo, int64_t hi,
                        int64_t *value, tm_error *error);

/* Three coordinates. */
tm_status tm_scan_point(tm_scan *scan, double point[3], tm_error *error);

/* The same where the number may stand on a later line. */
tm_status tm_scan_next_double(tm_scan *scan, const char *what, double *value,
                              tm_error *error);
tm_status tm_scan_next_integer(tm_scan *scan, const char *what, int64_t lo, int64_t hi,
                               int64_t *value, tm_error *error);

/* TM_OK where the line has no more words, else an error that shows the next one. */
tm_status tm_scan_no_more(tm_scan *scan, const char *what, tm_error *error);

/* TM_ERROR_INPUT at the line that is being read. */
tm_status tm_scan_fail(const tm_scan *scan, tm_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

bool tm_word_is(tm_word word, const char *string);
/* The same, upper and lower case taken alike (ASCII). */
bool tm_word_is_like(tm_word word, const char *string);

/* For "%.*s": at most as many bytes as a message should show. */
int tm_word_shown(tm_word word);

#endif
