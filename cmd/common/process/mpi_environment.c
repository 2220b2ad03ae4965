/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mpi_environment.h"

#include <stdlib.h>

/* What a launcher sets: Open MPI's, PMIx's, PMI's. */
static bool launched(void)
{
    static const char *const sign[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
    for (size_t i = 0; i < sizeof sign / sizeof *sign; i++)
        if (getenv(sign[i]))
            return true;
    return false;
}

/* Components of Open MPI, and of hwloc, which it asks for the machine's devices. */
void mpi_environment_set(const filter *f)
{
    static const char *const choice[][2] = {{"OMPI_MCA_pml", "ob1"},
                                            {"OMPI_MCA_btl", "self"},
                                            {"OMPI_MCA_ess_singleton_isolated", "1"},
                                            {"OMPI_MCA_orte_create_session_dirs", "0"},
                                            {"OMPI_MCA_shmem", "mmap"},
                                            {"HWLOC_COMPONENTS", "no_os,stop"}};
    tm_error error;
    for (size_t i = 0; !launched() && i < sizeof choice / sizeof *choice; i++)
        if (setenv(choice[i][0], choice[i][1], 0) != 0) {
            tm_fail_memory(&error);
            filter_fail(f, &error);
        }
}
