/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mpi_start.h"

#include "../../ranks/mpi/start.h"

#include <p4est.h>
#include <stdbool.h>

tm_status tm_mpi_start(tm_error *error)
{
    static bool started;
    if (started)
        return TM_OK;
    const tm_status status = tm_mpi_init(error);
    if (status != TM_OK)
        return status;
    started = true;
    sc_set_log_defaults(NULL, NULL, SC_LP_SILENT); /* but during p4est_call.c */
    sc_init(MPI_COMM_SELF, 0, 0, NULL, SC_LP_DEFAULT);
    p4est_init(NULL, SC_LP_DEFAULT);
    return TM_OK;
}
