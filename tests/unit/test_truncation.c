/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each beginning of a file is refused, or read as the whole file is, but where the sample
 * says that this cannot be seen (reader_samples.h). TM_CASES of each file have bytes
 * changed; they are read or refused. */
#include "random.h"
#include "reader_samples.h"

/* Returns how many cuts are taken as they should not be, or the other way round. */
static int cut(reader *read, const char *name, const char *bytes, size_t size,
               const bool *unseen)
{
    tm_text whole = {0};
    int wrong = 0;
    assert_int_equal(read_copy(read, bytes, size, &whole), TM_OK);
    for (size_t s = 0; s < size; s++) {
        tm_text part = {0};
        const tm_status status = read_copy(read, bytes, s, &part);
        const bool same =
            part.size == whole.size && memcmp(part.byte, whole.byte, whole.size) == 0;
        assert_true(status == TM_OK || status == TM_ERROR_INPUT);
        if ((status == TM_OK && !same) != unseen[s]) {
            wrong++;
            print_error("%s: %zu of %zu bytes are %s\n", name, s, size,
                        status == TM_OK ? "taken for whole" : "refused");
        }
        tm_text_free(&part);
    }
    tm_text_free(&whole);
    return wrong;
}

static void test_cuts(void **state)
{
    (void)state;
    int wrong = 0;
    for (size_t i = 0; i < READER_SAMPLES; i++) {
        char bytes[READER_SAMPLE_MAX];
        bool unseen[READER_SAMPLE_MAX];
        assert_true(strlen(reader_samples[i].text) < READER_SAMPLE_MAX);
        const size_t size = take_braces(reader_samples[i].text, bytes, unseen);
        wrong += cut(reader_samples[i].read, reader_samples[i].name, bytes, size, unseen);
    }
    assert_int_equal(wrong, 0);
}

static void test_changed_bytes(void **state)
{
    (void)state;
    const char *cases = getenv("TM_CASES");
    for (size_t i = 0; i < READER_SAMPLES; i++) {
        char bytes[READER_SAMPLE_MAX], changed[READER_SAMPLE_MAX];
        bool unseen[READER_SAMPLE_MAX];
        const size_t size = take_braces(reader_samples[i].text, bytes, unseen);
        if (size == 0)
            continue;
        for (int n = cases ? atoi(cases) : 1000; n > 0; n--) {
            memcpy(changed, bytes, size);
            for (unsigned k = 1 + random_below(3); k > 0; k--) {
                static const char likely[] = "0123456789-+.eE \n#[";
                changed[random_below((unsigned)size)] =
                    likely[random_below(sizeof likely - 1)];
            }
            tm_text meaning = {0};
            const tm_status status =
                read_copy(reader_samples[i].read, changed, size, &meaning);
            assert_true(status == TM_OK || status == TM_ERROR_INPUT);
            tm_text_free(&meaning);
        }
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_cuts),
                                       cmocka_unit_test(test_changed_bytes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
