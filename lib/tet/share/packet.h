/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A part of tm_tet_share_deal(): what goes from rank to rank. Nodes are numbers in the
 * list of nodes that goes to the same rank. */
#ifndef TM_TET_SHARE_PACKET_H
#define TM_TET_SHARE_PACKET_H

#include "share.h"

typedef struct packed_tet {
    uint32_t node[4];
    uint32_t key, index;
    uint8_t locked; /* bit e: edge e is */
} packed_tet;

typedef struct packed_node {
    double xyz[3];
    uint32_t number;
    int32_t marker;
    bool due;
} packed_node;

/* A face that stays, as one tetrahedron has it. */
typedef struct packed_face {
    uint32_t half; /* of the tetrahedra that go to the same rank */
    uint32_t node[3];
    int32_t marker;
    uint8_t side; /* which one the half face is */
    bool listed, has_other;
} packed_face;

typedef struct packed_edge {
    uint32_t node[2];
    int32_t marker;
} packed_edge;

enum { TETS, NODES, FACES, EDGES, LISTS };

/* What goes to all ranks, or came from all, one after the other. */
typedef struct packet {
    packed_tet *tet;
    double *region; /* [tets][regions] */
    packed_node *node;
    double *attribute; /* [nodes][attributes] */
    packed_face *face;
    packed_edge *edge;
    size_t *count[LISTS]; /* [ranks] */
    size_t all[LISTS], room[LISTS];
} packet;

/* The edges of a tetrahedron, as `locked` counts them. */
extern const uint8_t tm_packed_edge_end[6][2];

bool tm_packet_start(packet *p);
void tm_packet_free(packet *p);

/* Lists what the deal gives; false where memory is out. */
bool tm_packet_fill(packet *p, const tm_tet_share *share, const tm_tet_deal *deal);

/* Makes an empty share what came; `like` says what its rows have, and whether it is
 * connected: its pointers are not followed. */
tm_status tm_packet_unpack(const packet *p, const tm_tet_mesh *like, tm_tet_share *to,
                           tm_error *error);

#endif
