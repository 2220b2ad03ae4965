/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "foam.h"

#include "../../number/number.h"

#include <math.h>
#include <string.h>

enum { COORDINATES = 3 };

static bool is_mark(char c)
{
    return c != '\0' && strchr("(){};[]", c) != NULL;
}

static bool is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Tokens ---------------------------------------------------------------------------- */

static void step(tm_scan *scan)
{
    scan->line += *scan->at++ == '\n';
}

static bool begins(const tm_scan *scan, const char *with)
{
    const size_t size = strlen(with);
    return (size_t)(scan->end - scan->at) >= size && memcmp(scan->at, with, size) == 0;
}

static tm_status skip_comment(tm_scan *scan, tm_error *error)
{
    const size_t line = scan->line;
    for (scan->at += 2; !begins(scan, "*/"); step(scan))
        if (scan->at == scan->end)
            return tm_fail_at(error, TM_ERROR_INPUT, scan->name, line, NULL,
                              "a comment has no end");
    scan->at += 2;
    return TM_OK;
}

static tm_status skip_blanks(tm_scan *scan, tm_error *error)
{
    tm_status status = TM_OK;
    while (scan->at < scan->end && status == TM_OK) {
        if (begins(scan, "/*"))
            status = skip_comment(scan, error);
        else if (begins(scan, "//"))
            tm_scan_end_line(scan);
        else if (is_blank(*scan->at))
            step(scan);
        else
            break;
    }
    return status;
}

static tm_status take_string(tm_scan *scan, tm_foam_token *token, tm_error *error)
{
    const size_t line = scan->line;
    const char *begin = ++scan->at;
    for (; scan->at < scan->end && *scan->at != '"'; step(scan))
        if (*scan->at == '\\' && scan->end - scan->at > 1)
            step(scan);
    if (scan->at == scan->end)
        return tm_fail_at(error, TM_ERROR_INPUT, scan->name, line, NULL,
                          "a string has no end");
    *token = (tm_foam_token){{begin, (size_t)(scan->at - begin)}, true};
    scan->at++;
    return TM_OK;
}

tm_status tm_foam_next(tm_foam *foam, tm_foam_token *token, tm_error *error)
{
    tm_scan *scan = &foam->scan;
    const tm_status status = skip_blanks(scan, error);
    const char *begin = scan->at;
    if (status != TM_OK)
        return status;
    if (begin < scan->end && *begin == '"')
        return take_string(scan, token, error);
    if (begin < scan->end && *begin == '#')
        return tm_scan_fail(scan, error, "directives (#include and others) are not read");
    if (begin < scan->end && is_mark(*begin))
        scan->at++;
    else
        while (scan->at < scan->end && !is_mark(*scan->at) && !is_blank(*scan->at) &&
               *scan->at != '"')
            scan->at++;
    *token = (tm_foam_token){{begin, (size_t)(scan->at - begin)}, false};
    return TM_OK;
}

static bool is(const tm_foam_token *token, char c)
{
    return token->word.size == 1 && *token->word.begin == c && !token->string;
}

/* "'x' is there where WHAT should be" */
static tm_status fail_token(const tm_foam *foam, const tm_foam_token *token,
                            const char *what, tm_error *error)
{
    if (token->word.size == 0)
        return tm_scan_fail(&foam->scan, error, "the file ends where %s should be", what);
    return tm_scan_fail(&foam->scan, error, "'%.*s' stands where %s should be",
                        tm_word_shown(token->word), token->word.begin, what);
}

tm_status tm_foam_expect(tm_foam *foam, char c, tm_error *error)
{
    const char what[] = {'\'', c, '\'', '\0'};
    tm_foam_token token;
    const tm_status status = tm_foam_next(foam, &token, error);
    if (status != TM_OK || is(&token, c))
        return status;
    return fail_token(foam, &token, what, error);
}

bool tm_foam_is(tm_foam *foam, char c)
{
    tm_foam ahead = *foam;
    tm_foam_token token;
    if (tm_foam_next(&ahead, &token, NULL) != TM_OK || !is(&token, c))
        return false;
    *foam = ahead;
    return true;
}

static tm_status take_integer(tm_foam *foam, const char *what, int64_t *value,
                              tm_error *error)
{
    tm_foam_token token;
    const tm_status status = tm_foam_next(foam, &token, error);
    if (status != TM_OK)
        return status;
    const char *end = token.word.begin + token.word.size;
    if (token.string || token.word.size == 0 ||
        tm_read_int64(token.word.begin, end, value) != end)
        return fail_token(foam, &token, what, error);
    return TM_OK;
}

static tm_status take_real(tm_foam *foam, const char *what, double *value,
                           tm_error *error)
{
    tm_foam_token token;
    const tm_status status = tm_foam_next(foam, &token, error);
    if (status != TM_OK)
        return status;
    const char *end = token.word.begin + token.word.size;
    if (token.string || token.word.size == 0 ||
        tm_read_double(token.word.begin, end, value) != end || !isfinite(*value))
        return fail_token(foam, &token, what, error);
    return TM_OK;
}

tm_status tm_foam_count(tm_foam *foam, const char *what, size_t most, size_t *count,
                        tm_error *error)
{
    int64_t value = 0;
    const tm_status status = take_integer(foam, what, &value, error);
    if (status != TM_OK)
        return status;
    if (value < 0 || (uint64_t)value > most)
        return tm_scan_fail(&foam->scan, error, "%s is %lld (0 to %zu would be right)",
                            what, (long long)value, most);
    *count = (size_t)value;
    return TM_OK;
}

tm_status tm_foam_skip_value(tm_foam *foam, tm_error *error)
{
    size_t depth = 0;
    for (;;) {
        tm_foam_token token;
        const tm_status status = tm_foam_next(foam, &token, error);
        if (status != TM_OK)
            return status;
        if (token.word.size == 0 && !token.string)
            return fail_token(foam, &token, "the end of an entry", error);
        const bool closes = is(&token, ')') || is(&token, '}') || is(&token, ']');
        depth += is(&token, '(') || is(&token, '{') || is(&token, '[');
        if (closes && depth == 0)
            return fail_token(foam, &token, "the end of an entry", error);
        depth -= closes;
        if (depth == 0 && (is(&token, ';') || is(&token, '}')))
            return TM_OK;
    }
}

tm_status tm_foam_end(tm_foam *foam, tm_error *error)
{
    tm_foam_token token;
    const tm_status status = tm_foam_next(foam, &token, error);
    if (status != TM_OK || (token.word.size == 0 && !token.string))
        return status;
    return fail_token(foam, &token, "the end of the file", error);
}

/* The head -------------------------------------------------------------------------- */

/* "LSB;label=32;scalar=64" */
static void take_arch(tm_foam *foam, tm_word arch)
{
    static const char wide[] = "label=64", single[] = "scalar=32", big[] = "MSB";
    if (memmem(arch.begin, arch.size, wide, sizeof wide - 1))
        foam->label = TM_INT64;
    if (memmem(arch.begin, arch.size, single, sizeof single - 1))
        foam->scalar = TM_FLOAT32;
    foam->big = memmem(arch.begin, arch.size, big, sizeof big - 1) != NULL;
}

static tm_status take_entry(tm_foam *foam, tm_word key, tm_error *error)
{
    tm_foam ahead = *foam;
    tm_foam_token value;
    tm_status status = tm_foam_next(&ahead, &value, error);
    if (status == TM_OK && tm_word_is(key, "format"))
        foam->binary = tm_word_is(value.word, "binary");
    if (status == TM_OK && tm_word_is(key, "arch"))
        take_arch(foam, value.word);
    if (status == TM_OK && tm_word_is(key, "class"))
        foam->compact = tm_word_is(value.word, "faceCompactList");
    return status == TM_OK ? tm_foam_skip_value(foam, error) : status;
}

tm_status tm_foam_begin(tm_foam *foam, const char *bytes, size_t size, const char *name,
                        tm_error *error)
{
    *foam = (tm_foam){.label = TM_INT32, .scalar = TM_FLOAT64};
    tm_scan_begin(&foam->scan, bytes, size, name, '\0');
    tm_foam ahead = *foam;
    tm_foam_token token;
    tm_status status = tm_foam_next(&ahead, &token, error);
    if (status != TM_OK || !tm_word_is(token.word, "FoamFile"))
        return status;
    foam->scan = ahead.scan;
    status = tm_foam_expect(foam, '{', error);
    while (status == TM_OK && !tm_foam_is(foam, '}')) {
        status = tm_foam_next(foam, &token, error);
        if (status == TM_OK && token.word.size == 0)
            status = fail_token(foam, &token, "an entry of FoamFile", error);
        if (status == TM_OK)
            status = take_entry(foam, token.word, error);
    }
    return status;
}

/* Lists ----------------------------------------------------------------------------- */

typedef struct list {
    tm_number_type type; /* of binary numbers */
    size_t components;
    const char *what;
} list;

/* The bytes between the brackets. */
static tm_status take_bytes(tm_foam *foam, const list *of, size_t count,
                            tm_numbers *numbers, tm_error *error)
{
    tm_scan *scan = &foam->scan;
    const size_t left = (size_t)(scan->end - scan->at);
    const size_t size = tm_number_size(of->type) * of->components;
    if (count > left / size)
        return tm_scan_fail(scan, error, "the file ends in a list of %zu %s", count,
                            of->what);
    *numbers = (tm_numbers){.bytes = scan->at,
                            .count = count * of->components,
                            .type = of->type,
                            .big = foam->big};
    scan->at += count * size;
    return tm_foam_expect(foam, ')', error);
}

static tm_status take_number(tm_foam *foam, const list *of, char *to, tm_error *error)
{
    double real = 0;
    int64_t integer = 0;
    tm_status status;
    if (tm_number_is_whole(of->type)) {
        status = take_integer(foam, of->what, &integer, error);
        memcpy(to, &integer, sizeof integer);
    } else {
        status = take_real(foam, of->what, &real, error);
        memcpy(to, &real, sizeof real);
    }
    return status;
}

/* Item i: a number, or several in brackets. */
static tm_status take_item(tm_foam *foam, const list *of, size_t i, tm_numbers *numbers,
                           tm_error *error)
{
    tm_status status = TM_OK;
    if (of->components > 1)
        status = tm_foam_expect(foam, '(', error);
    for (size_t c = 0; c < of->components && status == TM_OK; c++)
        status = take_number(
            foam, of, numbers->own.byte + (i * of->components + c) * TM_NUMBERS_BYTES,
            error);
    if (of->components > 1 && status == TM_OK)
        status = tm_foam_expect(foam, ')', error);
    return status;
}

static tm_status take_text(tm_foam *foam, const list *of, size_t count,
                           tm_numbers *numbers, tm_error *error)
{
    const size_t left = (size_t)(foam->scan.end - foam->scan.at);
    if (count > left / (2 * of->components))
        return tm_scan_fail(&foam->scan, error, "the file ends in a list of %zu %s",
                            count, of->what);
    tm_status status = tm_numbers_room(numbers, of->type, count * of->components, error);
    for (size_t i = 0; i < count && status == TM_OK; i++)
        status = take_item(foam, of, i, numbers, error);
    return status == TM_OK ? tm_foam_expect(foam, ')', error) : status;
}

/* N{a} */
static tm_status take_alike(tm_foam *foam, const list *of, size_t count,
                            tm_numbers *numbers, tm_error *error)
{
    const size_t size = of->components * TM_NUMBERS_BYTES;
    tm_status status =
        tm_numbers_room(numbers, of->type, (count + 1) * of->components, error);
    if (status == TM_OK)
        status = take_item(foam, of, 0, numbers, error);
    for (size_t i = 1; i < count && status == TM_OK; i++)
        memcpy(numbers->own.byte + i * size, numbers->own.byte, size);
    numbers->count = count * of->components;
    return status == TM_OK ? tm_foam_expect(foam, '}', error) : status;
}

static tm_status take_list(tm_foam *foam, const list *of, size_t most, bool alike,
                           tm_numbers *numbers, tm_error *error)
{
    size_t count = 0;
    tm_status status = tm_foam_count(foam, "the size of a list", most, &count, error);
    if (status != TM_OK)
        return status;
    if (alike && tm_foam_is(foam, '{'))
        return take_alike(foam, of, count, numbers, error);
    if (!tm_foam_is(foam, '('))
        return count == 0 ? TM_OK : tm_foam_expect(foam, '(', error);
    return foam->binary && count > 0 ? take_bytes(foam, of, count, numbers, error)
                                     : take_text(foam, of, count, numbers, error);
}

tm_status tm_foam_labels(tm_foam *foam, const char *what, size_t most,
                         tm_numbers *numbers, tm_error *error)
{
    const list labels = {foam->label, 1, what};
    return take_list(foam, &labels, most, true, numbers, error);
}

tm_status tm_foam_points(tm_foam *foam, tm_numbers *numbers, tm_error *error)
{
    const list points = {foam->scalar, COORDINATES, "coordinates"};
    return take_list(foam, &points, UINT32_MAX - 1, false, numbers, error);
}

tm_status tm_foam_bits(tm_foam *foam, const char *what, size_t most, tm_numbers *numbers,
                       tm_error *error)
{
    const list bits = {TM_UINT8, 1, what};
    return take_list(foam, &bits, most, true, numbers, error);
}
