/* SPDX-License-Identifier: GPL-3.0-or-later */
/* jens_statistics.h as JSON, as tables and as a file .histo. */
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

static void spread_json(tm_json *json, const tm_spread *spread)
{
    tm_json_double(json, "worst", spread->worst);
    tm_json_double(json, "average", spread->average);
}

static void spread_object(tm_json *json, const char *key, const tm_spread *spread)
{
    tm_json_open(json, key, '{');
    spread_json(json, spread);
    tm_json_close(json, '}');
}

static void histogram_json(tm_json *json, const tm_jens_histogram *histogram)
{
    tm_json_integer(json, "negative", (int64_t)histogram->negative);
    spread_json(json, &histogram->all);
    tm_json_open(json, "histogram", '[');
    for (size_t i = 0; i < TM_JENS_BUCKETS; i++) {
        tm_json_open(json, NULL, '[');
        tm_json_double(json, NULL, tm_jens_edge[i]);
        tm_json_integer(json, NULL, (int64_t)histogram->bucket[i]);
        tm_json_close(json, ']');
    }
    tm_json_close(json, ']');
}

/* With the first elements that are not certified, not positive ones before the others. */
static void certified_json(tm_json *json, const tm_jens_statistics *statistics,
                           unsigned base)
{
    static const char *const key[TM_CERTIFICATES] = {"positive", "not_positive",
                                                     "undecided"};
    tm_json_open(json, "certified", '{');
    for (size_t i = 0; i < TM_CERTIFICATES; i++)
        tm_json_integer(json, key[i], (int64_t)statistics->certified[i].count);
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
    tm_json_open(json, "elements", '{');
    for (size_t i = 0; i < TM_ELEMENT_KINDS; i++)
        tm_json_integer(json, tm_element_shapes[tm_element_kind_nodes[i]].name,
                        (int64_t)statistics->kind[i]);
    tm_json_close(json, '}');
    histogram_json(json, &statistics->jens);
    if (request->scaled_jacobian) {
        tm_json_open(json, "scaled_jacobian", '{');
        histogram_json(json, &statistics->scaled_jacobian);
        tm_json_close(json, '}');
    }
    if (request->others) {
        spread_object(json, "aspect_ratio", &statistics->aspect_ratio);
        tm_json_open(json, "verdict", '{');
        spread_object(json, "scaled_jacobian", &statistics->verdict_scaled_jacobian);
        spread_object(json, "shape", &statistics->verdict_shape);
        tm_json_close(json, '}');
    }
    if (request->certify)
        certified_json(json, statistics, base);
}
