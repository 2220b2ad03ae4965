/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of markers and regions: from any bytes, by name and by value, and the groups of
 * foreign surfaces. */
#include "../../lib/format/surface/surface_format.h"
#include "../../lib/stream/group_markers.h"
#include "../../lib/text/utf8.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void assert_cleaned(const char *bytes, size_t size, const char *expected)
{
    tm_text name = {0};
    tm_group_clean(&name, bytes, size);
    assert_false(name.failed);
    assert_string_equal(name.byte ? name.byte : "", expected);
    tm_text_free(&name);
}

static void test_clean(void **state)
{
    (void)state;
#define CLEANED(bytes, expected) assert_cleaned(bytes, sizeof(bytes) - 1, expected)
    CLEANED("", "");
    CLEANED(" \t\r\n", "");
    CLEANED(" inlet port\t\r", "inlet port");
    CLEANED("a\tb\033[2Jc\177", "a\\x09b\\x1b[2Jc\\x7f");
    CLEANED("a\0b", "a\\x00b");
    CLEANED("gr\xf6\xdf"
            "er",
            "gr\xc3\xb6\xc3\x9f"
            "er");
    CLEANED("gr\xc3\xb6\xc3\x9f"
            "er",
            "gr\xc3\xb6\xc3\x9f"
            "er");
    CLEANED("\xc2\x85\x85", "\\x85\\x85");   /* next line, in UTF-8 and in Latin-1 */
    CLEANED("\xc0\xaf", "\xc3\x80\xc2\xaf"); /* overlong: no UTF-8 */
    CLEANED("\xed\xa0\x80", "\xc3\xad\xc2\xa0\\x80");
    CLEANED("\xf0\x9f\x98\x80\xf0\x9f", "\xf0\x9f\x98\x80\xc3\xb0\\x9f");
}

/* What is cleaned is a name: UTF-8, no control characters, no blanks at its ends; and
 * cleaning it again changes nothing. */
static void test_clean_random(void **state)
{
    (void)state;
    enum { ROUNDS = 20000, SIZE = 12 };
    for (int round = 0; round < ROUNDS; round++) {
        static const char likely[] = " \t_a\x80\xc2\xc3\xe0\xed\xf0\xf4\x9f\xbf";
        char bytes[SIZE];
        const size_t size = random_below(SIZE + 1);
        for (size_t i = 0; i < size; i++)
            bytes[i] = random_below(3) ? likely[random_below(sizeof likely - 1)]
                                       : (char)random_below(UINT8_MAX + 1);
        tm_text name = {0};
        tm_group_clean(&name, bytes, size);
        for (size_t i = 0; i < name.size;) {
            const size_t k = tm_utf8_size(name.byte + i, name.byte + name.size);
            assert_true(k > 0);
            assert_false(tm_utf8_is_control(name.byte + i, k));
            i += k;
        }
        if (name.size > 0) {
            assert_true(name.byte[0] != ' ' && name.byte[name.size - 1] != ' ');
            assert_cleaned(name.byte, name.size, name.byte);
        }
        tm_text_free(&name);
    }
}

/* As many names as need a table that grows: each gets one marker, found again. */
static void test_markers(void **state)
{
    (void)state;
    enum { NAMES = 3000 };
    tm_block group;
    tm_group_init(&group, ".group");
    tm_group_markers markers = {.group = &group, .dimension = TM_GROUP_FACES};
    int32_t given[NAMES] = {0}, values = 0;
    for (int i = 0; i < 4 * NAMES; i++) {
        const unsigned n = random_below(NAMES);
        char name[16];
        int32_t marker;
        snprintf(name, sizeof name, " wall %u", n);
        assert_int_equal(tm_group_marker(&markers, name, strlen(name), &marker, NULL),
                         TM_OK);
        assert_int_equal(marker, given[n] ? given[n] : values + 1);
        values += given[n] == 0;
        given[n] = marker;
        if (random_below(NAMES) > 0)
            continue;
        assert_int_equal(tm_group_marker(&markers, " ", 1, &marker, NULL), TM_OK);
        assert_int_equal(marker, ++values);
    }
    assert_int_equal(tm_group_check(&group, 1, "", NULL), TM_OK);
    for (unsigned n = 0; n < NAMES; n++) {
        char name[16];
        snprintf(name, sizeof name, "wall %u", n);
        if (given[n])
            assert_string_equal(tm_group_find(&group, TM_GROUP_FACES, given[n]), name);
        assert_null(tm_group_find(&group, TM_GROUP_EDGES, given[n]));
    }
    tm_group_markers_free(&markers);
    tm_group_free(&group);
    assert_null(tm_group_find(NULL, TM_GROUP_FACES, 1));
}

static void test_check(void **state)
{
    (void)state;
    tm_block group;
    tm_error error;
    tm_group_init(&group, ".group");
    assert_int_equal(tm_group_add(&group, TM_GROUP_FACES, 1, "a", NULL), TM_OK);
    assert_int_equal(tm_group_add(&group, TM_GROUP_EDGES, 1, "a", NULL), TM_OK);
    assert_int_equal(tm_group_check(&group, 0, "x", &error), TM_OK);
    assert_int_equal(tm_group_add(&group, TM_GROUP_FACES, 2, "a", NULL), TM_OK);
    assert_int_equal(tm_group_check(&group, 0, "x", &error), TM_ERROR_INPUT);
    assert_string_equal(error.what, "rows 0 and 2 have the same name (each may be there "
                                    "once in a dimension)");
    tm_block copy;
    tm_group_init(&copy, "surface.group");
    assert_int_equal(tm_group_append(&copy, &group, TM_GROUP_DIMENSIONS, NULL), TM_OK);
    assert_string_equal(copy.name, "surface.group");
    assert_int_equal(copy.count, 3);
    assert_int_equal(tm_group_dimension_of(&copy, 1), TM_GROUP_EDGES);
    assert_int_equal(tm_group_value(&copy, 2), 2);
    tm_group_free(&copy);
    tm_group_free(&group);
}

static void test_region(void **state)
{
    (void)state;
    double attribute[] = {7, 1.5, -3, 4e9};
    tm_block ele = {.kind = TM_ELE, .attributes = 1, .attribute = attribute};
    tm_block cell = {.kind = TM_CELL, .attributes = 2, .attribute = attribute};
    int32_t region = 0;
    assert_true(tm_group_region(&ele, 0, &region));
    assert_int_equal(region, 7);
    assert_false(tm_group_region(&ele, 1, &region));
    assert_true(tm_group_region(&ele, 2, &region));
    assert_int_equal(region, -3);
    assert_false(tm_group_region(&ele, 3, &region));
    assert_false(tm_group_region(&cell, 0, &region)); /* its second one is 1.5 */
    cell.attributes = 1;
    assert_false(tm_group_region(&cell, 0, &region));
}

/* The markers of a surface's facets as digits, '.' where it has none, and the names. */
static void assert_groups(const char *text, const char *markers, const char *names)
{
    tm_polygon_surface surface;
    tm_text found = {0}, named = {0};
    tm_polygon_surface_init(&surface);
    const tm_format format = tm_format_of(text, strlen(text), "x");
    assert_int_equal(tm_format_read(&surface, format, text, strlen(text), "x", NULL),
                     TM_OK);
    for (size_t f = 0; f < surface.facets; f++)
        tm_text_format(&found, "%d", surface.facet_marker[f]);
    tm_text_string(&found, surface.has_facet_markers ? "" : ".");
    for (size_t g = 0; g < surface.group.count; g++)
        tm_text_format(&named, "%d %s;", tm_group_value(&surface.group, g),
                       tm_group_name(&surface.group, g));
    assert_string_equal(found.byte, markers);
    assert_string_equal(named.byte ? named.byte : "", names);
    tm_text_free(&found);
    tm_text_free(&named);
    tm_polygon_surface_free(&surface);
}

#define POINTS "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
#define F      "f 1 2 3\n"

static void test_obj(void **state)
{
    (void)state;
    assert_groups(POINTS F F, "00.", "");
    assert_groups(POINTS "g\n" F, "0.", "");
    assert_groups(POINTS "g a\n" F F, "11", "1 a;");
    assert_groups(POINTS F "g a\n" F F "g\n" F, "1221", "2 a;");
    assert_groups(POINTS "g a\n" F "g b c\n" F "g a\n" F, "121", "1 a;2 b c;");
    assert_groups(POINTS "o x\ng a\nusemtl m\n" F F, "11", "1 a;");
    assert_groups(POINTS "o x\nusemtl m\n" F "usemtl n\n" F, "12", "1 m;2 n;");
    assert_groups(POINTS "o x\nusemtl m\n" F "o y\n" F "usemtl n\n" F, "123",
                  "1 x/m;2 y/m;3 y/n;");
    assert_groups(POINTS "g a #1\r\n" F "g \xfc\n" F, "12", "1 a #1;2 \xc3\xbc;");
    assert_groups(POINTS "g M#25\n" F "g M#26\n" F, "12", "1 M#25;2 M#26;");
    assert_groups(POINTS "g ha\\\nlf\n" F, "1", "1 half;");
    assert_groups(POINTS "g empty\ng a\n" F, "1", "1 a;");
}

#define T                                                                                \
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"         \
    "endloop\nendfacet\n"

static void test_stl(void **state)
{
    (void)state;
    assert_groups("solid\n" T T "endsolid\n", "00.", "");
    assert_groups("solid a\n" T "endsolid a\n", "1", "1 a;");
    assert_groups("solid a\n" T "endsolid\nsolid b\n" T T "endsolid\n", "122",
                  "1 a;2 b;");
    assert_groups("solid\n" T "endsolid\nsolid\n" T "endsolid\n", "12", "");
    assert_groups("solid a\n" T "endsolid\nsolid\n" T "endsolid\nSOLID a\n" T
                  "ENDSOLID\n",
                  "121", "1 a;");
    assert_groups("solid none\nendsolid\nsolid a b\r\n" T "endsolid\n", "2",
                  "1 none;2 a b;");
}

/* What the values of a joined name are as text, "" where it is none. */
static void assert_parts(const tm_block *group, const char *name, const char *expected)
{
    int32_t *part;
    size_t parts;
    tm_text text = {0};
    assert_int_equal(tm_group_parts(group, TM_GROUP_FACES, name, &part, &parts, NULL),
                     TM_OK);
    assert_int_equal(part != NULL, parts > 0);
    for (size_t i = 0; i < parts; i++)
        tm_text_format(&text, "%d ", (int)part[i]);
    tm_text_append(&text, "", 1);
    assert_string_equal(text.byte, expected);
    tm_text_free(&text);
    free(part);
}

static void test_parts(void **state)
{
    (void)state;
    tm_block group;
    tm_group_init(&group, ".group");
    assert_int_equal(tm_group_add(&group, TM_GROUP_FACES, 9, "in", NULL), TM_OK);
    assert_int_equal(tm_group_add(&group, TM_GROUP_FACES, 2, "a+b", NULL), TM_OK);
    assert_int_equal(tm_group_add(&group, TM_GROUP_FACES, -1, "low", NULL), TM_OK);
    assert_int_equal(tm_group_add(&group, TM_GROUP_REGIONS, 4, "steel", NULL), TM_OK);
    assert_parts(&group, "in + a+b", "2 9 ");
    assert_parts(&group, "in + 7 + a+b", "2 7 9 ");
    assert_parts(&group, "low + in", "9 -1 ");
    assert_parts(&group, "in + a+b + in", "2 9 ");
    assert_parts(&group, "in", "");
    assert_parts(&group, "in + in", "");
    assert_parts(&group, "in + steel", ""); /* that is of regions */
    assert_parts(&group, "in + ", "");
    assert_parts(&group, " + in", "");
    assert_parts(&group, "in + 2", ""); /* which has a name */
    assert_parts(&group, "in + 0", "");
    assert_parts(&group, "in + 99999999999", "");
    assert_parts(NULL, "3 + 1", "1 3 ");
    tm_group_free(&group);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clean),   cmocka_unit_test(test_clean_random),
        cmocka_unit_test(test_markers), cmocka_unit_test(test_check),
        cmocka_unit_test(test_region),  cmocka_unit_test(test_obj),
        cmocka_unit_test(test_stl),     cmocka_unit_test(test_parts)};
    random_start();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
