/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cavity that a node takes in a Delaunay mesh: its ball, and what is reached from
 * there without crossing a face that stays and has the node strictly inside its sphere.
 * (A. Bowyer, Computing Dirichlet tessellations; D. F. Watson, Computing the
 * n-dimensional Delaunay tessellation; both The Computer Journal 24 (1981).) */
#ifndef TM_DELAUNAY_DELAUNAY_CAVITY_H
#define TM_DELAUNAY_DELAUNAY_CAVITY_H

#include "../operation/ball.h"
#include "delaunay.h"
#include "../../mesh/edge_map.h"
#include "../star.h"

/* A face of the cavity: (node[0], node[1], node[2], the node) will be a tetrahedron. */
typedef struct tm_delaunay_face {
    uint32_t node[3];
    uint32_t half, beyond; /* the half face in the cavity, and its neighbour entry */
    /* Across the side face opposite node[i]: 4 × another face + its i, or a constrained
     * face of the cavity with TM_FACE_BIT. */
    uint32_t partner[3];
} tm_delaunay_face;

/* A constrained face at a tetrahedron of the cavity. Those at the node are open: the
 * tetrahedra on them are made new. So are those that continue their facet, which the node
 * takes in the same way in its plane; the node becomes a corner of theirs. */
typedef struct tm_delaunay_constrained {
    uint32_t face;
    uint32_t node[3]; /* it is to have */
    unsigned sides;   /* of it in the cavity */
    unsigned joined;  /* new tetrahedra on it */
    bool open;
} tm_delaunay_constrained;

/* The cavity with all that finding it needs; {0} but for the flatness of facet.h. */
typedef struct tm_delaunay_cavity {
    double flatness;
    tm_delaunay_report report;

    uint32_t node;
    uint32_t edge[2]; /* that the node is to split, or TM_NONE */
    uint32_t *tet;    /* the ball of the node comes first */
    size_t size, ball;
    bool is_cut_back; /* a tetrahedron was left out whose sphere holds the node */
    tm_delaunay_face *face;
    size_t faces;
    tm_delaunay_constrained *constrained;
    size_t constrained_count;

    tm_tet_marks inside, left_out;
    bool only_ball, no_facets; /* how a cavity that does not fit is tried again */
    tm_edge_map side;          /* edges of the faces: the first new side face there */
    tm_tet_marks seen;         /* nodes of the faces */
    size_t tet_room, face_room, constrained_room;
} tm_delaunay_cavity;

void tm_delaunay_cavity_free(tm_delaunay_cavity *cavity);

/* Finds the cavity of a node, of which ball[0 … count) are all tetrahedra. The node sees
 * all faces from inside, exactly, as it must see those of its ball: tetrahedra are left
 * out until it does. All nodes, and all edges with a marker, are at a face or the node. A
 * cavity as large as the ball needs no change. False where memory is out. Expected O(n)
 * for n tetrahedra. */
bool tm_delaunay_cavity_find(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh,
                             uint32_t node, const uint32_t *ball, size_t count);

/* The same before the node is there, to see whether it would be cut back: it is to split
 * the edge of a star, and mesh->xyz[node] is its place already. */
bool tm_delaunay_cavity_foresee(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh,
                                uint32_t node, const tm_star *star);

/* Whether all faces between the tetrahedra that the node will have are locally Delaunay.
 * Without constrained faces they always are; but not every point can be inserted where
 * some are, for not every surface is that of a constrained Delaunay mesh. */
bool tm_delaunay_cavity_is_delaunay(const tm_delaunay_cavity *cavity,
                                    const tm_tet_mesh *mesh);

/* Adds what was found to the report; before the mesh is changed. */
void tm_delaunay_cavity_count(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh);

#endif
