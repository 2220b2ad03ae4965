/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Another program, run to its end, with all that it says. */
#ifndef CMD_COMMON_RUN_PROGRAM_H
#define CMD_COMMON_RUN_PROGRAM_H

#include "../../../lib/base/error.h"
#include "../../../lib/text/text.h"

#include <stdbool.h>

typedef struct program_end {
    int cannot_start; /* errno, or 0 */
    int exit_status;  /* where no signal ended it */
    int signal;       /* or 0 */
    bool timed_out;   /* it was killed, as its time was over */
    tm_text output;   /* what it wrote on stdout and stderr, in that order */
} program_end;

/* What is done while a program runs. */
typedef struct program_watch {
    /* Is called with what the program writes, piece by piece. */
    void (*listen)(void *context, const char *bytes, size_t size);
    /* Is called once, when it has written nothing for `silence` seconds. */
    void (*silent)(void *context);
    void *context;
    double silence;
    double timeout; /* seconds after which it is killed, with its group; 0: none */
} program_watch;

/* Runs argv[0], which is looked up in PATH, without a shell and with nothing on stdin.
 * It has a terminal on stdout, so that what it says is not lost in a buffer when it
 * aborts. While signals are held (private.h) they kill it and its children; where we are
 * killed ourselves, it is killed too. */
tm_status run_program(char *const argv[], const program_watch *watch, program_end *end,
                      tm_error *error);

#endif
