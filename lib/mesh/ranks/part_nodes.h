/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The nodes of a part of a mesh: what a rank's things name, whoever has it. */
#ifndef TM_MESH_RANKS_PART_NODES_H
#define TM_MESH_RANKS_PART_NODES_H

#include "fetch.h"

TM_EXTERN_C_BEGIN

/* Nodes that something on this rank names. */
typedef struct tm_part_nodes {
    tm_number_set set;
    uint32_t *number; /* [set.count] */
    double (*xyz)[3]; /* [set.count], or NULL: see below */
} tm_part_nodes;

/* All ranks: the nodes in a list, in which they get their numbers in the part; TM_NONE
 * stays. With `own`, the rows that this rank has, xyz comes from who has it. To be freed
 * also after an error. */
tm_status tm_part_nodes_make(tm_part_nodes *nodes, uint32_t *list, size_t count,
                             const tm_rows *rows, const double (*own)[3],
                             tm_error *error);
void tm_part_nodes_free(tm_part_nodes *nodes);

TM_EXTERN_C_END

#endif
