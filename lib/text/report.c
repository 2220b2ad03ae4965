/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char count_format[] = "%.0f"; /* a count, as a double */
static const char number_format[] = "%.9g";

static const void *member(const tm_report_row *row, const void *of)
{
    return (const char *)of + row->offset;
}

static int64_t integer_of(const tm_report_row *row, const void *of)
{
    unsigned small;
    size_t size;
    int64_t number;
    if (row->type == TM_REPORT_UNSIGNED)
        return *(const unsigned *)memcpy(&small, member(row, of), sizeof small);
    if (row->type == TM_REPORT_INTEGER)
        return *(const int64_t *)memcpy(&number, member(row, of), sizeof number);
    return (int64_t) * (const size_t *)memcpy(&size, member(row, of), sizeof size);
}

static double number_of(const tm_report_row *row, const void *of)
{
    if (row->type == TM_REPORT_NUMBER)
        return *(const double *)member(row, of);
    return (double)integer_of(row, of);
}

static const char *format_of(const tm_report_row *row)
{
    if (row->format)
        return row->format;
    return row->type == TM_REPORT_NUMBER ? number_format : count_format;
}

static void counts_json(tm_json *json, const tm_report_row *row, const void *of)
{
    const size_t *count = member(row, of);
    tm_json_open(json, row->key, '[');
    for (size_t i = 0; i < row->size / sizeof *count; i++)
        tm_json_integer(json, NULL, (int64_t)count[i]);
    tm_json_close(json, ']');
}

static void row_json(tm_json *json, const tm_report_row *row, const void *of)
{
    switch (row->type) {
    case TM_REPORT_KNOWN:
        if (integer_of(row, of) == 0)
            tm_json_double(json, row->key, NAN);
        else
            tm_json_integer(json, row->key, integer_of(row, of));
        break;
    case TM_REPORT_NUMBER:
        tm_json_double(json, row->key, number_of(row, of));
        break;
    case TM_REPORT_COUNTS:
        counts_json(json, row, of);
        break;
    case TM_REPORT_OPEN:
        tm_json_open(json, row->key, '{');
        break;
    case TM_REPORT_CLOSE:
        tm_json_close(json, '}');
        break;
    default:
        tm_json_integer(json, row->key, integer_of(row, of));
    }
}

void tm_report_json(tm_json *json, const tm_report_row *row, const void *of)
{
    for (; row->type != TM_REPORT_END; row++)
        if (row->key)
            row_json(json, row, of);
}

void tm_report_object(tm_json *json, const char *key, const tm_report_row *row,
                      const void *of)
{
    tm_json_open(json, key, '{');
    tm_report_json(json, row, of);
    tm_json_close(json, '}');
}

void tm_report_histogram(tm_json *json, const char *key, const size_t *count, size_t bins,
                         double (*end)(size_t bin))
{
    tm_json_open(json, key, '[');
    for (size_t i = 0; i < bins; i++) {
        tm_json_open(json, NULL, '[');
        tm_json_double(json, NULL, end(i));
        tm_json_integer(json, NULL, (int64_t)count[i]);
        tm_json_close(json, ']');
    }
    tm_json_close(json, ']');
}

double tm_percent(size_t part, size_t whole)
{
    const double hundred = 100;
    return whole == 0 ? 0 : hundred * (double)part / (double)whole;
}

static void cell(tm_text *text, const char *format, double value)
{
    enum { CHARS = 512 }; /* "%.4f" of the largest double needs 314 */
    char digits[CHARS];
    snprintf(digits, sizeof digits, format, value);
    tm_text_format(text, "%*s", TM_COLUMN_WIDTH, digits);
}

void tm_report_cells(tm_text *text, const char *label, const char *format,
                     const double *value, size_t columns)
{
    tm_text_format(text, "%-*s", TM_LABEL_WIDTH, label);
    for (size_t c = 0; c < columns; c++)
        cell(text, format, value[c]);
}

void tm_report_bar(tm_text *text, double stars)
{
    const long count = lround(stars);
    tm_text_string(text, count > 0 ? "   " : "");
    for (long i = 0; i < count; i++)
        tm_text_string(text, "*");
    tm_text_string(text, "\n");
}

void tm_report_table(tm_text *text, const tm_report_row *row, const void *const column[],
                     size_t columns, int label_width)
{
    for (; row->type != TM_REPORT_END; row++) {
        if (!row->label)
            continue;
        if (row->type == TM_REPORT_HEADING) {
            tm_text_format(text, "%s\n", row->label);
            continue;
        }
        tm_text_format(text, "%-*s", label_width, row->label);
        for (size_t c = 0; c < columns; c++)
            cell(text, format_of(row), number_of(row, column[c]));
        if (columns == 2 && row->type == TM_REPORT_COUNT &&
            integer_of(row, column[0]) > 0)
            tm_text_format(text, "   %.2f times",
                           number_of(row, column[1]) / number_of(row, column[0]));
        tm_text_string(text, "\n");
    }
}
