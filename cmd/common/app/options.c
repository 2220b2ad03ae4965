/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line: options and operands. */
#include "filter.h"

#include "../../../lib/base/number.h"

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
    "  %s --quiet         no notes on standard error\n"
    "  -v, --verbose       more notes\n"
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
        if (c == -1)
            return -1;
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
        filter_usage(f, stderr);
        exit(EXIT_USAGE);
    }
}
