/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linear equations with a symmetric, positive definite matrix, solved by CHOLMOD. */
#ifndef TESTS_SOLVE_SYSTEM_H
#define TESTS_SOLVE_SYSTEM_H

#include "../../lib/base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <suitesparse/cholmod.h>

typedef struct linear_system {
    size_t unknowns;
    double *right; /* [unknowns]; after linear_system_solve() the solution */
    cholmod_common common;
    cholmod_triplet *matrix; /* its lower half */
    cholmod_dense *vector;   /* whose values are `right` */
} linear_system;

/* Matrix and right side are 0. linear_system_free() also after an error. */
tm_status linear_system_start(linear_system *s, size_t unknowns, tm_error *error);
void linear_system_free(linear_system *s);

/* Adds to an entry of the matrix; those above the diagonal are known by symmetry and
 * passed over. False where memory is out. */
bool linear_system_add(linear_system *s, size_t row, size_t column, double value);

/* TM_ERROR_SYSTEM where memory is out or the matrix is not positive definite. */
tm_status linear_system_solve(linear_system *s, tm_error *error);

#endif
