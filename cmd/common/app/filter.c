/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "filter.h"
#include "completion.h"

#include "../../../lib/base/parallel.h"
#include "../../../lib/text/file.h"
#include "kinds.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void filter_exit_after_text(const filter *f)
{
    if (fflush(stdout) != 0 || ferror(stdout)) {
        filter_message(f, "cannot write: %s", strerror(errno));
        exit(TM_ERROR_SYSTEM);
    }
    exit(EXIT_SUCCESS);
}

/* A standard descriptor that the caller closed would be given to the next file that is
 * opened; it gets one on which every read or write fails instead. */
static void occupy_standard_descriptors(void)
{
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        if (fcntl(fd, F_GETFD) < 0)
            (void)!open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void filter_start(filter *f, int argc, char **argv)
{
    occupy_standard_descriptors();
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_IGN);  /* a file that may not grow is an error of write() */
    static output_files files; /* filter_fail(), which gets f as const, tidies them up */
    f->files = &files;
    f->argc = argc;
    f->argv = argv;
    f->history = true;
    f->threads = tm_cores();
    opterr = 0;
    filter_launch(f, argv);
    if (argc == 2 && strcmp(argv[1], "--completion") == 0)
        filter_print_completion(f);
}

const tm_progress *filter_progress(const filter *f)
{
    return progress_context(f->progress);
}

void filter_stage(const filter *f, const char *what)
{
    tm_progress_stage(filter_progress(f), what);
}

const char *filter_input_name(const filter *f)
{
    return f->input ? f->input : "<stdin>";
}

static int try_file(const filter *f, const char *file, tm_error *error)
{
    const int fd = open(file, O_RDONLY | O_CLOEXEC), cause = errno;
    if (fd < 0) {
        char why[FILTER_APART];
        filter_explain_apart(f, file, why);
        tm_fail_at(error, TM_ERROR_SYSTEM, file, 0, NULL, "cannot open: %s%s",
                   strerror(cause), why);
    }
    return fd;
}

static int open_file(const filter *f, const char *file)
{
    tm_error error;
    const int fd = try_file(f, file, &error);
    if (fd < 0)
        filter_fail(f, &error);
    return fd;
}

int filter_open_input(const filter *f, tm_error *error)
{
    return f->input ? try_file(f, f->input, error) : STDIN_FILENO;
}

static int open_input(const filter *f)
{
    return f->input ? open_file(f, f->input) : STDIN_FILENO;
}

static void read_bytes(const filter *f, int fd, const char *name, tm_text *bytes)
{
    tm_error error;
    filter_stage(f, "reading");
    if (tm_read_all(fd, name, bytes, &error) != TM_OK)
        filter_fail(f, &error);
    if (fd != STDIN_FILENO)
        close(fd);
}

void filter_read_bytes(const filter *f, tm_text *bytes)
{
    read_bytes(f, open_input(f), filter_input_name(f), bytes);
}

void filter_read_file(const filter *f, const char *file, tm_text *bytes)
{
    read_bytes(f, open_file(f, file), file, bytes);
}

void filter_read(const filter *f, tm_stream *stream)
{
    tm_error error;
    int fd = open_input(f);
    tm_stream_init(stream);
    stream->progress = filter_progress(f);
    if (tm_stream_read(stream, fd, filter_input_name(f), f->threads, &error) != TM_OK ||
        kinds_check(f->name, stream, filter_input_name(f), &error) != TM_OK)
        filter_fail(f, &error);
    if (f->input)
        close(fd);
}

/* What went out cannot be taken back where the report of --json fails after it. */
static void require_report(const filter *f)
{
    tm_error error;
    if (!f->json || f->reported)
        return;
    tm_fail(&error, TM_ERROR_INTERNAL, "output before the report of --json");
    filter_fail(f, &error);
}

/* Standard output, or a temporary file beside -o FILE that filter_finish() renames, so
 * that FILE is whole or not there. */
int filter_open_output(filter *f)
{
    int fd = STDOUT_FILENO;
    tm_error error;
    require_report(f);
    if (f->output && output_files_open(f->files, f->output, &fd, &error) != TM_OK)
        filter_fail(f, &error);
    if (f->binary && f->output && isatty(fd))
        filter_usage_error(f,
                           "-o: the output is binary and '%s' is a terminal (-o - "
                           "forces it)",
                           f->output);
    if (isatty(fd))
        progress_end(f->progress); /* what is written would be in one line with it */
    return fd;
}

/* "# name version options: done" at the end of the stream's history. */
static tm_status add_history(const filter *f, tm_stream *stream, const char *done,
                             tm_error *error)
{
    tm_text line = {0};
    tm_text_format(&line, "%s %s%s%s%s: %s", f->name, TM_VERSION,
                   f->command.byte ? f->command.byte : "", f->input ? " " : "",
                   f->input ? f->input : "", done);
    const tm_status status = line.failed || f->command.failed
                                 ? tm_fail_memory(error)
                                 : tm_stream_add_history(stream, line.byte, error);
    tm_text_free(&line);
    return status;
}

void filter_add_history(const filter *f, tm_stream *stream, const char *done)
{
    tm_error error;
    if (f->history && add_history(f, stream, done, &error) != TM_OK)
        filter_fail(f, &error);
}

void filter_name_output(const filter *f, tm_error *error)
{
    if (!error->file[0])
        snprintf(error->file, sizeof error->file, "%s",
                 f->output ? f->output : "<stdout>");
}

static _Noreturn void fail_output(const filter *f, tm_error *error)
{
    filter_name_output(f, error);
    filter_fail(f, error);
}

void filter_write(filter *f, tm_stream *stream, const char *summary, ...)
{
    tm_error error;
    char done[512];
    va_list arguments;
    va_start(arguments, summary);
    vsnprintf(done, sizeof done, summary, arguments);
    va_end(arguments);
    filter_add_history(f, stream, done);
    int fd = filter_open_output(f);
    stream->progress = filter_progress(f);
    if (tm_stream_write(stream, fd, f->threads, &error) != TM_OK)
        fail_output(f, &error);
}

void filter_write_text(filter *f, const tm_text *text)
{
    tm_error error;
    if (!filter_speaks())
        return;
    int fd = filter_open_output(f);
    filter_stage(f, "writing");
    if (tm_write_text(fd, text, &error) != TM_OK)
        fail_output(f, &error);
}

bool filter_has_report(const filter *f)
{
    return f->output || !f->json || strcmp(f->json, "-") != 0;
}

tm_json *filter_json_begin(filter *f)
{
    f->json_object = (tm_json){.text = &f->report};
    tm_json_open(&f->json_object, NULL, '{');
    return &f->json_object;
}

/* To where --json says; a file gets its name with those of the output. */
static tm_status write_report(const filter *f, tm_error *error)
{
    if (strcmp(f->json, "-") != 0)
        return output_files_write(f->files, f->json, &f->report, error);
    progress_hold(f->progress);
    tm_status status = tm_write_text(f->json_is_output ? STDOUT_FILENO : STDERR_FILENO,
                                     &f->report, error);
    progress_release(f->progress);
    return status;
}

void filter_json_end(filter *f)
{
    tm_error error;
    tm_json_close(&f->json_object, '}');
    tm_text_string(&f->report, "\n");
    if (f->json && filter_speaks() && write_report(f, &error) != TM_OK)
        filter_fail(f, &error);
    tm_text_free(&f->report);
    f->reported = true;
}

void filter_write_json(filter *f, const tm_report_row *rows, const void *of)
{
    tm_report_json(filter_json_begin(f), rows, of);
    filter_json_end(f);
}

int filter_finish(filter *f, int status)
{
    tm_error error;
    require_report(f);
    filter_verbose_ranks(f);
    progress_end(f->progress);
    if (close(STDOUT_FILENO) != 0) {
        tm_fail_at(&error, TM_ERROR_SYSTEM, "<stdout>", 0, NULL, "cannot write: %s",
                   strerror(errno));
        filter_fail(f, &error);
    }
    if (output_files_finish(f->files, &error) != TM_OK)
        filter_fail(f, &error);
    tm_text_free(&f->command);
    return filter_speaks() ? status : EXIT_SUCCESS;
}
