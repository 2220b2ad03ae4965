/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "inp_text.h"

#include "../../number/number.h"
#include "../../stream/sniff.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <strings.h>

void tm_inp_begin(tm_inp_text *text, const char *bytes, size_t size, const char *name,
                  tm_error *error)
{
    const size_t mark = tm_byte_order_mark(bytes, size);
    *text = (tm_inp_text){
        .at = bytes + mark, .end = bytes + size, .name = name, .error = error};
    tm_inp_next(text);
}

tm_status tm_inp_fail(const tm_inp_text *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tm_fail_at_list(text->error, TM_ERROR_INPUT, text->name, text->line, NULL, format,
                    arguments);
    va_end(arguments);
    return TM_ERROR_INPUT;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

/* Without blanks around it. */
static tm_word trimmed(const char *begin, const char *end)
{
    while (begin < end && is_blank(*begin))
        begin++;
    while (begin < end && is_blank(end[-1]))
        end--;
    return (tm_word){begin, (size_t)(end - begin)};
}

/* The next line, whatever it is. */
static void take_line(tm_inp_text *text)
{
    const char *begin = text->at;
    while (text->at < text->end && *text->at != '\n' && *text->at != '\r')
        text->at++;
    text->row = trimmed(begin, text->at);
    if (text->at < text->end && *text->at++ == '\r' && text->at < text->end &&
        *text->at == '\n')
        text->at++;
    text->line++;
}

static bool begins(tm_word word, const char *with)
{
    const size_t size = strlen(with);
    return word.size >= size && memcmp(word.begin, with, size) == 0;
}

void tm_inp_next(tm_inp_text *text)
{
    text->kind = TM_INP_END;
    text->row = (tm_word){text->end, 0};
    while (text->at < text->end && text->kind == TM_INP_END) {
        take_line(text);
        if (begins(text->row, TM_INP_OWN))
            text->kind = TM_INP_COMMENT;
        else if (text->row.size > 0 && !begins(text->row, "**"))
            text->kind = *text->row.begin == '*' ? TM_INP_KEYWORD : TM_INP_DATA;
    }
    text->field = text->row.begin;
}

bool tm_inp_field(tm_inp_text *text, tm_word *field)
{
    const char *end = text->row.begin + text->row.size, *at = text->field;
    bool quoted = false;
    if (at >= end)
        return false;
    for (; at < end && (quoted || *at != ','); at++)
        quoted ^= *at == '"';
    *field = trimmed(text->field, at);
    if (field->size > 1 && *field->begin == '"' && field->begin[field->size - 1] == '"')
        *field = (tm_word){field->begin + 1, field->size - 2};
    text->field = at < end ? at + 1 : end;
    return true;
}

bool tm_inp_goes_on(const tm_inp_text *text)
{
    return text->row.size > 0 && text->row.begin[text->row.size - 1] == ',';
}

/* Numbers --------------------------------------------------------------------------- */

bool tm_inp_is_number(tm_word word)
{
    int64_t value;
    const char *end = word.begin + word.size;
    return word.size > 0 && tm_read_int64(word.begin, end, &value) == end;
}

tm_status tm_inp_id(const tm_inp_text *text, tm_word word, const char *what, int32_t *id)
{
    int64_t value;
    const char *end = word.begin + word.size;
    if (word.size == 0 || tm_read_int64(word.begin, end, &value) != end)
        return tm_inp_fail(text, "%s: '%.*s' is not a whole number", what,
                           tm_word_shown(word), word.begin);
    if (value < 1 || value > INT32_MAX)
        return tm_inp_fail(text, "%s: %.*s is out of range (1..%d)", what,
                           tm_word_shown(word), word.begin, INT32_MAX);
    *id = (int32_t)value;
    return TM_OK;
}

tm_status tm_inp_real(const tm_inp_text *text, tm_word word, const char *what,
                      double *real)
{
    enum { MOST = 64 };
    char copy[MOST];
    const char *begin = word.begin, *end = begin + word.size;
    *real = 0;
    if (word.size == 0)
        return TM_OK;
    const char *after = tm_read_double(begin, end, real);
    if (after != end && word.size < MOST) { /* a D for the exponent */
        for (size_t i = 0; i < word.size; i++)
            copy[i] = begin[i] == 'd' || begin[i] == 'D' ? 'e' : begin[i];
        begin = copy;
        end = copy + word.size;
        after = tm_read_double(begin, end, real);
    }
    if (after != end)
        return tm_inp_fail(text, "%s: '%.*s' is not a number", what, tm_word_shown(word),
                           word.begin);
    if (!isfinite(*real))
        return tm_inp_fail(text, "%s: '%.*s' is too large (below 1.8e308)", what,
                           tm_word_shown(word), word.begin);
    return TM_OK;
}

/* Keywords -------------------------------------------------------------------------- */

/* In capitals and without blanks; what does not fit is cut off. */
static void copy_key(char key[TM_INP_KEY], tm_word word)
{
    size_t k = 0;
    for (size_t i = 0; i < word.size && k + 1 < TM_INP_KEY; i++)
        if (!is_blank(word.begin[i]))
            key[k++] = (char)toupper((unsigned char)word.begin[i]);
    key[k] = '\0';
}

static void take_parameters(tm_inp_text *text, tm_inp_keyword *keyword)
{
    tm_word field;
    while (tm_inp_field(text, &field)) {
        if (field.size == 0 || keyword->parameters == TM_INP_PARAMETERS)
            continue;
        const char *end = field.begin + field.size;
        const char *equals = memchr(field.begin, '=', field.size);
        const size_t p = keyword->parameters++;
        tm_word value = equals ? trimmed(equals + 1, end) : (tm_word){end, 0};
        if (value.size > 1 && *value.begin == '"' && value.begin[value.size - 1] == '"')
            value = (tm_word){value.begin + 1, value.size - 2};
        keyword->value[p] = value;
        copy_key(keyword->key[p], trimmed(field.begin, equals ? equals : end));
    }
}

/* A line that goes on is followed by parameters, which begin with a letter. */
void tm_inp_keyword_take(tm_inp_text *text, tm_inp_keyword *keyword)
{
    tm_word name = {0};
    *keyword = (tm_inp_keyword){.line = text->line};
    tm_inp_field(text, &name);
    copy_key(keyword->name, (tm_word){name.begin + 1, name.size - 1});
    take_parameters(text, keyword);
    bool goes_on = tm_inp_goes_on(text);
    tm_inp_next(text);
    while (goes_on && text->kind == TM_INP_DATA &&
           isalpha((unsigned char)*text->row.begin)) {
        take_parameters(text, keyword);
        goes_on = tm_inp_goes_on(text);
        tm_inp_next(text);
    }
}

const tm_word *tm_inp_parameter(const tm_inp_keyword *keyword, const char *key)
{
    for (size_t p = 0; p < keyword->parameters; p++)
        if (strcmp(keyword->key[p], key) == 0)
            return &keyword->value[p];
    return NULL;
}
