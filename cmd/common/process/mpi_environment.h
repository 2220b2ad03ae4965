/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What filters that use p4est ask of MPI. */
#ifndef CMD_COMMON_MPI_ENVIRONMENT_H
#define CMD_COMMON_MPI_ENVIRONMENT_H

#include "../app/filter.h"

/* Where no launcher (mpirun, srun) has started the program, MPI is to start without what
 * talks to other processes (../../../lib/octree/forest/mpi_start.h): sets variables of
 * the environment, whatever those and files said before. Exits where
 * memory is out. */
void mpi_environment_set(const filter *f);

#endif
