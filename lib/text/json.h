/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A JSON value written piece by piece into a tm_text. Commas and quotes are added;
 * the caller keeps the brackets balanced. A key of NULL is for items of arrays.
 *
 *     tm_json json = {&text};
 *     tm_json_open(&json, NULL, '{');
 *     tm_json_integer(&json, "tets", 12);
 *     tm_json_close(&json, '}');
 */
#ifndef TM_TEXT_JSON_H
#define TM_TEXT_JSON_H

#include "../base/extern_c.h"
#include "text.h"

#include <stdbool.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Appends to a text, which says itself whether memory was out. */
typedef struct tm_json {
    tm_text *text;
    bool comma; /* the next item needs one before it */
} tm_json;

/* Append an item: to an object with its key, to an array, or as the whole of the text,
 * with key NULL. tm_json_open() begins an object or an array, which the closing bracket
 * ends; that each has its own is the caller's to see to. Strings are UTF-8. O(length). */
void tm_json_open(tm_json *json, const char *key, char bracket); /* '{' or '[' */
void tm_json_close(tm_json *json, char bracket);                 /* '}' or ']' */
void tm_json_bool(tm_json *json, const char *key, bool value);
void tm_json_integer(tm_json *json, const char *key, int64_t value);
void tm_json_double(tm_json *json, const char *key,
                    double value); /* null if not finite */
void tm_json_string(tm_json *json, const char *key, const char *value);

TM_EXTERN_C_END

#endif
