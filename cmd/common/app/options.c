/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line: options and operands. */
#include "filter.h"
#include "wrong_option.h"

#include "../../../lib/number/number.h"
#include "../../../lib/ranks/ranks.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { THREADS_MAX = 256, OPTION_NAME = 64 };

static const char shared_help[] =
    "  -o, --output FILE   write to FILE instead of standard output, whole or not at "
    "all\n"
    "  %s --threads N     use N threads, else one for each core; same bytes for every N\n"
    "      --json FILE     write a JSON report to FILE\n"
    "      --no-history    do not add a history line\n"
    "      --strict        refuse what the output cannot carry, instead of a note\n"
    "  %s --quiet         no notes and no progress on standard error\n"
    "  -v, --verbose       more notes, and the time that each stage takes\n"
    "  -h, --help          this text\n"
    "  -V, --version       the version\n";

void filter_usage(const filter *f, FILE *to)
{
    fprintf(to, "usage: %s %s\n", f->name, f->synopsis);
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

/* The row of an option that takes one of some words, or NULL. */
static const filter_words *words_of(const filter *f, int option)
{
    for (const filter_words *row = f->words; row && row->first; row++)
        if (row->option == option)
            return row;
    return NULL;
}

const char *filter_word_of(const filter_words *row, int k)
{
    return *(const char *const *)((const char *)row->first + (size_t)k * row->stride);
}

/* "-a", or where it has no letter "--ops". */
static void name_option(const filter *f, int option, char name[OPTION_NAME])
{
    const struct option *o = f->options;
    if (option < FILTER_JSON) {
        snprintf(name, OPTION_NAME, "-%c", option);
        return;
    }
    while (o->name && o->val != option)
        o++;
    snprintf(name, OPTION_NAME, "--%s", o->name ? o->name : "");
}

int filter_find_word(const filter *f, int option, const char *given)
{
    const filter_words *row = words_of(f, option);
    for (int k = 0; k < row->count; k++)
        if (strcmp(filter_word_of(row, k), given) == 0)
            return k;
    return -1;
}

int filter_word(const filter *f, int option, const char *given)
{
    char all[256] = "", name[OPTION_NAME];
    const filter_words *row = words_of(f, option);
    const int found = filter_find_word(f, option, given);
    if (found >= 0)
        return found;
    for (int k = 0; k < row->count; k++)
        snprintf(all + strlen(all), sizeof all - strlen(all), k ? ", %s" : "%s",
                 filter_word_of(row, k));
    name_option(f, option, name);
    filter_usage_error(f, "%s: '%s' is none of %s", name, given, all);
}

_Noreturn static void help(const filter *f)
{
    filter_usage(f, stdout);
    printf("\n%s\n\n%s", f->purpose, f->help);
    printf(shared_help, f->j_is_own ? "   " : "-j,", f->q_is_own ? "   " : "-q,");
    filter_exit_after_text(f);
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

static bool is_optional(const char *letters, int c)
{
    const char *at = strchr(letters, c);
    return at && at[1] == ':' && at[2] == ':';
}

/* An argument that may lack is not taken from the next word; whoever thought so is told,
 * once that word turns out to be wrong as an operand. */
static void remember_apart(filter *f, int c, int index)
{
    if (index >= 0 ? f->options[index].has_arg != optional_argument
                   : !is_optional(f->letters, c))
        return;
    if (optarg || optind >= f->argc || *f->argv[optind] == '-')
        return;
    f->apart = f->argv[optind];
    if (index >= 0)
        snprintf(f->apart_option, sizeof f->apart_option,
                 "--%s=", f->options[index].name);
    else
        snprintf(f->apart_option, sizeof f->apart_option, "-%c", c);
}

/* All options are known. */
static void begin_work(filter *f)
{
    static progress p; /* that of the program: signals erase it */
    f->progress = &p;
    if (!filter_speaks())
        f->verbosity = -1;
    progress_start(&p, f->name, f->verbosity == -1, f->verbosity == 1);
}

int filter_option(filter *f)
{
    for (;;) {
        int index = -1;
        int c = getopt_long(f->argc, f->argv, f->letters, f->options, &index);
        if (c == '?')
            filter_wrong_option(f);
        if (c == -1) {
            filter_other_file(f, "--json", f->json);
            begin_work(f);
            return -1;
        }
        if (take_shared(f, c))
            continue;
        remember(f, c, index);
        remember_apart(f, c, index);
        return c;
    }
}

/* A path, or a name with a suffix, is no number and no word of an option. */
static bool looks_like_file(const char *operand)
{
    const char *dot = strrchr(operand, '.');
    return strchr(operand, '/') || (dot && isalpha((unsigned char)dot[1]));
}

void filter_explain_apart(const filter *f, const char *operand, char text[FILTER_APART])
{
    *text = '\0';
    if (operand && operand == f->apart && !looks_like_file(operand) &&
        access(operand, F_OK) != 0)
        snprintf(text, FILTER_APART, " (if %s belongs to the option: %s%s)", operand,
                 f->apart_option, operand);
}

_Noreturn static void fail_operands(const filter *f)
{
    char why[FILTER_APART];
    filter_explain_apart(f, f->input, why);
    filter_usage_error(f, "one FILE at most, but there is also '%s'%s", f->argv[optind],
                       why);
}

void filter_no_picture(const filter *f, const char *file, const char *instead)
{
    static const char *const suffix[] = {".png", ".jpg", ".jpeg", ".gif",
                                         ".pdf", ".eps", ".ps"};
    const char *own = file ? strrchr(file, '.') : NULL;
    for (size_t i = 0; own && i < sizeof suffix / sizeof *suffix; i++)
        if (strcasecmp(own, suffix[i]) == 0)
            filter_usage_error(f, "'%s': no %s file is written, but %s", file, own + 1,
                               instead);
}

void filter_other_file(const filter *f, const char *option, const char *file)
{
    const bool is_output = file && f->output && strcmp(file, f->output) == 0;
    const bool is_report = file && f->json && f->json != file &&
                           strcmp(file, f->json) == 0 && strcmp(file, "-") != 0;
    if (is_output || is_report)
        filter_usage_error(f, "%s and %s are the same file, '%s'", option,
                           is_output ? "-o" : "--json", file);
}

void filter_operands(filter *f)
{
    if (optind < f->argc)
        f->input = f->argv[optind++];
    if (optind < f->argc)
        fail_operands(f);
    if (f->input && strcmp(f->input, "-") == 0)
        f->input = NULL;
    if (!f->input && isatty(STDIN_FILENO)) {
        filter_usage(f, stderr);
        exit(EXIT_USAGE);
    }
    /* a launcher may give its programs a terminal and write to a file itself */
    if (f->binary && !f->output && !f->forced && !tm_launched() && isatty(STDOUT_FILENO))
        filter_usage_error(f, "the output is binary and would go to a terminal (-o FILE "
                              "or a pipe would be right; -o - forces it)");
}
