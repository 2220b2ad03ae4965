/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The members of sets: ids, ranges and other sets, of parts and of instances. */
#ifndef TM_FORMAT_ABAQUS_INP_SETS_H
#define TM_FORMAT_ABAQUS_INP_SETS_H

#include "inp_model.h"

/* A member: a node or an element of the whole (see tm_inp_instance); of a surface an
 * element and its face, 1 … 6, 0 for that of a shell, or -1. A member may come more than
 * once. */
typedef tm_status tm_inp_member(void *context, uint32_t item, int face);

typedef struct tm_inp_walk {
    tm_inp_model *model;
    tm_inp_member *take;
    void *context;
    bool count_missing; /* what is not there, in the report */
    uint32_t root;      /* how many sets were walked */
    uint32_t *seen;     /* [sets]: in which of them a set was, and */
    uint32_t *seen_at;  /* [sets]: for which instance */
    int face;           /* of the elements of a set that a surface names */
} tm_inp_walk;

/* Prepares to walk the sets of a model that is sorted (tm_inp_ids_sort()). To be freed,
 * after an error too. */
tm_status tm_inp_walk_new(tm_inp_walk *walk, tm_inp_model *model);
void tm_inp_walk_free(tm_inp_walk *walk);

/* Gives all members of a set of an instance to walk->take. TM_ERROR_INPUT for a set that
 * is not there, and for sets of sets of more than a hundred. O(members). */
tm_status tm_inp_walk_set(tm_inp_walk *walk, size_t set, size_t instance);

/* Marks the sets of elements that surfaces name. */
void tm_inp_mark_surfaces(tm_inp_model *model);

#endif
