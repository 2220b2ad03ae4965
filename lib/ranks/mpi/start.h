/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The start and the end of MPI. */
#ifndef TM_RANKS_MPI_START_H
#define TM_RANKS_MPI_START_H

#include "../../base/extern_c.h"
#include "../../base/error.h"

TM_EXTERN_C_BEGIN

/* Starts MPI, once. After a launcher it ends with the program; else it is left as it is
 * then, as it would need memory to end. TM_ERROR_SYSTEM where MPI says that it does not
 * start, or where there is not the memory that Open MPI takes: lacking that, it would end
 * the program. */
tm_status tm_mpi_init(tm_error *error);

/* Ends MPI, if it runs: once. */
void tm_mpi_finish(void);

TM_EXTERN_C_END

#endif
