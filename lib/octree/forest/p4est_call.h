/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls of p4est that come back where it gives up. */
#ifndef TM_FOREST_P4EST_CALL_H
#define TM_FOREST_P4EST_CALL_H

#include "../../base/error.h"

/* Runs work(user), which calls p4est and allocates nothing else. p4est aborts the program
 * where it gets no memory or finds something wrong; here that is TM_ERROR_SYSTEM, whose
 * message says which. Nothing is printed. Before: tm_mpi_start(). What it has allocated
 * until then is lost, and what it was working on must not be used again. One at a time.
 */
tm_status tm_p4est_call(void (*work)(void *), void *user, tm_error *error);

#endif
