/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "start.h"

#include "../ranks.h"

#include <mpi.h>
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

void tm_mpi_finish(void)
{
    int ended = 0;
    MPI_Finalized(&ended);
    if (ended)
        return;
    ignore_leaks(true);
    MPI_Finalize();
    ignore_leaks(false);
}

/* Whether there is as much memory as Open MPI takes at most to start. */
static bool has_memory(void)
{
    enum { START_BYTES = 1 << 25 };
    char *volatile room = malloc(START_BYTES); /* volatile: that it is asked for */
    free(room);
    return room != NULL;
}

tm_status tm_mpi_init(tm_error *error)
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
    if (tm_launched() && atexit(tm_mpi_finish) != 0)
        return tm_fail_memory(error);
    return TM_OK;
}
