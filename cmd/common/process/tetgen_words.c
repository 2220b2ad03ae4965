/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen_words.h"

#include <string.h>

/* The lines of a text, one after the other; false behind the last. */
static bool next_line(const char **at, const char **line, int *size)
{
    if (!*at || !**at)
        return false;
    *line = *at;
    *size = (int)strcspn(*at, "\r\n");
    *at += *size;
    *at += strspn(*at, "\r\n");
    return true;
}

static bool contains(const char *line, int size, const char *words)
{
    return memmem(line, (size_t)size, words, strlen(words)) != NULL;
}

/* Progress, not a complaint. */
static bool is_progress(const char *line, int size)
{
    static const char *const words[] = {"Opening ",     "Delaunizing", "Creating ",
                                        "Constrained ", "Removing ",   "Refining ",
                                        "Optimizing ",  "Writing ",    "Jettisoning ",
                                        " seconds:",    "Detecting",   "Recovering",
                                        "Statistics"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (contains(line, size, words[i]))
            return true;
    return strspn(line, " ") >= (size_t)size;
}

void tetgen_show_complaints(const filter *f, const tm_text *output)
{
    enum { LINES_MAX = 10 };
    const char *at = output->byte, *line;
    int size, shown = 0;
    while (next_line(&at, &line, &size)) {
        if (is_progress(line, size))
            continue;
        if (shown++ < LINES_MAX)
            fprintf(stderr, "%s: tetgen: %.*s\n", f->name, size, line);
    }
    if (shown > LINES_MAX)
        fprintf(stderr, "%s: tetgen: … and %d lines more\n", f->name, shown - LINES_MAX);
}

void tetgen_show_all(const filter *f, const tm_text *output)
{
    const char *at = output->byte, *line;
    int size;
    while (next_line(&at, &line, &size))
        filter_verbose(f, "tetgen: %.*s", size, line);
}

void tetgen_show_warnings(const filter *f, const tm_text *output)
{
    const char *at = output->byte, *line, *first = NULL;
    int size, first_size = 0;
    size_t warnings = 0;
    while (next_line(&at, &line, &size)) {
        if (!contains(line, size, "Warning"))
            continue;
        if (warnings++ == 0) {
            first = line;
            first_size = size;
        }
    }
    if (warnings > 0)
        filter_note(f, "warnings of TetGen: %zu (-v shows them), the first: %.*s",
                    warnings, first_size, first);
}

bool tetgen_said(const tm_text *output, const char *words)
{
    return output->byte && memmem(output->byte, output->size, words, strlen(words));
}
