/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Items in the order of their places: by x, then y, then z; what is at one place by its
 * number. What is at the same place comes together, and nothing depends on how it was
 * numbered. */
#ifndef TM_GEOM_PLACE_ORDER_H
#define TM_GEOM_PLACE_ORDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct tm_placed {
    double xyz[3];
    uint32_t item;
} tm_placed;

/* O(count log count). */
void tm_place_sort(tm_placed *placed, size_t count);

/* rank[i] is how many of the points come before xyz[i] in that order. False where memory
 * is out. O(count log count), by several threads. */
bool tm_place_rank(const double (*xyz)[3], size_t count, unsigned threads,
                   uint32_t *rank);

#endif
