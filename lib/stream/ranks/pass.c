/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pass.h"

#include "../../ranks/ranks.h"
#include "../../text/file.h"

enum { MESSAGE = 1 << 16 };

void tm_pass_text(const char *bytes, size_t size)
{
    for (size_t at = 0; at < size; at += MESSAGE)
        tm_ranks_send(0, bytes + at, size - at < MESSAGE ? size - at : MESSAGE);
}

void tm_pass_end(void)
{
    tm_ranks_send(0, NULL, 0);
}

tm_status tm_pass_on(int fd, tm_status before, tm_error *error)
{
    char message[MESSAGE];
    tm_status status = before;
    for (unsigned from = 1; from < tm_ranks_count(); from++)
        for (size_t size = 1; size > 0;) {
            tm_ranks_receive(from, message, sizeof message, &size);
            if (status == TM_OK && size > 0)
                status = tm_write_all(fd, message, size, error);
        }
    return status;
}
