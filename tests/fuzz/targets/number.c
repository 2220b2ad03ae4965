/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers: text is read as strtod() reads it, and any double is written so that it is
 * read back. */
#include "target.h"

#include "../../../lib/number/number.h"

#include <ctype.h>

static uint64_t bits_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The bytes up to the first that no decimal number has. */
static void check_text(const uint8_t *bytes, size_t size)
{
    char *text = malloc(size + 1), *end;
    if (!text)
        give_up("malloc");
    size_t length = 0;
    while (length < size && (isdigit(bytes[length]) || strchr("+-.eE", bytes[length])) &&
           bytes[length] != '\0') {
        text[length] = (char)bytes[length];
        length++;
    }
    text[length] = '\0';
    double value = 0;
    const double expected = strtod(text, &end);
    const char *rest = tm_read_double(text, text + length, &value);
    require(rest ? rest == end : end == text, "it ends elsewhere");
    require(!rest || bits_of(value) == bits_of(expected), "it is another number");
    free(text);
}

static void check_double(const uint8_t *bytes)
{
    char text[TM_DOUBLE_CHARS];
    double value, again = 0;
    memcpy(&value, bytes, sizeof value);
    if (!isfinite(value))
        return;
    const char *end = tm_write_double(text, value);
    require(tm_read_double(text, end, &again) == end && bits_of(value) == bits_of(again),
            "what is written is read as another number");
    for (int most = 1; most <= 17; most++)
        require(tm_read_double(text, tm_write_rounded(text, value, most), &again) &&
                    (most < 17 || again == value),
                "it is rounded to no number, or another one");
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    check_text(bytes, size);
    if (size >= sizeof(double))
        check_double(bytes);
    return 0;
}
