/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What methods of finite volumes judge the facets and cells of a dual by. */
#ifndef TM_POLY_DUAL_DUAL_MEASURE_H
#define TM_POLY_DUAL_DUAL_MEASURE_H

#include "dual_parts.h"

/* Facets and cells are bad from here on: a little less than what is complained of. */
#define TM_DUAL_BAD 0.9

/* As poly_finite_volume.h defines them. */
typedef struct tm_dual_face {
    double centre[3], area[3];
} tm_dual_face;

typedef struct tm_dual_centre {
    double at[3], volume;
} tm_dual_centre;

typedef struct tm_dual_measures {
    const tm_dual *d;
    tm_dual_face *face;     /* [facets] */
    tm_dual_centre *centre; /* [cells] */
    const tm_block *cell;   /* the facets of cells */
} tm_dual_measures;

void tm_dual_measure_face(const tm_dual *d, size_t f, tm_dual_face *face);
void tm_dual_measure_centre(const tm_dual_measures *m, size_t c, tm_dual_centre *centre);

/* How bad a facet is: the largest of several measures, each 0 or less where it is good
 * and 1 where checkMesh complains. */
double tm_dual_judge_face(const tm_dual_measures *m, size_t f);

/* How far a cell is from being convex, by how the centroids of its facets are to the
 * planes of others: the worst pair, and what all add to *sum. */
double tm_dual_judge_cell(const tm_dual_measures *m, size_t c, double *sum);

/* Whether the pyramid of a facet and its first (0) or second (1) cell has no volume. */
bool tm_dual_is_wrong(const tm_dual_measures *m, size_t f, int side);

#endif
