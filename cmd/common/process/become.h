/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a new process does to be another program. */
#ifndef CMD_COMMON_BECOME_H
#define CMD_COMMON_BECOME_H

#include <stdbool.h>
#include <sys/types.h>

/* This process is to be killed where its parent ends, however that comes; false where
 * that has ended already. */
bool end_with_parent(pid_t parent);

/* Becomes argv[0], which is looked up in PATH, in a process group of its own that ends
 * with its parent, with these descriptors for the standard ones; -1 is /dev/null. Where
 * that cannot be done, errno is written to the descriptor `failure`, which the program
 * does not get. */
_Noreturn void become_program(char *const argv[], pid_t parent, const int standard[3],
                              int failure);

#endif
