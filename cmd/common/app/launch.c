/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Filters under a launcher. Ranks that have nothing to do end well, whatever becomes of
 * rank 0: a launcher that sees one fail kills the others, which may have something to
 * say. */
#include "filter.h"

#include "../../../lib/ranks/ranks.h"

#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* The program of that name that is linked with MPI: ../libexec/termesh/mpi/NAME. */
static void become_mpi_program(const filter *f, char **argv)
{
    char path[PATH_MAX + 64];
    const ssize_t size = readlink("/proc/self/exe", path, PATH_MAX);
    if (size <= 0)
        return;
    path[size] = '\0';
    for (int i = 0; i < 2; i++) {
        char *slash = strrchr(path, '/');
        if (!slash)
            return;
        *slash = '\0';
    }
    snprintf(path + strlen(path), sizeof path - strlen(path), "/libexec/termesh/mpi/%s",
             f->name);
    execv(path, argv);
}

void filter_launch(const filter *f, char **argv)
{
    if (tm_launched_count() == 1)
        return;
    if (f->ranks && !tm_ranks_are_mpi())
        become_mpi_program(f, argv);
    if (filter_speaks()) {
        if (!tm_ranks_are_mpi())
            tm_launched_forget();
        return;
    }
    if (!tm_ranks_are_mpi())
        exit(EXIT_SUCCESS);
    const int nothing = open("/dev/null", O_WRONLY);
    if (nothing >= 0)
        dup2(nothing, STDOUT_FILENO);
    close(nothing);
}

bool filter_together(const filter *f, bool can)
{
    tm_error error;
    if (tm_launched_count() == 1 || !tm_ranks_are_mpi())
        return false;
    if (!can && tm_launched_rank() > 0)
        exit(EXIT_SUCCESS);
    if (!can) {
        tm_launched_forget();
        return false;
    }
    if (tm_ranks_start(&error) != TM_OK)
        filter_fail(f, &error);
    return tm_ranks_count() > 1;
}

/* The processor time of this rank, in milliseconds, and the memory that it had at most,
 * in kB. */
static void find_usage(size_t *time, size_t *memory)
{
    enum { THOUSAND = 1000 };
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    const time_t seconds = usage.ru_utime.tv_sec + usage.ru_stime.tv_sec;
    const suseconds_t rest = usage.ru_utime.tv_usec + usage.ru_stime.tv_usec;
    *time = THOUSAND * (size_t)seconds + (size_t)rest / THOUSAND;
    *memory = (size_t)usage.ru_maxrss;
}

void filter_verbose_ranks(const filter *f)
{
    enum { BYTES, MESSAGES, TIME, MEMORY, FIGURES };
    const double thousand = 1e3, million = 1e6;
    const unsigned ranks = tm_ranks_count();
    if (ranks == 1)
        return;
    const tm_ranks_traffic sent = tm_ranks_sent();
    size_t sum[FIGURES] = {[BYTES] = sent.bytes, [MESSAGES] = sent.messages};
    double most[FIGURES];
    find_usage(&sum[TIME], &sum[MEMORY]);
    for (int i = 0; i < FIGURES; i++)
        most[i] = (double)sum[i];
    tm_ranks_sum(sum, FIGURES);
    tm_ranks_largest(most, FIGURES);
    filter_verbose(f,
                   "%u ranks: %.1f MB sent by each, %.1f MB at most, in %.0f messages, "
                   "%.0f at most; %.2f s of CPU, %.2f s at most; %.1f MB of memory, "
                   "%.1f MB at most",
                   ranks, (double)sum[BYTES] / ranks / million, most[BYTES] / million,
                   (double)sum[MESSAGES] / ranks, most[MESSAGES],
                   (double)sum[TIME] / ranks / thousand, most[TIME] / thousand,
                   (double)sum[MEMORY] / ranks / thousand, most[MEMORY] / thousand);
}

bool filter_speaks(void)
{
    return tm_launched_count() == 1 || tm_launched_rank() == 0;
}

void filter_end(int status)
{
    if (tm_ranks_count() > 1)
        tm_ranks_end(status);
    exit(filter_speaks() ? status : EXIT_SUCCESS);
}

void filter_agree(const filter *f, tm_status status, tm_error *error)
{
    if (tm_ranks_agree(status, error) == TM_OK)
        return;
    if (tm_rank() == 0)
        filter_say_failure(f, error);
    output_files_abandon(f->files);
    exit(tm_rank() == 0 ? (int)error->status : EXIT_SUCCESS);
}
