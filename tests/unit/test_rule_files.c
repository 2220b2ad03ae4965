/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of boxes and of octants: good ones, wrong ones, and damaged ones. */
#include "../../lib/octree/forest/rule_files.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { CHANGED = 5000, CHANGES_MAX = 4, TEXT_MAX = 256 };

static const char reg_text[] = "# two boxes\nn_regions 2\n\n0 0 -1e1\n300 100 170\n\n"
                               "5 # level\n\n-300 -300 0 300 300 88 6\n";
static const char ref_text[] = "# octants\n7\n\n 0 # the first\r\n4294967294\n7\n";

static void test_reg(void **state)
{
    (void)state;
    tm_error error = {0};
    tm_octree_rules rules = {0};
    const tm_octree_rule before = {.kind = TM_RULE_SURFACE, .level = 3};
    assert_int_equal(tm_octree_rules_add(&rules, &before, &error), TM_OK);
    assert_int_equal(tm_reg_read(&rules, reg_text, sizeof reg_text - 1, "a.reg", &error),
                     TM_OK);
    assert_int_equal(rules.count, 3);
    assert_int_equal(rules.rule[0].kind, TM_RULE_SURFACE);
    const double low[2][3] = {{0, 0, -10}, {-300, -300, 0}};
    const double high[2][3] = {{300, 100, 170}, {300, 300, 88}};
    for (int b = 0; b < 2; b++) {
        assert_int_equal(rules.rule[1 + b].kind, TM_RULE_BOX);
        assert_int_equal(rules.rule[1 + b].level, 5 + b);
        for (int i = 0; i < 3; i++) {
            assert_true(rules.rule[1 + b].low[i] == low[b][i]);
            assert_true(rules.rule[1 + b].high[i] == high[b][i]);
        }
    }
    tm_octree_rules_free(&rules);
}

static void refuse_reg(const char *text, size_t line, const char *part)
{
    tm_error error = {0};
    tm_octree_rules rules = {0};
    assert_int_equal(tm_reg_read(&rules, text, strlen(text), "a.reg", &error),
                     TM_ERROR_INPUT);
    assert_int_equal(error.line, line);
    assert_string_equal(error.file, "a.reg");
    if (!strstr(error.what, part))
        fail_msg("'%s' is not in '%s'", part, error.what);
    assert_int_equal(rules.count, 0);
    tm_octree_rules_free(&rules);
}

static void test_wrong_reg(void **state)
{
    (void)state;
    refuse_reg("", 1, "n_regions");
    refuse_reg("regions 1\n", 1, "n_regions");
    refuse_reg("n_regions\n", 2, "the number of boxes");
    refuse_reg("n_regions -1\n", 1, "out of range");
    refuse_reg("n_regions 1\n0 0 0\n1 1\n", 4, "the largest z");
    refuse_reg("n_regions 1\n0 0 0\n1 0,5 1\n5\n", 3, "is not a number");
    refuse_reg("n_regions 1\n0 0 0\n1 nan 1\n5\n", 3, "is not a number");
    refuse_reg("n_regions 1\n0 2 0\n1 1 1\n5\n", 3, "the largest y is below");
    refuse_reg("n_regions 1\n0 0 0\n1 1 1\n18\n", 4, "out of range (0..17)");
    refuse_reg("n_regions 1\n0 0 0 1 1 1 5\n0 0 0 1 1 1 5\n", 3, "more than the 1 boxes");
    refuse_reg("n_regions 2\n0 0 0 1 1 1 5\n", 3, "the smallest x");
}

static void test_ref(void **state)
{
    (void)state;
    tm_error error = {0};
    uint32_t *leaf = NULL;
    size_t leaves = 0;
    assert_int_equal(
        tm_ref_read(&leaf, &leaves, ref_text, sizeof ref_text - 1, "a.ref", &error),
        TM_OK);
    const uint32_t expected[] = {7, 0, UINT32_MAX - 1, 7};
    assert_int_equal(leaves, 4);
    assert_memory_equal(leaf, expected, sizeof expected);
    free(leaf);
}

static void refuse_ref(const char *text, size_t line, const char *part)
{
    tm_error error = {0};
    uint32_t *leaf = NULL;
    size_t leaves = 0;
    assert_int_equal(tm_ref_read(&leaf, &leaves, text, strlen(text), "a.ref", &error),
                     TM_ERROR_INPUT);
    assert_int_equal(error.line, line);
    if (!strstr(error.what, part))
        fail_msg("'%s' is not in '%s'", part, error.what);
    assert_null(leaf);
}

static void test_wrong_ref(void **state)
{
    (void)state;
    refuse_ref("1\n2 3\n", 2, "the line should end there");
    refuse_ref("1\n\n-3\n", 3, "out of range");
    refuse_ref("4294967295\n", 1, "out of range");
    refuse_ref("1.5\n", 1, "is not a whole number");
}

/* The bytes are read where reading one more is an error that a sanitizer sees. */
static void read_any(const char *bytes, size_t size)
{
    char *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    tm_error error = {0};
    tm_octree_rules rules = {0};
    if (tm_reg_read(&rules, copy, size, "file", &error) != TM_OK)
        assert_int_equal(rules.count, 0);
    for (size_t r = 0; r < rules.count; r++) {
        assert_true(rules.rule[r].level <= TM_OCTREE_LEVEL_MAX);
        for (int i = 0; i < 3; i++)
            assert_true(rules.rule[r].low[i] <= rules.rule[r].high[i]);
    }
    tm_octree_rules_free(&rules);
    uint32_t *leaf = NULL;
    size_t leaves = 0;
    const tm_status status = tm_ref_read(&leaf, &leaves, copy, size, "file", &error);
    assert_true(status == TM_OK || (status == TM_ERROR_INPUT && leaves == 0 && !leaf));
    free(leaf);
    free(copy);
}

/* Bytes that mean something in these files are likelier than others. */
static char random_byte(void)
{
    static const char likely[] = "0123456789-+.e \n\r\t#";
    return random_below(4) ? likely[random_below(sizeof likely - 1)]
                           : (char)random_below(256);
}

static void test_damaged(void **state)
{
    (void)state;
    static const char *const text[] = {reg_text, ref_text};
    static const unsigned lengths[] = {sizeof reg_text - 1, sizeof ref_text - 1};
    for (int t = 0; t < 2; t++) {
        const unsigned length = lengths[t];
        for (size_t size = 0; size <= length; size++)
            read_any(text[t], size);
        for (int i = 0; i < CHANGED; i++) {
            char changed[TEXT_MAX];
            memcpy(changed, text[t], length);
            for (unsigned n = 1 + random_below(CHANGES_MAX); n > 0; n--)
                changed[random_below(length)] = random_byte();
            read_any(changed, length);
        }
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reg),     cmocka_unit_test(test_wrong_reg),
        cmocka_unit_test(test_ref),     cmocka_unit_test(test_wrong_ref),
        cmocka_unit_test(test_damaged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
