/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tm_read_int64, tm_write_int64 and tm_write_uint32 against printf. */
#include "number_check.h"

static void check_integer(int64_t value)
{
    char text[TM_INTEGER_CHARS + 1], printed[TM_INTEGER_CHARS + 1];
    char *room = page_end - TM_INTEGER_CHARS;
    size_t written = (size_t)(tm_write_int64(room, value) - room);
    memcpy(text, room, written);
    text[written] = '\0';
    size_t size = (size_t)snprintf(printed, sizeof printed, "%" PRId64, value);
    assert_string_equal(text, printed);
    char *guarded = page_end - size;
    memcpy(guarded, text, size);
    int64_t got = ~value;
    if (tm_read_int64(guarded, page_end, &got) != page_end || got != value)
        fail_msg("'%s' reads as %" PRId64, text, got);
    char *open = guarded - TAIL;
    memcpy(open, text, size);
    memset(open + size, '9', TAIL);
    if (tm_read_int64(open, open + size, &got) != open + size || got != value)
        fail_msg("'%s' reads as %" PRId64 " if digits follow", text, got);
    open[size] = ' ';
    if (tm_read_int64(open, open + size + 1, &got) != open + size || got != value)
        fail_msg("'%s' reads as %" PRId64 " if a blank follows", text, got);
    uint32_t low = (uint32_t)value;
    written = (size_t)(tm_write_uint32(room, low) - room);
    memcpy(text, room, written);
    text[written] = '\0';
    snprintf(printed, sizeof printed, "%" PRIu32, low);
    assert_string_equal(text, printed);
    cases_done++;
}

static void integers(void **state)
{
    (void)state;
    check_integer(INT64_MIN);
    check_integer(INT64_MAX);
    for (int64_t power = 1;; power *= 10) {
        for (int64_t step = -1; step <= 1; step++) {
            check_integer(power + step);
            check_integer(-power + step);
        }
        if (power > INT64_MAX / 10)
            break;
    }
    for (unsigned long i = random_cases(); i > 0; i--)
        check_integer((int64_t)random_bits() >> random_below(64));
}

static void reads_integers_and_no_more(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int length; /* of the number; 0 where there is none that fits */
        int64_t value;
    } form[] = {
        {"", 0, 0},
        {"-", 0, 0},
        {"+", 0, 0},
        {"+-1", 0, 0},
        {" 1", 0, 0},
        {"x1234567890", 0, 0},
        {"/12345678", 0, 0},
        {":12345678", 0, 0},
        {"+7", 2, 7},
        {"-0", 2, 0},
        {"1.5", 1, 1},
        {"1e3", 1, 1},
        {"0x10", 1, 0},
        {"12345678", 8, 12345678},
        {"1234567\n8", 7, 1234567},
        {"123456789012345678 ", 18, 123456789012345678},
        {"000000000000000000000000000012", 30, 12},
        {"-000000000000000000000000000012", 31, -12},
        {"9223372036854775807", 19, INT64_MAX},
        {"9223372036854775808", 0, 0},
        {"-9223372036854775808", 20, INT64_MIN},
        {"-9223372036854775809", 0, 0},
        {"0009223372036854775808", 0, 0},
        {"18446744073709551616", 0, 0},
        {"18446744073709551617", 0, 0},
        {"99999999999999999999999999999999999999999", 0, 0},
    };
    for (size_t i = 0; i < sizeof form / sizeof *form; i++) {
        size_t size = strlen(form[i].text);
        char *guarded = page_end - size;
        memcpy(guarded, form[i].text, size);
        int64_t value = -1;
        const char *end = tm_read_int64(guarded, page_end, &value);
        int length = end == NULL ? 0 : (int)(end - guarded);
        int64_t expected = form[i].length > 0 ? form[i].value : -1;
        if (length != form[i].length || value != expected)
            fail_msg("'%s' reads as %" PRId64 ", %d bytes", form[i].text, value, length);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integers),
        cmocka_unit_test(reads_integers_and_no_more),
    };
    return cmocka_run_group_tests(tests, prepare, finish);
}
