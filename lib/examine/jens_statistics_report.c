/* SPDX-License-Identifier: GPL-3.0-or-later */
/* jens_statistics.h as JSON, as tables and as a file .histo. */
#include "../text/report.h"
#include "jens_statistics.h"

static const char *const answer[TM_CERTIFICATES] = {"certified", "not positive",
                                                    "undecided"};

void tm_jens_histogram_table(tm_text *text, const tm_jens_histogram *histogram,
                             size_t elements)
{
    tm_text_format(text, "negative: %zu\n", histogram->negative);
    for (size_t i = 0; i < TM_JENS_BUCKETS; i++)
        tm_text_format(text, "<%-6g : %zu\n", tm_jens_edge[i], histogram->bucket[i]);
    tm_text_format(text, "total: %zu\nworst quality %f\naverage quality %f\n", elements,
                   histogram->all.worst, histogram->all.average);
}

void tm_jens_histogram_file(tm_text *text, const tm_jens_histogram *histogram)
{
    const double first = 0.03; /* so it is called in these files */
    tm_text_format(text, "negative %zu\n", histogram->negative);
    for (size_t i = 0; i < TM_JENS_BUCKETS; i++)
        tm_text_format(text, "%f %zu\n", i == 0 ? first : tm_jens_edge[i],
                       histogram->bucket[i]);
}

void tm_jens_certified_table(tm_text *text, const tm_jens_statistics *statistics,
                             unsigned base)
{
    for (size_t i = 0; i < TM_CERTIFICATES; i++) {
        const tm_certified *c = &statistics->certified[i];
        tm_text_format(text, "%s: %zu", answer[i], c->count);
        if (i != TM_POSITIVE && c->count > 0) {
            tm_text_string(text, c->count == 1 ? " (element" : " (elements");
            for (size_t j = 0; j < c->count && j < TM_NAMED; j++)
                tm_text_format(text, " %zu", c->first[j] + base);
            tm_text_string(text, c->count > TM_NAMED ? " …)" : ")");
        }
        tm_text_string(text, "\n");
    }
}

#define ROW(key, type, member) TM_REPORT_ROW(key, NULL, NULL, type, member)

static double edge(size_t bucket)
{
    return tm_jens_edge[bucket];
}

static const tm_report_row spread[] = {
    ROW("worst", tm_spread, worst), ROW("average", tm_spread, average), {0}};

static void histogram_json(tm_json *json, const tm_jens_histogram *histogram)
{
    tm_json_integer(json, "negative", (int64_t)histogram->negative);
    tm_report_json(json, spread, &histogram->all);
    tm_report_histogram(json, "histogram", histogram->bucket, TM_JENS_BUCKETS, edge);
}

/* With the first elements that are not certified, not positive ones before the others. */
static void certified_json(tm_json *json, const tm_jens_statistics *statistics,
                           unsigned base)
{
    static const tm_report_row rows[] = {
        ROW("positive", tm_jens_statistics, certified[TM_POSITIVE].count),
        ROW("not_positive", tm_jens_statistics, certified[TM_NOT_POSITIVE].count),
        ROW("undecided", tm_jens_statistics, certified[TM_UNDECIDED].count),
        {0}};
    tm_json_open(json, "certified", '{');
    tm_report_json(json, rows, statistics);
    tm_json_open(json, "first", '[');
    for (size_t i = TM_NOT_POSITIVE; i < TM_CERTIFICATES; i++) {
        const tm_certified *c = &statistics->certified[i];
        for (size_t j = 0; j < c->count && j < TM_NAMED; j++)
            tm_json_integer(json, NULL, (int64_t)(c->first[j] + base));
    }
    tm_json_close(json, ']');
    tm_json_close(json, '}');
}

void tm_jens_statistics_json(tm_json *json, const tm_jens_statistics *statistics,
                             const tm_jens_request *request, unsigned base)
{
    static const tm_report_row elements[] = {ROW("tet", tm_jens_statistics, kind[0]),
                                             ROW("pyramid", tm_jens_statistics, kind[1]),
                                             ROW("wedge", tm_jens_statistics, kind[2]),
                                             ROW("hex", tm_jens_statistics, kind[3]),
                                             {0}};
    tm_report_object(json, "elements", elements, statistics);
    histogram_json(json, &statistics->jens);
    if (request->scaled_jacobian) {
        tm_json_open(json, "scaled_jacobian", '{');
        histogram_json(json, &statistics->scaled_jacobian);
        tm_json_close(json, '}');
    }
    if (request->others) {
        tm_report_object(json, "aspect_ratio", spread, &statistics->aspect_ratio);
        tm_json_open(json, "verdict", '{');
        tm_report_object(json, "scaled_jacobian", spread,
                         &statistics->verdict_scaled_jacobian);
        tm_report_object(json, "shape", spread, &statistics->verdict_shape);
        tm_json_close(json, '}');
    }
    if (request->certify)
        certified_json(json, statistics, base);
}
