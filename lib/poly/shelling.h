/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pieces of a mesh that are balls, grown tetrahedron by tetrahedron (shelling). A
 * tetrahedron that shares m faces with the piece is added only if what they share is a
 * disc: for m = 1 its fourth node is not in the piece, for m = 2 its edge in neither
 * shared face is not, for m = 3 always; then a node goes inside. The piece stays a ball.
 *
 * With `star` the piece stays a star, too: shelling_star.h.
 *
 * Several shellings may grow pieces of one mesh at a time (tm_shelling_fork()), each of
 * tetrahedra that no other one takes: they share which piece each tetrahedron is in, of
 * which each asks whether it is its own. With stars by the centroid a piece asks for
 * those beside it; then they are to be grown one after the other. */
#ifndef TM_POLY_SHELLING_H
#define TM_POLY_SHELLING_H

#include "../tet/star.h"
#include "partition.h"

/* A node of the piece that is the `turn`-th to be grown. */
typedef struct tm_shelling_node {
    uint32_t node, turn;
} tm_shelling_node;

typedef struct tm_shelling {
    const tm_tet_mesh *mesh;
    const tm_poly_options *options;
    double (*xyz)[3];      /* [nodes], by a ball scaled: a thin mesh as if it were not */
    uint32_t *piece;       /* [slots]: of each tetrahedron, or TM_NONE */
    tm_shelling_node *has; /* its nodes: a hash table, where other turns are free slots */
    size_t has_room, used;
    uint32_t turn;
    uint32_t id; /* of the piece that is grown */
    size_t size;
    uint32_t *member; /* [size] */
    size_t member_room;
    uint32_t *queue; /* tetrahedra at the piece */
    size_t queued, queue_room;
    double low[3], high[3]; /* the piece is between */
    double origin[3];       /* of what follows */
    double (*centroid)[3];  /* by the centroid: that of each piece */
    double moment[4];       /* by the centroid: that times the volume, and the volume */
    double centre[3];       /* star: a point that is so deep inside of all faces, */
    double depth;           /* or deeper; negative: none is known */
    double (*plane)[4];
    size_t plane_room;
    tm_star star;
} tm_shelling;

/* Nothing is in a piece. tm_shelling_free() also after an error. */
tm_status tm_shelling_start(tm_shelling *s, const tm_tet_mesh *mesh,
                            const tm_poly_options *options, tm_error *error);
void tm_shelling_free(tm_shelling *s);

/* Another one for the pieces of *s, which stays their owner. It is to be ended. */
void tm_shelling_fork(tm_shelling *other, const tm_shelling *s);
void tm_shelling_end(tm_shelling *other);

/* The piece that a tetrahedron is in, while others are grown, too. */
static inline uint32_t tm_piece_of(const uint32_t *piece, uint32_t t)
{
    return __atomic_load_n(&piece[t], __ATOMIC_RELAXED);
}

static inline void tm_set_piece(uint32_t *piece, uint32_t t, uint32_t id)
{
    __atomic_store_n(&piece[t], id, __ATOMIC_RELAXED);
}

/* Begins the piece `id` with tetrahedron t. False where memory is out, as below. */
bool tm_shelling_begin(tm_shelling *s, uint32_t id, uint32_t t);

/* Takes up a piece again, by its tetrahedra. */
bool tm_shelling_resume(tm_shelling *s, uint32_t id, const uint32_t *member, size_t size);

/* Adds what can be added of the tetrahedra with label[t] == name that are in no piece,
 * until nothing can. O(1) for each that is looked at while stars of edges are
 * small; with `star` sometimes O(size). */
bool tm_shelling_grow(tm_shelling *s, const uint32_t *label, uint32_t name);

/* Adds all of some tetrahedra, TM_SHELLING_ADD at most, or none; *taken tells. */
enum { TM_SHELLING_ADD = 8 };
bool tm_shelling_add(tm_shelling *s, const uint32_t *tet, size_t count, bool *taken);

#endif
