/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The virtual element of lowest order on one polyhedron, for Poisson's equation. Its
 * functions are given by their values at the nodes; what they are inside is never known,
 * only their projections on linear functions, and these exactly:
 *
 *   on a facet    the gradient's mean by integrals along the edges, where functions are
 *                 linear; the projection's integral is taken for the function's own
 *   in the cell   the gradient's mean by those integrals over the facets
 *
 * Exact for linear functions wherever facets are plane and close the cell; neither has to
 * be convex. The sources: L. Beirão da Veiga, F. Brezzi, A. Cangiani, G. Manzini, L. D.
 * Marini, A. Russo, Basic principles of virtual element methods, M3AS 23 (2013), and with
 * the facets' integrals B. Ahmad, A. Alsaedi, F. Brezzi, L. D. Marini, A. Russo,
 * Equivalent projectors for virtual element methods, Computers & Mathematics with
 * Applications 66 (2013); in three dimensions A. L. Gain, C. Talischi, G. H. Paulino, On
 * the virtual element method for three-dimensional linear elasticity problems on
 * arbitrary polyhedral meshes, CMAME 282 (2014). */
#ifndef TESTS_VEM_ELEMENT_H
#define TESTS_VEM_ELEMENT_H

#include "../../lib/stream/stream.h"

typedef struct vem_mesh {
    size_t nodes;
    const double (*xyz)[3];
    const tm_block *facet, *cell;
} vem_mesh;

typedef struct vem_element {
    size_t nodes;
    uint32_t *node;        /* [nodes]: of the mesh, each once */
    double (*place)[3];    /* [nodes]: from the mean of all, `origin` */
    double (*gradient)[3]; /* [nodes]: of the projection of each node's function */
    double origin[3];      /* of the mesh's coordinates */
    double volume;         /* negative where the cell is inside out */
    double centroid[3];    /* from the origin */
    double diameter;       /* the largest distance of two nodes */
    double product[3][3];  /* the sum of place × place over the nodes */
    uint32_t *local;       /* [of the mesh]: the place in node[], or TM_NONE */
    double *weight;        /* [nodes of the largest facet]: those of one facet */
    size_t room;           /* of node, place and gradient */
} vem_element;

/* An element for the cells of a mesh; vem_element_free() also after an error. */
tm_status vem_element_start(vem_element *e, const vem_mesh *mesh, tm_error *error);
void vem_element_free(vem_element *e);

/* Sets it to the cell c. TM_ERROR_INPUT where a facet does not name the cell, or where
 * the volume is not positive. O(nodes²), by the diameter. */
tm_status vem_element_set(vem_element *e, const vem_mesh *mesh, size_t c,
                          tm_error *error);

/* The stiffness between its nodes i and j: the projections' part, and the stabilisation
 * by the values of what is not projected, times the diameter (The hitchhiker's guide to
 * the virtual element method, M3AS 24, 2014, the choice "dofi-dofi"). O(1). */
double vem_stiffness(const vem_element *e, size_t i, size_t j);

/* The integral of node i's projected function over the cell. O(1). */
double vem_integral(const vem_element *e, size_t i);

#endif
