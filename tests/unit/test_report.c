/* SPDX-License-Identifier: GPL-3.0-or-later */
/* report.h: a struct as a JSON object and as a table. */
#include "../../lib/text/report.h"

#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

typedef struct {
    size_t nodes, unknown, known;
    size_t sizes[3];
    unsigned passes;
    int64_t euler;
    double volume;
    double none;
    struct {
        size_t count;
    } inner[2];
} sample;

#define ROW(key, label, format, member) TM_REPORT_ROW(key, label, format, sample, member)

static const tm_report_row rows[] = {ROW("nodes", "nodes of it", NULL, nodes),
                                     TM_REPORT_KNOWN_ROW("unknown", sample, unknown),
                                     TM_REPORT_KNOWN_ROW("known", sample, known),
                                     TM_REPORT_HEADING_ROW("\nrest"),
                                     TM_REPORT_OPEN_ROW("rest"),
                                     ROW("sizes", NULL, NULL, sizes),
                                     ROW("passes", "passes", NULL, passes),
                                     TM_REPORT_OPEN_ROW("deeper"),
                                     ROW("second", NULL, NULL, inner[1].count),
                                     TM_REPORT_CLOSE_ROW,
                                     TM_REPORT_CLOSE_ROW,
                                     ROW("euler", "Euler number", NULL, euler),
                                     ROW("volume", "volume", "%.3f", volume),
                                     ROW(NULL, "only to read", "%.1e", volume),
                                     ROW("none", NULL, NULL, none),
                                     {0}};

static const sample first = {.nodes = 4,
                             .known = 7,
                             .sizes = {1, 0, SIZE_MAX / 2},
                             .passes = UINT_MAX,
                             .euler = -5,
                             .volume = 0.1,
                             .none = INFINITY,
                             .inner = {{1}, {9}}};

static void assert_text(tm_text *text, const char *expected)
{
    assert_false(text->failed);
    assert_string_equal(text->byte ? text->byte : "", expected);
    tm_text_free(text);
}

static void members_are_keys(void **state)
{
    (void)state;
    tm_text text = {0};
    tm_json json = {.text = &text};
    tm_json_open(&json, NULL, '{');
    tm_report_json(&json, rows, &first);
    tm_report_object(&json, "empty", &rows[sizeof rows / sizeof *rows - 1], &first);
    tm_json_close(&json, '}');
    assert_text(&text, "{\"nodes\": 4, \"unknown\": null, \"known\": 7, "
                       "\"rest\": {\"sizes\": [1, 0, 9223372036854775807], "
                       "\"passes\": 4294967295, \"deeper\": {\"second\": 9}}, "
                       "\"euler\": -5, \"volume\": 0.1, \"none\": null, \"empty\": {}}");
}

static void labels_are_rows(void **state)
{
    (void)state;
    tm_text text = {0};
    tm_report_table(&text, rows, (const void *[]){&first}, 1, 14);
    assert_text(&text, "nodes of it                4\n"
                       "\nrest\n"
                       "passes            4294967295\n"
                       "Euler number              -5\n"
                       "volume                 0.100\n"
                       "only to read         1.0e-01\n");
}

static void two_columns_have_ratios_of_counts(void **state)
{
    (void)state;
    static const tm_report_row sizes[] = {ROW(NULL, "nodes", NULL, nodes),
                                          ROW(NULL, "known", NULL, known),
                                          ROW(NULL, "volume", "%.2f", volume),
                                          {0}};
    const sample before = {.nodes = 8, .known = 0, .volume = 1},
                 after = {.nodes = 10, .known = 3, .volume = 2};
    tm_text text = {0};
    tm_report_table(&text, sizes, (const void *[]){&before, &after}, 2, 8);
    assert_text(&text, "nodes                8            10   1.25 times\n"
                       "known                0             3\n"
                       "volume            1.00          2.00\n");
}

static void nothing_has_no_share(void **state)
{
    (void)state;
    assert_true(tm_percent(1, 8) == 12.5);
    assert_true(tm_percent(0, 0) == 0);
}

static double half(size_t bin)
{
    return (double)(bin + 1) / 2;
}

static void histograms_have_ends(void **state)
{
    (void)state;
    tm_text text = {0};
    tm_json json = {.text = &text};
    tm_report_histogram(&json, "some", (const size_t[]){3, 0, 5}, 3, half);
    tm_report_histogram(&json, "none", NULL, 0, half);
    assert_text(&text, "\"some\": [[0.5, 3], [1, 0], [1.5, 5]], \"none\": []");
}

static void bars_are_rounded(void **state)
{
    (void)state;
    tm_text text = {0};
    tm_report_cells(&text, "a", "%.1f", (const double[]){2.25, -1}, 2);
    tm_report_bar(&text, 2.5);
    tm_report_bar(&text, 0.4);
    assert_text(&text, "a                                       "
                       "           2.2          -1.0   ***\n\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(members_are_keys),
        cmocka_unit_test(labels_are_rows),
        cmocka_unit_test(two_columns_have_ratios_of_counts),
        cmocka_unit_test(nothing_has_no_share),
        cmocka_unit_test(histograms_have_ends),
        cmocka_unit_test(bars_are_rounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
