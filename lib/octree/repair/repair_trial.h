/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A few elements out of a mesh, as a mesh of their own on which something is tried. */
#ifndef TM_REPAIR_REPAIR_TRIAL_H
#define TM_REPAIR_REPAIR_TRIAL_H

#include "../../surface/surface.h"
#include "repair_state.h"

/* The elements at each node of a mesh: element[start[v]] … element[start[v + 1] - 1]. */
typedef struct tm_node_elements {
    size_t *start;
    uint32_t *element;
} tm_node_elements;

/* O(elements). */
tm_status tm_node_elements_find(tm_node_elements *around, const tm_mixed_mesh *mesh,
                                tm_error *error);
void tm_node_elements_free(tm_node_elements *around);

/* Elements, and marks to gather them with. Begins as zeros but for these two. */
typedef struct tm_trial {
    tm_repair_state *whole;
    const tm_node_elements *around;
    tm_repair_state part;   /* mesh and rule; room for more elements */
    size_t nodes, elements; /* of the part as it was gathered */
    uint32_t *node;         /* [nodes]: of the whole */
    uint32_t *element;      /* [elements]: of the whole */
    uint32_t *local;        /* [nodes of the whole]: TM_NONE between trials */
    bool *taken;            /* [elements of the whole]: false between trials */
    size_t node_room, element_room;
} tm_trial;

/* Gathers the elements core[0 … cores), which come first, and all up to `rings` elements
 * away. Nodes with elements outside do not move. There is room for TM_TRIAL_ROOM elements
 * of eight nodes more. */
enum { TM_TRIAL_ROOM = 64 };
tm_status tm_trial_gather(tm_trial *trial, const uint32_t *core, size_t cores,
                          unsigned rings, tm_error *error);

/* Gives the whole the places of nodes that moved, and what they may do. */
void tm_trial_commit(const tm_trial *trial);

void tm_trial_free(tm_trial *trial);

#endif
