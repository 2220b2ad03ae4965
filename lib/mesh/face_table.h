/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who shares a face: which elements have it, and which rows of .face and .facet name it;
 * node by node, each face at the smallest one of its nodes.
 *
 * Two faces are the same if they have the same nodes in the same cyclic order, from
 * wherever and in whichever sense. Those that have one are its members: half faces and
 * rows. A half face is a face of an element: that of tetrahedra alone is 4t + i, opposite
 * to corner i, tm_face_corner[i]; that of mixed elements is 8e + i, face[i] in shape.h.
 * An element that names a node twice has none. */
#ifndef TM_MESH_FACE_TABLE_H
#define TM_MESH_FACE_TABLE_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "../base/hash.h"
#include "mesh_view.h"

#include <stdbool.h>

TM_EXTERN_C_BEGIN

/* A half face, or row r of .face as first_row + r, and those of .facet after them. It is
 * turned if the larger one of the nodes beside the smallest one follows it, seen from
 * outside of a positive element. */
typedef struct tm_face_member {
    uint32_t id;
    uint32_t next; /* in member[]; TM_FACE_END */
    bool turned;
} tm_face_member;

#define TM_FACE_END UINT32_MAX

/* A face without its smallest node v. */
typedef struct tm_face {
    uint64_t beside;   /* the nodes next to v, the smaller one << 32 | the other */
    uint32_t opposite; /* to v in a quadrilateral; TM_NONE: a triangle */
    uint32_t first;    /* in member[]: elements in ascending order, then rows */
    uint32_t last;
    uint32_t elements;
} tm_face;

typedef struct tm_face_table {
    const tm_mesh_view *mesh;
    unsigned shift;     /* half face i of element e: e << shift | i */
    uint32_t first_row; /* elements << shift */
    size_t *start;      /* [nodes + 1]: what has faces at v is */
    uint32_t *item;     /* item[start[v] … start[v + 1]) */
    bool shared;        /* these are another table's */
    /* The faces at the node that tm_face_table_at() was last called for. */
    size_t faces;
    tm_face *face;
    size_t members;
    tm_face_member *member;
    tm_hash_table hash;
    size_t face_room, member_room, slot_room;
} tm_face_table;

/* Prepares *table for all elements, and all rows of three nodes or of four different
 * ones: those that name a node twice share no face with an element. TM_ERROR_SYSTEM where
 * memory is out or there are 2^31 members. The view has to stay as long as the table;
 * tm_face_table_free() also after an error. Up to 8 of threads >= 1 look at all elements
 * each, and list what is at a part of the nodes. O(nodes + members). */
tm_status tm_face_table_make(tm_face_table *table, const tm_mesh_view *mesh,
                             unsigned threads, tm_error *error);
void tm_face_table_free(tm_face_table *table);

/* A table with the lists of another one, which has to stay as long, and faces of its own:
 * for another thread. */
void tm_face_table_share(tm_face_table *table, const tm_face_table *other);

/* Cuts the nodes into runs with about as many members each: run i is of the nodes from
 * cut[i] up to cut[i + 1]. O(runs log nodes). */
void tm_face_table_cut(const tm_face_table *table, size_t runs, uint32_t *cut);

/* Finds the faces at node v, in no particular order. Expected O(k) for k members;
 * TM_ERROR_SYSTEM where memory is out. */
tm_status tm_face_table_at(tm_face_table *table, uint32_t v, tm_error *error);

/* Puts them in ascending order of their nodes, as tm_face_others() gives them.
 * O(k log k). */
void tm_face_table_sort(tm_face_table *table);

/* (*mate)[half]: the other one of the two half faces that share a face, or itself where
 * there is no other; of three, the first two are mates, and the others have TM_NONE, as
 * have those that are none. (*mate)[tm_half_faces() + row]: the first half face of the
 * face that a row of .face or .facet names; TM_NONE. malloc'ed. Expected O(nodes +
 * members). */
tm_status tm_face_mates(uint32_t **mate, const tm_mesh_view *mesh, tm_error *error);

/* The numbers of half faces are below. */
static inline size_t tm_half_faces(const tm_mesh_view *mesh)
{
    return (mesh->start ? (size_t)TM_ELEMENT_NODES : (size_t)TM_TET_NODES) *
           mesh->elements;
}

/* Face i (shape.h) of element e as a half face. */
static inline uint32_t tm_half_face(const tm_mesh_view *mesh, size_t e, size_t i)
{
    static const uint8_t opposite[] = {2, 0, 1, 3}; /* to face i of a tetrahedron */
    return (uint32_t)(mesh->start ? TM_ELEMENT_NODES * e + i
                                  : TM_TET_NODES * e + opposite[i]);
}

/* The other nodes of a face in ascending order; the third of a triangle is TM_NONE. */
static inline void tm_face_others(const tm_face *face, uint32_t node[3])
{
    const uint32_t p = (uint32_t)(face->beside >> 32), q = (uint32_t)face->beside;
    const uint32_t o = face->opposite;
    node[0] = o < p ? o : p;
    node[1] = o < p ? p : o < q ? o : q;
    node[2] = o < q ? q : o;
}

/* Whether a row can be a face: of three or four different nodes. */
bool tm_row_is_face(const tm_mesh_view *mesh, size_t row);

/* The nodes of a half face, outward where its element is positive; how many. */
size_t tm_half_face_nodes(const tm_mesh_view *mesh, uint32_t half, uint32_t node[4]);

TM_EXTERN_C_END

#endif
