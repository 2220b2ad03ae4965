/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The optimiser on the parts of a mesh that ranks have. */
#ifndef TM_LAYER_SHARED_OPTIMISE_H
#define TM_LAYER_SHARED_OPTIMISE_H

#include "../../optimise/optimise.h"
#include "octree_mesh.h"

/* tm_mixed_optimise() where no node is off the surface, of a mesh that ranks have parts
 * of. In each pass bad elements that are far from each other have nothing to do with each
 * other, and are mended in any order: what of them hangs together goes to one rank,
 * mostly the one that has it. Only where options->most_measured is reached, which is
 * counted in the order of one process, goes all that is bad, with what is around it, to
 * rank 0. rule[nodes] is as in the whole mesh, of ghosts too. Of the report all ranks get
 * worst_after of the whole mesh. All ranks call it. Of a whole mesh it is
 * tm_mixed_optimise(). */
tm_status tm_shared_optimise(tm_octree_mesh *mesh, tm_node_rule *rule,
                             const tm_boundary *boundary,
                             const tm_optimise_options *options,
                             tm_optimise_report *report, tm_error *error);

#endif
