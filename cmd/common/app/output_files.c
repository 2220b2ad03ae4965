/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "output_files.h"

#include "../../../lib/text/file.h"
#include "../process/private.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
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

static void free_file(output_file *file)
{
    free(file->name);
    free(file->target);
    free(file->temporary);
}

/* The number of a file that is open already, as /dev/stdout is: its link leads to the
 * name under which it was opened, not to the file. -1 for others. */
static int descriptor_of(const char *path)
{
    static const char *const folder[] = {"/proc/self/fd/", "/dev/fd/"};
    for (size_t i = 0; i < sizeof folder / sizeof *folder; i++) {
        const char *digits = path + strlen(folder[i]);
        char *end;
        if (strncmp(path, folder[i], strlen(folder[i])) != 0 || *digits < '0')
            continue;
        const long fd = strtol(digits, &end, 10);
        if (*end == '\0' && fd <= INT_MAX)
            return (int)fd;
    }
    return -1;
}

/* The file that a name leads to through symbolic links, which need not be there; NULL
 * with errno where there is none. */
static char *follow_links(const char *name)
{
    enum { LINKS_MAX = 40 }; /* as Linux has it, path_resolution(7) */
    tm_text path = {0};
    char target[PATH_MAX];
    tm_text_string(&path, name);
    for (int links = 0; !path.failed && links <= LINKS_MAX; links++) {
        const ssize_t size = descriptor_of(path.byte) >= 0
                                 ? -1
                                 : readlink(path.byte, target, sizeof target);
        if (size < 0)
            return path.byte;
        const char *slash = strrchr(path.byte, '/');
        path.size = slash && target[0] != '/' ? (size_t)(slash + 1 - path.byte) : 0;
        tm_text_append(&path, target, (size_t)size);
    }
    errno = path.failed ? ENOMEM : ELOOP;
    tm_text_free(&path);
    return NULL;
}

/* Makes a file in the folder of file->target, with a short name, as that may be as long
 * as a name can be; -1 with errno where that fails. */
static int make_temporary(output_file *file, const struct stat *old)
{
    tm_text text = {0};
    const char *slash = strrchr(file->target, '/');
    const size_t folder = slash ? (size_t)(slash + 1 - file->target) : 0;
    tm_text_append(&text, file->target, folder);
    tm_text_string(&text, "termesh.XXXXXX");
    errno = ENOMEM;
    int fd = text.failed ? -1 : mkostemp(text.byte, O_CLOEXEC);
    if (fd < 0) {
        const int cause = errno;
        tm_text_free(&text);
        errno = cause;
        return -1;
    }
    file->temporary = text.byte;
    const mode_t everyone = S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH;
    mode_t mask = umask(0);
    umask(mask);
    fchmod(fd, old ? old->st_mode & everyone : everyone & ~mask);
    return fd;
}

/* Whether errno says that no file can be made in the folder, by this user or at all. */
static bool folder_is_closed(void)
{
    return errno == EACCES || errno == EPERM || errno == EROFS;
}

static int open_file(output_file *file)
{
    struct stat old;
    const bool exists = stat(file->name, &old) == 0;
    if (exists && !S_ISREG(old.st_mode))
        return open(file->name, O_WRONLY | O_CLOEXEC);
    file->target = follow_links(file->name);
    if (!file->target)
        return -1;
    const int there = descriptor_of(file->target);
    if (there >= 0)
        return fcntl(there, F_DUPFD_CLOEXEC, 0); /* it goes on where it is */
    const int fd = make_temporary(file, exists ? &old : NULL);
    if (fd < 0 && exists && folder_is_closed())
        return open(file->target, O_WRONLY | O_TRUNC | O_CLOEXEC);
    return fd;
}

tm_status output_files_make_folder(output_files *files, const char *name, tm_error *error)
{
    const mode_t everyone = S_IRWXU | S_IRWXG | S_IRWXO;
    char *folder = strdup(name);
    if (!folder)
        return tm_fail_memory(error);
    private_signals_hold();
    if (mkdir(name, everyone) == 0) {
        files->folder = folder;
        return TM_OK;
    }
    tm_status status = TM_OK;
    if (errno != EEXIST)
        status = tm_fail_at(error, TM_ERROR_SYSTEM, name, 0, NULL,
                            "cannot make the folder: %s", strerror(errno));
    free(folder);
    private_signals_release();
    return status;
}

tm_status output_files_open(output_files *files, const char *name, int *fd,
                            tm_error *error)
{
    output_file *grown = realloc(files->file, (files->count + 1) * sizeof *files->file);
    if (!grown)
        return tm_fail_memory(error);
    files->file = grown;
    output_file file = {.name = strdup(name), .fd = -1};
    if (!file.name)
        return tm_fail_memory(error);
    if (files->count == 0)
        private_signals_hold();
    file.fd = open_file(&file);
    if (file.fd < 0) {
        tm_status status = fail_file(name, error);
        free_file(&file);
        if (files->count == 0)
            private_signals_release();
        return status;
    }
    *fd = file.fd;
    files->file[files->count++] = file;
    return TM_OK;
}

/* Forgets the files; a signal that waited takes its course. */
static void release(output_files *files)
{
    for (size_t i = 0; i < files->count; i++)
        free_file(&files->file[i]);
    free(files->file);
    const int held = (files->count > 0) + (files->folder != NULL);
    free(files->folder);
    *files = (output_files){0};
    for (int i = 0; i < held; i++)
        private_signals_release();
}

void output_files_abandon(output_files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        if (files->file[i].fd >= 0)
            close(files->file[i].fd);
        if (files->file[i].temporary)
            unlink(files->file[i].temporary);
        if (files->folder && files->file[i].target)
            unlink(files->file[i].target);
    }
    if (files->folder)
        rmdir(files->folder);
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
        if (files->file[i].temporary &&
            rename(files->file[i].temporary, files->file[i].target) != 0)
            status = fail_file(files->file[i].name, error);
    if (status == TM_OK)
        release(files);
    else
        output_files_abandon(files);
    return status;
}

tm_status output_files_write(output_files *files, const char *name, const tm_text *text,
                             tm_error *error)
{
    int fd = -1;
    tm_status status =
        text->failed ? tm_fail_memory(error) : output_files_open(files, name, &fd, error);
    if (status != TM_OK)
        return status;
    status = tm_write_text(fd, text, error);
    if (status != TM_OK)
        snprintf(error->file, sizeof error->file, "%s", name);
    return status;
}

tm_status output_file_write(const char *name, const tm_text *text, tm_error *error)
{
    output_files files = {0};
    const tm_status status = output_files_write(&files, name, text, error);
    if (status == TM_OK)
        return output_files_finish(&files, error);
    output_files_abandon(&files);
    return status;
}
