/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gmsh's library in a process of its own. What it reads it trusts: damaged files end it
 * by a signal, let it ask for all the memory there is, or run without end; and it prints.
 * None of that may happen to a filter. */
#ifndef CMD_COMMON_GMSH_CHILD_H
#define CMD_COMMON_GMSH_CHILD_H

#include "../../../lib/base/error.h"
#include "../process/private.h"

#include <stddef.h>

/* What it may use. */
typedef struct gmsh_limits {
    size_t memory;    /* bytes of address space beyond what it has at the start; 0: any */
    unsigned seconds; /* of processor time; 0: any */
} gmsh_limits;

/* Runs work(context, error) in a child process in which Gmsh is initialised, silent and
 * fails at its first error, and waits for it. Of the child's memory nothing comes back
 * but *error: results are written to a file that is open. Returns what work() returned;
 * TM_ERROR_INPUT where a signal or a limit ended it, TM_ERROR_SYSTEM where no process can
 * be made. Signals that end the filter end it, too (private.h: they are held here). */
typedef tm_status gmsh_work(void *context, tm_error *error);
tm_status gmsh_child_run(gmsh_work *work, void *context, const gmsh_limits *limits,
                         tm_error *error);

/* A name for a file, for Gmsh, which tells formats by the suffix, and of any file NAME
 * reads NAME.opt, too, which may hold commands. In a folder in which there is nothing
 * else. */
typedef struct gmsh_link {
    private_folder folder;
    char path[1024];
} gmsh_link;

/* Makes it, for the file that is open as fd in this process and in its children. */
tm_status gmsh_link_make(gmsh_link *link, int fd, const char *suffix, tm_error *error);
void gmsh_link_remove(gmsh_link *link);

/* Gmsh writes the path to files, and says it in messages: removes the folder from the
 * first `size` bytes where it is there. Returns how many bytes are left. */
size_t gmsh_link_hide(const gmsh_link *link, char *bytes, size_t size);

/* In the child: sets *error to what Gmsh's last error says, with no more than `status`.
 */
tm_status gmsh_fail(tm_status status, tm_error *error);

/* Whether Gmsh has said what is wrong. It does so of kinds of elements that it knows the
 * number of and no more; not where memory is out. */
bool gmsh_says_why(void);

#endif
