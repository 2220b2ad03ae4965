/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gmsh_child.h"

#include "../process/become.h"
#include "../process/private.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <gmshc.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* Where the child leaves what it has to say. */
typedef struct report {
    bool is_done;
    bool is_limited; /* its memory, more than that of its parent */
    bool lacks_memory;
    tm_status status;
    tm_error error;
} report;

static report *to_leave; /* that of this child */

_Noreturn static void end_for_memory(void)
{
    to_leave->lacks_memory = true;
    _exit(EXIT_FAILURE);
}

/* What Gmsh has said last, or NULL: to be freed by gmshFree(). */
static char *last_error(void)
{
    char *what = NULL;
    int failed;
    gmshLoggerGetLastError(&what, &failed);
    if (!failed && what && strstr(what, "Out of memory"))
        end_for_memory();
    if (!failed && what && *what)
        return what;
    gmshFree(what);
    return NULL;
}

bool gmsh_says_why(void)
{
    char *what = last_error();
    gmshFree(what);
    return what != NULL;
}

tm_status gmsh_fail(tm_status status, tm_error *error)
{
    char *what = last_error();
    if (what && strstr(what, "Unable to open file")) /* which is open here */
        status = TM_ERROR_SYSTEM;
    if (what)
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

/* Limits what is mapped to that much more than there is, in bytes, unless the limit is
 * less already. The sanitizers map more than any limit. */
static bool limit_memory(size_t more)
{
#ifdef __SANITIZE_ADDRESS__
    (void)more;
    return false;
#else
    size_t pages = 0;
    struct rlimit before;
    FILE *file = fopen("/proc/self/statm", "re");
    if (file) {
        if (fscanf(file, "%zu", &pages) != 1)
            pages = 0;
        fclose(file);
    }
    const rlim_t most = (rlim_t)(pages * (size_t)sysconf(_SC_PAGESIZE) + more);
    return pages > 0 && getrlimit(RLIMIT_AS, &before) == 0 && before.rlim_cur > most &&
           setrlimit(RLIMIT_AS, &(struct rlimit){most, most}) == 0;
#endif
}

static void limit(const gmsh_limits *limits, report *left)
{
    if (limits->memory > 0)
        left->is_limited = limit_memory(limits->memory);
    if (limits->seconds > 0)
        setrlimit(RLIMIT_CPU, &(struct rlimit){limits->seconds, limits->seconds + 1});
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
}

/* The libraries below Gmsh print, too. */
static tm_status silence(tm_error *error)
{
    const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nothing < 0 || dup2(nothing, STDIN_FILENO) < 0 ||
        dup2(nothing, STDOUT_FILENO) < 0 || dup2(nothing, STDERR_FILENO) < 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot open /dev/null: %s",
                       strerror(errno));
    return TM_OK;
}

typedef void new_handler(void);
typedef new_handler *new_handler_setter(new_handler *handler);

/* Gmsh catches what is thrown where memory is out, and goes on with a part of the mesh.
 * New is asked again once; then the child ends. */
static void end_without_memory(void)
{
    static bool again;
    if (again)
        end_for_memory();
    again = true;
}

/* Calls std::set_new_handler() of the C++ library that Gmsh came with. Nothing is linked
 * with it, as a C compiler may have come without. */
static void watch_memory(void)
{
    void *found = dlsym(RTLD_DEFAULT, "_ZSt15set_new_handlerPFvvE");
    new_handler_setter *set;
    memcpy(&set, &found, sizeof set);
    if (found)
        set(end_without_memory);
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
                               report *left, pid_t parent)
{
    static const int ends[] = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGXCPU};
    setpgid(0, 0);
    if (!end_with_parent(parent))
        _exit(EXIT_FAILURE);
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        signal(ends[i], SIG_DFL);
    private_signals_unblock();
    to_leave = left;
    watch_memory();
    left->status = silence(&left->error);
    if (left->status == TM_OK)
        left->status = start_gmsh(&left->error);
    if (left->status == TM_OK) {
        limit(limits, left);
        left->status = work(context, &left->error);
    }
    left->is_done = true;
    _exit(EXIT_SUCCESS);
}

/* How it ended, where it is not done. Where nothing is limited no file is read. */
static tm_status fail_ended(int status, const report *left, const gmsh_limits *limits,
                            tm_error *error)
{
    const bool reads = limits->seconds > 0;
    const tm_status cause = reads ? TM_ERROR_INPUT : TM_ERROR_SYSTEM;
    const char *why = reads ? " (the file may be damaged)" : "";
    if (left->lacks_memory && left->is_limited)
        return tm_fail(error, TM_ERROR_INPUT,
                       "Gmsh asks for more memory than a file of this size needs%s", why);
    if (left->lacks_memory)
        return tm_fail_memory(error);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        return tm_fail(error, cause, "Gmsh did not come to an end in %u seconds%s",
                       limits->seconds, why);
    if (WIFSIGNALED(status))
        return tm_fail(error, cause, "Gmsh broke off: %s%s", strsignal(WTERMSIG(status)),
                       why);
    return tm_fail(error, cause, "Gmsh broke off%s", why);
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
        return fail_ended(status, left, limits, error);
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
    const pid_t parent = getpid();
    const pid_t child = private_signals_came() ? -1 : fork();
    if (child == 0)
        be_child(work, context, limits, left, parent);
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
