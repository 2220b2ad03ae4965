/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tet_statistics.h as JSON and as tables. */
#include "../text/report.h"
#include "../element/tet_quality.h"
#include "tet_statistics.h"

#include <math.h>
#include <stdio.h>

enum {
    SMALL_LIMITS = 6, /* <5 … <30 degrees; volume quality <0.05 … <0.3 */
    KEY_CHARS = 16,
    LABEL_CHARS = 80
};

#define ROW(key, label, format, member)                                                  \
    TM_REPORT_ROW(key, label, format, tm_tet_statistics, member)

static const tm_report_row sizes[] = {
    ROW("nodes", "nodes", NULL, nodes),
    ROW("tets", "tetrahedra", NULL, tets),
    ROW("volume", "volume", "%.7g", volume),
    ROW("min_dihedral", "smallest dihedral angle", "%.4f", min_dihedral),
    ROW("max_dihedral", "largest dihedral angle", "%.4f", max_dihedral),
    {0}};

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

/* Shares in percent, a row of the table and a key of the JSON for each limit. */
typedef struct share_list {
    const char *label; /* with the limit for %g */
    char sign;         /* before it in the key */
    size_t limits;
    double (*limit)(size_t i);
    double (*share)(const tm_tet_statistics *s, size_t i);
} share_list;

static double large_limit(size_t i)
{
    return tm_large_limit[i];
}

static double low_quality_share(const tm_tet_statistics *s, size_t i)
{
    return tm_percent(tm_count_through(s->volume_quality, i), s->tets);
}

static double small_angle_share(const tm_tet_statistics *s, size_t i)
{
    return tm_percent(tm_count_through(s->dihedral, i), angles(s));
}

static double large_angle_share(const tm_tet_statistics *s, size_t i)
{
    return tm_percent(s->large[i], angles(s));
}

static const share_list low_qualities = {"  with volume quality below %.2f", '<',
                                         SMALL_LIMITS, volume_quality_end,
                                         low_quality_share};
static const share_list small_angles = {"  below %g", '<', SMALL_LIMITS, dihedral_end,
                                        small_angle_share};
static const share_list large_angles = {"  above %g", '>', TM_LARGE_LIMITS, large_limit,
                                        large_angle_share};

static void shares_json(tm_json *json, const share_list *list, const tm_tet_statistics *s)
{
    for (size_t i = 0; i < list->limits; i++) {
        char key[KEY_CHARS];
        snprintf(key, sizeof key, "%c%g", list->sign, list->limit(i));
        tm_json_double(json, key, list->share(s, i));
    }
}

void tm_tet_statistics_json(tm_json *json, const tm_tet_statistics *s)
{
    tm_report_json(json, sizes, s);
    tm_json_double(json, "bad_percent", tm_percent(s->bad, s->tets));
    tm_json_open(json, "dihedral_percent", '{');
    shares_json(json, &small_angles, s);
    shares_json(json, &large_angles, s);
    tm_json_close(json, '}');
    tm_json_open(json, "volume_quality_percent", '{');
    shares_json(json, &low_qualities, s);
    tm_json_close(json, '}');
    tm_report_histogram(json, "dihedral_histogram", s->dihedral, TM_DIHEDRAL_BINS,
                        dihedral_end);
    tm_report_histogram(json, "volume_quality_histogram", s->volume_quality,
                        TM_VOLUME_QUALITY_BINS, volume_quality_end);
}

void tm_tet_statistics_object(tm_json *json, const char *key, const tm_tet_statistics *s)
{
    tm_json_open(json, key, '{');
    tm_tet_statistics_json(json, s);
    tm_json_close(json, '}');
}

/* A table of one column or of two. */
typedef struct table {
    tm_text *text;
    const tm_tet_statistics *column[2];
    size_t columns;
} table;

static void heading(const table *t, const char *what)
{
    tm_text_format(t->text, "\n%s\n", what);
}

static void bad_row(const table *t)
{
    char what[LABEL_CHARS];
    double share[2];
    const double limit = t->column[0]->limit;
    for (size_t c = 0; c < t->columns; c++)
        share[c] = tm_percent(t->column[c]->bad, t->column[c]->tets);
    snprintf(what, sizeof what, "  with an angle below %g or above %g", limit,
             half_turn - limit);
    tm_report_cells(t->text, what, "%.2f", share, t->columns);
    tm_text_string(t->text, "\n");
}

static void share_rows(const table *t, const share_list *list)
{
    for (size_t i = 0; i < list->limits; i++) {
        char what[LABEL_CHARS];
        double share[2];
        for (size_t c = 0; c < t->columns; c++)
            share[c] = list->share(t->column[c], i);
        snprintf(what, sizeof what, list->label, list->limit(i));
        tm_report_cells(t->text, what, "%.2f", share, t->columns);
        tm_text_string(t->text, "\n");
    }
}

/* Shares of two bins, from `bin` on. */
static double angles_in(const tm_tet_statistics *s, size_t bin)
{
    return tm_percent(s->dihedral[bin] + s->dihedral[bin + 1], angles(s));
}

static double qualities_in(const tm_tet_statistics *s, size_t bin)
{
    return tm_percent(s->volume_quality[bin] + s->volume_quality[bin + 1], s->tets);
}

/* Rows of two bins each, with a bar for the last column. */
static void histogram_rows(const table *t, const char *format, size_t bins,
                           double (*share_in)(const tm_tet_statistics *s, size_t bin),
                           double (*end)(size_t bin))
{
    const size_t last = t->columns - 1;
    double longest = 0;
    for (size_t i = 0; i < bins; i += 2)
        longest = fmax(longest, share_in(t->column[last], i));
    for (size_t i = 0; i < bins; i += 2) {
        char what[LABEL_CHARS];
        double share[2];
        for (size_t c = 0; c < t->columns; c++)
            share[c] = share_in(t->column[c], i);
        snprintf(what, sizeof what, format, i == 0 ? 0 : end(i - 1), end(i + 1));
        tm_report_cells(t->text, what, "%.2f", share, t->columns);
        tm_report_bar(t->text, longest > 0 ? TM_LONGEST_BAR * share[last] / longest : 0);
    }
}

void tm_tet_statistics_table(tm_text *text, const tm_tet_statistics *before,
                             const tm_tet_statistics *statistics)
{
    const table t = {text, {before ? before : statistics, statistics}, before ? 2 : 1};
    if (before)
        tm_text_format(text, "%*s%*s\n", TM_LABEL_WIDTH + TM_COLUMN_WIDTH, "before",
                       TM_COLUMN_WIDTH, "after");
    tm_report_table(text, sizes, (const void *const *)t.column, t.columns,
                    TM_LABEL_WIDTH);
    heading(&t, "tetrahedra, %");
    bad_row(&t);
    share_rows(&t, &low_qualities);
    heading(&t, "dihedral angles, %");
    share_rows(&t, &small_angles);
    share_rows(&t, &large_angles);
    heading(&t, "histogram of dihedral angles, %");
    histogram_rows(&t, "  %3g to %3g", TM_DIHEDRAL_BINS, angles_in, dihedral_end);
    heading(&t, "histogram of volume quality, %");
    histogram_rows(&t, "  %.1f to %.1f", TM_VOLUME_QUALITY_BINS, qualities_in,
                   volume_quality_end);
}
