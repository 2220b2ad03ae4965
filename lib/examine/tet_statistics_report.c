/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tet_statistics.h as JSON and as tables. */
#include "../element/tet_quality.h"
#include "tet_statistics.h"

#include <math.h>
#include <stdio.h>

enum {
    SMALL_LIMITS = 6, /* <5 … <30 degrees; volume quality <0.05 … <0.3 */
    KEY_CHARS = 16,
    LABEL_WIDTH = 40,
    COLUMN_WIDTH = 14,
    LONGEST_BAR = 30
};

static const double half_turn = 180; /* degrees */

static size_t angles(const tm_tet_statistics *s)
{
    return TM_TET_EDGES * s->tets;
}

/* The upper end of a bin of volume quality, as the double nearest to its decimals. */
static double volume_quality_end(size_t bin)
{
    return (double)(bin + 1) / TM_VOLUME_QUALITY_BINS;
}

static double dihedral_end(size_t bin)
{
    return TM_DIHEDRAL_BIN * (double)(bin + 1);
}

static void share_json(tm_json *json, char sign, double limit, size_t part, size_t whole)
{
    char key[KEY_CHARS];
    snprintf(key, sizeof key, "%c%g", sign, limit);
    tm_json_double(json, key, tm_percent(part, whole));
}

static void histogram_json(tm_json *json, const char *key, const size_t *histogram,
                           size_t bins, double (*end)(size_t bin))
{
    tm_json_open(json, key, '[');
    for (size_t i = 0; i < bins; i++) {
        tm_json_open(json, NULL, '[');
        tm_json_double(json, NULL, end(i));
        tm_json_integer(json, NULL, (int64_t)histogram[i]);
        tm_json_close(json, ']');
    }
    tm_json_close(json, ']');
}

void tm_tet_statistics_json(tm_json *json, const tm_tet_statistics *s)
{
    tm_json_integer(json, "nodes", (int64_t)s->nodes);
    tm_json_integer(json, "tets", (int64_t)s->tets);
    tm_json_double(json, "volume", s->volume);
    tm_json_double(json, "min_dihedral", s->min_dihedral);
    tm_json_double(json, "max_dihedral", s->max_dihedral);
    tm_json_double(json, "bad_percent", tm_percent(s->bad, s->tets));
    tm_json_open(json, "dihedral_percent", '{');
    for (size_t i = 0; i < SMALL_LIMITS; i++)
        share_json(json, '<', dihedral_end(i), tm_count_through(s->dihedral, i),
                   angles(s));
    for (size_t i = 0; i < TM_LARGE_LIMITS; i++)
        share_json(json, '>', tm_large_limit[i], s->large[i], angles(s));
    tm_json_close(json, '}');
    tm_json_open(json, "volume_quality_percent", '{');
    for (size_t i = 0; i < SMALL_LIMITS; i++)
        share_json(json, '<', volume_quality_end(i),
                   tm_count_through(s->volume_quality, i), s->tets);
    tm_json_close(json, '}');
    histogram_json(json, "dihedral_histogram", s->dihedral, TM_DIHEDRAL_BINS,
                   dihedral_end);
    histogram_json(json, "volume_quality_histogram", s->volume_quality,
                   TM_VOLUME_QUALITY_BINS, volume_quality_end);
}

/* A table of one column or of two. */
typedef struct table {
    tm_text *text;
    const tm_tet_statistics *column[2];
    size_t columns;
} table;

static void label(const table *t, const char *indent, const char *what)
{
    tm_text_format(t->text, "%s%-*s", indent, LABEL_WIDTH - (indent[0] ? 2 : 0), what);
}

static void number(const table *t, const char *format, double value)
{
    char cell[KEY_CHARS * 2];
    snprintf(cell, sizeof cell, format, value);
    tm_text_format(t->text, "%*s", COLUMN_WIDTH, cell);
}

static void end_row(const table *t)
{
    tm_text_string(t->text, "\n");
}

static void heading(const table *t, const char *what)
{
    tm_text_format(t->text, "\n%s\n", what);
}

/* A row of counts; with two columns, how many times the first the second is. */
static void count_row(const table *t, const char *what, size_t first, size_t second)
{
    label(t, "", what);
    number(t, "%.0f", (double)first);
    if (t->columns == 2) {
        number(t, "%.0f", (double)second);
        if (first > 0)
            tm_text_format(t->text, "   %.2f times", (double)second / (double)first);
    }
    end_row(t);
}

static void number_row(const table *t, const char *what, const char *format, double first,
                       double second)
{
    label(t, "", what);
    number(t, format, first);
    if (t->columns == 2)
        number(t, format, second);
    end_row(t);
}

/* Shares in percent of each column, then a bar for the last one where longest > 0. */
static void share_row(const table *t, const char *what, const double share[2],
                      double longest)
{
    label(t, "  ", what);
    for (size_t c = 0; c < t->columns; c++)
        number(t, "%.2f", share[c]);
    if (longest > 0) {
        const int stars = (int)lround(LONGEST_BAR * share[t->columns - 1] / longest);
        tm_text_string(t->text, stars > 0 ? "   " : "");
        for (int i = 0; i < stars; i++)
            tm_text_string(t->text, "*");
    }
    end_row(t);
}

static void size_rows(const table *t)
{
    const tm_tet_statistics *s = t->column[0];
    const tm_tet_statistics *after = t->column[t->columns - 1];
    count_row(t, "nodes", s->nodes, after->nodes);
    count_row(t, "tetrahedra", s->tets, after->tets);
    number_row(t, "volume", "%.7g", s->volume, after->volume);
    number_row(t, "smallest dihedral angle", "%.4f", s->min_dihedral,
               after->min_dihedral);
    number_row(t, "largest dihedral angle", "%.4f", s->max_dihedral, after->max_dihedral);
}

static void bad_row(const table *t)
{
    char what[LABEL_WIDTH * 2];
    double share[2];
    for (size_t c = 0; c < t->columns; c++)
        share[c] = tm_percent(t->column[c]->bad, t->column[c]->tets);
    snprintf(what, sizeof what, "with an angle below %g or above %g", t->column[0]->limit,
             half_turn - t->column[0]->limit);
    heading(t, "tetrahedra, %");
    share_row(t, what, share, 0);
}

static void volume_quality_rows(const table *t)
{
    for (size_t i = 0; i < SMALL_LIMITS; i++) {
        char what[LABEL_WIDTH];
        double share[2];
        for (size_t c = 0; c < t->columns; c++)
            share[c] = tm_percent(tm_count_through(t->column[c]->volume_quality, i),
                                  t->column[c]->tets);
        snprintf(what, sizeof what, "with volume quality below %.2f",
                 volume_quality_end(i));
        share_row(t, what, share, 0);
    }
}

static void small_dihedral_rows(const table *t)
{
    for (size_t i = 0; i < SMALL_LIMITS; i++) {
        char what[LABEL_WIDTH];
        double share[2];
        for (size_t c = 0; c < t->columns; c++)
            share[c] = tm_percent(tm_count_through(t->column[c]->dihedral, i),
                                  angles(t->column[c]));
        snprintf(what, sizeof what, "below %g", dihedral_end(i));
        share_row(t, what, share, 0);
    }
}

static void large_dihedral_rows(const table *t)
{
    for (size_t i = 0; i < TM_LARGE_LIMITS; i++) {
        char what[LABEL_WIDTH];
        double share[2];
        for (size_t c = 0; c < t->columns; c++)
            share[c] = tm_percent(t->column[c]->large[i], angles(t->column[c]));
        snprintf(what, sizeof what, "above %g", tm_large_limit[i]);
        share_row(t, what, share, 0);
    }
}

/* Rows of two bins each. `of` gives the histogram of a column, `wholes` what it counts.
 */
static void histogram_rows(const table *t, const char *format, size_t bins,
                           const size_t *const histogram[2], const size_t wholes[2],
                           double (*end)(size_t bin))
{
    const size_t last = t->columns - 1;
    double longest = 0;
    for (size_t i = 0; i < bins; i += 2)
        longest = fmax(longest, tm_percent(histogram[last][i] + histogram[last][i + 1],
                                           wholes[last]));
    for (size_t i = 0; i < bins; i += 2) {
        char what[LABEL_WIDTH];
        double share[2];
        for (size_t c = 0; c < t->columns; c++)
            share[c] = tm_percent(histogram[c][i] + histogram[c][i + 1], wholes[c]);
        snprintf(what, sizeof what, format, i == 0 ? 0 : end(i - 1), end(i + 1));
        share_row(t, what, share, longest);
    }
}

static void histograms(const table *t)
{
    const size_t *dihedral[2], *quality[2];
    size_t all_angles[2], all_tets[2];
    for (size_t c = 0; c < t->columns; c++) {
        dihedral[c] = t->column[c]->dihedral;
        quality[c] = t->column[c]->volume_quality;
        all_angles[c] = angles(t->column[c]);
        all_tets[c] = t->column[c]->tets;
    }
    heading(t, "histogram of dihedral angles, %");
    histogram_rows(t, "%3g to %3g", TM_DIHEDRAL_BINS, dihedral, all_angles, dihedral_end);
    heading(t, "histogram of volume quality, %");
    histogram_rows(t, "%.1f to %.1f", TM_VOLUME_QUALITY_BINS, quality, all_tets,
                   volume_quality_end);
}

void tm_tet_statistics_table(tm_text *text, const tm_tet_statistics *before,
                             const tm_tet_statistics *statistics)
{
    const table t = {text, {before ? before : statistics, statistics}, before ? 2 : 1};
    if (before)
        tm_text_format(text, "%*s%*s\n", LABEL_WIDTH + COLUMN_WIDTH, "before",
                       COLUMN_WIDTH, "after");
    size_rows(&t);
    bad_row(&t);
    volume_quality_rows(&t);
    heading(&t, "dihedral angles, %");
    small_dihedral_rows(&t);
    large_dihedral_rows(&t);
    histograms(&t);
}
