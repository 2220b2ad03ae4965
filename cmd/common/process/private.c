/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "private.h"

#include "../../../lib/text/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdalign.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Signals -------------------------------------------------------------------------- */

static const int held[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU, SIGUSR1, SIGUSR2};
enum { HELD = sizeof held / sizeof held[0] };

static struct sigaction before[HELD];
static int holds; /* that were not released yet */
static volatile sig_atomic_t came;
static volatile pid_t child_group;

static void note(int signal_number)
{
    came = signal_number;
    if (child_group > 0)
        kill(-child_group, SIGKILL);
}

void private_signals_hold(void)
{
    if (holds++ > 0)
        return;
    struct sigaction action = {.sa_handler = note};
    sigemptyset(&action.sa_mask);
    came = 0;
    for (size_t i = 0; i < HELD; i++) {
        sigaction(held[i], NULL, &before[i]);
        if (before[i].sa_handler != SIG_IGN)
            sigaction(held[i], &action, NULL);
    }
}

static void mask(int how)
{
    sigset_t set;
    sigemptyset(&set);
    for (size_t i = 0; i < HELD; i++)
        sigaddset(&set, held[i]);
    sigprocmask(how, &set, NULL);
}

void private_signals_block(void)
{
    mask(SIG_BLOCK);
}

void private_signals_unblock(void)
{
    mask(SIG_UNBLOCK);
}

void private_signals_kill(pid_t group)
{
    child_group = group;
}

bool private_signals_came(void)
{
    return came != 0;
}

void private_signals_release(void)
{
    if (--holds > 0)
        return;
    for (size_t i = 0; i < HELD; i++)
        sigaction(held[i], &before[i], NULL);
    if (came)
        raise(came);
}

/* The folder ----------------------------------------------------------------------- */

/* Removes the folder that is open as fd, and its files. There may be no memory, and no
 * other descriptor. */
static void remove_folder(const char *path, int fd)
{
    enum { ROOM = 4096 };
    alignas(struct dirent64) char room[ROOM];
    for (ssize_t got; (got = getdents64(fd, room, sizeof room)) > 0;)
        for (ssize_t at = 0; at < got;) {
            const struct dirent64 *entry = (const struct dirent64 *)(room + at);
            if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
                unlinkat(fd, entry->d_name, 0);
            at += entry->d_reclen;
        }
    rmdir(path);
}

/* Removes a folder of ours that nobody has locked: who made it was killed. One that is
 * young may not be locked yet. */
static void remove_left(const char *path)
{
    static const time_t young = 60; /* seconds */
    struct stat about;
    const int fd = open(path, O_DIRECTORY | O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (fd < 0)
        return;
    if (fstat(fd, &about) == 0 && about.st_uid == geteuid() &&
        (about.st_mode & (S_IRWXG | S_IRWXO)) == 0 &&
        about.st_mtime < time(NULL) - young && flock(fd, LOCK_EX | LOCK_NB) == 0)
        remove_folder(path, fd);
    close(fd);
}

/* Removes what others that were killed have left: termesh-NAME.XXXXXX beside
 * folder->path. */
static void remove_all_left(const private_folder *folder)
{
    enum { RANDOM = 6 };
    char parent[sizeof folder->path], path[2 * sizeof folder->path];
    memcpy(parent, folder->path, sizeof parent);
    char *name = strrchr(parent, '/');
    *name++ = '\0';
    const size_t size = strlen(name);
    DIR *listing = opendir(parent);
    if (!listing)
        return;
    for (struct dirent *entry; (entry = readdir(listing));)
        if (strlen(entry->d_name) == size &&
            strncmp(entry->d_name, name, size - RANDOM) == 0 &&
            strcmp(entry->d_name, name) != 0) {
            snprintf(path, sizeof path, "%s/%s", parent, entry->d_name);
            remove_left(path);
        }
    closedir(listing);
}

/* Makes it, opens and locks it; false with errno where that cannot be done. */
static bool make_folder(private_folder *folder)
{
    if (!mkdtemp(folder->path))
        return false;
    folder->lock = open(folder->path, O_DIRECTORY | O_RDONLY | O_CLOEXEC);
    const int cause = errno;
    if (folder->lock < 0)
        rmdir(folder->path);
    else
        flock(folder->lock, LOCK_EX | LOCK_NB);
    errno = cause;
    return folder->lock >= 0;
}

tm_status private_folder_open(private_folder *folder, const char *name, tm_error *error)
{
    const char *parent = getenv("TMPDIR");
    if (!parent || !*parent)
        parent = "/tmp";
    if (strchr(parent, '\n'))
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "the path in TMPDIR has a line break, which TetGen's files cannot "
                       "name");
    /* A program takes what begins with - for an option. */
    int size = snprintf(folder->path, sizeof folder->path, "%s%s/termesh-%s.XXXXXX",
                        parent[0] == '-' ? "./" : "", parent, name);
    if (size < 0 || (size_t)size >= sizeof folder->path)
        return tm_fail(error, TM_ERROR_SYSTEM, "the path in TMPDIR is too long");
    private_signals_hold();
    if (make_folder(folder)) {
        remove_all_left(folder);
        return TM_OK;
    }
    tm_status status =
        tm_fail(error, TM_ERROR_SYSTEM, "cannot make a folder in %s: %s%s", parent,
                strerror(errno), getenv("TMPDIR") ? " (TMPDIR says where)" : "");
    folder->path[0] = '\0';
    private_signals_release();
    return status;
}

/* Opens a file of the folder; -1 with errno where that fails. */
static int open_file(const private_folder *folder, const char *file, int flags)
{
    return openat(folder->lock, file, flags | O_CLOEXEC, S_IRUSR | S_IWUSR);
}

static tm_status fail_file(const private_folder *folder, const char *file,
                           const char *what, tm_error *error)
{
    return tm_fail(error, TM_ERROR_SYSTEM, "%s %s/%s: %s", what, folder->path, file,
                   strerror(errno));
}

int private_folder_create(const private_folder *folder, const char *file)
{
    return open_file(folder, file, O_WRONLY | O_CREAT | O_EXCL);
}

tm_status private_folder_write(const private_folder *folder, const char *file,
                               const tm_text *text, tm_error *error)
{
    if (text->failed)
        return tm_fail_memory(error);
    int fd = private_folder_create(folder, file);
    if (fd < 0)
        return fail_file(folder, file, "cannot make", error);
    tm_status status = tm_write_all(fd, text->byte, text->size, NULL);
    if (status != TM_OK)
        fail_file(folder, file, "cannot write", error);
    if (close(fd) != 0 && status == TM_OK)
        status = fail_file(folder, file, "cannot write", error);
    return status;
}

tm_status private_folder_read(const private_folder *folder, const char *file,
                              tm_text *text, bool *exists, tm_error *error)
{
    int fd = open_file(folder, file, O_RDONLY);
    *exists = fd >= 0;
    if (fd < 0)
        return errno == ENOENT ? TM_OK : fail_file(folder, file, "cannot open", error);
    tm_status status = tm_read_all(fd, file, text, error);
    close(fd);
    return status;
}

int private_folder_full(const private_folder *folder)
{
    enum { ROOM = 1 << 16 };
    static const char name[] = "room", byte[ROOM] = "";
    int fd = open_file(folder, name, O_WRONLY | O_CREAT | O_TRUNC);
    if (fd < 0)
        return errno;
    errno = 0;
    int cause = tm_write_all(fd, byte, sizeof byte, NULL) == TM_OK ? 0 : errno;
    if (close(fd) != 0 && cause == 0)
        cause = errno;
    return cause;
}

void private_folder_close(private_folder *folder)
{
    remove_folder(folder->path, folder->lock);
    close(folder->lock);
    folder->path[0] = '\0';
    private_signals_release();
}
