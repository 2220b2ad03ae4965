/* SPDX-License-Identifier: GPL-3.0-or-later */
/* MPI, which p4est needs even for one process. */
#ifndef TM_FOREST_MPI_START_H
#define TM_FOREST_MPI_START_H

#include "../../base/error.h"

/* Starts MPI and p4est, once; they end with the program. Where no launcher (mpirun, srun)
 * has started the program, without what talks to other processes: that takes 0.01 s and
 * not 0.3 s, and needs no folder for temporary files. Nothing is printed. TM_ERROR_SYSTEM
 * where MPI says that it does not start (Open MPI ends the program instead). Each process
 * works for itself: MPI_COMM_SELF. */
tm_status tm_mpi_start(tm_error *error);

#endif
