# shellcheck shell=sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced: MPI for one process, as the filters set it (lib/octree/forest/mpi_start.h).
export OMPI_MCA_pml=ob1 OMPI_MCA_btl=self OMPI_MCA_ess_singleton_isolated=1 \
    OMPI_MCA_orte_create_session_dirs=0 OMPI_MCA_shmem=mmap OMPI_MCA_memory=^patcher \
    OMPI_MCA_osc=^ucx HWLOC_COMPONENTS=no_os,stop
