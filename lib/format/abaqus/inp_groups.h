/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which sets what is in, as one value: an element or node has one region or marker, but
 * may be in several sets. Those that are in the same sets are a class. */
#ifndef TM_FORMAT_ABAQUS_INP_GROUPS_H
#define TM_FORMAT_ABAQUS_INP_GROUPS_H

#include "inp_model.h"

/* A set of an instance. */
typedef struct tm_inp_group {
    uint32_t set, instance;
    uint32_t same; /* the group of elements of the same name, of a surface; or its own */
    size_t count[TM_GROUP_DIMENSIONS]; /* members */
    int32_t value[TM_GROUP_DIMENSIONS];
} tm_inp_group;

/* A class is those of `parent` that are also in `group`; class 0 is in none. */
typedef struct tm_inp_class {
    uint32_t parent, group;
    uint32_t child, child_of; /* the class that its members go to, in group child_of */
    bool is_used[TM_GROUP_DIMENSIONS];
    int32_t value[TM_GROUP_DIMENSIONS];
} tm_inp_class;

typedef struct tm_inp_classes {
    size_t items;
    uint32_t *of; /* [items]: the class of each */
    size_t classes, room;
    tm_inp_class *class;
} tm_inp_classes;

tm_status tm_inp_classes_new(tm_inp_classes *classes, size_t items, tm_error *error);
void tm_inp_classes_free(tm_inp_classes *classes);

/* Puts an item into a group, one group after the other; an item may come more than once.
 * With `only_free` one that is in some is left. */
tm_status tm_inp_classes_put(tm_inp_classes *classes, uint32_t item, uint32_t group,
                             bool only_free, tm_error *error);

/* What the stream's names and values are made of. */
typedef struct tm_inp_groups {
    tm_inp_model *model;
    size_t groups;
    tm_inp_group *group;
    int32_t next[TM_GROUP_DIMENSIONS]; /* the value above all there are */
    tm_block named;                    /* .group */
    tm_block joined; /* what abaqus-export says that stands for several: "1 + 3" */
} tm_inp_groups;

/* Whether a set is called Nall or Eall, as CalculiX's cgx calls all nodes and elements.
 */
bool tm_inp_says_nothing(const tm_inp_set *set);

/* Lists the sets that count. */
tm_status tm_inp_groups_find(tm_inp_groups *groups, tm_inp_model *model);
void tm_inp_groups_free(tm_inp_groups *groups);

/* Gives groups with members their values: what comments say, else 1, 2, … above those.
 * And names. */
tm_status tm_inp_groups_name(tm_inp_groups *groups);

/* Gives classes that are used theirs: that of the one group, or that abaqus-export says,
 * or one more, named "a + b"; *several counts those. */
tm_status tm_inp_classes_name(tm_inp_classes *classes, tm_inp_groups *groups,
                              size_t *several);

#endif
