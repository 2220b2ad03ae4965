/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a long operation is ended early. Whoever wants to gives a tm_stop in its options;
 * it is asked between steps, and what is best so far is the result. NULL: to the end. */
#ifndef TM_BASE_STOP_H
#define TM_BASE_STOP_H

#include "extern_c.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

typedef struct tm_stop {
    bool (*wanted)(void *context); /* once it says so it says so each time */
    void *context;
} tm_stop;

/* Whether to stop; false where stop is NULL. */
static inline bool tm_stop_is_wanted(const tm_stop *stop)
{
    return stop && stop->wanted(stop->context);
}

TM_EXTERN_C_END

#endif
