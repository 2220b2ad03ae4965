/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points and weights for integrals over polyhedra and their facets, by the Gauss-Legendre
 * rule with three points on the collapsed cube (A. H. Stroud, Approximate calculation of
 * multiple integrals, 1971, conical products): exact for polynomials of third degree in
 * cells, of fourth on facets. Cells are pyramids of their centroid, with signs: points
 * may be outside of a cell that is no star, where integrands have to go on. */
#ifndef TESTS_SOLVE_QUADRATURE_H
#define TESTS_SOLVE_QUADRATURE_H

#include "mesh.h"

/* {0} is empty; memory is kept from one to the next. */
typedef struct quadrature {
    size_t count;
    double (*x)[3];
    double *weight;
    double (*normal)[3]; /* on facets: the weight times the triangle's own normal */
    size_t room[3];
} quadrature;

void quadrature_free(quadrature *q);

/* Fill q; false where memory is out. O(corners). */
bool quadrature_of_cell(quadrature *q, const solve_mesh *mesh, size_t c);
bool quadrature_of_facet(quadrature *q, const solve_mesh *mesh, size_t f);

#endif
