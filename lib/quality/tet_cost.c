/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_cost.h"

bool tm_cost_allows(const tm_cost *cost, const double a[3], const double b[3],
                    const double c[3], const double d[3])
{
    double angle[TM_TET_EDGES];
    tm_tet_dihedrals(a, b, c, d, angle);
    for (int e = 0; e < TM_TET_EDGES; e++)
        if (angle[e] < cost->least_angle || angle[e] > cost->most_angle)
            return false;
    return true;
}
