/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every filter does alike: the shared options, input and output, messages, exit
 * statuses. A filter's main() reads:
 *
 *     filter_start(&filter, argc, argv);
 *     while ((c = filter_option(&filter)) != -1)   the filter's own options, if any
 *         switch (c) { … default: filter_usage_error(&filter, …); }
 *     filter_operands(&filter);
 *     filter_read(&filter, &stream);               exits on failure
 *     …
 *     filter_write(&filter, &stream, "what was done");
 *     return filter_finish(&filter, 0);
 *
 * Functions that fail print one line on stderr and exit with the status of termesh(7): 2
 * usage, 3 input, 4 system, 5 internal. */
#ifndef CMD_COMMON_FILTER_H
#define CMD_COMMON_FILTER_H

#include "../../../lib/base/error.h"
#include "../../../lib/text/report.h"
#include "../../../lib/text/text.h"
#include "../../../lib/base/version.h"
#include "../../../lib/stream/ranks/slices.h"
#include "../../../lib/stream/stream.h"
#include "output_files.h"
#include "progress.h"

#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>

enum { EXIT_GOAL = 1, EXIT_USAGE = 2 };

/* The long options of every filter and their letters; a filter's table ends with it. */
/* clang-format off */
#define FILTER_OPTIONS \
    {"help", no_argument, NULL, 'h'}, \
    {"version", no_argument, NULL, 'V'}, \
    {"output", required_argument, NULL, 'o'}, \
    {"quiet", no_argument, NULL, FILTER_QUIET}, \
    {"verbose", no_argument, NULL, 'v'}, \
    {"json", required_argument, NULL, FILTER_JSON}, \
    {"no-history", no_argument, NULL, FILTER_NO_HISTORY}, \
    {"strict", no_argument, NULL, FILTER_STRICT}, \
    {"threads", required_argument, NULL, FILTER_THREADS}, \
    {NULL, 0, NULL, 0}
/* clang-format on */
#define FILTER_LETTERS       "hVo:vqj:"
#define FILTER_LETTERS_NOT_J "hVo:vq" /* where j_is_own */

enum {
    FILTER_JSON = 256,
    FILTER_QUIET,
    FILTER_NO_HISTORY,
    FILTER_STRICT,
    FILTER_THREADS,
    FILTER_OWN = 512 /* a filter numbers its own long-only options from here */
};

/* The words that an option takes: `count` of them, the first at `first`, the next one
 * `stride` bytes on. A table ends with {0}. The completion of shells has them from here.
 */
typedef struct filter_words {
    int option;
    const char *const *first;
    size_t stride;
    int count;
} filter_words;
#define FILTER_WORDS(option, list)                                                       \
    {                                                                                    \
        option, list, sizeof *(list), (int)(sizeof(list) / sizeof *(list))               \
    }

typedef struct filter {
    /* set by the filter */
    const char *name;             /* "lepp-improve" */
    const char *synopsis;         /* "[-m FACTOR] … [FILE]" */
    const char *purpose;          /* one line for --help */
    const char *help;             /* the filter's own options, a line each, for --help */
    const struct option *options; /* its own, then FILTER_OPTIONS */
    const char *letters;          /* getopt's, its own + FILTER_LETTERS */
    const filter_words *words;    /* of options that take one of some; or NULL */
    bool json_is_output;          /* --json - is stdout: the *-stats and mesh-check */
    bool q_is_own;                /* -q is the filter's; quiet is --quiet only */
    bool j_is_own;                /* -j is the filter's; threads are --threads only */
    bool binary;                  /* its output is, before filter_operands() */
    bool ranks;                   /* it can work on several: see filter_together() */
    /* set from the command line */
    int argc;
    char **argv;
    const char *input;  /* NULL: standard input */
    const char *output; /* NULL: standard output */
    const char *json;   /* NULL: none */
    int verbosity;      /* -1 quiet, 0, 1 verbose */
    bool history;
    bool forced; /* -o -: to standard output, whatever that is */
    bool strict; /* what the output cannot carry is an error */
    unsigned threads;
    const char *apart;     /* what follows an option whose argument may lack */
    char apart_option[32]; /* how that is written before its argument: "-q" */
    tm_text command;       /* the options as given, for the history */
    output_files *files;   /* -o FILE in the making */
    progress *progress;    /* NULL until all options are known */
    tm_text report;        /* of --json, in the making */
    bool reported;         /* the report is where it belongs */
    tm_json json_object;
} filter;

void filter_start(filter *f, int argc, char **argv);

/* Under a launcher filter_start() goes on as the program that is linked with MPI where
 * f->ranks says so; of other filters rank 0 works and the others end. */
void filter_launch(const filter *f, char **argv);

/* After the command line of a filter with f->ranks: whether all ranks work together now,
 * which they do where there are several and what is asked for can be done so. Else rank 0
 * goes on, as without a launcher, and the others end. */
bool filter_together(const filter *f, bool can);

/* A step that all ranks make has ended so on this one: goes on where it has not failed on
 * any; else one of them says why, all end, and the launcher has its status. */
void filter_agree(const filter *f, tm_status status, tm_error *error);

/* What ranks that work together have sent to each other, and how evenly they have worked,
 * as filter_verbose() says it. */
void filter_verbose_ranks(const filter *f);

/* Whether this rank is the one that says something. */
bool filter_speaks(void);

/* exit(status), of all ranks; what they have not agreed upon ends the others, too. */
_Noreturn void filter_end(int status);

/* The next option that is the filter's own, or -1 after the last. */
int filter_option(filter *f);

/* Takes the rest of the command line: at most one FILE. With no FILE (or "-") standard
 * input is read; if that is a terminal: usage, exit 2. So is binary output to one. */
void filter_operands(filter *f);

/* A usage error where a file that an option names is that of -o or --json, too. For
 * --json filter_option() does so. */
void filter_other_file(const filter *f, const char *option, const char *file);

/* A usage error, which ends with `instead`, where a file to write has the suffix of a
 * picture of pixels or of pages, which is not written; NULL is no file. */
void filter_no_picture(const filter *f, const char *file, const char *instead);

/* Option arguments as numbers in lo..hi, else a usage error that names the option. */
double filter_number(const filter *f, const char *option, const char *text, double lo,
                     double hi);
long filter_integer(const filter *f, const char *option, const char *text, long lo,
                    long hi);

/* An option argument as its place in the option's row of f->words, else a usage error; or
 * -1 where it is none of them. */
int filter_word(const filter *f, int option, const char *given);
int filter_find_word(const filter *f, int option, const char *given);
const char *filter_word_of(const filter_words *row, int k); /* word k of the row */

/* Where the operand is the word behind an option whose argument may lack, and is no file:
 * that it may be meant for that argument, and how to write it; else "". */
enum { FILTER_APART = 320 };
void filter_explain_apart(const filter *f, const char *operand, char text[FILTER_APART]);

/* "usage: name synopsis" */
void filter_usage(const filter *f, FILE *to);

/* "name: message", then exit 2, pointing to --help. */
_Noreturn void filter_usage_error(const filter *f, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* "name: file:line: block: what", then exit with error->status. */
_Noreturn void filter_fail(const filter *f, const tm_error *error);

/* The line alone. */
void filter_say_failure(const filter *f, const tm_error *error);

/* filter_fail() where memory is out. */
_Noreturn void filter_fail_memory(const filter *f);

/* What the library is to be given where it takes a tm_progress. */
const tm_progress *filter_progress(const filter *f);

/* A stage of the filter's own begins: "drawing". */
void filter_stage(const filter *f, const char *what);

/* A line on stderr as it is. */
void filter_print(const filter *f, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The same of bytes that a reader refused; `reader` is the filter that reads the format.
 * Where they look like what another one reads, that is said. */
_Noreturn void filter_fail_file(const filter *f, tm_error *error, const tm_text *bytes,
                                const char *reader);

/* One line on stderr, "name: …": note() unless -q, verbose() with -v only. Bytes that a
 * terminal would obey are shown as \x1b. */
void filter_message(const filter *f, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void filter_note(const filter *f, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void filter_verbose(const filter *f, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* What of the input is not in the output: "3 edges (.edge)". A note that says so, or with
 * --strict an error, exit 3; before anything is written. */
void filter_leave_out(const filter *f, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* FILE, or standard input, open for reading; -1 with an error. */
int filter_open_input(const filter *f, tm_error *error);

/* Standard output, or -o FILE in the making. */
int filter_open_output(filter *f);

/* Names it in an error that names no file yet. */
void filter_name_output(const filter *f, tm_error *error);

/* Adds the line to the history of a stream: "# name version options: done". */
void filter_add_history(const filter *f, tm_stream *stream, const char *done);

/* The input's name for messages: the file, or "<stdin>". */
const char *filter_input_name(const filter *f);

/* All bytes of FILE or standard input, or of another file, which is named. */
void filter_read_bytes(const filter *f, tm_text *bytes);
void filter_read_file(const filter *f, const char *file, tm_text *bytes);

/* Reads the stream from FILE or standard input; what it holds is what the filter takes
 * (kinds.h). */
void filter_read(const filter *f, tm_stream *stream);

/* Adds the history line "name version options: summary" (unless --no-history) and
 * writes the stream to the output. summary is a printf format. With --json the report has
 * been written before, so that nothing goes out where that fails. */
void filter_write(filter *f, tm_stream *stream, const char *summary, ...)
    __attribute__((format(printf, 3, 4)));

/* The same of ranks that work together, each of which has a slice. */
void filter_read_slices(const filter *f, tm_slices *slices);
void filter_write_slices(filter *f, tm_slices *slices, const char *summary, ...)
    __attribute__((format(printf, 3, 4)));

/* filter_write_text() of what all ranks have, in their order, which are together a text.
 */
void filter_write_texts(filter *f, const tm_text *text);

/* Writes a text (a table, a foreign file) to the output, after the report as well. */
void filter_write_text(filter *f, const tm_text *text);

/* Whether the report to read is written: not where standard output is for the JSON. */
bool filter_has_report(const filter *f);

/* An object with these rows of a struct (report.h) to where --json says, if it does. Of
 * one that has more, the members are put between begin and end. */
void filter_write_json(filter *f, const tm_report_row *rows, const void *of);
tm_json *filter_json_begin(filter *f);
void filter_json_end(filter *f);

/* Ends the program after text on standard output, which must have arrived. */
_Noreturn void filter_exit_after_text(const filter *f);

/* Closes and checks standard output, puts -o FILE in place. Returns status for main(). */
int filter_finish(filter *f, int status);

#endif
