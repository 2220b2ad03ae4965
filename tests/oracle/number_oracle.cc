/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lib/number/number.h against the C++ library: std::to_chars says what the digits are,
 * std::from_chars what a text means. Exit status 1 and the first difference on stderr.
 * TM_SEED repeats a run, TM_CASES is the number of random values of each kind. */
#include "../unit/random.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>

extern "C" {
#include "../../lib/number/number.h"
}

namespace
{

#ifdef __SANITIZE_ADDRESS__
constexpr unsigned long default_cases = 60000;
#else
constexpr unsigned long default_cases = 1200000;
#endif
constexpr int significand_bits = 52, last_biased_exponent = 2046;
unsigned long cases_done;

[[noreturn]] void fail(const char *what, const std::string &got, const std::string &want)
{
    std::fprintf(stderr, "number_oracle: %s: %s (%s expected)\n", what, got.c_str(),
                 want.c_str());
    std::exit(EXIT_FAILURE);
}

std::uint64_t bits_of(double value)
{
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

double from_bits(std::uint64_t bits)
{
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

std::string exactly(double value)
{
    char text[64];
    std::snprintf(text, sizeof text, "%a", value);
    return text;
}

/* What tm_write_double should write, put together from the digits of std::to_chars. */
std::string expected_text(double value)
{
    if (value == 0)
        return std::signbit(value) ? "-0" : "0";
    char buffer[64];
    char *end = std::to_chars(buffer, buffer + sizeof buffer, std::fabs(value),
                              std::chars_format::scientific)
                    .ptr;
    std::string scientific(buffer, end);
    std::size_t mark = scientific.find('e');
    int exponent = std::stoi(scientific.substr(mark + 1));
    std::string digits = scientific.substr(0, mark);
    if (digits.size() > 1)
        digits.erase(1, 1);

    std::string with_exponent = digits.substr(0, 1);
    if (digits.size() > 1)
        with_exponent += "." + digits.substr(1);
    with_exponent += "e" + std::to_string(exponent);

    std::string plain = digits;
    int before = exponent + 1, count = static_cast<int>(digits.size());
    if (before <= 0)
        plain = "0." + std::string(static_cast<std::size_t>(-before), '0') + digits;
    else if (before >= count)
        plain += std::string(static_cast<std::size_t>(before - count), '0');
    else
        plain.insert(static_cast<std::size_t>(before), 1, '.');

    const std::string &shorter =
        plain.size() <= with_exponent.size() ? plain : with_exponent;
    return std::signbit(value) ? "-" + shorter : shorter;
}

void check_value(double value)
{
    char text[TM_DOUBLE_CHARS], other[512];
    char *end = tm_write_double(text, value);
    std::string written(text, end);
    if (written != expected_text(value))
        fail("written", written, expected_text(value));
    char *other_end = std::to_chars(other, other + sizeof other, value).ptr;
    if (end - text > other_end - other)
        fail("longer than std::to_chars", written, std::string(other, other_end));
    double back = 0;
    std::from_chars_result result = std::from_chars(text, end, back);
    if (result.ptr != end || bits_of(back) != bits_of(value))
        fail("std::from_chars reads back", exactly(back), exactly(value));
    const char *read_end = tm_read_double(text, end, &back);
    if (read_end != end || bits_of(back) != bits_of(value))
        fail("tm_read_double reads back", exactly(back), exactly(value));
    cases_done++;
}

void check_text(const std::string &text)
{
    const char *begin = text.data(), *end = begin + text.size();
    double want = 0, got = 0;
    std::from_chars_result result = std::from_chars(begin, end, want);
    const char *rest = tm_read_double(begin, end, &got);
    if (result.ec == std::errc::invalid_argument) {
        if (rest != nullptr)
            fail("reads what is no number", text, "NULL");
    } else if (rest != result.ptr) {
        fail("end of number", text, std::string(begin, result.ptr));
    } else if (result.ec == std::errc::result_out_of_range) {
        if (got != 0 && !std::isinf(got))
            fail(text.c_str(), exactly(got), "out of range");
    } else if (bits_of(got) != bits_of(want)) {
        fail(text.c_str(), exactly(got), exactly(want));
    }
    cases_done++;
}

void check_integer(std::int64_t value)
{
    char text[TM_INTEGER_CHARS], other[TM_INTEGER_CHARS];
    std::string written(text, tm_write_int64(text, value));
    std::string want(other, std::to_chars(other, other + sizeof other, value).ptr);
    if (written != want)
        fail("tm_write_int64", written, want);
    std::int64_t back = 0;
    const char *end = written.data() + written.size();
    if (tm_read_int64(written.data(), end, &back) != end || back != value)
        fail("tm_read_int64", std::to_string(back), want);
    std::uint32_t low = static_cast<std::uint32_t>(value);
    written.assign(text, tm_write_uint32(text, low));
    if (written != std::to_string(low))
        fail("tm_write_uint32", written, std::to_string(low));
    cases_done++;
}

/* The doubles up to 3 units in the last place around 2^e, for every e. */
void check_every_exponent()
{
    for (std::uint64_t biased = 0; biased <= last_biased_exponent; biased++) {
        std::uint64_t power = biased << significand_bits;
        for (std::uint64_t step = 0; step <= 3; step++) {
            check_value(from_bits(power + step));
            check_value(-from_bits(power + step));
            if (power > 0)
                check_value(from_bits(power - step));
        }
    }
}

double random_finite()
{
    double value;
    do {
        value = from_bits(random_bits());
    } while (!std::isfinite(value));
    return value;
}

/* Digits of a random length up to `longest`, perhaps a point among them, an exponent. */
std::string random_text(unsigned longest)
{
    std::string text = random_below(2) == 0 ? "" : "-";
    unsigned length = 1 + random_below(longest), point = random_below(2 * longest);
    for (unsigned i = 0; i < length; i++) {
        if (i == point)
            text += '.';
        text += static_cast<char>('0' + random_below(10));
    }
    if (random_below(2) == 0)
        text += "e" + std::to_string(static_cast<int>(random_below(700)) - 360);
    return text;
}

void check_random(unsigned long count)
{
    constexpr double thousand = 1000;
    constexpr unsigned short_digits = 20, long_digits = 800, long_share = 100;
    for (unsigned long i = 0; i < count; i++) {
        check_value(random_finite());
        check_value(std::ldexp(random_unit(), static_cast<int>(random_below(20)) - 10));
        check_value(from_bits(random_bits() >> (12 + random_below(52)))); /* subnormal */
        check_value(static_cast<double>(random_below(10000000)) / thousand);
        check_text(random_text(short_digits));
        if (i % long_share == 0)
            check_text(random_text(long_digits));
        check_integer(static_cast<std::int64_t>(random_bits() >> random_below(64)));
    }
}

} // namespace

int main()
{
    const char *count = std::getenv("TM_CASES");
    random_start();
    for (double limit : {0.0, -0.0, std::numeric_limits<double>::max(),
                         std::numeric_limits<double>::min()})
        check_value(limit);
    check_integer(INT64_MIN);
    check_integer(INT64_MAX);
    check_every_exponent();
    check_random(count != nullptr ? std::strtoul(count, nullptr, 10) : default_cases);
    std::printf("number_oracle: %lu cases\n", cases_done);
    return EXIT_SUCCESS;
}
