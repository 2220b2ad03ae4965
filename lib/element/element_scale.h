/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An element moved and scaled so that products of coordinates stay in range. */
#ifndef TM_ELEMENT_ELEMENT_SCALE_H
#define TM_ELEMENT_ELEMENT_SCALE_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { TM_SCALED_NODES = 8 };

/* p[i] = the element's node i less its first; where that is very small or large, times a
 * power of two that brings the largest coordinate into [1/2, 1). False where all nodes
 * are in one place or a difference overflows. */
static inline bool tm_scale_element(double p[TM_SCALED_NODES][3], size_t nodes,
                                    const double (*xyz)[3], const uint32_t *item)
{
    const double small = 1e-40;
    const double large = 1e40;
    double largest = 0;
    for (size_t v = 0; v < nodes; v++) {
        for (size_t i = 0; i < 3; i++) {
            p[v][i] = xyz[item[v]][i] - xyz[item[0]][i];
            const double size = fabs(p[v][i]);
            largest = size > largest ? size : largest;
        }
    }
    if (small < largest && largest < large)
        return true;
    if (!(largest > 0 && isfinite(largest)))
        return false;
    int exponent;
    frexp(largest, &exponent);
    for (size_t v = 0; v < nodes; v++)
        for (size_t i = 0; i < 3; i++)
            p[v][i] = ldexp(p[v][i], -exponent);
    return true;
}

#endif
