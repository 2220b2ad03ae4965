/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "file.h"

#include "../base/array.h"
#include "input.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

tm_status tm_read_all(int fd, const char *name, tm_text *text, tm_error *error)
{
    enum { STEP = 1 << 16 };
    tm_input input;
    tm_input_open(&input, fd, name);
    tm_status status = TM_OK;
    size_t got = 1;
    while (status == TM_OK && got > 0) {
        char *moved = tm_grow(text->byte, &text->capacity, text->size + STEP + 1, 1);
        if (!moved) {
            status = tm_fail_memory(error);
            break;
        }
        text->byte = moved;
        status = tm_input_read(&input, text->byte + text->size,
                               text->capacity - text->size - 1, &got, error);
        text->size += got;
        text->byte[text->size] = '\0';
    }
    tm_input_close(&input);
    return status;
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

tm_status tm_write_text(int fd, const tm_text *text, tm_error *error)
{
    if (text->failed)
        return tm_fail_memory(error);
    return text->size > 0 ? tm_write_all(fd, text->byte, text->size, error) : TM_OK;
}
