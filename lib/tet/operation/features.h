/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What must not move: the surface of a mesh, which is its boundary, the faces between its
 * regions, and marked faces inside. Without a tolerance it stays exactly where it is:
 * corners, straight edges and flat facets. With one it stays within an envelope: corners,
 * curves, and patches between these. */
#ifndef TM_OPERATION_FEATURES_H
#define TM_OPERATION_FEATURES_H

#include "../envelope/envelope.h"
#include "../surface_limits.h"
#include "../star.h"
#include "ball.h"

typedef struct tm_features {
    size_t room;
    uint8_t *dimension;  /* of what a node may move in: 3 inside, 2 a flat facet or a
                            patch,  1 a straight feature edge or a curve, 0 nothing */
    uint32_t (*line)[2]; /* of a node with dimension 1: its neighbours on the edge; on a
                            curve in the order of that */
    double flatness;     /* points that are this near to a plane are in it */
    bool may_move;       /* within the envelope */
    tm_envelope envelope;
} tm_features;

/* Finds them. Without a tolerance (limits NULL, or 0) two triangles are in one facet if
 * they have the same marker and are coplanar but for the rounding of coordinates; an edge
 * that is not between two such ones, or has a marker, is a feature edge; with one, see
 * envelope.h. Nodes also stay where they are if the mesh only touches itself there, if
 * they are inside and have a marker, or if their marker is not that of their neighbours
 * in the facet or on the edge. Expected O(n). */
tm_status tm_features_find(tm_features *features, const tm_tet_mesh *mesh,
                           const tm_surface_limits *limits, tm_tet_marks *marks,
                           tm_error *error);
void tm_features_free(tm_features *features);

/* The same of a part of a mesh that has that flatness; of nodes all of whose tetrahedra
 * are in it, if no marker differs from that of a neighbour. */
tm_status tm_features_find_in_part(tm_features *features, const tm_tet_mesh *part,
                                   double flatness, tm_tet_marks *marks, tm_error *error);

/* Room for so many nodes, and faces, in all; false where memory is out. */
bool tm_features_reserve(tm_features *features, size_t nodes, size_t faces);

/* Makes *to, which is {0} or was found, the same as *from; false, with *to as it
 * was, where memory is out. */
bool tm_features_copy(tm_features *to, const tm_features *from);

/* Makes a node of *to what it is in *from; both have room for it. */
void tm_features_copy_node(tm_features *to, const tm_features *from, uint32_t node);

/* How the node of a ball may move. */
tm_freedom tm_features_freedom(const tm_features *features, const tm_tet_mesh *mesh,
                               const tm_ball *ball);

/* What an edge is in. */
typedef enum tm_edge_class {
    TM_EDGE_INSIDE,
    TM_EDGE_IN_FACET,  /* of two flat faces */
    TM_EDGE_OF_FEATURE /* has to stay */
} tm_edge_class;

/* Where the edge of a star is. constrained[0] and constrained[1] are the two faces of
 * TM_EDGE_IN_FACET, as the places in the ring of their third nodes. */
tm_edge_class tm_features_classify(const tm_features *features, const tm_tet_mesh *mesh,
                                   const tm_star *star, size_t constrained[2]);

/* A new node was put inside, or on the edge ab, which was in the place. */
void tm_features_classify_node(tm_features *features, uint32_t node, tm_edge_class place,
                               uint32_t a, uint32_t b);

/* Node a of a feature edge goes, and its neighbour b is joined to the one beyond. There
 * is room for that after tm_features_reserve(). */
void tm_features_join(tm_features *features, uint32_t a, uint32_t b);

/* The neighbour of node a, which is on a feature edge, that is not b. */
uint32_t tm_features_beyond(const tm_features *features, uint32_t a, uint32_t b);

/* What an edge stands for of a curve of the envelope: between two places on it, in order.
 */
typedef struct tm_curve_part {
    uint32_t curve;
    uint32_t node[2]; /* the ends of the edge in the order of the curve */
    double place[2];  /* of a closed curve the second may be one time around more */
} tm_curve_part;

/* Finds that; false where the edge is on no curve. */
bool tm_features_part(const tm_features *features, uint32_t a, uint32_t b,
                      tm_curve_part *part);

/* Node v is at that place of its curve. */
void tm_features_put(tm_features *features, uint32_t v, uint32_t curve, double place);

#endif
