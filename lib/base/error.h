/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors are values: a function of the library that can fail returns a tm_status and
 * fills a tm_error with the place and the cause. Only the filters in cmd/ print them.
 *
 * What holds in all headers, where they do not say otherwise:
 *   - `error` may be NULL. What it says is for a status that is not TM_OK.
 *   - The only error is TM_ERROR_SYSTEM: memory is out, or there would be more of
 *     something than 32 bits can number.
 *   - tm_X_free() gives back all that *x holds, which may be freed again then; {0} holds
 *     nothing.
 *   - Arrays that are returned are malloc'ed, and to be freed by the caller.
 *   - The cost is O(n), or O(n log n) where something is sorted or searched, in what a
 *     function reads and what it makes. What repeats steps until nothing gets better, as
 *     tm_improve(), tm_lepp_improve(), tm_repair() and tm_octree_mesh_choose(), has no
 *     such bound: options limit it. */
#ifndef TM_BASE_ERROR_H
#define TM_BASE_ERROR_H

#include "extern_c.h"

#include <stdarg.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

/* What went wrong, as the exit status of a filter that meets it. */
typedef enum tm_status {
    TM_OK = 0,
    TM_ERROR_INPUT = 3,   /* the input is not what it should be */
    TM_ERROR_SYSTEM = 4,  /* I/O, memory, a program that is missing */
    TM_ERROR_INTERNAL = 5 /* a self-check failed */
} tm_status;

typedef struct tm_error {
    tm_status status;
    char file[256]; /* "" where the error is not about a file */
    size_t line;    /* from 1; 0 where there is none */
    char block[64]; /* ".ele", "surface.node"; "" where there is none */
    char what[512]; /* what is wrong (what would be right) */
} tm_error;

/* Sets *error (which may be NULL) to status and the printf-style message; place fields
 * are cleared. Returns status, so that a caller can write `return tm_fail(…)`. */
tm_status tm_fail(tm_error *error, tm_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The same with a place; file and block may be NULL, line 0. */
tm_status tm_fail_at(tm_error *error, tm_status status, const char *file, size_t line,
                     const char *block, const char *format, ...)
    __attribute__((format(printf, 6, 7)));

/* The same for who has a list of arguments, which is used up. */
tm_status tm_fail_at_list(tm_error *error, tm_status status, const char *file,
                          size_t line, const char *block, const char *format,
                          va_list arguments) __attribute__((format(printf, 6, 0)));

/* The same as *cause, which was got of another function. Returns its status. */
tm_status tm_fail_as(tm_error *error, const tm_error *cause);

/* What an error, which may be NULL, says; with that status. */
tm_error tm_error_of(tm_status status, const tm_error *error);

/* So many lines are before the text in which the error, which may be NULL, has its line.
 */
void tm_error_add_lines(size_t lines, tm_error *error);

/* "out of memory", as TM_ERROR_SYSTEM. */
void tm_say_memory(tm_error *error);

static inline tm_status tm_fail_memory(tm_error *error)
{
    tm_say_memory(error);
    return TM_ERROR_SYSTEM;
}

TM_EXTERN_C_END

#endif
