/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Known solutions u of Poisson's equation -Δu = f, and how far from one is what a method
 * has found. */
#ifndef TESTS_SOLVE_SOLUTION_H
#define TESTS_SOLVE_SOLUTION_H

#include "mesh.h"

typedef struct solution {
    double (*u)(const double x[3]);
    double (*f)(const double x[3]);
    void (*gradient)(const double x[3], double g[3]);
} solution;

/* u = 1 + 2x - 3y + z/2: every method has to find it but for rounding, the patch test. */
extern const solution solution_linear;

/* u = sin 2x · cos 3y · exp z. */
extern const solution solution_wave;

/* In a cell a method of lowest order has a linear function: its value at the cell's
 * centroid, and its gradient. */
typedef struct solve_cell {
    double value;
    double gradient[3];
} solve_cell;

/* Relative to the norms of the solution and of its gradient; H1 is of gradients alone,
 * cell by cell. */
typedef struct solve_errors {
    double l2;
    double h1;
} solve_errors;

/* Compares the functions found[cells] with the solution. O(corners). */
tm_status solution_errors(solve_errors *errors, const solution *exact,
                          const solve_mesh *mesh, const solve_cell *found,
                          tm_error *error);

#endif
