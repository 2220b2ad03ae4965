/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Things at the nodes and in the leaves of a share, as nodes of its mesh: which ranks
 * have them as ghosts, and what these get from those that own them. */
#ifndef TM_SHARE_MESH_GHOSTS_H
#define TM_SHARE_MESH_GHOSTS_H

#include "../../base/extern_c.h"
#include "octree_share.h"

TM_EXTERN_C_BEGIN

typedef struct tm_mesh_ghosts {
    unsigned ranks;
    size_t *sends, *receives; /* [ranks]: how many each rank has of ours, or we of it */
    size_t all_sent, all_received; /* of all ranks */
    uint32_t *sent;     /* own things that others have as ghosts, by local numbers */
    uint32_t *received; /* ghosts; both in the order of ranks */
    char *room; /* for values of all that is sent and received, of TM_GHOST_BYTES each */
} tm_mesh_ghosts;

/* What may be given to ghosts. */
enum { TM_GHOST_BYTES = 40 };

/* Finds them. of_node[i][local node], of so many lists, and of_leaf[local leaf], which
 * may be NULL, are the things there, TM_NONE where there is none: all ranks that have a
 * node or a leaf must agree in which lists there is something. TM_ERROR_SYSTEM where
 * memory is out. To be freed, after an error too. O(ghosts). */
tm_status tm_mesh_ghosts_find(tm_mesh_ghosts *ghosts, const tm_octree_share *share,
                              const uint32_t *const *of_node, size_t lists,
                              const uint32_t *of_leaf, tm_error *error);
/* Those of them that are kept, about which all ranks agree. */
tm_status tm_mesh_ghosts_some(tm_mesh_ghosts *some, const tm_mesh_ghosts *all,
                              const bool *kept, tm_error *error);
void tm_mesh_ghosts_free(tm_mesh_ghosts *ghosts);

/* Gives ghosts the values, of `size` bytes, at most TM_GHOST_BYTES, of their owners. All
 * ranks call it. */
void tm_mesh_ghosts_fill(const tm_mesh_ghosts *ghosts, void *value, size_t size);

/* Marks everywhere what any rank has marked. */
void tm_mesh_ghosts_mark(const tm_mesh_ghosts *ghosts, bool *mark);

TM_EXTERN_C_END

#endif
