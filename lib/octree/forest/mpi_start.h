/* SPDX-License-Identifier: GPL-3.0-or-later */
/* MPI, which p4est needs even for one process. */
#ifndef TM_FOREST_MPI_START_H
#define TM_FOREST_MPI_START_H

#include "../../base/extern_c.h"
#include "../../base/error.h"

TM_EXTERN_C_BEGIN

/* Starts MPI (ranks/mpi/start.h) and p4est, once. Nothing is printed. Errors are those of
 * tm_mpi_init(). Each process works for itself: MPI_COMM_SELF. With these variables in
 * the environment, which are the program's to set where no launcher has started it, Open
 * MPI takes 0.01 s and not 0.3 s and needs no folder for temporary files:
 *
 *     OMPI_MCA_pml=ob1 OMPI_MCA_btl=self OMPI_MCA_ess_singleton_isolated=1
 *     OMPI_MCA_orte_create_session_dirs=0 OMPI_MCA_shmem=mmap OMPI_MCA_memory=^patcher
 *     OMPI_MCA_osc=^ucx HWLOC_COMPONENTS=no_os,stop */
tm_status tm_mpi_start(tm_error *error);

TM_EXTERN_C_END

#endif
