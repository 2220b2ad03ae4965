/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_program.h"

#include "../../../lib/text/input.h"
#include "become.h"
#include "private.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

/* A pair of descriptors: what is written to `write` can be read from `read`. */
typedef struct {
    int read;
    int write;
} channel;

static bool open_pipe(channel *c)
{
    int fd[2];
    if (pipe2(fd, O_CLOEXEC) != 0)
        return false;
    *c = (channel){fd[0], fd[1]};
    return true;
}

/* A terminal that passes bytes on as they are. */
static bool open_terminal(channel *c)
{
    enum { NAME = 128 };
    char name[NAME];
    struct termios mode;
    c->write = -1;
    c->read = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (c->read < 0)
        return false;
    if (grantpt(c->read) == 0 && unlockpt(c->read) == 0 &&
        ptsname_r(c->read, name, sizeof name) == 0)
        c->write = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (c->write >= 0 && tcgetattr(c->write, &mode) == 0) {
        cfmakeraw(&mode);
        if (tcsetattr(c->write, TCSANOW, &mode) == 0)
            return true;
    }
    if (c->write >= 0)
        close(c->write);
    close(c->read);
    return false;
}

static double now(void)
{
    static const double nanosecond = 1e-9;
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + nanosecond * (double)t.tv_nsec;
}

/* The times of one run; HUGE_VAL: never. */
typedef struct {
    double end;    /* when it is killed */
    double silent; /* when it has been silent for too long */
} moments;

/* Waits until there is something to read, or for a signal; kills the program when its
 * time is over. */
static void wait_to_read(int fd, pid_t child, const program_watch *watch, moments *at,
                         program_end *end)
{
    static const double milliseconds = 1e3, longest = 1e6;
    struct pollfd one = {.fd = fd, .events = POLLIN};
    for (;;) {
        const double until = fmin(fmin(at->end, at->silent) - now(), longest);
        const int wait = (int)ceil(fmax(until, 0) * milliseconds);
        const int ready = poll(&one, 1, wait);
        if (ready > 0 || (ready < 0 && errno != EINTR))
            return;
        if (now() >= at->silent) {
            at->silent = HUGE_VAL;
            watch->silent(watch->context);
        }
        if (now() >= at->end) {
            at->end = HUGE_VAL;
            end->timed_out = true;
            kill(-child, SIGKILL);
        }
    }
}

/* Reads until no process can write any more; a terminal says so by EIO. */
static tm_status listen_to(int fd, pid_t child, const program_watch *watch,
                           program_end *end, tm_error *error)
{
    enum { STEP = 4096 };
    char bytes[STEP];
    moments at = {.end = watch->timeout > 0 ? now() + watch->timeout : HUGE_VAL,
                  .silent = now() + watch->silence};
    for (;;) {
        wait_to_read(fd, child, watch, &at, end);
        ptrdiff_t got = tm_read_some(fd, bytes, sizeof bytes);
        if (got == 0 || (got < 0 && errno == EIO))
            return TM_OK;
        if (got < 0)
            return tm_fail(error, TM_ERROR_SYSTEM, "cannot read from a program: %s",
                           strerror(errno));
        tm_text_append(&end->output, bytes, (size_t)got);
        watch->listen(watch->context, bytes, (size_t)got);
        if (at.silent < HUGE_VAL)
            at.silent = now() + watch->silence;
    }
}

static tm_status wait_for(pid_t child, program_end *end, tm_error *error)
{
    int status;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return tm_fail(error, TM_ERROR_SYSTEM, "cannot wait for a program: %s",
                           strerror(errno));
    if (WIFSIGNALED(status))
        end->signal = WTERMSIG(status);
    else
        end->exit_status = WEXITSTATUS(status);
    return TM_OK;
}

static pid_t start(char *const argv[], const channel *output, const channel *failure)
{
    const pid_t parent = getpid();
    private_signals_block();
    pid_t child = private_signals_came() ? -1 : fork();
    if (child == 0) {
        const int standard[] = {-1, output->write, output->write};
        become_program(argv, parent, standard, failure->write);
    }
    int cause = errno;
    if (child > 0) {
        setpgid(child, child);
        private_signals_kill(child);
    }
    private_signals_unblock();
    errno = cause;
    return child;
}

tm_status run_program(char *const argv[], const program_watch *watch, program_end *end,
                      tm_error *error)
{
    channel output, failure;
    *end = (program_end){0};
    if (!open_pipe(&failure))
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot make a pipe: %s", strerror(errno));
    if (!open_terminal(&output) && !open_pipe(&output)) {
        close(failure.read);
        close(failure.write);
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot make a pipe: %s", strerror(errno));
    }
    pid_t child = start(argv, &output, &failure);
    int cause = errno;
    close(output.write);
    close(failure.write);
    tm_status status = TM_OK;
    if (child < 0) {
        status = tm_fail(error, TM_ERROR_SYSTEM, "cannot start %s: %s", argv[0],
                         private_signals_came() ? "interrupted" : strerror(cause));
    } else {
        tm_read_some(failure.read, (char *)&end->cannot_start, sizeof end->cannot_start);
        status = listen_to(output.read, child, watch, end, error);
        tm_status waited = wait_for(child, end, error);
        private_signals_kill(0);
        status = status == TM_OK ? waited : status;
    }
    close(output.read);
    close(failure.read);
    return status;
}
