/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Items in the order of a space-filling curve (the Z curve of G. M. Morton, 1966): what
 * is near in space comes near in the order, so that work in this order finds its memory
 * in the cache. */
#ifndef TM_GEOM_SPACE_ORDER_H
#define TM_GEOM_SPACE_ORDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A cube around points, that the curve fills with 1024³ cells. */
typedef struct tm_space {
    double low[3];
    double cells; /* per unit of length */
} tm_space;

typedef struct tm_curve_point {
    uint32_t position; /* on the curve */
    uint32_t item;
} tm_curve_point;

tm_space tm_space_around(const double (*xyz)[3], size_t count);

/* The same around the points of a box; around none where low is above high. */
tm_space tm_space_of_box(const double low[3], const double high[3]);

/* Makes a box larger by points; NaN counts for nothing. */
void tm_box_extend(double low[3], double high[3], const double p[3]);

/* The position of a point on the curve; the nearest end for points outside. */
uint32_t tm_space_position(const tm_space *space, const double p[3]);

/* Sorts by position; what has the same stays in its order. False where memory is out.
 * O(count), by several threads. */
bool tm_space_sort(tm_curve_point *point, size_t count, unsigned threads);

#endif
