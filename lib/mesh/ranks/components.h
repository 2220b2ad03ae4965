/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Disjoint sets of things of which each rank has a slice. */
#ifndef TM_MESH_RANKS_COMPONENTS_H
#define TM_MESH_RANKS_COMPONENTS_H

#include "../../base/extern_c.h"
#include "../../base/error.h"
#include "rows.h"

#include <stdint.h>

TM_EXTERN_C_BEGIN

/* All ranks: parent[rows->count], the forest of all things of which this rank has some,
 * becomes their roots; a root is its own parent. Halves the way each time: O(log of the
 * longest way) times all ranks say something to each other. */
tm_status tm_ranks_find_roots(const tm_rows *rows, uint32_t *parent, tm_error *error);

/* All ranks: joins things that are pairs on any of them, pair[pairs][2], which changes;
 * parent[rows->count], to be filled by this, is the smallest one in the set of each. Of
 * all roots that have pairs those that are not the smallest one of theirs get a smaller
 * parent, then ways are halved, and that again: O(log things) times (Y. Shiloach and U.
 * Vishkin, An O(log n) parallel connectivity algorithm, Journal of Algorithms 3, 1982).
 */
tm_status tm_ranks_unite(const tm_rows *rows, uint32_t (*pair)[2], size_t pairs,
                         uint32_t *parent, tm_error *error);

TM_EXTERN_C_END

#endif
