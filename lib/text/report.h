/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A struct of counts and measures as a report: as members of a JSON object, and as a
 * table to read. Each member of the struct is one row of a list, which ends with {0}:
 *
 *     static const tm_report_row rows[] = {
 *         TM_REPORT_ROW("tets", "tetrahedra", NULL, tm_statistics, tets),
 *         TM_REPORT_ROW("volume", "volume", "%.7g", tm_statistics, volume),
 *         {0}};
 *     tm_report_json(&json, rows, &statistics);
 *     tm_report_table(&text, rows, (const void *[]){&statistics}, 1, TM_LABEL_WIDTH);
 */
#ifndef TM_TEXT_REPORT_H
#define TM_TEXT_REPORT_H

#include "../base/extern_c.h"
#include "json.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

typedef enum tm_report_type {
    TM_REPORT_END,
    TM_REPORT_COUNT,  /* size_t */
    TM_REPORT_COUNTS, /* an array of them: an array in JSON, not in tables */
    TM_REPORT_KNOWN,  /* size_t: 0 is not known, null in JSON */
    TM_REPORT_UNSIGNED,
    TM_REPORT_INTEGER, /* int64_t */
    TM_REPORT_NUMBER,  /* double */
    TM_REPORT_OPEN,    /* an object in JSON, up to */
    TM_REPORT_CLOSE,
    TM_REPORT_HEADING /* a line in tables: the label */
} tm_report_type;

typedef struct tm_report_row {
    const char *key;    /* in JSON; NULL: not there */
    const char *label;  /* in tables; NULL: not there */
    const char *format; /* in tables, of a double; NULL: of a number "%.9g" */
    tm_report_type type;
    size_t offset; /* of the member */
    size_t size;   /* of it, in bytes */
} tm_report_row;

/* clang-format off */
/* The type is that of the member; nothing is looked at where the pointer points. */
#define TM_REPORT_TYPE(type, member) \
    _Generic(((type *)1)->member, size_t: TM_REPORT_COUNT, size_t *: TM_REPORT_COUNTS, \
             unsigned: TM_REPORT_UNSIGNED, int64_t: TM_REPORT_INTEGER, \
             double: TM_REPORT_NUMBER)
#define TM_REPORT_ROW(key, label, format, type, member) \
    {key, label, format, TM_REPORT_TYPE(type, member), offsetof(type, member), \
     sizeof(((type *)1)->member)}
/* A count of which 0 means that it is not known. */
#define TM_REPORT_KNOWN_ROW(key, type, member) \
    {key, NULL, NULL, TM_REPORT_KNOWN, offsetof(type, member), sizeof(size_t)}
#define TM_REPORT_OPEN_ROW(key) {key, NULL, NULL, TM_REPORT_OPEN, 0, 0}
#define TM_REPORT_CLOSE_ROW {"", NULL, NULL, TM_REPORT_CLOSE, 0, 0}
#define TM_REPORT_HEADING_ROW(label) {NULL, label, NULL, TM_REPORT_HEADING, 0, 0}
/* clang-format on */

/* Adds the rows that have a key to the object that is open. */
void tm_report_json(tm_json *json, const tm_report_row *row, const void *of);

/* Adds an object with the rows. */
void tm_report_object(tm_json *json, const char *key, const tm_report_row *row,
                      const void *of);

/* Adds a histogram as [[upper end of bin 0, count[0]], …]. */
void tm_report_histogram(tm_json *json, const char *key, const size_t *count, size_t bins,
                         double (*end)(size_t bin));

/* 100 part / whole; 0 of nothing is 0. */
double tm_percent(size_t part, size_t whole);

/* Bytes of a table's label, of a number behind it, and stars of the longest bar. */
enum { TM_LABEL_WIDTH = 40, TM_COLUMN_WIDTH = 14, TM_LONGEST_BAR = 30 };

/* Appends a line for each row that has a label: it and the value of each column. Behind
 * counts in two columns stands how many times the first the second is. */
void tm_report_table(tm_text *text, const tm_report_row *row, const void *const column[],
                     size_t columns, int label_width);

/* Appends a label and numbers of one format, and no end of line. */
void tm_report_cells(tm_text *text, const char *label, const char *format,
                     const double *value, size_t columns);

/* Appends a bar of so many stars, and the end of the line. */
void tm_report_bar(tm_text *text, double stars);

TM_EXTERN_C_END

#endif
