/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether the boundary is a closed manifold surface; a part of tm_tet_examine(). */
#ifndef TM_TET_EXAMINE_BOUNDARY_H
#define TM_TET_EXAMINE_BOUNDARY_H

#include "../base/error.h"
#include "../quality/examination.h"

/* Finds in *found: open and non-manifold edges, non-manifold vertices, the area. Each
 * face has three different nodes, and no two have the same three. O(nodes + faces) where
 * few faces meet at a node. */
tm_status tm_examine_boundary(tm_examination *found, const double (*xyz)[3], size_t nodes,
                              const uint32_t (*face)[3], size_t faces, tm_error *error);

#endif
