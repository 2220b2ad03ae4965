/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nodes of polyhedra moved until a finite volume method can use them: what OpenFOAM's
 * checkMesh -allGeometry minds, it no longer finds. */
#ifndef TM_POLY_FIT_H
#define TM_POLY_FIT_H

#include "../../base/extern_c.h"
#include "../../base/error.h"
#include "../../mesh/poly_arrays.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

/* What can be wrong. */
typedef enum tm_fit_fault {
    TM_FIT_PYRAMID,    /* a facet and the centroid of a cell beside it: its pyramid is not
                          of positive volume */
    TM_FIT_TETRAHEDRA, /* a facet has no node from which its triangles make tetrahedra of
                          positive volume with both centroids */
    TM_FIT_CONCAVE,    /* a cell has facets with another's centroid beyond their plane */
    TM_FIT_OBLIQUE,    /* a facet is more than 70 degrees from normal to the line between
                          the centroids */
    TM_FIT_SKEW,       /* that line misses its centroid by more than 4 times its extent */
    TM_FIT_UNEVEN,  /* … or it is 19 times as far from one of them as from the other */
    TM_FIT_UNEQUAL, /* of the cells beside a facet one is 100 times as large */
    TM_FIT_UNDETERMINED, /* the inner facets of a cell are all in nearly one direction */
    TM_FIT_FAULTS
} tm_fit_fault;

typedef struct tm_fit_report {
    size_t before[TM_FIT_FAULTS], after[TM_FIT_FAULTS];
    size_t moved; /* nodes, as often as they were */
    size_t work;  /* corners of facets that were judged because a node was tried */
} tm_fit_report;

typedef struct tm_fit_options {
    const bool *fixed; /* [nodes]: these stay */
    /* [nodes], or NULL: where a node moves: in the simplex of these points, those before
     * TM_NONE, with barycentric coordinates of at least `least`; without one, anywhere.
     */
    const uint32_t (*corner)[4];
    const double (*point)[3];
    double least;
    bool convex; /* concave cells are faults */
    int rounds;  /* at most */
    size_t work; /* no more nodes are tried after so much; 0: any */
} tm_fit_options;

/* Moves nodes of facets and cells with faults, or nearly so, by pattern search. A step is
 * taken only if around the node no fault of any kind becomes more, and what is missing in
 * all of them together becomes less. xyz is mesh->xyz. TM_ERROR_SYSTEM where memory is
 * out; xyz is then as good as it has become. O(facets), and for each node that is tried
 * O(facets of its cells), some 0.03 ms. */
tm_status tm_polyhedra_fit(const tm_poly_arrays *mesh, double (*xyz)[3],
                           const tm_fit_options *options, tm_fit_report *report,
                           tm_error *error);

/* How many faults there are still. */
size_t tm_fit_faults_left(const tm_fit_report *report);

/* Writes which, as "3 pyramids of no volume, 1 concave cell", or nothing; what is longer
 * than size - 1 is cut off. */
void tm_fit_faults_say(const tm_fit_report *report, char *text, size_t size);

TM_EXTERN_C_END

#endif
