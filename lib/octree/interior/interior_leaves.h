/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The leaves that stand for the interior, chosen so that what they bound is a manifold on
 * which a layer of elements can be put. */
#ifndef TM_LAYER_INTERIOR_LEAVES_H
#define TM_LAYER_INTERIOR_LEAVES_H

#include "../../base/extern_c.h"
#include "octant_mask.h"
#include "../forest/octree.h"

TM_EXTERN_C_BEGIN

typedef struct tm_interior {
    bool *chosen;           /* [leaves] */
    tm_octant_mask *mask;   /* [nodes of the octree] */
    bool *used;             /* [nodes]: the mesh has the node: it is a corner of a chosen
                               leaf, or in the middle of an edge of a face with a centre */
    size_t count;           /* leaves chosen */
    size_t filled, removed; /* changed so that the boundary is a manifold */
    uint32_t *label;        /* [leaves]: of a surface with walls, the region, 0 outside;
                               else NULL */
    uint32_t (*octant)[8];  /* [nodes]: the same of the octants around it */
} tm_interior;

/* Chooses the leaves whose centres are inside the surface, then adds and takes away some
 * until at each node of their boundary (1) the faces of it make one fan and (2) no two of
 * them face each other, so that the node can move inward and away from all of them. The
 * fewest and those whose centres are closest to the surface are changed. Of a surface
 * with walls it is what tm_interior_label() does. TM_ERROR_SYSTEM where memory is out.
 * *interior is to be freed, after an error too. Expected O(leaves). */
tm_status tm_interior_choose(tm_interior *interior, const tm_octree *octree,
                             const tm_surface *surface, tm_error *error);
/* The same where it is asked that corners and curves of walls are not laid out. */
tm_status tm_interior_choose_how(tm_interior *interior, const tm_octree *octree,
                                 const tm_surface *surface, bool lay_out,
                                 tm_error *error);
void tm_interior_free(tm_interior *interior);

/* Chooses, as another interior, the leaves that the chosen ones enclose: what is not
 * chosen and not joined to the outside of the brick. Where there are some, both have the
 * nodes `used` that either has, so that they have the same faces in common; no arrays and
 * count 0 where there are none. Its masks are as good as those of the interior.
 * TM_ERROR_SYSTEM where memory is out; it is to be freed, after an error too. O(leaves).
 */
tm_status tm_interior_find_enclosed(tm_interior *enclosed, tm_interior *interior,
                                    const tm_octree *octree, const tm_surface *surface,
                                    tm_error *error);

/* The part, of so many, that has a leaf; `parts` where none has. */
static inline size_t tm_interior_part_of(const tm_interior *part, size_t parts,
                                         size_t leaf)
{
    size_t p = 0;
    while (p < parts && !part[p].chosen[leaf])
        p++;
    return p;
}

/* How far the surface is from a leaf's centre, in its sides; those that it does not cross
 * are farther than any that it does. */
double tm_leaf_depth(const tm_octree *octree, const tm_surface *surface, size_t leaf);

/* Whether a leaf, not the first, is on the same side of all surface as the one before it:
 * between two leaves that touch and that the surface does not meet there is none of it.
 */
bool tm_leaf_is_as_before(const tm_octree *octree, size_t leaf);

/* Makes a leaf chosen that is not, or the other way, with the masks of its nodes; used
 * and count are then as tm_interior_find_used() says again. */
void tm_interior_flip(tm_interior *interior, const tm_octree *octree, size_t leaf);
void tm_interior_find_used(tm_interior *interior, const tm_octree *octree);

/* Gives a leaf that label, and its octants around its nodes. */
void tm_interior_set_label(tm_interior *interior, const tm_octree *octree, size_t leaf,
                           uint32_t label);

/* Marks the leaves that the surface crosses but none of whose corners is on the boundary
 * of the chosen ones: there a thin part, or a gap, is lost. Returns how many. None where
 * the inside is by the winding number: there surface may be within the interior. */
size_t tm_interior_find_lost(const tm_interior *interior, const tm_octree *octree,
                             const tm_surface *surface, uint8_t *lost);

TM_EXTERN_C_END

#endif
