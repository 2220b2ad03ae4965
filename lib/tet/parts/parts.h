/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh cut into parts that are meshes of their own, to be changed independently, and
 * joined again. Faces between parts stay as they are: in a part they are on the boundary,
 * and their edges are locked. The cut depends on the mesh only; that of another round
 * goes elsewhere, so that what is between parts in one is inside of them in the next. */
#ifndef TM_TET_PARTS_PARTS_H
#define TM_TET_PARTS_PARTS_H

#include "../mesh.h"

TM_EXTERN_C_BEGIN

typedef struct tm_tet_part {
    uint32_t first, past; /* of order[]: its tetrahedra */
    tm_tet_mesh mesh;     /* once it is taken */
    size_t nodes;         /* that it was taken with: */
    uint32_t *node;       /* [nodes]: which one of the whole mesh each is */
} tm_tet_part;

typedef struct tm_tet_parts {
    size_t count;
    tm_tet_part *part;
    uint32_t *order; /* [tets]: along a space-filling curve, part by part */
    uint32_t *place; /* [slots]: where a tetrahedron is in order[] */
    /* NULL where there are no rows of .edge: */
    uint8_t *has_edge; /* [nodes]: such rows name it */
    uint8_t *taken;    /* [edges]: a part has it */
} tm_tet_parts;

/* Cuts the living tetrahedra into parts of at most `size`, as near as the curve makes
 * them, and a multiple of 4 of them, so that 2 or 4 threads have as much to do each;
 * `round` counts the cuts. Nothing is taken. TM_ERROR_SYSTEM where memory is out;
 * tm_tet_parts_free() in any case. O(n). */
tm_status tm_tet_parts_cut(tm_tet_parts *parts, const tm_tet_mesh *mesh, size_t size,
                           unsigned round, tm_error *error);
void tm_tet_parts_free(tm_tet_parts *parts);

/* What that is made of, for a mesh of which a process has only a share. How many parts:
 */
size_t tm_tet_parts_count(size_t tets, size_t size);

/* A point as the round's curve sees it: turned about three axes, another way in each
 * round, so that planes where parts end cross those of the round before. */
void tm_tet_parts_turn(const double p[3], unsigned round, double q[3]);

/* Fills has_edge and taken; false where memory is out. */
bool tm_tet_parts_note_edges(tm_tet_parts *parts, const tm_tet_mesh *mesh);

/* Makes part p a mesh: tetrahedra in the order of the cut, each node with its attributes
 * and markers, faces and edges that it has. Different parts may be taken at a time.
 * Expected O(tetrahedra of the part). */
tm_status tm_tet_part_take(const tm_tet_parts *parts, size_t p, const tm_tet_mesh *mesh,
                           tm_error *error);

/* Makes *mesh what the parts have become, and empties them. Nodes keep their numbers, new
 * ones come behind, part by part; tetrahedra are in the order of the parts, without dead
 * slots. The mesh cannot be given back after an error, only freed. O(n). */
tm_status tm_tet_parts_join(tm_tet_parts *parts, tm_tet_mesh *mesh, unsigned threads,
                            tm_error *error);

/* between[v]: a face between two parts has node v of the mesh, of which no part has been
 * taken. O(n). */
void tm_tet_parts_between(const tm_tet_parts *parts, const tm_tet_mesh *mesh,
                          bool *between);

TM_EXTERN_C_END

#endif
