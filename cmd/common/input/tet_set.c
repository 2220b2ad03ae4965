/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_set.h"

#include "../../../lib/geom/vector.h"
#include "../../../lib/number/number.h"
#include "../../../lib/stream/group.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char box_word[] = "box", region_word[] = "region";

/* What a rule may be ------------------------------------------------------------------
 */

static bool is_word(const char *text, size_t length, const char *word)
{
    return strlen(word) == length && strncmp(text, word, length) == 0;
}

/* A number from 1, of nothing but digits; 0 where it is none. */
static size_t number_of(const char *text, size_t length)
{
    int64_t number;
    if (length == 0 || strspn(text, "0123456789") < length ||
        tm_read_int64(text, text + length, &number) != text + length)
        return 0;
    return (size_t)number;
}

size_t tet_set_attribute(const char *text, size_t length)
{
    static const char prefix[] = "attribute_";
    const size_t begin = sizeof prefix - 1;
    if (length <= begin || strncmp(text, prefix, begin) != 0)
        return 0;
    return number_of(text + begin, length - begin);
}

static size_t attribute_of(const char *text, size_t length)
{
    if (is_word(text, length, region_word))
        return 1;
    const size_t named = tet_set_attribute(text, length);
    return named > 0 ? named : number_of(text, length);
}

static void read_box(const filter *f, tet_set_rule *rule, const char *at)
{
    enum { NUMBERS = 6 };
    double number[NUMBERS];
    bool is_box = true;
    for (int k = 0; k < NUMBERS && is_box; k++) {
        const size_t length = strcspn(at, ",");
        is_box = tm_read_double(at, at + length, &number[k]) == at + length &&
                 isfinite(number[k]) && at[length] == (k + 1 < NUMBERS ? ',' : '\0');
        at += length + (at[length] != '\0');
    }
    for (int k = 0; k < 3 && is_box; k++) {
        rule->low[k] = number[k];
        rule->high[k] = number[k + 3];
        is_box = rule->low[k] <= rule->high[k];
    }
    if (!is_box)
        filter_usage_error(
            f, "--set %s: a box is x0,y0,z0,x1,y1,z1: its lowest and highest corner",
            rule->text);
}

static void read_comparison(const filter *f, tet_set_rule *rule, const char *at)
{
    const char *end = rule->text + strlen(rule->text);
    rule->less = *at == '<';
    rule->more = *at == '>';
    rule->equal = *at == '=' || at[1] == '=';
    at += *at != '=' && at[1] == '=' ? 2 : 1;
    if (tm_read_double(at, end, &rule->value) == end && isfinite(rule->value))
        return;
    rule->name = at;
    if (*at == '\0' || rule->less || rule->more || rule->attribute != 1)
        filter_usage_error(f, "--set %s: '%s' is no number", rule->text, at);
}

void tet_set_add(const filter *f, tet_set *set, const char *text)
{
    tet_set_rule rule = {.kind = TET_SET_LIST, .text = text};
    const size_t length = strcspn(text, "<>=");
    rule.attribute = text[length] == '\0' ? 0 : attribute_of(text, length);
    if (is_word(text, length, box_word) && text[length] == '=') {
        rule.kind = TET_SET_BOX;
        read_box(f, &rule, text + length + 1);
    } else if (rule.attribute > 0) {
        rule.kind = TET_SET_ATTRIBUTE;
        read_comparison(f, &rule, text + length);
    }
    tet_set_rule *grown = realloc(set->rule, (set->rules + 1) * sizeof *grown);
    if (!grown)
        filter_fail_memory(f);
    set->rule = grown;
    grown[set->rules++] = rule;
}

void tet_set_free(tet_set *set)
{
    free(set->rule);
    *set = (tet_set){0};
}

/* Boxes -------------------------------------------------------------------------------
 */

/* Whether the tetrahedron and the box from the origin to `size` are apart along an axis.
 */
static bool are_apart(const double axis[3], const double corner[4][3],
                      const double size[3])
{
    double low = 0, high = 0, least = HUGE_VAL, most = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        low += fmin(axis[k] * size[k], 0);
        high += fmax(axis[k] * size[k], 0);
    }
    for (int i = 0; i < 4; i++) {
        const double at = tm_dot(axis, corner[i]);
        least = fmin(least, at);
        most = fmax(most, at);
    }
    return most < low || high < least;
}

/* Whether they have a point in common: two convex bodies are apart along the normal of a
 * face, or of an edge of each. */
static bool meets_box(const double corner[4][3], const double size[3])
{
    static const double axis[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double edge[6][3], normal[3];
    int edges = 0;
    for (int k = 0; k < 3; k++)
        if (are_apart(axis[k], corner, size))
            return false;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++)
            tm_subtract(edge[edges++], corner[i], corner[j]);
    for (int i = 0; i < edges; i++) {
        for (int k = 0; k < 3; k++) {
            tm_cross(normal, edge[i], axis[k]);
            if (are_apart(normal, corner, size))
                return false;
        }
        for (int j = 0; j < i; j++) { /* the faces' normals are of these */
            tm_cross(normal, edge[i], edge[j]);
            if (are_apart(normal, corner, size))
                return false;
        }
    }
    return true;
}

static void find_box(const tet_set_rule *rule, const tm_block *node, const tm_block *ele,
                     bool *in_set)
{
    double corner[4][3], size[3];
    tm_subtract(size, rule->high, rule->low);
    for (size_t t = 0; t < ele->count; t++) {
        for (int i = 0; i < 4; i++)
            tm_subtract(corner[i],
                        node->real + 3 * (size_t)ele->integer[4 * t + (size_t)i],
                        rule->low);
        in_set[t] = in_set[t] || meets_box((const double(*)[3])corner, size);
    }
}

/* Attributes --------------------------------------------------------------------------
 */

_Noreturn static void fail(const filter *f, const char *block, const char *what)
{
    tm_error error;
    tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, block, "%s", what);
    filter_fail(f, &error);
}

/* The value that a rule compares with. */
static double value_of(const filter *f, const tet_set_rule *rule, const tm_stream *stream)
{
    char why[256];
    const tm_block *group = tm_stream_find(stream, ".group");
    if (!rule->name)
        return rule->value;
    const int32_t *region =
        tm_group_named(group, TM_GROUP_REGIONS, rule->name, strlen(rule->name));
    if (region)
        return *region;
    snprintf(why, sizeof why, "no region has the name '%s'", rule->name);
    fail(f, ".group", why);
}

static void find_attribute(const filter *f, const tet_set_rule *rule,
                           const tm_stream *stream, const tm_block *ele, bool *in_set)
{
    char why[128];
    const double value = value_of(f, rule, stream);
    if (rule->attribute > ele->attributes) {
        snprintf(why, sizeof why,
                 "tetrahedra have %zu attributes, but --set asks for number %zu",
                 ele->attributes, rule->attribute);
        fail(f, ele->name, why);
    }
    for (size_t t = 0; t < ele->count; t++) {
        const double is = ele->attribute[t * ele->attributes + rule->attribute - 1];
        in_set[t] = in_set[t] || (rule->less && is < value) ||
                    (rule->equal && is == value) || (rule->more && is > value);
    }
}

void tet_set_check_sizes(const filter *f, const tm_stream *stream, size_t attribute,
                         const bool *in_set)
{
    char why[128];
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *ele = tm_stream_find(stream, ".ele");
    for (size_t k = 0; ele && k < 4 * ele->count; k++) {
        const uint32_t v = ele->integer[k];
        if (in_set && !in_set[k / 4])
            continue;
        if (attribute > node->attributes) {
            snprintf(why, sizeof why,
                     "nodes have %zu attributes, but --until-size asks for number %zu",
                     node->attributes, attribute);
            fail(f, node->name, why);
        }
        if (!(node->attribute[v * node->attributes + attribute - 1] > 0)) {
            snprintf(why, sizeof why,
                     "node %zu has a size that is not greater than 0 in attribute_%zu",
                     v + (size_t)stream->base, attribute);
            fail(f, node->name, why);
        }
    }
}

/* Lists -------------------------------------------------------------------------------
 */

static void find_listed(const filter *f, const tet_set_rule *rule,
                        const tm_stream *stream, const tm_block *ele, bool *in_set)
{
    tm_error error;
    tm_text bytes = {0};
    size_t line = 0;
    filter_read_file(f, rule->text, &bytes);
    const char *at = bytes.byte, *end = at + bytes.size;
    while (at < end) {
        static const char blanks[] = " \t\r";
        const char *line_end = memchr(at, '\n', (size_t)(end - at)), *last;
        int64_t number;
        line++;
        line_end = line_end ? line_end : end;
        last = line_end;
        while (at < last && strchr(blanks, last[-1]))
            last--;
        while (at < last && strchr(blanks, *at))
            at++;
        if (at < last && *at != '#') {
            if (tm_read_int64(at, last, &number) != last || number < stream->base ||
                (uint64_t)number - stream->base >= ele->count) {
                tm_fail_at(&error, TM_ERROR_INPUT, rule->text, line, NULL,
                           "'%.*s' is no number of a tetrahedron (%u … %zu)",
                           (int)(last - at), at, stream->base,
                           ele->count + stream->base - 1);
                filter_fail(f, &error);
            }
            in_set[(uint64_t)number - stream->base] = true;
        }
        at = line_end < end ? line_end + 1 : end;
    }
    tm_text_free(&bytes);
}

bool *tet_set_find(const filter *f, const tet_set *set, const tm_stream *stream)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *ele = tm_stream_find(stream, ".ele");
    if (set->rules == 0)
        return NULL;
    bool *in_set = calloc(ele && ele->count > 0 ? ele->count : 1, sizeof *in_set);
    if (!in_set)
        filter_fail_memory(f);
    for (size_t k = 0; ele && k < set->rules; k++) {
        const tet_set_rule *rule = &set->rule[k];
        if (rule->kind == TET_SET_BOX)
            find_box(rule, node, ele, in_set);
        else if (rule->kind == TET_SET_ATTRIBUTE)
            find_attribute(f, rule, stream, ele, in_set);
        else
            find_listed(f, rule, stream, ele, in_set);
    }
    return in_set;
}
