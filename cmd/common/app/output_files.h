/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files as the output of a filter: each is written in the same folder without a name
 * first, or under another one where the file system has no files without, with the mode
 * that the shell would give, and they get their names when all are whole. Before that an
 * error, or SIGINT, SIGTERM or SIGHUP, leaves none; without a name, nothing does. A
 * symbolic link stays: what it leads to is written. Written directly is what is there
 * already and is no regular file, a device or a named pipe, what is open already
 * (/dev/stdout), and a file in a folder in which none can be made; these are not whole
 * where the filter fails in the middle. */
#ifndef CMD_COMMON_OUTPUT_FILES_H
#define CMD_COMMON_OUTPUT_FILES_H

#include "../../../lib/base/error.h"
#include "../../../lib/text/text.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct output_file {
    char *name;      /* as it was given */
    char *target;    /* where that leads to, through symbolic links; NULL: a device */
    char *temporary; /* its other name, or NULL */
    bool unnamed;    /* else, and without a temporary, written directly */
    bool named;      /* target is it; an old one has the other name, if it was there */
    int fd;
} output_file;

/* Begins as {0}. */
typedef struct output_files {
    size_t count;
    output_file *file;
    char *folder; /* that was made for them, or NULL; */
    size_t made;  /* and those that it is in, from this length of its name on */
    bool named;   /* none is to be without a name while it is written */
    bool held;    /* signals: something has a name that is not to stay (private.h) */
} output_files;

/* Makes the folder that the files will be in, unless it is there. One for a set, before
 * its files. Where the set is abandoned, a folder that was made is gone, too. */
tm_status output_files_make_folder(output_files *files, const char *name,
                                   tm_error *error);

/* Begins a file; *fd is for writing. */
tm_status output_files_open(output_files *files, const char *name, int *fd,
                            tm_error *error);

/* Under which path others on this machine, or where it is named on others, can open the
 * last file that was begun while it is written; "" where it is written directly. */
enum { OUTPUT_PATH = 4096 };
void output_files_path(const output_files *files, char path[OUTPUT_PATH]);

/* A file of the set that is a text. */
tm_status output_files_write(output_files *files, const char *name, const tm_text *text,
                             tm_error *error);

/* Closes all and gives them their names; where one cannot have it, none has. */
tm_status output_files_finish(output_files *files, tm_error *error);

/* Removes all that was begun. */
void output_files_abandon(output_files *files);

/* A text as one file, a set of its own. */
tm_status output_file_write(const char *name, const tm_text *text, tm_error *error);

#endif
