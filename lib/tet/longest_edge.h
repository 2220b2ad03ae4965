/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The longest edge of a tetrahedron. Edges are compared by (squared length, larger node,
 * smaller node), so that of two edges one is always the longer. */
#ifndef TM_TET_LONGEST_EDGE_H
#define TM_TET_LONGEST_EDGE_H

#include "../geom/vector.h"
#include "star.h"

typedef struct tm_edge_rank {
    double length2;
    uint64_t key;
} tm_edge_rank;

static inline bool tm_edge_is_longer(const tm_edge_rank *e, const tm_edge_rank *f)
{
    return e->length2 > f->length2 || (e->length2 == f->length2 && e->key > f->key);
}

/* The longest edge of t, 0 … 5 as in tm_edge_corner. */
static inline unsigned tm_longest_edge(const tm_tet_mesh *mesh, uint32_t t,
                                       tm_edge_rank *rank)
{
    const uint32_t *n = mesh->tet[t];
    unsigned longest = 0;
    *rank = (tm_edge_rank){-1, 0};
    for (unsigned e = 0; e < 6; e++) {
        uint32_t a = n[tm_edge_corner[e][0]], b = n[tm_edge_corner[e][1]];
        tm_edge_rank other = {tm_distance2(mesh->xyz[a], mesh->xyz[b]),
                              tm_edge_key(a, b)};
        if (!tm_edge_is_longer(&other, rank))
            continue;
        *rank = other;
        longest = e;
    }
    return longest;
}

#endif
