/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tm_read_double against strtod and exact arithmetic. */
#include "number_check.h"

#include <float.h>
#include <gmp.h>

enum { TEXT_CHARS = 16384, MIN_EXPONENT = -1074 };

/* strtod in the "C" locale says what text means. */
static void check_like_strtod(const char *text)
{
    char *end;
    double value = strtod(text, &end);
    check_read(text, strlen(text), (size_t)(end - text), value);
}

static void reads_the_grammar_and_no_more(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t length; /* of the number; 0 where there is none */
        double value;
    } form[] = {
        {"", 0, 0},
        {"+", 0, 0},
        {"-", 0, 0},
        {".", 0, 0},
        {"-.", 0, 0},
        {"e5", 0, 0},
        {".e5", 0, 0},
        {"+-1", 0, 0},
        {"-+1", 0, 0},
        {"--1", 0, 0},
        {" 1", 0, 0},
        {"nan", 0, 0},
        {"inf", 0, 0},
        {"-infinity", 0, 0},
        {"x", 0, 0},
        {",5", 0, 0},
        {"/", 0, 0},
        {":", 0, 0},
        {"1", 1, 1},
        {"+1", 2, 1},
        {"-1", 2, -1},
        {"1.", 2, 1},
        {"-.5", 3, -0.5},
        {"+.5", 3, 0.5},
        {"1..2", 2, 1},
        {"1.5.2", 3, 1.5},
        {"1e", 1, 1},
        {"1e+", 1, 1},
        {"1e-", 1, 1},
        {"1e+-2", 1, 1},
        {"1.e", 2, 1},
        {"1.e2", 4, 100},
        {".5E1", 4, 5},
        {"1e2.5", 3, 100},
        {"1e 2", 1, 1},
        {"0x10", 1, 0},
        {"1_0", 1, 1},
        {"1,5", 1, 1},
        {"0,5", 1, 0},
        {"1d5", 1, 1},
        {"1\xa0", 1, 1},
        {"1\xb1\xb2", 1, 1},
        {"12345678:", 8, 12345678},
        {"1234567/", 7, 1234567},
        {"0", 1, 0},
        {"-0", 2, -0.0},
        {"-0.000e5", 8, -0.0},
        {"00012.50", 8, 12.5},
        {"1e-0002", 7, 0.01},
        {"1e400", 5, HUGE_VAL},
        {"-1e400", 6, -HUGE_VAL},
        {"1e-400", 6, 0},
        {"-1e-400", 7, -0.0},
        {"0e400", 5, 0},
        {"1e99999999999999999999", 22, HUGE_VAL},
        {"1e-99999999999999999999", 23, 0},
        {"0e99999999999999999999", 22, 0},
        {"9223372036854775808e0", 21, 0x1p63},
        {"18446744073709551616", 20, 0x1p64},
        {"9007199254740993", 16, 0x1p53},
        {"9007199254740995", 16, 0x1p53 + 4},
        {"179769313486231580793728971405301e276", 37, DBL_MAX},
        {"17976931348623159e292", 21, HUGE_VAL},
        {"2.4703282292062327e-324", 23, 0},
        {"2.4703282292062328e-324", 23, 0x1p-1074},
    };
    for (size_t i = 0; i < sizeof form / sizeof *form; i++) {
        const char *text = form[i].text;
        if (form[i].length > 0) {
            check_read(text, strlen(text), form[i].length, form[i].value);
            continue;
        }
        double value = 1;
        char *guarded = page_end - strlen(text);
        memcpy(guarded, text, strlen(text));
        if (tm_read_double(guarded, page_end, &value) != NULL || value != 1)
            fail_msg("'%s' reads as a number", text);
    }
}

/* Each beginning of a text is a text. */
static void reads_every_prefix_like_strtod(void **state)
{
    (void)state;
    static const char *const text[] = {
        "-123456789012345678901234567890.123456789e-0012 ",
        "+0000.00000000000000000000123456789E+30x",
        "8414709848078965.8414709848078965e-308,",
        "0.84147098480789651234567",
        "1234567.1234567e",
        ".12345678 12345678",
    };
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        char prefix[TM_DOUBLE_CHARS * 2] = "";
        for (size_t size = 0; size < strlen(text[i]); size++) {
            prefix[size] = text[i][size];
            prefix[size + 1] = '\0';
            char *end;
            double value = strtod(prefix, &end);
            if (end > prefix)
                check_read(prefix, size + 1, (size_t)(end - prefix), value);
        }
    }
}

/* m·10^e for every e, also where it is too large or too small. */
static void every_power_of_ten(void **state)
{
    (void)state;
    enum { LARGEST = 400, SMALL = 20, RANDOM = 100 };
    char text[TM_DOUBLE_CHARS * 2];
    for (int e = -LARGEST; e <= LARGEST; e++) {
        for (unsigned m = 1; m <= SMALL + RANDOM; m++) {
            uint64_t digits = m <= SMALL ? m : random_bits() >> random_below(64);
            snprintf(text, sizeof text, "%" PRIu64 "e%d", digits, e);
            check_like_strtod(text);
        }
    }
}

static void digit_strings(void **state)
{
    (void)state;
    enum {
        SHORT = 25,
        LONG = 800,
        VERY_LONG = 12000,
        LONG_SHARE = 50,
        VERY_SHARE = 5000
    };
    static char text[TEXT_CHARS];
    for (unsigned long i = random_cases(); i > 0; i--) {
        random_decimal(text, 1 + random_below(SHORT));
        check_like_strtod(text);
        if (i % LONG_SHARE == 0) {
            random_decimal(text, 1 + random_below(LONG));
            check_like_strtod(text);
        }
        if (i % VERY_SHARE == 0) {
            random_decimal(text, 1 + random_below(VERY_LONG));
            check_like_strtod(text);
        }
    }
}

/* Reads digits·10^exponent in several spellings and expects value. */
static void check_spellings(mpz_t digits, int exponent, double value)
{
    enum { ZEROS = 40 };
    static char plain[TEXT_CHARS], text[2 * TEXT_CHARS];
    mpz_get_str(plain, 10, digits);
    int count = (int)strlen(plain), zeros = (int)random_below(ZEROS);
    int size = sprintf(text, "%se%d", plain, exponent);
    check_read(text, (size_t)size, (size_t)size, value);
    int before = (int)random_below((unsigned)count + 1);
    size = sprintf(text, "%.*s.%se%d", before, plain, plain + before,
                   exponent + count - before);
    check_read(text, (size_t)size, (size_t)size, value);
    size = sprintf(text, "0.%0*d%s%0*de%d", zeros + 1, 0, plain, zeros + 1, 0,
                   exponent + count + zeros + 1);
    check_read(text, (size_t)size, (size_t)size, value);
}

/* The middle between the double with these bits and the next, and its neighbours on both
 * sides, written out in full; also with one more digit far behind. */
static void check_middle(uint64_t bits)
{
    enum { FAR = 1000 };
    uint64_t significand = bits & ((UINT64_C(1) << SIGNIFICAND_BITS) - 1);
    int biased = (int)(bits >> SIGNIFICAND_BITS);
    if (biased > 0)
        significand |= UINT64_C(1) << SIGNIFICAND_BITS;
    int twos = MIN_EXPONENT - 1 + (biased > 0 ? biased - 1 : 0);
    mpz_t middle, power;
    mpz_init_set_ui(middle, 2 * significand + 1);
    mpz_init(power);
    mpz_ui_pow_ui(power, twos < 0 ? 5 : 2, (unsigned long)abs(twos));
    mpz_mul(middle, middle, power);
    int exponent = twos < 0 ? twos : 0;

    check_spellings(middle, exponent, from_bits(bits + (bits & 1)));
    mpz_sub_ui(middle, middle, 1);
    check_spellings(middle, exponent, from_bits(bits));
    mpz_add_ui(middle, middle, 2);
    check_spellings(middle, exponent, from_bits(bits + 1));
    mpz_ui_pow_ui(power, 10, FAR);
    mpz_sub_ui(middle, middle, 1);
    mpz_mul(middle, middle, power);
    mpz_add_ui(middle, middle, 1);
    check_spellings(middle, exponent - FAR, from_bits(bits + 1));
    mpz_sub_ui(middle, middle, 2);
    check_spellings(middle, exponent - FAR, from_bits(bits));
    mpz_clears(middle, power, NULL);
}

static void middles_of_doubles(void **state)
{
    (void)state;
    enum { EACH_SHARE = 200 };
    check_middle(0);
    check_middle(bits_of(DBL_MIN) - 1);
    check_middle(bits_of(DBL_MAX));
    for (uint64_t biased = 0; biased < FINITE_EXPONENTS; biased++) {
        check_middle(biased << SIGNIFICAND_BITS);
        check_middle((biased << SIGNIFICAND_BITS) + (random_bits() >> 12));
    }
    for (unsigned long i = random_cases() / EACH_SHARE; i > 0; i--)
        check_middle(random_bits() % bits_of(HUGE_VAL));
}

/* Middles with few digits: (2m + 1)/2^twos, m of 53 bits. */
static void short_middles(void **state)
{
    (void)state;
    enum { MOST_TWOS = 8 };
    char text[2 * TM_DOUBLE_CHARS];
    for (unsigned long i = random_cases(); i > 0; i--) {
        uint64_t middle = random_bits() >> 10 | UINT64_C(1) << 53 | 1;
        int twos = 1 + (int)random_below(MOST_TWOS);
        uint64_t fraction = middle & ((UINT64_C(1) << twos) - 1);
        for (int k = 0; k < twos; k++)
            fraction *= 5; /* in units of 10^-twos */
        snprintf(text, sizeof text, "%" PRIu64 ".%0*" PRIu64, middle >> twos, twos,
                 fraction);
        check_like_strtod(text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_the_grammar_and_no_more),
        cmocka_unit_test(reads_every_prefix_like_strtod),
        cmocka_unit_test(every_power_of_ten),
        cmocka_unit_test(digit_strings),
        cmocka_unit_test(middles_of_doubles),
        cmocka_unit_test(short_middles),
    };
    return cmocka_run_group_tests(tests, prepare, finish);
}
