/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random numbers of the tests: the seed is TM_SEED of the environment or new in each
 * run, and printed, so that a failure can be had again. */
#ifndef TESTS_UNIT_RANDOM_H
#define TESTS_UNIT_RANDOM_H

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static uint64_t random_state;

static inline void random_start(void)
{
    const char *seed = getenv("TM_SEED");
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    random_state =
        seed ? strtoull(seed, NULL, 0) : (uint64_t)now.tv_sec ^ (uint64_t)now.tv_nsec;
    printf("TM_SEED=%" PRIu64 "\n", random_state);
}

/* 64 random bits: SplitMix64 (Steele, Lea, Flood, OOPSLA 2014). */
static inline uint64_t random_bits(void)
{
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* In 0 … count-1. */
static inline unsigned random_below(unsigned count)
{
    return (unsigned)(random_bits() % count);
}

/* Uniform in [0, 1). */
static inline double random_unit(void)
{
    return (double)(random_bits() >> 11) * 0x1p-53;
}

#endif
