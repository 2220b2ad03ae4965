/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options that say how fine an octree is: -a, -s, -b, -r, -l. */
#ifndef CMD_COMMON_OCTREE_RULES_H
#define CMD_COMMON_OCTREE_RULES_H

#include "../../lib/octree/octree.h"
#include "filter.h"

typedef struct octree_rules {
    size_t count, room;
    tm_octree_rule *rule;
    const char **file; /* [count]: what is to be read for it, or NULL */
    size_t file_room;
} octree_rules;

/* Takes the option c with its argument in optarg, and for -r the level that follows. Files
 * are not opened yet. */
void octree_rules_option(filter *f, octree_rules *rules, int c);

/* A rule of a kind that has only a level. */
void octree_rules_add_level(const filter *f, octree_rules *rules, tm_octree_rule_kind kind,
                            long level);

/* Reads the files; exits where that fails. */
void octree_rules_read(const filter *f, octree_rules *rules,
                       const tm_surface_options *options);
void octree_rules_free(octree_rules *rules);

#endif
