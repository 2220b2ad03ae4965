/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "file.h"

#include "array.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

ptrdiff_t tm_read_some(int fd, char *bytes, size_t size)
{
    ssize_t got;
    do
        got = read(fd, bytes, size);
    while (got < 0 && errno == EINTR);
    return got;
}

tm_status tm_read_all(int fd, const char *name, tm_text *text, tm_error *error)
{
    enum { STEP = 1 << 16 };
    for (;;) {
        char *moved = tm_grow(text->byte, &text->capacity, text->size + STEP + 1, 1);
        if (!moved)
            return tm_fail_memory(error);
        text->byte = moved;
        ptrdiff_t got =
            tm_read_some(fd, text->byte + text->size, text->capacity - text->size - 1);
        if (got < 0)
            return tm_fail_at(error, TM_ERROR_SYSTEM, name, 0, NULL, "cannot read: %s",
                              strerror(errno));
        text->size += (size_t)got;
        text->byte[text->size] = '\0';
        if (got == 0)
            return TM_OK;
    }
}

tm_status tm_write_all(int fd, const char *bytes, size_t size, tm_error *error)
{
    while (size > 0) {
        ssize_t put = write(fd, bytes, size);
        if (put < 0 && errno == EINTR)
            continue;
        if (put < 0)
            return tm_fail(error, TM_ERROR_SYSTEM, "cannot write: %s", strerror(errno));
        bytes += put;
        size -= (size_t)put;
    }
    return TM_OK;
}
