/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen_orient.h"

#include "../geom/predicates.h"

tm_turned tm_tetgen_orient(const tm_block *node, tm_block *ele)
{
    enum { CORNERS = 4 };
    tm_turned result = {0};
    const double *xyz = node->real;
    for (size_t t = 0; t < ele->count; t++) {
        uint32_t *v = ele->integer + CORNERS * t;
        const double *corner[CORNERS];
        for (int i = 0; i < CORNERS; i++)
            corner[i] = xyz + (size_t)v[i] * 3;
        int sign = tm_orient3d(corner[0], corner[1], corner[2], corner[3]);
        if (sign < 0) {
            uint32_t last = v[3];
            v[3] = v[2];
            v[2] = last;
            result.turned++;
        } else if (sign == 0) {
            result.flat++;
        }
    }
    return result;
}
