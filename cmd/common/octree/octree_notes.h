/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What octree-mesh says of a mesh that is not what the surface and the rules are. */
#ifndef CMD_COMMON_OCTREE_NOTES_H
#define CMD_COMMON_OCTREE_NOTES_H

#include "../../../lib/octree/layer/octree_mesh.h"
#include "../app/filter.h"
#include "../input/octree_rules.h"

/* Boxes and regions that ask for nothing. */
void octree_note_outside(const filter *f, const octree_rules *rules, const tm_surface *s);

/* What of the surface could not be made, and where; leaf_side is that of the smallest
 * octants. */
void octree_note_losses(const filter *f, const tm_surface *s,
                        const tm_octree_mesh_report *r, double leaf_side);

#endif
