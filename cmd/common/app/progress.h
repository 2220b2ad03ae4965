/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a filter says while it works: on a terminal one line, what it does, how far it is
 * and for how long; with -v a line for each stage, where it ends. The library only leaves
 * word of where it is. A thread draws the line from that, so that it goes on where
 * nothing is said for long, and the work is not asked what time it is. */
#ifndef CMD_COMMON_PROGRESS_H
#define CMD_COMMON_PROGRESS_H

#include "../../../lib/base/progress.h"

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>

/* Since the filter began: elapsed, of its processors, and what this rank has sent. */
typedef struct progress_clock {
    double seconds, cpu;
    size_t sent; /* bytes */
} progress_clock;

typedef struct progress {
    tm_progress to; /* for the library */
    const char *name;
    int fd;       /* standard error */
    bool draws;   /* the line, in the thread */
    bool verbose; /* a line for each stage */
    bool shown;   /* the line is there */
    bool ending;
    tm_progress_at at; /* the last word of the library; what is NULL before the first */
    progress_clock stage;
    double began;
    pthread_t thread;
    pthread_mutex_t lock; /* of all the above, and of the terminal */
    pthread_cond_t wake;
} progress;

/* Begins to draw, unless quiet, if standard error is a terminal that can erase a line.
 * One at a time: a signal that ends the filter erases it. */
void progress_start(progress *p, const char *name, bool quiet, bool verbose);

/* What the library is to be given: NULL where nobody is told. */
const tm_progress *progress_context(const progress *p);

/* Between these two the line is erased and the terminal is the caller's. Both take NULL.
 */
void progress_hold(progress *p);
void progress_release(progress *p);

/* The last stage is over, the line is gone for good. Takes NULL. */
void progress_end(progress *p);

/* For progress.c and its test. ------------------------------------------------------- */

enum { PROGRESS_LINE = 512 };

/* The line, cut to so many columns, without a line break. */
void progress_line(char line[PROGRESS_LINE], const char *name, const tm_progress_at *at,
                   double seconds, size_t columns);

/* What -v says of a stage that took from…to; `kilobytes` is the most that the filter had
 * in memory so far. */
void progress_stage_line(char line[PROGRESS_LINE], const char *name, const char *what,
                         const progress_clock *from, const progress_clock *to,
                         long kilobytes);

/* Draws the line if there is something to say. */
void progress_draw(progress *p, double seconds);

#endif
