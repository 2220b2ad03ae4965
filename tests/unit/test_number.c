/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tm_write_double, and that what is written reads back: against strtod and %.17g, and in
 * a locale with a decimal comma. See also ../oracle/number_oracle.cc. */
#include "number_check.h"

#include <float.h>
#include <locale.h>

enum { TEXT_CHARS = 1024 };

/* What is written reads back, here and by strtod; so does %.17g, which is not shorter. */
static void check_value(double value)
{
    char text[TM_DOUBLE_CHARS + 1], printed[TM_DOUBLE_CHARS + 1];
    char *room = page_end - TM_DOUBLE_CHARS;
    size_t size = (size_t)(tm_write_double(room, value) - room);
    memcpy(text, room, size);
    text[size] = '\0';
    check_read(text, size, size, value);
    if (bits_of(strtod(text, NULL)) != bits_of(value))
        fail_msg("%a is written '%s', which strtod reads as %a", value, text,
                 strtod(text, NULL));
    size_t printed_size = (size_t)snprintf(printed, sizeof printed, "%.17g", value);
    check_read(printed, printed_size, printed_size, value);
    if (size > printed_size)
        fail_msg("'%s' is longer than '%s'", text, printed);
}

static void check_around(uint64_t bits)
{
    enum { ULPS = 3 };
    for (uint64_t step = 0; step <= ULPS; step++) {
        if (isfinite(from_bits(bits + step)))
            check_value(from_bits(bits + step));
        if (bits >= step)
            check_value(-from_bits(bits - step));
    }
}

static void writes_the_shorter_form(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *text;
    } form[] = {
        {0, "0"},
        {-0.0, "-0"},
        {1, "1"},
        {-1, "-1"},
        {0.5, "0.5"},
        {0.1, "0.1"},
        {0.01, "0.01"},
        {0.001, "1e-3"},
        {0.0625, "0.0625"},
        {0.012, "0.012"},
        {1.2e-3, "0.0012"},
        {1.2e-4, "1.2e-4"},
        {1e2, "100"},
        {1e3, "1e3"},
        {1200, "1200"},
        {12000, "12000"},
        {1.2e5, "1.2e5"},
        {123456, "123456"},
        {1e9, "1e9"},
        {1e-9, "1e-9"},
        {1.5e22, "1.5e22"},
        {1e23, "1e23"},
        {100.5, "100.5"},
        {12345678.5, "12345678.5"},
        {123456789.5, "123456789.5"},
        {1234567890.5, "1234567890.5"},
        {12345678901234.5, "12345678901234.5"},
        {0.1 + 0.2, "0.30000000000000004"},
        {9007199254740991, "9007199254740991"},
        {9007199254740992, "9007199254740992"},
        {1.2345678901234567e19, "12345678901234567000"},
        {12345678900000, "1.23456789e13"},
        {DBL_MAX, "1.7976931348623157e308"},
        {DBL_MIN, "2.2250738585072014e-308"},
        {-2.2250738585072011e-308, "-2.225073858507201e-308"},
        {0x1p-1074, "5e-324"},
        {0x1p-1073, "1e-323"},
        {0x1p-1072, "2e-323"},
        {9.5367431640625e-7, "9.5367431640625e-7"},
    };
    for (size_t i = 0; i < sizeof form / sizeof *form; i++) {
        char text[TM_DOUBLE_CHARS + 1];
        *tm_write_double(text, form[i].value) = '\0';
        assert_string_equal(text, form[i].text);
        check_value(form[i].value);
    }
}

static void every_exponent(void **state)
{
    (void)state;
    for (uint64_t biased = 0; biased < FINITE_EXPONENTS; biased++) {
        check_around(biased << SIGNIFICAND_BITS);
        check_around((biased << SIGNIFICAND_BITS) + (random_bits() >> 12));
    }
}

static void random_values(void **state)
{
    (void)state;
    enum { DECIMALS = 10000000, SUBNORMAL_BITS = 52 };
    for (unsigned long i = random_cases(); i > 0; i--) {
        double value = from_bits(random_bits());
        if (isfinite(value))
            check_value(value);
        check_value(random_unit() * 200 - 100);
        check_value(from_bits(random_bits() >> (12 + random_below(SUBNORMAL_BITS))));
        check_value((double)random_below(DECIMALS) / 1000);
    }
}

static bool write_file(const char *folder, const char *name, const char *content)
{
    char path[TEXT_CHARS];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (file == NULL)
        return false;
    bool good = fputs(content, file) >= 0;
    return fclose(file) == 0 && good;
}

/* Makes a locale "comma" in folder, whose decimal point is a comma; what is not said has
 * localedef's defaults. */
static bool make_comma_locale(const char *folder)
{
    char command[TEXT_CHARS];
    snprintf(command, sizeof command,
             "cd '%s' && localedef -c -f ./ascii -i ./source ./comma >messages 2>&1; "
             "test -f comma/LC_NUMERIC",
             folder);
    return write_file(folder, "ascii",
                      "<code_set_name> ANSI_X3.4-1968\n<escape_char> /\n"
                      "CHARMAP\n<U0000>..<U007F> /x00 ASCII\nEND CHARMAP\n") &&
           write_file(folder, "source",
                      "LC_NUMERIC\ndecimal_point \"<U002C>\"\n"
                      "thousands_sep \"\"\ngrouping -1\nEND LC_NUMERIC\n") &&
           system(command) == 0;
}

static void remove_folder(const char *folder)
{
    char command[TEXT_CHARS];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    assert_int_equal(system(command), 0);
}

/* The same texts and values as without it. */
static void a_decimal_comma_changes_nothing(void **state)
{
    (void)state;
    enum { COUNT = 20000, LONG = 800, SHORT_SHARE = 10 };
    char folder[] = "/tmp/test_number.XXXXXX";
    assert_non_null(mkdtemp(folder));
    bool made = make_comma_locale(folder);
    setenv("LOCPATH", folder, 1);
    bool set = made && setlocale(LC_ALL, "comma") != NULL;
    remove_folder(folder);
    if (!set) {
        print_message("localedef cannot make a locale with a decimal comma here\n");
        skip();
    }
    assert_string_equal(localeconv()->decimal_point, ",");
    static char text[TEXT_CHARS];
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    for (int i = 0; i < COUNT; i++) {
        double value = random_unit() * 1000;
        size_t size = (size_t)(tm_write_double(text, value) - text);
        assert_null(memchr(text, ',', size));
        check_read(text, size, size, value);
        random_decimal(text, 1 + random_below(i % SHORT_SHARE == 0 ? LONG : 20));
        char *end;
        value = strtod_l(text, &end, plain);
        check_read(text, strlen(text), (size_t)(end - text), value);
    }
    check_read("0,5", 3, 1, 0);
    freelocale(plain);
    setlocale(LC_ALL, "C");
}

/* Nine digits are what %.9g prints, where no tie of decimals is in the way, and give
 * back every float. */
static void nine_digits_are_enough_for_a_float(void **state)
{
    (void)state;
    enum { COUNT = 200000, DIGITS = 9 };
    static const struct {
        double value;
        const char *text;
    } form[] = {{0, "0"},
                {-0.0, "-0"},
                {0.1, "0.1"},
                {1.0 / 3, "0.333333333"},
                {-2e9 / 3, "-666666667"},
                {1000000.125, "1000000.12"},
                {999999999.9, "1e9"},
                {1e300 / 3, "3.33333333e299"}};
    char text[TM_DOUBLE_CHARS + 1], printed[TM_DOUBLE_CHARS + 1];
    for (size_t i = 0; i < sizeof form / sizeof form[0]; i++) {
        *tm_write_rounded(text, form[i].value, DIGITS) = '\0';
        assert_string_equal(text, form[i].text);
    }
    for (int i = 0; i < COUNT; i++) {
        double value = (random_unit() - 0.5) * pow(10, (int)random_below(60) - 30);
        *tm_write_rounded(text, value, DIGITS) = '\0';
        snprintf(printed, sizeof printed, "%.9g", value);
        if (strtod(text, NULL) != strtod(printed, NULL))
            fail_msg("%a is written '%s', but printed '%s'", value, text, printed);
        float narrow = (float)value;
        *tm_write_rounded(text, (double)narrow, DIGITS) = '\0';
        assert_true(strtof(text, NULL) == narrow);
    }
}

/* What is halfway goes to the even digit, whichever the digit is. */
static void ties_go_to_even(void **state)
{
    (void)state;
    for (int tens = 1; tens < 100; tens++) {
        char text[TM_DOUBLE_CHARS + 1];
        *tm_write_rounded(text, tens + 0.5, tens < 10 ? 1 : 2) = '\0';
        assert_true(strtod(text, NULL) == tens + tens % 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ties_go_to_even),
        cmocka_unit_test(writes_the_shorter_form),
        cmocka_unit_test(every_exponent),
        cmocka_unit_test(random_values),
        cmocka_unit_test(nine_digits_are_enough_for_a_float),
        cmocka_unit_test(a_decimal_comma_changes_nothing),
    };
    return cmocka_run_group_tests(tests, prepare, finish);
}
