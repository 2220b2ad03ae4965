/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gmsh_child.h"

#include "../process/private.h"

#include <errno.h>
#include <fcntl.h>
#include <gmshc.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* Where the child leaves what it has to say. */
typedef struct report {
    bool is_done;
    tm_status status;
    tm_error error;
} report;

tm_status gmsh_fail(tm_status status, tm_error *error)
{
    char *what = NULL;
    int failed;
    gmshLoggerGetLastError(&what, &failed);
    if (!failed && what && *what)
        tm_fail(error, status, "Gmsh: %s", what);
    else
        tm_fail(error, status,
                "Gmsh breaks off and does not say why (it asks for much memory where a "
                "file is damaged)");
    gmshFree(what);
    return status;
}

/* The name ------------------------------------------------------------------------- */

tm_status gmsh_link_make(gmsh_link *link, int fd, const char *suffix, tm_error *error)
{
    char to[64];
    const tm_status status = private_folder_open(&link->folder, "gmsh", error);
    if (status != TM_OK)
        return status;
    snprintf(to, sizeof to, "/proc/self/fd/%d", fd);
    snprintf(link->path, sizeof link->path, "%s/mesh.%s", link->folder.path, suffix);
    if (symlink(to, link->path) == 0)
        return TM_OK;
    tm_fail(error, TM_ERROR_SYSTEM, "cannot make %s: %s", link->path, strerror(errno));
    private_folder_close(&link->folder);
    return TM_ERROR_SYSTEM;
}

void gmsh_link_remove(gmsh_link *link)
{
    private_folder_close(&link->folder);
}

size_t gmsh_link_hide(const gmsh_link *link, char *bytes, size_t size)
{
    const char *name = strrchr(link->path, '/') + 1;
    const size_t folder = (size_t)(name - link->path);
    char *at;
    while ((at = memmem(bytes, size, link->path, strlen(link->path)))) {
        memmove(at, at + folder, size - (size_t)(at - bytes) - folder);
        size -= folder;
    }
    return size;
}

/* The child ------------------------------------------------------------------------ */

/* All that is mapped so far, in bytes. */
static size_t address_space(void)
{
    size_t pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (file) {
        if (fscanf(file, "%zu", &pages) != 1)
            pages = 0;
        fclose(file);
    }
    return pages * (size_t)sysconf(_SC_PAGESIZE);
}

/* The sanitizers map more than there is. */
static void limit(const gmsh_limits *limits)
{
#ifndef __SANITIZE_ADDRESS__
    if (limits->memory > 0) {
        const rlim_t most = (rlim_t)(address_space() + limits->memory);
        setrlimit(RLIMIT_AS, &(struct rlimit){most, most});
    }
#endif
    if (limits->seconds > 0)
        setrlimit(RLIMIT_CPU, &(struct rlimit){limits->seconds, limits->seconds + 1});
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
}

/* The libraries below Gmsh print, too. */
static void silence(void)
{
    const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nothing < 0 || dup2(nothing, STDIN_FILENO) < 0 ||
        dup2(nothing, STDOUT_FILENO) < 0 || dup2(nothing, STDERR_FILENO) < 0)
        _exit(EXIT_FAILURE);
}

static tm_status start_gmsh(tm_error *error)
{
    int failed;
    gmshInitialize(0, NULL, 0, &failed);
    if (failed)
        return gmsh_fail(TM_ERROR_SYSTEM, error);
    gmshOptionSetNumber("General.Terminal", 0, &failed);
    if (!failed)
        gmshOptionSetNumber("General.NumThreads", 1, &failed);
    if (!failed)
        gmshLoggerStart(&failed);
    return failed ? gmsh_fail(TM_ERROR_SYSTEM, error) : TM_OK;
}

/* In the new process: never returns, and tidies nothing up. */
_Noreturn static void be_child(gmsh_work *work, void *context, const gmsh_limits *limits,
                               report *left)
{
    static const int ends[] = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGXCPU};
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    silence();
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        signal(ends[i], SIG_DFL);
    private_signals_unblock();
    left->status = start_gmsh(&left->error);
    if (left->status == TM_OK) {
        limit(limits);
        left->status = work(context, &left->error);
    }
    left->is_done = true;
    _exit(EXIT_SUCCESS);
}

static tm_status fail_ended(int status, const gmsh_limits *limits, tm_error *error)
{
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        return tm_fail(error, TM_ERROR_INPUT,
                       "Gmsh did not come to an end in %u seconds (the file may be "
                       "damaged)",
                       limits->seconds);
    if (WIFSIGNALED(status))
        return tm_fail(error, TM_ERROR_INPUT,
                       "Gmsh broke off: %s (the file may be damaged)",
                       strsignal(WTERMSIG(status)));
    return tm_fail(error, TM_ERROR_INPUT, "Gmsh broke off (the file may be damaged)");
}

/* Waits; a signal that ends the filter has killed it. */
static tm_status wait_for(pid_t child, const report *left, const gmsh_limits *limits,
                          tm_error *error)
{
    int status;
    pid_t ended;
    while ((ended = waitpid(child, &status, 0)) < 0 && errno == EINTR)
        ;
    private_signals_kill(0);
    if (private_signals_came())
        return tm_fail(error, TM_ERROR_SYSTEM, "interrupted");
    if (ended < 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot wait for Gmsh: %s",
                       strerror(errno));
    if (!left->is_done)
        return fail_ended(status, limits, error);
    if (left->status != TM_OK && error)
        *error = left->error;
    return left->status;
}

tm_status gmsh_child_run(gmsh_work *work, void *context, const gmsh_limits *limits,
                         tm_error *error)
{
    report *left = mmap(NULL, sizeof *left, PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (left == MAP_FAILED)
        return tm_fail_memory(error);
    private_signals_hold();
    private_signals_block();
    const pid_t child = private_signals_came() ? -1 : fork();
    if (child == 0)
        be_child(work, context, limits, left);
    const int cause = errno;
    if (child > 0) {
        setpgid(child, child);
        private_signals_kill(child);
    }
    private_signals_unblock();
    const tm_status status =
        child > 0 ? wait_for(child, left, limits, error)
                  : tm_fail(error, TM_ERROR_SYSTEM, "cannot start a process: %s",
                            private_signals_came() ? "interrupted" : strerror(cause));
    munmap(left, sizeof *left);
    private_signals_release();
    return status;
}
