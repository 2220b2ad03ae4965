/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A quick look at a surface of which little is known: whether it crosses itself at all.
 */
#ifndef TM_SURFACE_SURFACE_APART_H
#define TM_SURFACE_SURFACE_APART_H

#include "../base/error.h"
#include "../base/extern_c.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* *apart becomes whether all triangles have an area and no two meet elsewhere than in
 * common nodes and edges, exactly as tm_triangles_meet() says. Boxes of triangles in the
 * order of a space-filling curve, and of pairs of these boxes, take a third of the time
 * of the tree that surface.h makes for its many queries. TM_ERROR_SYSTEM where memory is
 * out. Expected O(n log n), less where it is false. */
tm_status tm_triangles_are_apart(const double (*xyz)[3], size_t nodes,
                                 const uint32_t (*triangle)[3], size_t triangles,
                                 bool *apart, tm_error *error);

TM_EXTERN_C_END

#endif
