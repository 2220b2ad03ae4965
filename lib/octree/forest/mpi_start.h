/* SPDX-License-Identifier: GPL-3.0-or-later */
/* MPI, which p4est needs even for one process. */
#ifndef TM_FOREST_MPI_START_H
#define TM_FOREST_MPI_START_H

#include "../../base/error.h"

/* Starts MPI and p4est, once; they end with the program. Nothing is printed.
 * TM_ERROR_SYSTEM where MPI says that it does not start (Open MPI ends the program
 * instead). Each process works for itself: MPI_COMM_SELF. With these variables in the
 * environment, which are the program's to set where no launcher (mpirun, srun) has
 * started it, Open MPI takes 0.01 s and not 0.3 s and needs no folder for temporary
 * files:
 *
 *     OMPI_MCA_pml=ob1 OMPI_MCA_btl=self OMPI_MCA_ess_singleton_isolated=1
 *     OMPI_MCA_orte_create_session_dirs=0 OMPI_MCA_shmem=mmap
 *     HWLOC_COMPONENTS=no_os,stop */
tm_status tm_mpi_start(tm_error *error);

#endif
