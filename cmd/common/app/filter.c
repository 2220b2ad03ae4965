/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "filter.h"

#include "../../../lib/base/file.h"
#include "../../../lib/base/number.h"
#include "kinds.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { THREADS_MAX = 256 };

static const char shared_help[] =
    "  -o, --output FILE   write to FILE instead of standard output, whole or not at "
    "all\n"
    "  %s --threads N     use N threads; the output is the same for every N\n"
    "      --json FILE     write a JSON report to FILE\n"
    "      --no-history    do not add a history line\n"
    "      --strict        refuse what the output cannot carry, instead of a note\n"
    "  %s --quiet         no notes and no progress on standard error\n"
    "  -v, --verbose       more notes, and the time that each stage takes\n"
    "  -h, --help          this text\n"
    "  -V, --version       the version\n";

static void usage(const filter *f, FILE *to)
{
    fprintf(to, "usage: %s %s\n", f->name, f->synopsis);
}

void filter_exit_after_text(const filter *f)
{
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "%s: cannot write: %s\n", f->name, strerror(errno));
        exit(TM_ERROR_SYSTEM);
    }
    exit(EXIT_SUCCESS);
}

_Noreturn static void help(const filter *f)
{
    usage(f, stdout);
    printf("\n%s\n\n%s", f->purpose, f->help);
    printf(shared_help, f->j_is_own ? "   " : "-j,", f->q_is_own ? "   " : "-q,");
    filter_exit_after_text(f);
}

static void print_message(const filter *f, const char *format, va_list arguments)
{
    progress_hold(f->progress);
    fprintf(stderr, "%s: ", f->name);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    progress_release(f->progress);
}

void filter_print(const filter *f, const char *format, ...)
{
    va_list arguments;
    progress_hold(f->progress);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    progress_release(f->progress);
}

void filter_usage_error(const filter *f, const char *format, ...)
{
    va_list arguments;
    progress_end(f->progress);
    va_start(arguments, format);
    print_message(f, format, arguments);
    va_end(arguments);
    usage(f, stderr);
    fprintf(stderr, "Try '%s --help'.\n", f->name);
    exit(EXIT_USAGE);
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

void filter_fail(const filter *f, const tm_error *error)
{
    progress_end(f->progress);
    fprintf(stderr, "%s: ", f->name);
    if (error->file[0] && error->line)
        fprintf(stderr, "%s:%zu: ", error->file, error->line);
    else if (error->file[0])
        fprintf(stderr, "%s: ", error->file);
    if (error->block[0])
        fprintf(stderr, "%s: ", error->block);
    fprintf(stderr, "%s\n", error->what);
    output_files_abandon(f->files);
    exit((int)error->status);
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

double filter_number(const filter *f, const char *option, const char *text, double lo,
                     double hi)
{
    double value;
    const char *end = text + strlen(text);
    if (tm_read_double(text, end, &value) != end || !(value >= lo && value <= hi))
        filter_usage_error(f, "%s: '%s' is not a number in %g … %g", option, text, lo,
                           hi);
    return value;
}

long filter_integer(const filter *f, const char *option, const char *text, long lo,
                    long hi)
{
    int64_t value;
    const char *end = text + strlen(text);
    if (tm_read_int64(text, end, &value) != end || value < lo || value > hi)
        filter_usage_error(f, "%s: '%s' is not a whole number in %ld … %ld", option, text,
                           lo, hi);
    return (long)value;
}

int filter_word(const filter *f, const char *option, const char *const *word, int count,
                const char *given)
{
    char all[256] = "";
    for (int k = 0; k < count; k++) {
        if (strcmp(word[k], given) == 0)
            return k;
        snprintf(all + strlen(all), sizeof all - strlen(all), k ? ", %s" : "%s", word[k]);
    }
    filter_usage_error(f, "%s: '%s' is none of %s", option, given, all);
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
    f->threads = 1;
    opterr = 0;
}

/* Adds an option to the command as the history line will show it. */
static void remember(filter *f, int c, int index)
{
    if (c < FILTER_JSON)
        tm_text_format(&f->command, " -%c%s", c, optarg ? optarg : "");
    else if (index >= 0)
        tm_text_format(&f->command, " --%s%s%s", f->options[index].name,
                       optarg ? "=" : "", optarg ? optarg : "");
}

static void take_threads(filter *f)
{
    f->threads = (unsigned)filter_integer(f, "--threads", optarg, 1, THREADS_MAX);
}

/* Takes a shared option; false where c is the filter's own. */
static bool take_shared(filter *f, int c)
{
    switch (c) {
    case 'h':
        help(f);
    case 'V':
        printf("%s (termesh) %s\n", f->name, TM_VERSION);
        filter_exit_after_text(f);
    case 'o':
        f->output = strcmp(optarg, "-") ? optarg : NULL;
        f->forced = !f->output;
        return true;
    case 'q':
        if (f->q_is_own)
            return false;
        f->verbosity = -1;
        return true;
    case FILTER_QUIET:
        f->verbosity = -1;
        return true;
    case 'v':
        f->verbosity = 1;
        return true;
    case 'j':
        if (f->j_is_own)
            return false;
        take_threads(f);
        return true;
    case FILTER_THREADS:
        take_threads(f);
        return true;
    case FILTER_JSON:
        f->json = optarg;
        return true;
    case FILTER_NO_HISTORY:
        f->history = false;
        return true;
    case FILTER_STRICT:
        f->strict = true;
        return true;
    default:
        return false;
    }
}

/* All options are known. */
static void begin_work(filter *f)
{
    static progress p; /* that of the program: signals erase it */
    f->progress = &p;
    progress_start(&p, f->name, f->verbosity<0, f->verbosity> 0);
}

const tm_progress *filter_progress(const filter *f)
{
    return progress_context(f->progress);
}

void filter_stage(const filter *f, const char *what)
{
    tm_progress_stage(filter_progress(f), what);
}

int filter_option(filter *f)
{
    for (;;) {
        int index = -1;
        int c = getopt_long(f->argc, f->argv, f->letters, f->options, &index);
        if (c == '?' && optopt > 0 && optopt < FILTER_JSON)
            filter_usage_error(f, "option -%c is unknown or lacks its argument", optopt);
        if (c == '?')
            filter_usage_error(f,
                               "option '%s' is unknown, ambiguous or lacks its argument",
                               f->argv[optind - 1]);
        if (c == -1) {
            begin_work(f);
            return -1;
        }
        if (take_shared(f, c))
            continue;
        remember(f, c, index);
        return c;
    }
}

void filter_operands(filter *f)
{
    if (optind < f->argc)
        f->input = f->argv[optind++];
    if (optind < f->argc)
        filter_usage_error(f, "one FILE at most, but there is also '%s'",
                           f->argv[optind]);
    if (f->input && strcmp(f->input, "-") == 0)
        f->input = NULL;
    if (!f->input && isatty(STDIN_FILENO)) {
        usage(f, stderr);
        exit(EXIT_USAGE);
    }
    if (f->binary && !f->output && !f->forced && isatty(STDOUT_FILENO))
        filter_usage_error(f, "the output is binary and would go to a terminal (-o FILE "
                              "or a pipe would be right; -o - forces it)");
}

const char *filter_input_name(const filter *f)
{
    return f->input ? f->input : "<stdin>";
}

static int open_file(const filter *f, const char *file)
{
    int fd = open(file, O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        tm_error error;
        tm_fail_at(&error, TM_ERROR_SYSTEM, file, 0, NULL, "cannot open: %s",
                   strerror(errno));
        filter_fail(f, &error);
    }
    return fd;
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
    if (tm_stream_read(stream, fd, filter_input_name(f), &error) != TM_OK ||
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
static int open_output(filter *f)
{
    int fd = STDOUT_FILENO;
    tm_error error;
    require_report(f);
    if (f->output && output_files_open(f->files, f->output, &fd, &error) != TM_OK)
        filter_fail(f, &error);
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

void filter_write(filter *f, tm_stream *stream, const char *summary, ...)
{
    tm_error error;
    char done[512];
    va_list arguments;
    va_start(arguments, summary);
    vsnprintf(done, sizeof done, summary, arguments);
    va_end(arguments);
    if (f->history && add_history(f, stream, done, &error) != TM_OK)
        filter_fail(f, &error);
    int fd = open_output(f);
    stream->progress = filter_progress(f);
    if (tm_stream_write(stream, fd, f->threads, &error) != TM_OK)
        filter_fail(f, &error);
}

static tm_status write_text(int fd, const tm_text *text, tm_error *error)
{
    if (text->failed)
        return tm_fail_memory(error);
    return tm_write_all(fd, text->byte ? text->byte : "", text->size, error);
}

void filter_write_text(filter *f, const tm_text *text)
{
    tm_error error;
    int fd = open_output(f);
    filter_stage(f, "writing");
    if (write_text(fd, text, &error) == TM_OK)
        return;
    if (f->output)
        snprintf(error.file, sizeof error.file, "%s", f->output);
    filter_fail(f, &error);
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

/* To where --json says. */
static tm_status write_report(const filter *f, tm_error *error)
{
    if (strcmp(f->json, "-") != 0)
        return output_file_write(f->json, &f->report, error);
    progress_hold(f->progress);
    tm_status status =
        write_text(f->json_is_output ? STDOUT_FILENO : STDERR_FILENO, &f->report, error);
    progress_release(f->progress);
    return status;
}

void filter_json_end(filter *f)
{
    tm_error error;
    tm_json_close(&f->json_object, '}');
    tm_text_string(&f->report, "\n");
    if (f->json && write_report(f, &error) != TM_OK)
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
    progress_end(f->progress);
    if (output_files_finish(f->files, &error) != TM_OK)
        filter_fail(f, &error);
    if (close(STDOUT_FILENO) != 0) {
        tm_fail_at(&error, TM_ERROR_SYSTEM, "<stdout>", 0, NULL, "cannot write: %s",
                   strerror(errno));
        filter_fail(f, &error);
    }
    tm_text_free(&f->command);
    return status;
}
