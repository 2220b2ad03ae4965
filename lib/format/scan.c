/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scan.h"

#include "../number/number.h"
#include "../stream/sniff.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <strings.h>

enum { SHOWN = 40 };

void tm_scan_begin(tm_scan *scan, const char *bytes, size_t size, const char *name,
                   char comment)
{
    const size_t mark = tm_byte_order_mark(bytes, size);
    *scan = (tm_scan){bytes + mark, bytes + size, name, 1, comment};
}

static bool is_line_end(char c)
{
    return c == '\n' || c == '\r';
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

bool tm_scan_more(tm_scan *scan)
{
    while (scan->at < scan->end && is_blank(*scan->at))
        scan->at++;
    return scan->at < scan->end && !is_line_end(*scan->at) &&
           !(scan->comment && *scan->at == scan->comment);
}

tm_word tm_scan_rest(tm_scan *scan)
{
    tm_word rest = {scan->at, 0};
    while (scan->at < scan->end && !is_line_end(*scan->at))
        scan->at++;
    rest.size = (size_t)(scan->at - rest.begin);
    return rest;
}

void tm_scan_end_line(tm_scan *scan)
{
    tm_scan_rest(scan);
    if (scan->at == scan->end)
        return;
    char first = *scan->at++;
    if (first == '\r' && scan->at < scan->end && *scan->at == '\n')
        scan->at++;
    scan->line++;
}

bool tm_scan_seek(tm_scan *scan)
{
    while (!tm_scan_more(scan)) {
        if (scan->at == scan->end)
            return false;
        tm_scan_end_line(scan);
    }
    return true;
}

tm_word tm_scan_word(tm_scan *scan)
{
    tm_word word = {scan->at, 0};
    if (!tm_scan_more(scan))
        return word;
    word.begin = scan->at;
    while (scan->at < scan->end && !is_blank(*scan->at) && !is_line_end(*scan->at) &&
           !(scan->comment && *scan->at == scan->comment))
        scan->at++;
    word.size = (size_t)(scan->at - word.begin);
    return word;
}

tm_status tm_scan_fail(const tm_scan *scan, tm_error *error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tm_fail_at_list(error, TM_ERROR_INPUT, scan->name, scan->line, NULL, format,
                    arguments);
    va_end(arguments);
    return TM_ERROR_INPUT;
}

static tm_status fail_missing(const tm_scan *scan, const char *what, tm_error *error)
{
    if (scan->at == scan->end)
        return tm_scan_fail(scan, error, "the file ends where %s should be", what);
    return tm_scan_fail(scan, error, "the line ends where %s should be", what);
}

/* As tm_read_double(), of a number that has D for E. */
static const char *read_fortran(const char *begin, const char *at, const char *end,
                                double *value)
{
    enum { LONGEST = 64 };
    char text[LONGEST];
    const size_t size = (size_t)(end - begin);
    if (!at || at == end || (*at != 'D' && *at != 'd') || size > sizeof text)
        return at;
    memcpy(text, begin, size);
    text[at - begin] = 'e';
    return tm_read_double(text, text + size, value) == text + size ? end : at;
}

tm_status tm_scan_double(tm_scan *scan, const char *what, double *value, tm_error *error)
{
    tm_word word = tm_scan_word(scan);
    if (word.size == 0)
        return fail_missing(scan, what, error);
    const char *end = word.begin + word.size;
    const char *after = tm_read_double(word.begin, end, value);
    after = read_fortran(word.begin, after, end, value);
    if (after != end) {
        bool comma = after && *after == ',';
        return tm_scan_fail(scan, error, "%s: '%.*s' is not a number%s", what,
                            tm_word_shown(word), word.begin,
                            comma ? " (the decimal sign is a point)" : "");
    }
    if (!isfinite(*value))
        return tm_scan_fail(scan, error, "%s: '%.*s' is too large (below 1.8e308)", what,
                            tm_word_shown(word), word.begin);
    return TM_OK;
}

tm_status tm_scan_integer(tm_scan *scan, const char *what, int64_t lo, int64_t hi,
                          int64_t *value, tm_error *error)
{
    tm_word word = tm_scan_word(scan);
    if (word.size == 0)
        return fail_missing(scan, what, error);
    const char *end = word.begin + word.size;
    if (tm_read_int64(word.begin, end, value) != end)
        return tm_scan_fail(scan, error, "%s: '%.*s' is not a whole number", what,
                            tm_word_shown(word), word.begin);
    if (*value < lo || *value > hi)
        return tm_scan_fail(scan, error,
                            "%s: %" PRId64 " is out of range (%" PRId64 "..%" PRId64 ")",
                            what, *value, lo, hi);
    return TM_OK;
}

tm_status tm_scan_whole(tm_scan *scan, const char *what, int64_t lo, int64_t hi,
                        int64_t *value, tm_error *error)
{
    static const double largest = 9007199254740992; /* 2^53 */
    tm_scan ahead = *scan;
    double real = 0;
    if (tm_scan_integer(&ahead, what, INT64_MIN, INT64_MAX, value, NULL) == TM_OK ||
        (ahead = *scan, tm_scan_double(&ahead, what, &real, NULL) != TM_OK) ||
        real != floor(real) || fabs(real) > largest || (double)lo > real ||
        real > (double)hi)
        return tm_scan_integer(scan, what, lo, hi, value, error);
    *value = (int64_t)real;
    *scan = ahead;
    return TM_OK;
}

tm_status tm_scan_point(tm_scan *scan, double point[3], tm_error *error)
{
    static const char *const what[3] = {"the x coordinate", "the y coordinate",
                                        "the z coordinate"};
    tm_status status = TM_OK;
    for (int i = 0; i < 3 && status == TM_OK; i++)
        status = tm_scan_double(scan, what[i], &point[i], error);
    return status;
}

tm_status tm_scan_next_double(tm_scan *scan, const char *what, double *value,
                              tm_error *error)
{
    tm_scan_seek(scan);
    return tm_scan_double(scan, what, value, error);
}

tm_status tm_scan_next_integer(tm_scan *scan, const char *what, int64_t lo, int64_t hi,
                               int64_t *value, tm_error *error)
{
    tm_scan_seek(scan);
    return tm_scan_integer(scan, what, lo, hi, value, error);
}

tm_status tm_scan_no_more(tm_scan *scan, const char *what, tm_error *error)
{
    if (!tm_scan_more(scan))
        return TM_OK;
    tm_word word = tm_scan_word(scan);
    return tm_scan_fail(scan, error, "'%.*s' follows %s (the line should end there)",
                        tm_word_shown(word), word.begin, what);
}

bool tm_word_is(tm_word word, const char *string)
{
    return strlen(string) == word.size && memcmp(word.begin, string, word.size) == 0;
}

bool tm_word_is_like(tm_word word, const char *string)
{
    return strlen(string) == word.size && strncasecmp(word.begin, string, word.size) == 0;
}

int tm_word_shown(tm_word word)
{
    enum { TAIL = 0x80, TAIL_BITS = 0xC0 };
    size_t size = word.size < SHOWN ? word.size : SHOWN;
    /* no letter of UTF-8 is cut */
    if (size < word.size)
        while (size > 0 && (word.begin[size] & TAIL_BITS) == TAIL)
            size--;
    return (int)size;
}
