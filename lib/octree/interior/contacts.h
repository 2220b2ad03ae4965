/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Leaves at the nodes where something is wrong: one of them is to be changed. */
#ifndef TM_LAYER_CONTACTS_H
#define TM_LAYER_CONTACTS_H

#include "../../base/error.h"
#include "../forest/octree.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A leaf that has a node. */
typedef struct tm_contact {
    uint32_t node, leaf;
} tm_contact;

/* contact[] is malloc'ed; {0} is an empty list. */
typedef struct tm_contacts {
    size_t count, room;
    tm_contact *contact;
} tm_contacts;

/* Lists the leaves at bad nodes anew, node by node. TM_ERROR_SYSTEM where memory is out.
 * O(leaves), and O(n log n) of those listed. */
tm_status tm_contacts_find(tm_contacts *list, const tm_octree *octree, const bool *bad,
                           tm_error *error);

/* The first contact behind i that is of another node. */
size_t tm_contacts_next(const tm_contacts *list, size_t i);

#endif
