/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cheapest of all tetrahedralisations of a small cavity: its boundary stays, nodes
 * inside may be used or left out, none is added. By branch and bound: J. Liu, B. Chen,
 * S. Sun, Small polyhedron reconnection for mesh improvement and its implementation based
 * on advancing front technique, International Journal for Numerical Methods in
 * Engineering 79 (2009); C. Marot, K. Verhetsel, J.-F. Remacle, Reviving the search for
 * optimal tetrahedralizations, Proceedings of the 28th International Meshing Roundtable
 * (2020).
 *
 * The front is the boundary of what is not filled yet. One of its faces is chosen, that
 * with the fewest nodes to join it to, and all of these are tried, the cheapest first.
 * What is found is exact without any test of intersections: tetrahedra that are all
 * positive and whose faces cancel but for the boundary of the cavity cover each of its
 * points once. Intersections are only looked for to give up early. */
#ifndef TM_OPERATION_CAVITY_SEARCH_H
#define TM_OPERATION_CAVITY_SEARCH_H

#include "cavity.h"

/* A cavity has so many nodes, faces, and tetrahedra at most: with v nodes, i of them
 * inside, a ball has 2 (v - i) - 4 faces. */
enum { TM_SEARCH_NODES = 24, TM_SEARCH_FACES = 44, TM_SEARCH_TETS = 80 };

/* Sets of 4 nodes. */
enum { TM_SEARCH_QUADS = 10626 };

typedef struct tm_cavity_search {
    /* The cavity: its nodes, those of its boundary first. (face[f], a point inside) is a
     * positive order; every edge is of two faces. */
    size_t nodes, outer_nodes, faces;
    uint32_t label[TM_SEARCH_NODES]; /* in the mesh */
    double xyz[TM_SEARCH_NODES][3];
    uint8_t face[TM_SEARCH_FACES][3];

    /* What was found. */
    size_t tets;
    uint8_t tet[TM_SEARCH_TETS][4]; /* positive */
    double cost;                    /* of all of them */
    size_t steps;                   /* of the search */

    /* Of the nodes: those that make a positive tetrahedron with three others; those that
     * are not hidden by the boundary from one; of such sets of nodes the bits. */
    uint32_t above[TM_SEARCH_NODES][TM_SEARCH_NODES][TM_SEARCH_NODES];
    uint32_t visible[TM_SEARCH_NODES];
    double cost_of[TM_SEARCH_QUADS]; /* NAN: not known yet */
    /* Of a face that was in the front: the nodes that it may be joined to, where bit
     * TM_SEARCH_NODES says that this is known, and the least that costs. */
    uint32_t candidates[TM_SEARCH_NODES][TM_SEARCH_NODES][TM_SEARCH_NODES];
    double cheapest[TM_SEARCH_NODES][TM_SEARCH_NODES][TM_SEARCH_NODES];
} tm_cavity_search;

/* Takes a cavity of the mesh; false where it is too large, or its boundary touches
 * itself. O(its nodes times tetrahedra). */
bool tm_cavity_search_load(tm_cavity_search *search, const tm_tet_mesh *mesh,
                           const tm_cavity *cavity);

/* Looks for the cheapest one below `most`; each tetrahedron exactly positive and at least
 * `least` good. Gives up after so many steps, with the best that was found by then; false
 * where that is nothing. Deterministic; some 2 µs a step. */
bool tm_cavity_search_run(tm_cavity_search *search, const tm_cost *cost, double least,
                          double most, size_t steps_most);

#endif
