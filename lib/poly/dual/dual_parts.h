/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of the dual share.
 *
 * A piece is what of a tetrahedron is next to one of its corners: 4t + i for corner i.
 * Cells are sets of pieces at one node. A wall is a face of tetrahedra with a point on
 * it: on the boundary, between cells of a node; what of it is next to corner j is the
 * quad 3 wall + j: the node, the middles of two edges, the point. A spoke is half an edge
 * at which there are quads: from a node to the middle. */
#ifndef TM_POLY_DUAL_DUAL_PARTS_H
#define TM_POLY_DUAL_DUAL_PARTS_H

#include "../../geom/vector.h"
#include "../../tet/star.h"
#include "dual.h"

/* How a node is cut. */
typedef enum tm_dual_level {
    TM_DUAL_WHOLE,  /* a cell for each fan */
    TM_DUAL_TO_CUT, /* the next one, but still to be done */
    TM_DUAL_CUT,    /* cells are cut at edges that are bent inward */
    TM_DUAL_TO_CUT_MORE,
    TM_DUAL_CUT_MORE, /* at all such edges */
    TM_DUAL_PIECES,   /* a cell for each tetrahedron */
    TM_DUAL_LEVELS
} tm_dual_level;

/* An edge with walls. */
typedef struct tm_dual_edge {
    uint32_t node[2];
    uint32_t half;  /* of a wall with a quad at it */
    uint32_t faces; /* how many walls have one */
    bool real[2];   /* the spoke at node[i] is an edge of facets */
    bool constrained;
    int32_t marker; /* of .edge, or of a face at it */
    bool listed;    /* .edge has it */
    bool marked;    /* with a marker that keeps it */
    uint32_t point; /* TM_NONE: the middle is in no facet */
} tm_dual_edge;

typedef struct tm_dual_wall {
    uint32_t half;    /* 4t + i, one of the two sides */
    bool constrained; /* the face has to stay */
    bool quad[3];     /* which corners of it are between two cells, or on the boundary */
    int32_t marker;
    uint32_t point;
    uint32_t edge[3]; /* opposite corner j; TM_NONE where both ends have no quad */
} tm_dual_wall;

/* Where a point is. */
typedef enum tm_dual_place {
    TM_DUAL_IN_TET,  /* of: the tetrahedron */
    TM_DUAL_IN_FACE, /* the wall */
    TM_DUAL_ON_EDGE, /* the edge */
    TM_DUAL_AT_NODE  /* the node */
} tm_dual_place;

typedef struct tm_dual_point {
    uint8_t place;
    uint32_t of;
} tm_dual_point;

/* Walls in the order of their halves, edges by their nodes; xyz[point]. */
typedef struct tm_dual_kept {
    tm_dual_wall *wall;
    size_t walls;
    tm_dual_edge *edge;
    tm_edge_map edge_of;
    double (*xyz)[3];
} tm_dual_kept;

typedef struct tm_dual {
    const tm_tet_mesh *mesh;
    const tm_dual_options *options;
    double flatness;
    double cosine;  /* of the feature angle */
    uint8_t *level; /* [nodes]: tm_dual_level */
    uint8_t *cuts; /* [pieces]: bit k: the face opposite corner k is cut at the piece's */
    bool has_cuts; /* faces that need not stay may be between cells of a node */
    size_t cut_nodes;
    size_t most;   /* of the report's work */
    bool spent;    /* no more points are moved */
    size_t late;   /* rounds since then */
    bool again;    /* there are nodes to be cut */
    bool *touched; /* [nodes]: has constrained faces or is cut */

    uint32_t *cell; /* [pieces] */
    size_t cells;
    uint32_t *cell_node; /* [cells] */

    tm_dual_wall *wall;
    size_t walls, wall_room;
    tm_dual_edge *edge;
    size_t edges, edge_room;
    tm_edge_map edge_of;
    uint32_t *following;  /* [3 walls]: the quad that continues one, at its last spoke */
    bool *begins;         /* [3 walls]: nothing is before it */
    uint32_t *face_point; /* [4 tetrahedra]: of the wall there, or TM_NONE */
    uint32_t *node_point; /* [nodes] */
    uint32_t *quad_start, *quad_of; /* the quads at a node; [nodes + 1] */

    /* Points: first those in tetrahedra. */
    size_t points, point_room, xyz_room;
    tm_dual_point *point;
    double (*xyz)[3];     /* [points] */
    double (*tet_xyz)[3]; /* [tetrahedra]: where the points in them were put last */
    uint8_t *frozen;      /* [tetrahedra]: that is the centroid */

    /* Where the points of walls and edges were, when the dual was built before. */
    tm_dual_kept kept;

    tm_block facet;
    size_t facets, items, facet_room, marker_room, start_room, item_room;
} tm_dual;

#endif
