/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mpi_environment.h"

#include "../../../lib/ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

extern char **environ;

/* Forgets what the environment and files say to Open MPI. */
static bool forget_parameters(void)
{
    static const char prefix[] = "OMPI_MCA_";
    char name[128];
    for (size_t i = 0; environ[i];) {
        const size_t length = strcspn(environ[i], "=");
        if (strncmp(environ[i], prefix, strlen(prefix)) != 0 || length >= sizeof name) {
            i++;
            continue;
        }
        memcpy(name, environ[i], length);
        name[length] = '\0';
        if (unsetenv(name) != 0)
            return false;
    }
    return setenv("OMPI_MCA_mca_base_param_files", "none", 1) == 0;
}

/* Components of Open MPI, and of hwloc, which it asks for the machine's devices. */
void mpi_environment_set(const filter *f)
{
    static const char *const choice[][2] = {
        {"OMPI_MCA_pml", "ob1"},
        {"OMPI_MCA_btl", "self"},
        {"OMPI_MCA_ess_singleton_isolated", "1"},
        {"OMPI_MCA_orte_create_session_dirs", "0"},
        {"OMPI_MCA_shmem", "mmap"},
        /* These two watch munmap() in the whole program. */
        {"OMPI_MCA_memory", "^patcher"},
        {"OMPI_MCA_osc", "^ucx"},
        {"HWLOC_COMPONENTS", "no_os,stop"}};
    bool done = true;
    if (!tm_launched()) {
        done = forget_parameters();
        for (size_t i = 0; done && i < sizeof choice / sizeof *choice; i++)
            done = setenv(choice[i][0], choice[i][1], 1) == 0;
    }
    tm_error error;
    if (!done) {
        tm_fail_memory(&error);
        filter_fail(f, &error);
    }
}
