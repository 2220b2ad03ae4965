/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The groups that elements are in, as markers and regions with names. An element has one
 * marker or region but may be in several physical groups: for each set of groups that
 * there is, there is a value. */
#ifndef CMD_COMMON_GMSH_GROUPS_H
#define CMD_COMMON_GMSH_GROUPS_H

#include "../../../lib/stream/group.h"
#include "gmsh_model.h"

#include <stdint.h>

/* Physical groups, ascending; or where there are none, the entity that the elements are
 * of. */
typedef struct gmsh_set {
    int dimension;
    int entity;
    size_t groups;
    int *group;
    bool is_part; /* the entity has parts, of which each has this set */
    bool is_used;
    int32_t value;
} gmsh_set;

typedef struct gmsh_sets {
    const gmsh_model *model;
    const gmsh_model *swapped; /* the same file with swapped tags, or NULL */
    uint32_t *of_entity;       /* [model->entities] */
    size_t sets, room;
    gmsh_set *set;
    size_t renumbered; /* entities whose number is that of a group */
} gmsh_sets;

/* The sets of the entities of a model. *sets is to be freed, after an error too. */
tm_status gmsh_sets_of_entities(gmsh_sets *sets, const gmsh_model *model,
                                const gmsh_model *swapped, tm_error *error);
void gmsh_sets_free(gmsh_sets *sets);

/* The set that has the groups of both; one that has none is as good as not there. */
tm_status gmsh_sets_join(gmsh_sets *sets, uint32_t a, uint32_t b, uint32_t *both,
                         tm_error *error);

/* The set of a single group. */
tm_status gmsh_sets_single(gmsh_sets *sets, int dimension, int group, uint32_t *set,
                           tm_error *error);

/* The set of an entity without a group, whatever groups it has. */
tm_status gmsh_sets_ungrouped(gmsh_sets *sets, const gmsh_entity *entity, uint32_t *set,
                              tm_error *error);

/* Gives the sets that are used their values: that of one group the number of that, that
 * of an entity its number, unless a group has it; those of several, and such entities,
 * numbers above all of these. Appends names to *group, which is empty, also those of
 * groups that are in sets of several only. TM_ERROR_SYSTEM where memory is out. */
tm_status gmsh_sets_name(gmsh_sets *sets, tm_block *group, tm_error *error);

#endif
