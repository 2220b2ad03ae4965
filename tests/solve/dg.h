/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The symmetric interior penalty method with a linear function for each polyhedron, four
 * unknowns, for Poisson's equation:
 *
 *   Σ_cells ∫ ∇u·∇v - Σ_facets ∫ {∇u}·[v] + {∇v}·[u] - σ [u]·[v] = ∫ f v
 *
 * with the mean {} and the jump [] of both sides. On the boundary the values are the
 * solution's, by the same terms (Nitsche). σ is 3/2 of the larger surface by volume of
 * both cells, and on the boundary 3 of it: gradients are constant, so |f| |∇v|² =
 * |f| / |cell| ∫ |∇v|², and 1/2 and 1 would do for the form to be positive, as summing
 * over the facets f of a cell shows. So the method takes polyhedra of any shape, as they
 * come, for a facet as many times as it has triangles.
 *
 * D. N. Arnold, An interior penalty finite element method with discontinuous elements,
 * SIAM Journal on Numerical Analysis 19 (1982); the penalty as K. Shahbazi, An explicit
 * expression for the penalty parameter of the interior penalty method, Journal of
 * Computational Physics 205 (2005), has it for simplices; on polyhedra A. Cangiani, E. H.
 * Georgoulis, P. Houston, hp-version discontinuous Galerkin methods on polygonal and
 * polyhedral meshes, M3AS 24 (2014). */
#ifndef TESTS_SOLVE_DG_H
#define TESTS_SOLVE_DG_H

#include "mesh.h"
#include "solution.h"

/* Solves the equation; what was found to found[cells], how many unknowns there were to
 * *unknowns. */
tm_status dg_solve(solve_cell *found, size_t *unknowns, const solve_mesh *mesh,
                   const solution *exact, tm_error *error);

#endif
