/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Of a block of kind TM_GROUP, integer is [count][2]: the dimension, and where in the
 * text the name begins, which ends with a NUL; marker is the value. */
#include "group.h"

#include "../base/array.h"
#include "../number/number.h"
#include "../text/utf8.h"
#include "block.h"
#include "group_names.h"
#include "row.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

tm_group_dimension tm_group_dimension_of(const tm_block *group, size_t g)
{
    return (tm_group_dimension)group->integer[2 * g];
}

int32_t tm_group_value(const tm_block *group, size_t g)
{
    return group->marker[g];
}

const char *tm_group_name(const tm_block *group, size_t g)
{
    return group->text.byte + group->integer[2 * g + 1];
}

const char *tm_group_find(const tm_block *group, tm_group_dimension dimension,
                          int32_t value)
{
    for (size_t g = 0; group && g < group->count; g++)
        if (group->marker[g] == value && tm_group_dimension_of(group, g) == dimension)
            return tm_group_name(group, g);
    return NULL;
}

const int32_t *tm_group_named(const tm_block *group, tm_group_dimension dimension,
                              const char *name, size_t size)
{
    for (size_t g = 0; group && g < group->count; g++) {
        const char *known = tm_group_name(group, g);
        if (tm_group_dimension_of(group, g) == dimension && strlen(known) == size &&
            memcmp(known, name, size) == 0)
            return &group->marker[g];
    }
    return NULL;
}

/* Part of a joined name: a name, or the number of a value that has none. */
static bool find_part(const tm_block *group, tm_group_dimension dimension,
                      const char *name, size_t size, int32_t *value)
{
    int64_t number;
    const int32_t *named = tm_group_named(group, dimension, name, size);
    *value = named ? *named : 0;
    if (named)
        return true;
    if (tm_read_int64(name, name + size, &number) != name + size || number < 1 ||
        number > INT32_MAX || tm_group_find(group, dimension, (int32_t)number))
        return false;
    *value = (int32_t)number;
    return true;
}

static size_t sort_parts(int32_t *part, size_t parts)
{
    size_t count = 0;
    if (parts > 0)
        qsort(part, parts, sizeof *part, tm_compare_numbers);
    for (size_t i = 0; i < parts; i++)
        if (count == 0 || part[count - 1] != part[i])
            part[count++] = part[i];
    return count;
}

tm_status tm_group_parts(const tm_block *group, tm_group_dimension dimension,
                         const char *name, int32_t **part, size_t *parts, tm_error *error)
{
    const size_t length = sizeof TM_GROUP_AND - 1;
    bool is_known = strstr(name, TM_GROUP_AND) != NULL;
    size_t room = 0;
    tm_status status = TM_OK;
    *part = NULL;
    *parts = 0;
    for (const char *end; is_known && name && status == TM_OK;
         name = *end ? end + length : NULL) {
        end = strstr(name, TM_GROUP_AND);
        if (!end)
            end = name + strlen(name);
        int32_t *moved = tm_grow(*part, &room, *parts + 1, sizeof *moved);
        if (moved) {
            *part = moved;
            is_known = find_part(group, dimension, name, (size_t)(end - name),
                                 &moved[(*parts)++]);
        } else {
            status = tm_fail_memory(error);
        }
    }
    *parts = sort_parts(*part, *parts);
    if (status == TM_OK && is_known && *parts > 1)
        return TM_OK;
    free(*part);
    *part = NULL;
    *parts = 0;
    return status;
}

size_t tm_group_region_attribute(const tm_block *cells)
{
    return cells->kind == TM_CELL ? 1 : 0;
}

bool tm_group_region(const tm_block *cells, size_t e, int32_t *region)
{
    const size_t which = tm_group_region_attribute(cells);
    if (which >= cells->attributes)
        return false;
    const double value = cells->attribute[e * cells->attributes + which];
    if (!(value >= INT32_MIN && value <= INT32_MAX) || value != floor(value))
        return false;
    *region = (int32_t)value;
    return true;
}

void tm_group_init(tm_block *group, const char *name)
{
    *group = (tm_block){.kind = TM_GROUP, .markers = true};
    snprintf(group->name, sizeof group->name, "%s", name);
}

void tm_group_free(tm_block *group)
{
    tm_block_clear(group);
}

tm_status tm_group_append(tm_block *group, const tm_block *from,
                          tm_group_dimension dimension, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t g = 0; g < from->count && status == TM_OK; g++) {
        const tm_group_dimension of = tm_group_dimension_of(from, g);
        if (dimension == of || dimension == TM_GROUP_DIMENSIONS)
            status =
                tm_group_add(group, of, from->marker[g], tm_group_name(from, g), error);
    }
    return status;
}

tm_status tm_group_to_stream(const tm_block *from, tm_stream *stream, const char *name,
                             tm_error *error)
{
    if (from->count == 0)
        return TM_OK;
    tm_block *group = tm_stream_add(stream, name);
    return group ? tm_group_append(group, from, TM_GROUP_DIMENSIONS, error)
                 : tm_fail_memory(error);
}

/* Sets row g, for which there is room. */
static tm_status set_row(tm_block *group, size_t g, tm_group_dimension dimension,
                         int32_t value, const char *name, size_t size, tm_error *error)
{
    if (size >= TM_NONE - group->text.size)
        return tm_fail(error, TM_ERROR_INPUT, "the names are over 4 GB long");
    group->integer[2 * g] = dimension;
    group->integer[2 * g + 1] = (uint32_t)group->text.size;
    group->marker[g] = value;
    tm_text_append(&group->text, name, size);
    tm_text_append(&group->text, "", 1);
    return group->text.failed ? tm_fail_memory(error) : TM_OK;
}

tm_status tm_group_add(tm_block *group, tm_group_dimension dimension, int32_t value,
                       const char *name, tm_error *error)
{
    const size_t count = group->count;
    /* at 0 or a power of 2 there may be no more room */
    if ((count & (count - 1)) == 0 && !tm_block_resize(group, count ? 2 * count : 1))
        return tm_fail_memory(error);
    const tm_status status =
        set_row(group, count, dimension, value, name, strlen(name), error);
    if (status == TM_OK)
        group->count++;
    return status;
}

/* A character of Latin-1 that is no ASCII, as UTF-8. */
static void append_latin1(tm_text *name, unsigned char byte)
{
    enum { LEAD = 0xC0, TAIL = 0x80, TAIL_BITS = 6, TAIL_MASK = 0x3F };
    const char utf8[] = {(char)(LEAD | byte >> TAIL_BITS),
                         (char)(TAIL | (byte & TAIL_MASK))};
    if (tm_utf8_is_control(utf8, sizeof utf8))
        tm_text_format(name, "\\x%02x", byte);
    else
        tm_text_append(name, utf8, sizeof utf8);
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

void tm_group_clean(tm_text *name, const char *bytes, size_t size)
{
    const char *end = bytes + size;
    while (bytes < end && is_blank(*bytes))
        bytes++;
    while (end > bytes && is_blank(end[-1]))
        end--;
    while (bytes < end) {
        const size_t k = tm_utf8_size(bytes, end);
        if (k == 0)
            append_latin1(name, (unsigned char)*bytes);
        else if (tm_utf8_is_control(bytes, k))
            tm_text_format(name, "\\x%02x", (unsigned char)bytes[k - 1]);
        else
            tm_text_append(name, bytes, k);
        bytes += k ? k : 1;
    }
}

/* Rows as text --------------------------------------------------------------------- */

static tm_status wrong_name(tm_row_context *c, const char *what)
{
    return tm_fail(&c->problem, TM_ERROR_INPUT, "row %zu: %s", c->block->count + c->base,
                   what);
}

const char *tm_group_row_name(tm_row_context *c, const char *at, const char *feed)
{
    tm_block *group = c->block;
    const size_t g = group->count;
    while (tm_is_blank(*at))
        at++;
    const char *end = feed;
    while (end > at && tm_is_blank(end[-1]))
        end--;
    tm_status status = TM_OK;
    if (at == end)
        status = wrong_name(c, "there is no name (the rest of the row)");
    for (const char *p = at; p < end && status == TM_OK;) {
        const size_t k = tm_utf8_size(p, end);
        if (k == 0)
            status = wrong_name(c, "the name is not UTF-8");
        else if (tm_utf8_is_control(p, k))
            status = wrong_name(c, "there is a control character in the name (a CR at "
                                   "the line's end?)");
        p += k;
    }
    if (status == TM_OK)
        status = set_row(group, g, tm_group_dimension_of(group, g), group->marker[g], at,
                         (size_t)(end - at), &c->problem);
    return status == TM_OK ? feed + 1 : NULL;
}

void tm_group_write(tm_text *text, const tm_block *group, unsigned base)
{
    for (size_t g = 0; g < group->count; g++)
        tm_text_format(text, "%zu %d %d %s\n", g + base,
                       (int)tm_group_dimension_of(group, g), group->marker[g],
                       tm_group_name(group, g));
}
