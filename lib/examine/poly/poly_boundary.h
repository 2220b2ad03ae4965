/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A surface of polygons, as the boundary of a polyhedron or of a whole mesh: its edges
 * with the facets at them, its nodes with the fans of facets around them. It may be wrong
 * in any way. */
#ifndef TM_EXAMINE_POLY_BOUNDARY_H
#define TM_EXAMINE_POLY_BOUNDARY_H

#include "../../base/extern_c.h"
#include "../../base/error.h"
#include "../../mesh/poly_arrays.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Faces that have the edge, and in which sense: from end[0] to end[1], or back. */
typedef struct tm_poly_edge {
    uint32_t end[2]; /* nodes of the surface */
    uint32_t along;
    uint32_t against;
    uint32_t corner[2]; /* the first along, the first against; TM_NONE */
    uint32_t at_end[2]; /* a corner at each end */
} tm_poly_edge;

/* Nodes are numbered within the surface, as they come first; corners are those of the
 * faces one after the other. {0} is empty; memory is kept from one surface to the next
 * until tm_poly_boundary_free(). */
typedef struct tm_poly_boundary {
    size_t nodes;
    size_t edges;
    size_t faces;
    size_t corners;
    size_t pieces;        /* connected through edges and nodes */
    uint32_t *node;       /* [nodes]: in the mesh */
    uint32_t *fans;       /* [nodes]: of faces, connected through edges at the node */
    uint32_t *face_start; /* [faces + 1]: the corners of face f are */
    uint32_t *corner;     /* corner[face_start[f] … face_start[f + 1]), nodes here */
    uint32_t *face;       /* [corners]: whose corner it is */
    tm_poly_edge *edge;   /* [edges] */
    uint32_t *slot;       /* hash table of nodes, then of edges */
    uint32_t *parent;     /* a tree for each fan, then for each piece */
    size_t room[8];       /* of the arrays */
} tm_poly_boundary;

void tm_poly_boundary_free(tm_poly_boundary *b);

/* Finds the surface of some facets. They are turned to be seen from within `cell` where
 * that is their second cell; TM_NONE turns none. A turned facet begins with the same
 * node. TM_ERROR_SYSTEM where memory is out or there are 2^31 corners. Expected
 * O(corners). */
tm_status tm_poly_boundary_find(tm_poly_boundary *b, const tm_poly_arrays *mesh,
                                const uint32_t *facet, size_t facets, uint32_t cell,
                                tm_error *error);

/* Whether an edge has two faces, which run along it in opposite senses. */
static inline bool tm_poly_edge_is_good(const tm_poly_edge *e)
{
    return e->along == 1 && e->against == 1;
}

/* What keeps the surface from being a sphere, and what it bounds from being a ball. */
typedef enum tm_poly_cause {
    TM_CAUSE_EDGE,   /* an edge that has not two faces in opposite senses */
    TM_CAUSE_VERTEX, /* the faces at a node are more than one fan: its link is no cycle */
    TM_CAUSE_PIECES, /* it is not connected */
    TM_CAUSE_EULER,  /* nodes - edges + faces is not 2 */
    TM_POLY_CAUSES
} tm_poly_cause;

/* The causes as a set, bit 1 << cause for each; 0: the polyhedron is simple. */
unsigned tm_poly_boundary_causes(const tm_poly_boundary *b);

TM_EXTERN_C_END

#endif
