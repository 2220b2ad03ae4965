/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One rank: a program without a launcher. */
#include "ranks.h"

#include "../base/array.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool tm_ranks_are_mpi(void)
{
    return false;
}

tm_status tm_ranks_start(tm_error *error)
{
    (void)error;
    return TM_OK;
}

unsigned tm_rank(void)
{
    return 0;
}

unsigned tm_ranks_count(void)
{
    return 1;
}

void tm_ranks_leave(void)
{
}

void tm_ranks_end(int status)
{
    exit(status);
}

tm_status tm_ranks_first_error(tm_status status, tm_error *error)
{
    (void)error;
    return status;
}

void tm_ranks_sum(size_t *value, size_t count)
{
    (void)value;
    (void)count;
}

void tm_ranks_least(double *value, size_t count)
{
    (void)value;
    (void)count;
}

void tm_ranks_largest(double *value, size_t count)
{
    (void)value;
    (void)count;
}

bool tm_ranks_find_any(bool value)
{
    return value;
}

size_t tm_ranks_before(size_t value, size_t *all)
{
    if (all)
        *all = value;
    return 0;
}

void tm_ranks_broadcast(void *bytes, size_t size)
{
    (void)bytes;
    (void)size;
}

void tm_ranks_swap(const void *send, const size_t *send_count, size_t size, void *got,
                   const size_t *got_count)
{
    (void)got_count;
    if (send_count[0] > 0)
        memcpy(got, send, send_count[0] * size);
}

tm_status tm_ranks_exchange(const void *send, const size_t *send_count, size_t size,
                            void **got, size_t *got_count, tm_error *error)
{
    got_count[0] = send_count[0];
    *got = tm_new(send_count[0], size);
    if (!*got)
        return tm_fail_memory(error);
    tm_ranks_swap(send, send_count, size, *got, got_count);
    return TM_OK;
}

tm_status tm_ranks_gather(const void *mine, size_t count, size_t size, void **all,
                          size_t *total, tm_error *error)
{
    size_t got;
    if (total)
        *total = count;
    return tm_ranks_exchange(mine, &count, size, all, &got, error);
}

tm_status tm_ranks_share(const void *mine, size_t count, size_t size, void **all,
                         size_t *total, tm_error *error)
{
    return tm_ranks_gather(mine, count, size, all, total, error);
}

void tm_ranks_send(unsigned to, const void *bytes, size_t size)
{
    (void)to;
    (void)bytes;
    (void)size;
}

void tm_ranks_receive(unsigned from, void *bytes, size_t room, size_t *size)
{
    (void)from;
    (void)bytes;
    (void)room;
    *size = 0;
}

struct tm_ranks_file {
    int fd;
};

static tm_status fail_file(tm_error *error)
{
    return tm_fail(error, TM_ERROR_SYSTEM, "cannot write: %s", strerror(errno));
}

tm_status tm_ranks_file_open(tm_ranks_file **file, const char *name, tm_error *error)
{
    const int fd = open(name, O_WRONLY | O_CLOEXEC);
    *file = fd >= 0 ? malloc(sizeof **file) : NULL;
    if (*file)
        (*file)->fd = fd;
    if (fd < 0)
        return fail_file(error);
    if (!*file)
        close(fd);
    return *file ? TM_OK : tm_fail_memory(error);
}

tm_status tm_ranks_file_put(tm_ranks_file *file, size_t at, const char *bytes,
                            size_t size, tm_error *error)
{
    while (size > 0) {
        const ssize_t put = pwrite(file->fd, bytes, size, (off_t)at);
        if (put < 0 && errno != EINTR)
            return fail_file(error);
        const size_t some = put > 0 ? (size_t)put : 0;
        bytes += some;
        size -= some;
        at += some;
    }
    return TM_OK;
}

tm_status tm_ranks_file_close(tm_ranks_file **file, tm_error *error)
{
    const int closed = close((*file)->fd);
    free(*file);
    *file = NULL;
    return closed == 0 ? TM_OK : fail_file(error);
}

tm_ranks_traffic tm_ranks_sent(void)
{
    return (tm_ranks_traffic){0};
}
