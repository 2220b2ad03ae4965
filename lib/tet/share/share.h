/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What one of several ranks (ranks/ranks.h) has of a mesh: some of its tetrahedra, with
 * their nodes, faces and edges, as a mesh of its own. All functions are called by all
 * ranks, and fail on all of them. */
#ifndef TM_TET_SHARE_SHARE_H
#define TM_TET_SHARE_SHARE_H

#include "../../ranks/mail.h"
#include "../parts/parts.h"

TM_EXTERN_C_BEGIN

/* The half face on the other side of a face whose tetrahedron another rank has: in
 * neighbour[][], and in side[] of a face that stays. It is that of tetrahedron
 * tm_tet_share.beyond. */

typedef struct tm_tet_share {
    tm_tet_mesh mesh; /* without dead tetrahedra */
    uint32_t beyond;  /* the tetrahedron that stands for those of other ranks: slots */
    uint32_t *number; /* [nodes]: which one of the whole mesh each is, ascending */
    bool *due;        /* [nodes]: see improve_parts.c */
    uint32_t *index;  /* [slots]: which one of the input a tetrahedron was */
    bool *own;        /* [slots]: others have it, too, and it is theirs, if not */
    size_t all_nodes; /* numbers that nodes of the whole mesh have, or had */
    size_t all_tets;
    size_t *home; /* [ranks + 1]: rank r keeps the books on nodes home[r] … home[r + 1] */

    /* Nodes of this rank's slice of the input that no tetrahedron has. */
    size_t loose;
    uint32_t *loose_number;
    tm_tet_mesh loose_nodes; /* only nodes */
} tm_tet_share;

void tm_tet_share_free(tm_tet_share *share);

/* Which tetrahedra a rank gives away: rank r gets the next count[r] of tet[], and sorts
 * all that it gets by their keys, below 2^30; of the same one, in the order of ranks. */
typedef struct tm_tet_deal {
    size_t *count; /* [ranks] */
    size_t tets;   /* all */
    uint32_t *tet, *key;
} tm_tet_deal;

void tm_tet_deal_free(tm_tet_deal *deal);

/* Gives them away, with all that belongs to them, and makes *to what the others give:
 * connected if this mesh is. `to` may be the share itself. O(tetrahedra), and a sort of
 * nodes. */
tm_status tm_tet_share_deal(tm_tet_share *share, const tm_tet_deal *deal,
                            tm_tet_share *to, tm_error *error);

/* Gives each rank the tetrahedra of its parts, of so many, in the round's order. */
tm_status tm_tet_share_deal_along(tm_tet_share *share, size_t parts, unsigned round,
                                  tm_error *error);

/* Gives each rank its parts of the cut of a round (parts.h), and lists these; those of
 * one process. What is not its own is forgotten. */
tm_status tm_tet_share_cut(tm_tet_share *share, tm_tet_parts *parts, size_t size,
                           unsigned round, tm_error *error);

/* Makes the share what its parts have become. */
tm_status tm_tet_share_join(tm_tet_share *share, tm_tet_parts *parts, unsigned threads,
                            size_t *inner_faces, tm_error *error);

/* Makes a flag of nodes true where it is on any rank: flag[count] of the first nodes. */
tm_status tm_tet_share_any(const tm_tet_share *share, bool *flag, size_t count,
                           tm_error *error);

/* Gets also the tetrahedra around all nodes of its own ones; by `key` (NULL: in the order
 * of ranks). */
tm_status tm_tet_share_widen(tm_tet_share *share, const uint32_t *key, tm_tet_share *to,
                             tm_error *error);

TM_EXTERN_C_END

#endif
