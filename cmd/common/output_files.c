/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "output_files.h"

#include "../../lib/base/text.h"
#include "private_signals.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <fcntl.h>
#include <unistd.h>

static tm_status fail_file(const char *name, tm_error *error)
{
    return tm_fail_at(error, TM_ERROR_SYSTEM, name, 0, NULL, "cannot write: %s",
                      strerror(errno));
}

/* NAME.XXXXXX, as mkostemp() wants it; NULL where memory is out. */
static char *temporary_name(const char *name)
{
    tm_text text = {0};
    tm_text_format(&text, "%s.XXXXXX", name);
    return text.failed ? NULL : text.byte;
}

tm_status output_files_open(output_files *files, const char *name, int *fd,
                            tm_error *error)
{
    output_file *grown = realloc(files->file, (files->count + 1) * sizeof *files->file);
    if (!grown)
        return tm_fail_memory(error);
    files->file = grown;
    output_file file = {strdup(name), temporary_name(name), -1};
    if (!file.name || !file.temporary) {
        free(file.name);
        free(file.temporary);
        return tm_fail_memory(error);
    }
    if (files->count == 0)
        private_signals_hold();
    file.fd = mkostemp(file.temporary, O_CLOEXEC);
    if (file.fd < 0) {
        tm_status status = fail_file(name, error);
        free(file.name);
        free(file.temporary);
        if (files->count == 0)
            private_signals_release();
        return status;
    }
    mode_t mask = umask(0);
    umask(mask);
    fchmod(file.fd, 0666 & ~mask);
    *fd = file.fd;
    files->file[files->count++] = file;
    return TM_OK;
}

/* Forgets the files; a signal that waited takes its course. */
static void release(output_files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        free(files->file[i].name);
        free(files->file[i].temporary);
    }
    free(files->file);
    if (files->count > 0)
        private_signals_release();
    *files = (output_files){0};
}

void output_files_abandon(output_files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        if (files->file[i].fd >= 0)
            close(files->file[i].fd);
        unlink(files->file[i].temporary);
    }
    release(files);
}

static tm_status close_all(output_files *files, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t i = 0; i < files->count; i++) {
        if (close(files->file[i].fd) != 0 && status == TM_OK)
            status = fail_file(files->file[i].name, error);
        files->file[i].fd = -1;
    }
    return status;
}

tm_status output_files_finish(output_files *files, tm_error *error)
{
    tm_status status = close_all(files, error);
    if (status == TM_OK && private_signals_came())
        status = tm_fail(error, TM_ERROR_SYSTEM, "interrupted");
    for (size_t i = 0; i < files->count && status == TM_OK; i++)
        if (rename(files->file[i].temporary, files->file[i].name) != 0)
            status = fail_file(files->file[i].name, error);
    if (status == TM_OK)
        release(files);
    else
        output_files_abandon(files);
    return status;
}
