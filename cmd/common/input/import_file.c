/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "import_file.h"

#include "../../../lib/base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

void import_input(const filter *f, tm_text *bytes)
{
    tm_error error;
    int fd = filter_open_input(f);
    if (tm_read_all(fd, filter_input_name(f), bytes, &error) != TM_OK)
        filter_fail(f, &error);
    if (f->input)
        close(fd);
}

tm_status import_file(const char *file, tm_text *bytes, tm_error *error)
{
    int fd = open(file, O_RDONLY | O_CLOEXEC);
    if (fd < 0)
        return tm_fail_at(error, TM_ERROR_SYSTEM, file, 0, NULL, "cannot open: %s",
                          strerror(errno));
    tm_status status = tm_read_all(fd, file, bytes, error);
    close(fd);
    return status;
}
