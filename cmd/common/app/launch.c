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
