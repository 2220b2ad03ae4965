/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gnuplot.h"

#include "../../../lib/base/file.h"
#include "../app/output_files.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* An unnamed file that holds the script, at its beginning; -1 with errno. A file and not
 * a pipe, so that gnuplot and we never wait for each other. */
static int script_file(const tm_text *script, tm_error *error)
{
    FILE *file = tmpfile();
    if (!file) {
        tm_fail(error, TM_ERROR_SYSTEM, "cannot make a temporary file: %s",
                strerror(errno));
        return -1;
    }
    const int fd = fcntl(fileno(file), F_DUPFD_CLOEXEC, 0);
    const int reason = errno;
    fclose(file);
    if (fd < 0) {
        tm_fail(error, TM_ERROR_SYSTEM, "cannot make a temporary file: %s",
                strerror(reason));
        return -1;
    }
    if (tm_write_all(fd, script->byte, script->size, error) != TM_OK ||
        lseek(fd, 0, SEEK_SET) != 0) {
        close(fd);
        return -1;
    }
    return fd;
}

/* Starts gnuplot without the user's own settings. Returns 0 or what errno would say. */
static int start(int input, int output, pid_t *child)
{
    char *const arguments[] = {"gnuplot", "-d", NULL};
    /* In the C locale gnuplot complains that it cannot write a degree sign. */
    if (setenv("LC_ALL", "C.UTF-8", 1) != 0)
        return errno;
    posix_spawn_file_actions_t actions;
    int reason = posix_spawn_file_actions_init(&actions);
    if (reason != 0)
        return reason;
    reason = posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    if (reason == 0)
        reason = posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    if (reason == 0)
        reason = posix_spawnp(child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return reason;
}

static bool wait_for(pid_t child)
{
    int status;
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR)
            return false;
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static tm_status run(int script, tm_text *figure, tm_error *error)
{
    int end[2];
    if (pipe2(end, O_CLOEXEC) != 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot run gnuplot: %s", strerror(errno));
    pid_t child = -1;
    const int reason = start(script, end[1], &child);
    close(end[1]);
    tm_status status = TM_OK;
    if (reason == ENOENT)
        status =
            tm_fail(error, TM_ERROR_SYSTEM, "--plot needs gnuplot (package gnuplot-nox)");
    else if (reason != 0)
        status =
            tm_fail(error, TM_ERROR_SYSTEM, "cannot run gnuplot: %s", strerror(reason));
    else
        status = tm_read_all(end[0], "gnuplot", figure, error);
    close(end[0]);
    if (reason == 0 && (!wait_for(child) || figure->size == 0) && status == TM_OK)
        status = tm_fail(error, TM_ERROR_SYSTEM, "gnuplot failed");
    return status;
}

tm_status gnuplot_plot(const tm_text *script, const char *file, tm_error *error)
{
    if (script->failed || script->size == 0)
        return tm_fail_memory(error);
    const int fd = script_file(script, error);
    if (fd < 0)
        return TM_ERROR_SYSTEM;
    tm_text figure = {0};
    tm_status status = run(fd, &figure, error);
    close(fd);
    if (status == TM_OK)
        status = output_file_write(file, &figure, error);
    tm_text_free(&figure);
    return status;
}
