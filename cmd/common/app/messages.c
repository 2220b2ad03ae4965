/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Messages on stderr. They quote the input, names, and what other programs say: what a
 * terminal would obey is shown as \x1b. */
#include "filter.h"

#include "../../../lib/ranks/ranks.h"
#include "../../../lib/text/utf8.h"
#include "../../../lib/stream/sniff.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { MESSAGE = 4096, SHOWN = sizeof "\\x1b" - 1 };

/* The string as it is shown, at most SHOWN times as long; returns its end. */
static char *put_shown(char *to, const char *string)
{
    const char *end = string + strlen(string);
    for (const char *at = string; at < end;) {
        size_t size = tm_utf8_size(at, end);
        if (size > 0 && !tm_utf8_is_control(at, size)) {
            memcpy(to, at, size);
            to += size;
            at += size;
            continue;
        }
        for (size = size > 0 ? size : 1; size > 0; size--, to += SHOWN)
            snprintf(to, SHOWN + 1, "\\x%02x", (unsigned char)*at++);
    }
    return to;
}

/* "name: …" and a line feed, at once; there may be no memory left. */
static void print_message(const filter *f, const char *format, va_list arguments)
{
    char message[MESSAGE], line[SHOWN * MESSAGE + 1];
    int size = snprintf(message, sizeof message, "%s: ", f->name);
    vsnprintf(message + size, sizeof message - (size_t)size, format, arguments);
    char *end = put_shown(line, message);
    *end++ = '\n';
    progress_hold(f->progress);
    fwrite(line, 1, (size_t)(end - line), stderr);
    progress_release(f->progress);
}

void filter_print(const filter *f, const char *format, ...)
{
    va_list arguments;
    if (!filter_speaks())
        return;
    progress_hold(f->progress);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    progress_release(f->progress);
}

void filter_message(const filter *f, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_message(f, format, arguments);
    va_end(arguments);
}

void filter_note(const filter *f, const char *format, ...)
{
    if (f->verbosity < 0)
        return;
    va_list arguments;
    va_start(arguments, format);
    print_message(f, format, arguments);
    va_end(arguments);
}

void filter_verbose(const filter *f, const char *format, ...)
{
    if (f->verbosity < 1)
        return;
    va_list arguments;
    va_start(arguments, format);
    print_message(f, format, arguments);
    va_end(arguments);
}

void filter_usage_error(const filter *f, const char *format, ...)
{
    va_list arguments;
    if (!filter_speaks())
        filter_end(EXIT_USAGE);
    progress_end(f->progress);
    va_start(arguments, format);
    print_message(f, format, arguments);
    va_end(arguments);
    filter_usage(f, stderr);
    fprintf(stderr, "Try '%s --help'.\n", f->name);
    filter_end(EXIT_USAGE);
}

void filter_say_failure(const filter *f, const tm_error *error)
{
    char line[32] = "";
    progress_end(f->progress);
    if (error->line)
        snprintf(line, sizeof line, ":%zu", error->line);
    filter_message(f, "%s%s%s%s%s%s", error->file, error->file[0] ? line : "",
                   error->file[0] ? ": " : "", error->block, error->block[0] ? ": " : "",
                   error->what);
}

void filter_fail(const filter *f, const tm_error *error)
{
    if (filter_speaks() || tm_ranks_count() > 1)
        filter_say_failure(f, error);
    output_files_abandon(f->files);
    filter_end((int)error->status);
}

void filter_fail_memory(const filter *f)
{
    tm_error error;
    tm_fail_memory(&error);
    filter_fail(f, &error);
}

void filter_fail_file(const filter *f, tm_error *error, const tm_text *bytes,
                      const char *reader)
{
    const tm_look look = tm_look_at(bytes->byte, bytes->size);
    const size_t length = strlen(error->what);
    if (error->status == TM_ERROR_INPUT && look.advice && !strstr(look.advice, reader))
        snprintf(error->what + length, sizeof error->what - length, "; looks like %s: %s",
                 look.what, look.advice);
    filter_fail(f, error);
}

void filter_leave_out(const filter *f, const char *format, ...)
{
    tm_error error = {.status = TM_ERROR_INPUT};
    const size_t size = sizeof error.what;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error.what, size, format, arguments);
    va_end(arguments);
    if (!f->strict) {
        filter_note(f, "%s: %s: left out", filter_input_name(f), error.what);
        return;
    }
    const size_t length = strlen(error.what);
    snprintf(error.what + length, size - length, ": the output cannot carry it");
    snprintf(error.file, sizeof error.file, "%s", filter_input_name(f));
    filter_fail(f, &error);
}
