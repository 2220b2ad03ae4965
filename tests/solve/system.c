/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "system.h"

#include <string.h>

tm_status linear_system_start(linear_system *s, size_t unknowns, tm_error *error)
{
    *s = (linear_system){.unknowns = unknowns};
    cholmod_start(&s->common);
    s->matrix =
        cholmod_allocate_triplet(unknowns, unknowns, 1, -1, CHOLMOD_REAL, &s->common);
    s->vector = cholmod_zeros(unknowns, 1, CHOLMOD_REAL, &s->common);
    if (!s->matrix || !s->vector)
        return tm_fail_memory(error);
    s->right = s->vector->x;
    return TM_OK;
}

void linear_system_free(linear_system *s)
{
    cholmod_free_triplet(&s->matrix, &s->common);
    cholmod_free_dense(&s->vector, &s->common);
    cholmod_finish(&s->common);
}

bool linear_system_add(linear_system *s, size_t row, size_t column, double value)
{
    cholmod_triplet *m = s->matrix;
    if (row < column)
        return true;
    if (m->nnz == m->nzmax && !cholmod_reallocate_triplet(2 * m->nnz + 1, m, &s->common))
        return false;
    ((int *)m->i)[m->nnz] = (int)row;
    ((int *)m->j)[m->nnz] = (int)column;
    ((double *)m->x)[m->nnz++] = value;
    return true;
}

tm_status linear_system_solve(linear_system *s, tm_error *error)
{
    cholmod_common *common = &s->common;
    cholmod_sparse *matrix = cholmod_triplet_to_sparse(s->matrix, 0, common);
    cholmod_factor *factor = matrix ? cholmod_analyze(matrix, common) : NULL;
    cholmod_dense *found = NULL;
    if (factor && cholmod_factorize(matrix, factor, common) &&
        common->status == CHOLMOD_OK)
        found = cholmod_solve(CHOLMOD_A, factor, s->vector, common);
    tm_status status = TM_OK;
    if (found)
        memcpy(s->right, found->x, s->unknowns * sizeof *s->right);
    else
        status = tm_fail(error, TM_ERROR_SYSTEM, "CHOLMOD: status %d%s", common->status,
                         common->status == CHOLMOD_NOT_POSDEF
                             ? ", the matrix is not positive definite"
                             : "");
    cholmod_free_dense(&found, common);
    cholmod_free_factor(&factor, common);
    cholmod_free_sparse(&matrix, common);
    return status;
}
