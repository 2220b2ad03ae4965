/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void copy(char *to, size_t size, const char *from)
{
    snprintf(to, size, "%s", from ? from : "");
}

tm_status tm_fail(tm_error *error, tm_status status, const char *format, ...)
{
    if (error) {
        memset(error, 0, sizeof *error);
        error->status = status;
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->what, sizeof error->what, format, arguments);
        va_end(arguments);
    }
    return status;
}

tm_status tm_fail_at_list(tm_error *error, tm_status status, const char *file,
                          size_t line, const char *block, const char *format,
                          va_list arguments)
{
    if (error) {
        error->status = status;
        error->line = line;
        copy(error->file, sizeof error->file, file);
        copy(error->block, sizeof error->block, block);
        vsnprintf(error->what, sizeof error->what, format, arguments);
    }
    return status;
}

tm_status tm_fail_at(tm_error *error, tm_status status, const char *file, size_t line,
                     const char *block, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tm_fail_at_list(error, status, file, line, block, format, arguments);
    va_end(arguments);
    return status;
}

tm_status tm_fail_as(tm_error *error, const tm_error *cause)
{
    if (error)
        *error = *cause;
    return cause->status;
}

tm_error tm_error_of(tm_status status, const tm_error *error)
{
    tm_error said = {.status = status};
    if (error && status != TM_OK)
        said = *error;
    said.status = status;
    return said;
}

void tm_error_add_lines(size_t lines, tm_error *error)
{
    if (error && error->line > 0)
        error->line += lines;
}

void tm_say_memory(tm_error *error)
{
    tm_fail(error, TM_ERROR_SYSTEM, "out of memory");
}
