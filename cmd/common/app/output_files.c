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

static const char *last_part(const char *name)
{
    const char *slash = strrchr(name, '/');
    return slash ? slash + 1 : name;
}

/* The folder of file->target, with its slash, and `name`; NULL where memory is out. */
static char *beside_target(const output_file *file, const char *name)
{
    tm_text text = {0};
    tm_text_append(&text, file->target, (size_t)(last_part(file->target) - file->target));
    tm_text_string(&text, name);
    if (!text.failed)
        return text.byte;
    tm_text_free(&text);
    errno = ENOMEM;
    return NULL;
}

/* A file without a name there, which can get one; -1 where there is no such thing. */
static int make_unnamed(output_file *file)
{
    char *folder = beside_target(file, ".");
    const int fd = folder && access("/proc/self/fd", X_OK) == 0
                       ? open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, S_IRUSR | S_IWUSR)
                       : -1;
    file->unnamed = fd >= 0;
    free(folder);
    return fd;
}

/* A file with a name as short as names can have to be; -1 with errno. */
static int make_named(output_file *file)
{
    file->temporary = beside_target(file, "termesh.XXXXXX");
    if (!file->temporary)
        return -1;
    const int fd = mkostemp(file->temporary, O_CLOEXEC), cause = errno;
    if (fd < 0) {
        free(file->temporary);
        file->temporary = NULL;
    }
    errno = cause;
    return fd;
}

/* A signal must not end the filter from now on: something has a name that is to be gone.
 */
static void hold_signals(output_files *files)
{
    if (!files->held)
        private_signals_hold();
    files->held = true;
}

static void release_signals(output_files *files)
{
    const bool held = files->held;
    files->held = false;
    if (held)
        private_signals_release();
}

/* Makes a file in the folder of file->target; -1 with errno where that fails. */
static int make_temporary(output_files *files, output_file *file, const struct stat *old)
{
    int fd = files->named ? -1 : make_unnamed(file);
    if (fd < 0) {
        hold_signals(files);
        fd = make_named(file);
    }
    if (fd < 0)
        return -1;
    const mode_t everyone = S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH;
    mode_t mask = umask(0);
    umask(mask);
    fchmod(fd, old ? old->st_mode & everyone : everyone & ~mask);
    return fd;
}

/* Links a file without a name to one that no other has: file->temporary. */
static bool link_beside(output_file *file, const char *open_file)
{
    enum { NAMES = 1000000 };
    char name[32];
    int linked = -1;
    for (int i = 0; linked != 0 && i < NAMES; i++) {
        snprintf(name, sizeof name, "termesh.%06d", (int)((getpid() + i) % NAMES));
        free(file->temporary);
        file->temporary = beside_target(file, name);
        if (!file->temporary)
            return false;
        linked =
            linkat(AT_FDCWD, open_file, AT_FDCWD, file->temporary, AT_SYMLINK_FOLLOW);
        if (linked != 0 && errno != EEXIST)
            break;
    }
    if (linked == 0)
        return true;
    free(file->temporary);
    file->temporary = NULL;
    return false;
}

/* Gives the file under file->temporary its name. Where that is another one's, which may
 * have to come back, that is under file->temporary then. False with errno. */
static bool exchange_names(output_file *file, bool may_come_back)
{
    const char *from = file->temporary, *to = file->target;
    file->named =
        may_come_back && renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_EXCHANGE) == 0;
    if (file->named)
        return true;
    const bool is_new = access(to, F_OK) != 0;
    if (rename(from, to) != 0)
        return false;
    file->named = is_new;
    free(file->temporary);
    file->temporary = NULL;
    return true;
}

/* Gives a whole file its name, in place of the one that has it; false with errno. */
static bool give_name(output_file *file, bool may_come_back)
{
    if (file->unnamed) {
        char open_file[64];
        snprintf(open_file, sizeof open_file, "/proc/self/fd/%d", file->fd);
        if (linkat(AT_FDCWD, open_file, AT_FDCWD, file->target, AT_SYMLINK_FOLLOW) == 0)
            return file->named = true;
        if (errno != EEXIST || !link_beside(file, open_file))
            return false;
    }
    return !file->temporary || exchange_names(file, may_come_back);
}

/* Whether both are to get one name, whatever way leads there. */
static bool is_same(const output_file *a, const output_file *b)
{
    struct stat x, y;
    if (strcmp(last_part(a->target), last_part(b->target)) != 0)
        return false;
    char *p = beside_target(a, "."), *q = beside_target(b, ".");
    const bool same = p && q && stat(p, &x) == 0 && stat(q, &y) == 0 &&
                      x.st_dev == y.st_dev && x.st_ino == y.st_ino;
    free(p);
    free(q);
    return same;
}

static bool is_taken(const output_files *files, const output_file *file)
{
    bool taken = false;
    for (size_t i = 0; i < files->count && !taken; i++)
        taken = (files->file[i].unnamed || files->file[i].temporary) &&
                is_same(&files->file[i], file);
    return taken;
}

/* Whether errno says that no file can be made in the folder, by this user or at all. */
static bool folder_is_closed(void)
{
    return errno == EACCES || errno == EPERM || errno == EROFS;
}

static int open_file(output_files *files, output_file *file)
{
    struct stat old;
    const bool exists = stat(file->name, &old) == 0;
    if (!exists && (errno != ENOENT || file->name[0] == '\0'))
        return -1;
    if (exists && !S_ISREG(old.st_mode))
        return open(file->name, O_WRONLY | O_CLOEXEC);
    file->target = follow_links(file->name);
    if (!file->target)
        return -1;
    const int there = descriptor_of(file->target);
    if (there >= 0)
        return fcntl(there, F_DUPFD_CLOEXEC, 0); /* it goes on where it is */
    if (is_taken(files, file)) {
        errno = EEXIST;
        return -1;
    }
    const int fd = make_temporary(files, file, exists ? &old : NULL);
    if (fd < 0 && exists && folder_is_closed())
        return open(file->target, O_WRONLY | O_TRUNC | O_CLOEXEC);
    return fd;
}

/* Makes files->folder and those that it is in; false with errno. files->made is 0 where
 * all are there. */
static bool make_folders(output_files *files)
{
    const mode_t everyone = S_IRWXU | S_IRWXG | S_IRWXO;
    char *name = files->folder;
    for (size_t at = 1; at <= strlen(name); at++) {
        const char end = name[at];
        if (end != '/' && end != '\0')
            continue;
        name[at] = '\0';
        const bool is_made = mkdir(name, everyone) == 0, is_there = errno == EEXIST;
        name[at] = end;
        if (is_made && files->made == 0)
            files->made = at;
        if (!is_made && !is_there)
            return false;
    }
    return true;
}

/* Removes those that were made, the innermost first. */
static void remove_folders(output_files *files)
{
    char *name = files->folder;
    for (size_t at = strlen(name); files->made > 0 && at >= files->made; at--)
        if (name[at] == '/' || name[at] == '\0') {
            name[at] = '\0';
            rmdir(name);
        }
}

tm_status output_files_make_folder(output_files *files, const char *name, tm_error *error)
{
    tm_status status = TM_OK;
    files->folder = strdup(name);
    if (!files->folder)
        return tm_fail_memory(error);
    hold_signals(files);
    if (!make_folders(files))
        status = tm_fail_at(error, TM_ERROR_SYSTEM, name, 0, NULL,
                            "cannot make the folder: %s", strerror(errno));
    if (status == TM_OK && files->made > 0)
        return TM_OK;
    remove_folders(files);
    free(files->folder);
    files->folder = NULL;
    files->made = 0;
    release_signals(files);
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
    file.fd = open_file(files, &file);
    if (file.fd < 0) {
        tm_status status = errno != EEXIST
                               ? fail_file(name, error)
                               : tm_fail_at(error, TM_ERROR_SYSTEM, name, 0, NULL,
                                            "cannot write: two outputs have this name");
        free_file(&file);
        if (files->count == 0 && !files->folder)
            release_signals(files);
        return status;
    }
    *fd = file.fd;
    files->file[files->count++] = file;
    return TM_OK;
}

void output_files_path(const output_files *files, char path[OUTPUT_PATH])
{
    const output_file *file = &files->file[files->count - 1];
    const char *temporary = file->temporary ? file->temporary : "";
    if (file->unnamed)
        snprintf(path, OUTPUT_PATH, "/proc/%ld/fd/%d", (long)getpid(), file->fd);
    else
        snprintf(path, OUTPUT_PATH, "%s", temporary);
}

/* Forgets the files; a signal that waited takes its course. */
static void release(output_files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        if (files->file[i].fd >= 0)
            close(files->file[i].fd);
        free_file(&files->file[i]);
    }
    free(files->file);
    free(files->folder);
    *files = (output_files){.held = files->held};
    release_signals(files);
}

void output_files_abandon(output_files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        const output_file *file = &files->file[i];
        if (file->named && file->temporary)
            rename(file->temporary, file->target);
        else if (file->named)
            unlink(file->target);
        else if (file->temporary)
            unlink(file->temporary);
    }
    if (files->folder)
        remove_folders(files);
    release(files);
}

/* Those without a name stay open until they have one. */
static tm_status close_named(output_files *files, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t i = 0; i < files->count; i++) {
        if (files->file[i].unnamed)
            continue;
        if (close(files->file[i].fd) != 0 && status == TM_OK)
            status = fail_file(files->file[i].name, error);
        files->file[i].fd = -1;
    }
    return status;
}

tm_status output_files_finish(output_files *files, tm_error *error)
{
    hold_signals(files);
    tm_status status = close_named(files, error);
    if (status == TM_OK && private_signals_came())
        status = tm_fail(error, TM_ERROR_SYSTEM, "interrupted");
    for (size_t i = 0; i < files->count && status == TM_OK; i++)
        if (!give_name(&files->file[i], files->count > 1))
            status = fail_file(files->file[i].name, error);
    if (status != TM_OK) {
        output_files_abandon(files);
        return status;
    }
    for (size_t i = 0; i < files->count; i++)
        if (files->file[i].temporary)
            unlink(files->file[i].temporary); /* the old one */
    release(files);
    return TM_OK;
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
