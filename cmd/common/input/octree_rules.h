/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options that say how fine an octree is: -a, -s, -b, -r, -l. */
#ifndef CMD_COMMON_OCTREE_RULES_H
#define CMD_COMMON_OCTREE_RULES_H

#include "../../../lib/octree/forest/rule_files.h"
#include "../app/filter.h"

/* What the rules refer to. */
typedef struct octree_rules {
    tm_octree_rules rules;
    size_t regions, leaf_lists;
    tm_surface *region;
    uint32_t **leaf_list;
} octree_rules;

/* Adds the rule of option c with its argument in optarg; -r takes the level from the next
 * word. Files are read, and what is wrong with them ends the program. */
void octree_rules_option(filter *f, octree_rules *rules, int c);

/* A rule of a kind that has only a level. */
void octree_rules_add_level(const filter *f, octree_rules *rules,
                            tm_octree_rule_kind kind, unsigned level);

void octree_rules_free(octree_rules *rules);

#endif
