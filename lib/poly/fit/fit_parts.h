/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of tm_polyhedra_fit(): fit_judge.c judges, fit.c moves nodes. */
#ifndef TM_POLY_FIT_PARTS_H
#define TM_POLY_FIT_PARTS_H

#include "../../examine/poly/poly_all_geometry.h"
#include "fit.h"

#include <stdint.h>

/* Faults by their kind, and what all together are short of being none. */
typedef struct tm_fit_sum {
    size_t count[TM_FIT_FAULTS];
    double missing;
} tm_fit_sum;

/* Add the faults of a facet, and of a cell alone. */
void tm_fit_judge_facet(const tm_poly_centroids *m, size_t f, tm_fit_sum *sum);
void tm_fit_judge_cell(const tm_poly_centroids *m, size_t c, tm_fit_sum *sum);

#endif
