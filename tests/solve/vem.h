/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Virtual elements of lowest order on polyhedra, for Poisson's equation. Their functions
 * are given by their values at the nodes; what they are inside is never known, only their
 * projections on linear functions, and these exactly:
 *
 *   on a facet    the gradient's mean by integrals along the edges, where functions are
 *                 linear; the projection's integral is taken for the function's own
 *   in the cell   the gradient's mean by those integrals over the facets
 *
 * Exact for linear functions wherever facets are plane and close the cell; neither has to
 * be convex. The stiffness is that of the projections, and to stabilise it the values at
 * the nodes of what is not projected, times the diameter (The hitchhiker's guide to the
 * virtual element method, M3AS 24, 2014, the choice "dofi-dofi").
 *
 * The sources: L. Beirão da Veiga, F. Brezzi, A. Cangiani, G. Manzini, L. D. Marini, A.
 * Russo, Basic principles of virtual element methods, M3AS 23 (2013), and with the
 * facets' integrals B. Ahmad, A. Alsaedi, F. Brezzi, L. D. Marini, A. Russo, Equivalent
 * projectors for virtual element methods, Computers & Mathematics with Applications 66
 * (2013); in three dimensions A. L. Gain, C. Talischi, G. H. Paulino, On the virtual
 * element method for three-dimensional linear elasticity problems on arbitrary polyhedral
 * meshes, CMAME 282 (2014). */
#ifndef TESTS_SOLVE_VEM_H
#define TESTS_SOLVE_VEM_H

#include "mesh.h"
#include "solution.h"

/* Solves the equation with the solution's values at the nodes of the boundary; the
 * projections to found[cells]. The unknowns, *unknowns of them, are the values at the
 * nodes inside that facets have. */
tm_status vem_solve(solve_cell *found, size_t *unknowns, const solve_mesh *mesh,
                    const solution *exact, tm_error *error);

#endif
