/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of tm_shared_optimise(), for shared_optimise.c and shared_mend.c only. */
#ifndef TM_LAYER_SHARED_PARTS_H
#define TM_LAYER_SHARED_PARTS_H

#include "mesh_share.h"
#include "shared_optimise.h"

typedef struct tm_shared_work {
    tm_octree_mesh *mesh;
    const tm_mesh_share *share;
    tm_node_rule *rule;
    const tm_boundary *boundary;
    const tm_optimise_options *options;
    double *jens;        /* [own elements] */
    bool *near;          /* [nodes]: within the rings of what is bad */
    uint32_t *label;     /* [nodes of the octree]: of their sets */
    bool *mark;          /* [nodes] */
    uint32_t *candidate; /* own elements that are near what was bad at first */
    size_t candidates;
} tm_shared_work;

/* A node on its way between ranks. */
typedef struct tm_sent_node {
    double xyz[3];
    tm_node_rule rule;
    uint32_t number;
} tm_sent_node;

/* A near node of an element, or TM_NONE. */
static inline uint32_t tm_shared_near_node(const tm_shared_work *s, size_t e)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        if (s->near[mesh->item[i]])
            return mesh->item[i];
    return TM_NONE;
}

static inline bool tm_shared_is_near(const tm_shared_work *s, size_t e)
{
    return tm_shared_near_node(s, e) != TM_NONE;
}

/* shared_mend.c: what is near goes to the ranks that mend it, and comes back. */

/* The node of the octree that stands for a node of the mesh: where it is, or a corner of
 * its leaf. */
uint32_t tm_shared_stand_in(const tm_shared_work *s, uint32_t n);

/* Sends the candidates that are near to the ranks of their sets, which make that pass of
 * tm_mixed_optimise(); pass 0: to rank 0, which makes all. *moved, to be freed, gets the
 * nodes that are elsewhere then; *measured how many elements were measured here. All
 * ranks call it. */
tm_status tm_shared_mend(const tm_shared_work *s, unsigned pass, tm_sent_node **moved,
                         size_t *listed, size_t *measured, tm_error *error);

/* Gives the moved nodes to their ranks, and these to those that have them as ghosts. */
tm_status tm_shared_put(const tm_shared_work *s, tm_sent_node *moved, size_t listed,
                        tm_error *error);

#endif
