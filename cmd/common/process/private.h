/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a filter must tidy up before it ends, also where a signal ends it: signals that
 * wait meanwhile, and a folder in which another program works. */
#ifndef CMD_COMMON_PRIVATE_H
#define CMD_COMMON_PRIVATE_H

#include "../../../lib/base/error.h"
#include "../../../lib/text/text.h"

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

/* A folder that only the user can look into, in which another program works on files of
 * ours. It is gone when private_folder_close() returns, and also where a signal ends
 * the filter before: SIGINT, SIGTERM and SIGHUP kill the program, private_folder_close()
 * then raises them again. Where the filter is killed it stays, until the next one makes
 * a folder of that name in the same place. One at a time. */
typedef struct private_folder {
    char path[768];
    int lock; /* the folder, open, and locked as long as it is in use */
} private_folder;

/* Makes $TMPDIR/termesh-NAME.XXXXXX, or that in /tmp, with mode 0700. The path, which may
 * be relative, does not begin with -. */
tm_status private_folder_open(private_folder *folder, const char *name, tm_error *error);

/* Makes a file of the folder, to write; -1 with errno where that fails. */
int private_folder_create(const private_folder *folder, const char *file);

/* Writes a file of the folder. */
tm_status private_folder_write(const private_folder *folder, const char *file,
                               const tm_text *text, tm_error *error);

/* Reads a file of the folder; *exists is false where it is not there. */
tm_status private_folder_read(const private_folder *folder, const char *file,
                              tm_text *text, bool *exists, tm_error *error);

/* Why nothing more can be written in the folder, as errno says it, as where the disk is
 * full; 0 where something can. */
int private_folder_full(const private_folder *folder);

/* Removes the folder with all files in it. */
void private_folder_close(private_folder *folder);

#endif
