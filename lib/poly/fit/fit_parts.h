/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of tm_polyhedra_fit(): fit_measure.c measures, fit.c moves nodes. */
#ifndef TM_POLY_FIT_PARTS_H
#define TM_POLY_FIT_PARTS_H

#include "fit.h"

#include <stdint.h>

typedef struct tm_fit_facet {
    double centre[3], area[3]; /* outward from its first cell */
} tm_fit_facet;

typedef struct tm_fit_cell {
    double centre[3], volume;
} tm_fit_cell;

/* A mesh with the centroids of its facets and cells. */
typedef struct tm_fit_mesh {
    const tm_poly_arrays *mesh;
    tm_fit_facet *facet; /* [facets] */
    tm_fit_cell *cell;   /* [cells] */
} tm_fit_mesh;

/* Faults by their kind, and what all together are short of being none. */
typedef struct tm_fit_sum {
    size_t count[TM_FIT_FAULTS];
    double missing;
} tm_fit_sum;

void tm_fit_measure_facet(const tm_fit_mesh *m, size_t f);
/* Of its facets, as they were measured. */
void tm_fit_measure_cell(const tm_fit_mesh *m, size_t c);

/* Add the faults of a facet, and of a cell alone. */
void tm_fit_judge_facet(const tm_fit_mesh *m, size_t f, tm_fit_sum *sum);
void tm_fit_judge_cell(const tm_fit_mesh *m, size_t c, tm_fit_sum *sum);

#endif
