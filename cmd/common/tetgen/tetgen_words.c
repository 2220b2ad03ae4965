/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen_words.h"

#include <math.h>
#include <stdlib.h>
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

/* Progress, not a complaint; or how the C++ library says that TetGen broke off. */
static bool is_progress(const char *line, int size)
{
    static const char *const words[] = {"Opening ",     "Delaunizing",     "Creating ",
                                        "Constrained ", "Removing ",       "Refining ",
                                        "Optimizing ",  "Writing ",        "Jettisoning ",
                                        " seconds:",    "Detecting",       "Recovering",
                                        "Statistics",   "terminate called"};
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
            filter_message(f, "tetgen: %.*s", size, line);
    }
    if (shown > LINES_MAX)
        filter_message(f, "tetgen: … and %d lines more", shown - LINES_MAX);
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

/* The three numbers of nodes in "( 1, 2, 3)", of which none is below base; the rest of
 * the text, or NULL. */
static const char *read_triangle(const char *at, const tm_polygon_surface *surface,
                                 size_t node[3])
{
    at += strcspn(at, "(\n");
    for (int i = 0; i < 3; i++) {
        char *end;
        if (*at != (i == 0 ? '(' : ','))
            return NULL;
        node[i] = strtoul(at + 1, &end, 10) - surface->base;
        if (end == at + 1 || node[i] >= surface->nodes)
            return NULL;
        at = end;
    }
    return at;
}

/* Somewhere in the boxes of both triangles. */
static void place_of(const tm_polygon_surface *surface, const size_t a[3],
                     const size_t b[3], double place[3])
{
    const double(*xyz)[3] = (const double(*)[3])surface->xyz;
    for (int k = 0; k < 3; k++) {
        const double low = fmax(fmin(xyz[a[0]][k], fmin(xyz[a[1]][k], xyz[a[2]][k])),
                                fmin(xyz[b[0]][k], fmin(xyz[b[1]][k], xyz[b[2]][k])));
        const double high = fmin(fmax(xyz[a[0]][k], fmax(xyz[a[1]][k], xyz[a[2]][k])),
                                 fmax(xyz[b[0]][k], fmax(xyz[b[1]][k], xyz[b[2]][k])));
        place[k] = (low + high) / 2;
    }
}

/* TetGen finds some pairs twice. */
static bool is_shown(const size_t (*pair)[2], size_t pairs, size_t first, size_t second)
{
    for (size_t i = 0; i < pairs; i++)
        if (pair[i][0] == first && pair[i][1] == second)
            return true;
    return false;
}

size_t tetgen_show_pairs(const filter *f, const tm_text *output,
                         const tm_polygon_surface *surface)
{
    enum { PAIRS_MAX = 5 };
    static const char begin[] = "Facet #";
    size_t pairs = 0, shown[PAIRS_MAX][2];
    const char *at = output->byte;
    while (at && (at = strstr(at, begin))) {
        size_t first, second, a[3], b[3];
        double p[3];
        if (sscanf(at, "Facet #%zu intersects facet #%zu at", &first, &second) != 2 ||
            is_shown((const size_t(*)[2])shown, pairs < PAIRS_MAX ? pairs : PAIRS_MAX,
                     first, second) ||
            pairs++ >= PAIRS_MAX) {
            at += strlen(begin);
            continue;
        }
        shown[pairs - 1][0] = first;
        shown[pairs - 1][1] = second;
        const char *rest = read_triangle(strpbrk(at, "\r\n") + 1, surface, a);
        at += strlen(begin);
        if (!rest || !read_triangle(rest, surface, b))
            continue;
        place_of(surface, a, b, p);
        /* TetGen numbers facets from 1. */
        filter_message(f, "faces %zu and %zu meet near (%g, %g, %g)",
                       first - 1 + surface->base, second - 1 + surface->base, p[0], p[1],
                       p[2]);
    }
    if (pairs > PAIRS_MAX)
        filter_message(f, "… and %zu pairs more", pairs - PAIRS_MAX);
    return pairs;
}

void tetgen_tell(const filter *f, const char *words, size_t size)
{
    static const char *const step[] = {"Delaunizing vertices",
                                       "Creating surface mesh",
                                       "Recovering boundaries",
                                       "Removing exterior tetrahedra",
                                       "Suppressing Steiner points",
                                       "Recovering Delaunayness",
                                       "Refining mesh",
                                       "Optimizing mesh"};
    tm_progress_at at = {.what = "TetGen"};
    const char *last = NULL;
    for (size_t i = 0; i < sizeof step / sizeof *step; i++) {
        const char *said = memmem(words, size, step[i], strlen(step[i]));
        if (!said || (last && said < last))
            continue;
        last = said;
        at.doing = step[i];
    }
    if (last)
        tm_progress_tell(filter_progress(f), &at);
}
