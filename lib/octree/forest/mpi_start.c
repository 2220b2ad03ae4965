/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mpi_start.h"

#include <p4est.h>
#include <stdlib.h>

/* gcc and clang say it in different ways. */
#ifdef __SANITIZE_ADDRESS__
#define FINDS_LEAKS
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define FINDS_LEAKS
#endif
#endif

/* What Open MPI does not free is no leak of ours. */
#ifdef FINDS_LEAKS
#include <sanitizer/lsan_interface.h>

const char *__lsan_default_suppressions(void)
{
    return "leak:libmpi";
}

const char *__lsan_default_options(void)
{
    return "print_suppressions=0";
}
#endif

static void ignore_leaks(bool ignore)
{
#ifdef FINDS_LEAKS
    if (ignore)
        __lsan_disable();
    else
        __lsan_enable();
#else
    (void)ignore;
#endif
}

static void finish(void)
{
    int ended = 0;
    MPI_Finalized(&ended);
    if (ended)
        return;
    ignore_leaks(true);
    MPI_Finalize();
    ignore_leaks(false);
}

bool tm_mpi_launched(void)
{
    static const char *const sign[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
    for (size_t i = 0; i < sizeof sign / sizeof *sign; i++)
        if (getenv(sign[i]))
            return true;
    return false;
}

/* Whether there is as much memory as Open MPI takes at most to start. */
static bool has_memory(void)
{
    enum { START_BYTES = 1 << 25 };
    char *volatile room = malloc(START_BYTES); /* volatile: that it is asked for */
    free(room);
    return room != NULL;
}

tm_status tm_mpi_start(tm_error *error)
{
    int started = 0;
    MPI_Initialized(&started);
    if (started)
        return TM_OK;
    if (!has_memory())
        return tm_fail_memory(error);
    int got = 0;
    ignore_leaks(true);
    const int status = MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &got);
    ignore_leaks(false);
    if (status != MPI_SUCCESS)
        return tm_fail(error, TM_ERROR_SYSTEM, "MPI does not start");
    if (tm_mpi_launched() && atexit(finish) != 0)
        return tm_fail_memory(error);
    sc_set_log_defaults(NULL, NULL, SC_LP_SILENT); /* but during p4est_call.c */
    sc_init(MPI_COMM_SELF, 0, 0, NULL, SC_LP_DEFAULT);
    p4est_init(NULL, SC_LP_DEFAULT);
    return TM_OK;
}
