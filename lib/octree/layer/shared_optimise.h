/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The optimiser on the parts of a mesh that ranks have. */
#ifndef TM_LAYER_SHARED_OPTIMISE_H
#define TM_LAYER_SHARED_OPTIMISE_H

#include "../../optimise/optimise.h"
#include "mesh_share.h"

/* tm_mixed_optimise() where no node is off the surface: what is bad, with the elements
 * around it that may be moved or are looked at, is small, and goes to rank 0, which mends
 * it as if all of the mesh were there. rule[nodes] is as in the whole mesh, of ghosts
 * too. Of the report all ranks get worst_after of the whole mesh. All ranks call it. With
 * `share` NULL it is tm_mixed_optimise(). */
tm_status tm_shared_optimise(tm_assembly *assembly, const tm_mesh_share *share,
                             tm_node_rule *rule, const tm_boundary *boundary,
                             const tm_optimise_options *options,
                             tm_optimise_report *report, tm_error *error);

#endif
