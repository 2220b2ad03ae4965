/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "become.h"

#include "private.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <unistd.h>

bool end_with_parent(pid_t parent)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    return getppid() == parent;
}

static bool take_descriptors(const int standard[3])
{
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++) {
        const int from =
            standard[fd] >= 0 ? standard[fd] : open("/dev/null", O_RDWR | O_CLOEXEC);
        if (from < 0 || dup2(from, fd) < 0)
            return false;
    }
    return true;
}

void become_program(char *const argv[], pid_t parent, const int standard[3], int failure)
{
    setpgid(0, 0);
    if (!end_with_parent(parent))
        _exit(EXIT_FAILURE);
    if (take_descriptors(standard)) {
        private_signals_unblock();
        signal(SIGXFSZ, SIG_DFL); /* filter_start() ignores it */
        execvp(argv[0], argv);
    }
    const int cause = errno;
    (void)!write(failure, &cause, sizeof cause);
    _exit(EXIT_FAILURE);
}
