/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far a long operation is. Whoever wants to know gives a tm_progress in its options;
 * it is told on the thread that called the operation, and of nothing that depends on
 * time. NULL: nobody is told. */
#ifndef TM_BASE_PROGRESS_H
#define TM_BASE_PROGRESS_H

#include "extern_c.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

/* Where it is; what is not known, or does not apply, is 0. */
typedef struct tm_progress_at {
    const char *what;    /* the stage, "improving": a string that stays */
    const char *doing;   /* what of it: another string, or NULL */
    size_t pass;         /* which of its passes, from 1 */
    size_t done, of;     /* so many of all steps of the stage or, if it has some, pass */
    bool bytes;          /* the steps are bytes of a file */
    size_t bad, all_bad; /* what is bad still, of what was at first */
} tm_progress_at;

typedef struct tm_progress {
    void (*report)(void *context, const tm_progress_at *at);
    void *context;
} tm_progress;

/* Reports; nothing where progress is NULL. */
static inline void tm_progress_tell(const tm_progress *progress, const tm_progress_at *at)
{
    if (progress)
        progress->report(progress->context, at);
}

/* A stage begins of which nothing more is said. */
void tm_progress_stage(const tm_progress *progress, const char *what);

/* Of an operation that is all one stage of another one: what it says is `doing` there. */
typedef struct tm_progress_within {
    tm_progress inner; /* for the operation */
    const tm_progress *outer;
    const char *what;
} tm_progress_within;

/* Begins that stage, and returns what the operation is to be given: NULL where outer is.
 * *within is to stay until it has ended. */
const tm_progress *tm_progress_begin_within(tm_progress_within *within,
                                            const tm_progress *outer, const char *what);

/* In a loop, before step `done`: tells each 64th one. */
static inline void tm_progress_step(const tm_progress *progress, tm_progress_at *at,
                                    size_t done)
{
    enum { EVERY = 64 };
    if (!progress || done % EVERY != 0)
        return;
    at->done = done;
    progress->report(progress->context, at);
}

TM_EXTERN_C_END

#endif
