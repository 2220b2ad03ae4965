/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints powers.h: the table of powers of ten that lib/number/power.c holds. For every k
 * in [POWER_MIN, POWER_MAX] it has the 128 leading bits of 10^k, cut off (not rounded):
 *     10^k = (significand + rest)·2^(floor(log2 10^k) - 127),   0 <= rest < 1,
 * with 2^127 <= significand < 2^128, and the lower 64 of them not all ones, so that the
 * writer can add 1. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gmp.h> /* declares gmp_printf() after stdio.h only */

/* 10^19 · 10^-343 is less than half the smallest double, so the reader needs no power
 * below -342; the writer needs 10^324 for the smallest double, 5·10^-324. */
enum { POWER_MIN = -342, POWER_MAX = 324 };
enum { SIGNIFICAND_BITS = 128, WORD_BITS = 64 };

/* The 128 leading bits of 10^k. */
static void leading_bits(mpz_t significand, int k)
{
    mpz_t power;
    mpz_init(power);
    mpz_ui_pow_ui(power, 10, (unsigned long)abs(k));
    mp_bitcnt_t bits = mpz_sizeinbase(power, 2);
    if (k < 0) { /* 2^(bits + 127) / power lies between 2^127 and 2^128 */
        mpz_set_ui(significand, 0);
        mpz_setbit(significand, bits + SIGNIFICAND_BITS - 1);
        mpz_fdiv_q(significand, significand, power);
    } else if (bits > SIGNIFICAND_BITS) {
        mpz_fdiv_q_2exp(significand, power, bits - SIGNIFICAND_BITS);
    } else {
        mpz_mul_2exp(significand, power, SIGNIFICAND_BITS - bits);
    }
    mpz_clear(power);
}

int main(void)
{
    mpz_t significand, half;
    mpz_inits(significand, half, NULL);
    printf("/* Made by lib/number/generate/powers.c. The 128 leading bits of 10^k. */\n");
    printf("enum { POWER_MIN = %d, POWER_MAX = %d };\n", POWER_MIN, POWER_MAX);
    printf("const tm_power tm_powers[POWER_MAX - POWER_MIN + 1] = {\n");
    for (int k = POWER_MIN; k <= POWER_MAX; k++) {
        leading_bits(significand, k);
        if (mpz_sizeinbase(significand, 2) != SIGNIFICAND_BITS ||
            mpz_scan0(significand, 0) >= WORD_BITS) {
            gmp_fprintf(stderr, "powers: 10^%d: unexpected bits: %Zx\n", k, significand);
            return EXIT_FAILURE;
        }
        mpz_fdiv_q_2exp(half, significand, WORD_BITS);
        gmp_printf("    {0x%016Zx, ", half);
        mpz_fdiv_r_2exp(half, significand, WORD_BITS);
        gmp_printf("0x%016Zx}, /* %d */\n", half, k);
    }
    printf("};\n");
    mpz_clears(significand, half, NULL);
    if (fclose(stdout) != 0) {
        fprintf(stderr, "powers: <stdout>: %s\n", strerror(errno));
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
