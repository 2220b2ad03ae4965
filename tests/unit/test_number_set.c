/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A set of numbers: what is in it, and which one each is. */
#include "../../lib/base/number_set.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

enum { NONE = 7, MOST = 300 };

/* Random lists, with numbers several times and such that are none, against counting. */
static void random_lists(void **state)
{
    (void)state;
    for (unsigned round = 0; round < 2000; round++) {
        uint32_t list[MOST], all[MOST];
        const uint32_t shift = round % 2 ? UINT32_MAX - 4 * MOST : 0;
        const size_t count = random_below(MOST);
        bool is_in[4 * MOST] = {false};
        tm_number_set set;
        for (size_t i = 0; i < count; i++) {
            const uint32_t number = random_below(4 * MOST);
            list[i] = random_below(5) == 0 ? NONE : shift + number;
            is_in[number] |= list[i] != NONE;
        }
        assert_true(tm_number_set_of(&set, list, count, NONE));
        uint32_t below = 0;
        for (uint32_t number = 0; number < 4 * MOST; number++) {
            assert_int_equal(tm_number_set_below(&set, shift + number), below);
            assert_int_equal(tm_number_set_has(&set, shift + number), is_in[number]);
            if (is_in[number])
                all[below++] = shift + number;
        }
        assert_int_equal(set.count, below);
        uint32_t listed[MOST];
        tm_number_set_list(&set, listed);
        assert_memory_equal(listed, all, below * sizeof *all);
        tm_number_set_free(&set);
    }
}

static void ends_of_the_range(void **state)
{
    (void)state;
    const uint32_t ends[] = {0, UINT32_MAX - 1};
    tm_number_set set;
    assert_true(tm_number_set_of(&set, ends, 1, UINT32_MAX));
    assert_int_equal(tm_number_set_below(&set, UINT32_MAX), 1);
    assert_false(tm_number_set_has(&set, UINT32_MAX));
    tm_number_set_free(&set);
    assert_true(tm_number_set_of(&set, ends + 1, 1, UINT32_MAX));
    assert_int_equal(tm_number_set_below(&set, 0), 0);
    assert_int_equal(tm_number_set_below(&set, UINT32_MAX), 1);
    assert_true(tm_number_set_has(&set, UINT32_MAX - 1));
    tm_number_set_free(&set);
    assert_true(tm_number_set_of(&set, NULL, 0, UINT32_MAX));
    assert_int_equal(tm_number_set_below(&set, 3), 0);
    assert_false(tm_number_set_has(&set, 0));
    tm_number_set_free(&set);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_lists),
                                       cmocka_unit_test(ends_of_the_range)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
