/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Streams that are damaged, or whole but strange. */
#ifndef TESTS_FUZZ_DAMAGE_H
#define TESTS_FUZZ_DAMAGE_H

#include "../../lib/text/text.h"

#include <stdint.h>

/* Appends the stream of that seed and number to *text; the same every time. */
void make_damaged(tm_text *text, uint64_t seed, uint64_t number);

#endif
