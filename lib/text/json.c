/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "json.h"

#include <inttypes.h>
#include <math.h>

static void quoted(tm_text *text, const char *string)
{
    tm_text_string(text, "\"");
    for (; *string; string++) {
        unsigned char c = (unsigned char)*string;
        if (c == '"' || c == '\\')
            tm_text_format(text, "\\%c", c);
        else if (c < ' ')
            tm_text_format(text, "\\u%04x", c);
        else
            tm_text_append(text, string, 1);
    }
    tm_text_string(text, "\"");
}

/* What goes before a value: the comma, and the key where there is one. */
static void begin(tm_json *json, const char *key)
{
    if (json->comma)
        tm_text_string(json->text, ", ");
    if (key) {
        quoted(json->text, key);
        tm_text_string(json->text, ": ");
    }
    json->comma = true;
}

void tm_json_open(tm_json *json, const char *key, char bracket)
{
    begin(json, key);
    tm_text_append(json->text, &bracket, 1);
    json->comma = false;
}

void tm_json_close(tm_json *json, char bracket)
{
    tm_text_append(json->text, &bracket, 1);
    json->comma = true;
}

void tm_json_bool(tm_json *json, const char *key, bool value)
{
    begin(json, key);
    tm_text_string(json->text, value ? "true" : "false");
}

void tm_json_integer(tm_json *json, const char *key, int64_t value)
{
    begin(json, key);
    tm_text_format(json->text, "%" PRId64, value);
}

void tm_json_double(tm_json *json, const char *key, double value)
{
    begin(json, key);
    if (isfinite(value))
        tm_text_double(json->text, value);
    else
        tm_text_string(json->text, "null");
}

void tm_json_string(tm_json *json, const char *key, const char *value)
{
    begin(json, key);
    quoted(json->text, value);
}
