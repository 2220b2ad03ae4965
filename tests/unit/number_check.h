/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the tests of numbers share. Every text is read twice: before an unmapped page, and
 * with digits behind its end, which must not be seen. TM_CASES is the number of random
 * values of each kind. */
#ifndef TESTS_UNIT_NUMBER_CHECK_H
#define TESTS_UNIT_NUMBER_CHECK_H

#include "../../lib/number/number.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

#ifdef __SANITIZE_ADDRESS__
enum { DEFAULT_CASES = 40000 };
#else
enum { DEFAULT_CASES = 1000000 };
#endif
enum { ROOM = 65536, TAIL = 16 };
enum { SIGNIFICAND_BITS = 52, FINITE_EXPONENTS = 2047 };

static char *page_end; /* the first byte of an unmapped page */
static unsigned long cases_done;

static inline int prepare(void **state)
{
    (void)state;
    random_start();
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    char *room = mmap(NULL, ROOM + page, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (room == MAP_FAILED || mprotect(room + ROOM, page, PROT_NONE) != 0)
        return -1;
    page_end = room + ROOM;
    return 0;
}

static inline int finish(void **state)
{
    (void)state;
    printf("%lu numbers checked\n", cases_done);
    return 0;
}

static inline unsigned long random_cases(void)
{
    const char *count = getenv("TM_CASES");
    return count != NULL ? strtoul(count, NULL, 10) : DEFAULT_CASES;
}

static inline uint64_t bits_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline double from_bits(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Reads text, whose number has `length` bytes, and expects value. */
static inline void check_read(const char *text, size_t size, size_t length, double value)
{
    char *guarded = page_end - size;
    memcpy(guarded, text, size);
    double got = NAN;
    const char *rest = tm_read_double(guarded, page_end, &got);
    if (rest != guarded + length || bits_of(got) != bits_of(value))
        fail_msg("'%s' reads as %a, %td bytes (%a, %zu bytes expected)", text, got,
                 rest == NULL ? -1 : rest - guarded, value, length);
    char *open = guarded - TAIL;
    memmove(open, guarded, size);
    memset(open + size, '9', TAIL);
    rest = tm_read_double(open, open + size, &got);
    if (rest != open + length || bits_of(got) != bits_of(value))
        fail_msg("'%s' reads as %a if digits follow (%a expected)", text, got, value);
    cases_done++;
}

/* Puts count random digits at text, perhaps a point among them and an exponent after. */
static inline void random_decimal(char *text, unsigned count)
{
    enum { EXPONENTS = 700 };
    unsigned point = random_below(2 * count), zeros = random_below(2 * count);
    char *p = text;
    for (unsigned i = 0; i < count; i++) {
        if (i == point)
            *p++ = '.';
        *p++ = i >= zeros && zeros >= count / 2 ? '0' : (char)('0' + random_below(10));
    }
    *p = '\0';
    if (random_below(2) == 0)
        sprintf(p, "e%d", (int)random_below(EXPONENTS) - EXPONENTS / 2 - (int)count / 2);
}

#endif
