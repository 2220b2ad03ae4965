/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "p4est_call.h"

#include <p4est.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

static jmp_buf before;

/* The first line that libsc logs as an error during a call: why it aborts. */
static char cause[256];

/* An sc_log_handler_t. */
static void note_cause(FILE *file, const char *source, int line, int package,
                       int category, int priority, const char *message)
{
    (void)file, (void)source, (void)line, (void)package, (void)category, (void)priority;
    if (cause[0])
        return;
    static const char prefix[] = "Abort: ";
    if (strncmp(message, prefix, strlen(prefix)) == 0)
        message += strlen(prefix);
    snprintf(cause, sizeof cause, "%.*s", (int)strcspn(message, "\n"), message);
}

/* What libsc calls in place of abort(). */
static void leave(void)
{
    longjmp(before, 1);
}

static void begin(void)
{
    cause[0] = '\0';
    sc_set_log_defaults(NULL, note_cause, SC_LP_ERROR);
    sc_set_abort_handler(leave);
}

static void end(void)
{
    sc_set_abort_handler(NULL);
    sc_set_log_defaults(NULL, NULL, SC_LP_SILENT);
}

/* libsc says "Returned NULL from malloc", or calloc, realloc, or "Allocation". */
static tm_status fail(tm_error *error)
{
    if (strstr(cause, "alloc") || strstr(cause, "Alloc"))
        return tm_fail_memory(error);
    return tm_fail(error, TM_ERROR_SYSTEM, "p4est gives up: %s",
                   cause[0] ? cause : "it does not say why");
}

tm_status tm_p4est_call(void (*work)(void *), void *user, tm_error *error)
{
    if (setjmp(before) != 0) {
        end();
        return fail(error);
    }
    begin();
    work(user);
    end();
    return TM_OK;
}
