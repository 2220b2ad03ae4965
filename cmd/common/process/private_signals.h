/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Signals that end a filter wait while something of it must be tidied up first; the
 * program that it runs is killed at once. */
#ifndef CMD_COMMON_PRIVATE_SIGNALS_H
#define CMD_COMMON_PRIVATE_SIGNALS_H

#include <stdbool.h>
#include <sys/types.h>

/* From here SIGINT, SIGTERM and SIGHUP are only noted, unless they are ignored, until as
 * many _release() as _hold() were called. */
void private_signals_hold(void);

/* The process group to kill when one comes, or 0. Between _block() and _unblock() none
 * comes. */
void private_signals_block(void);
void private_signals_unblock(void);
void private_signals_kill(pid_t group);

/* True when one has come. */
bool private_signals_came(void);

/* As before the first _hold(); the one that has come takes its course. */
void private_signals_release(void);

#endif
