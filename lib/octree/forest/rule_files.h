/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files that say where an octree is refined: boxes (.reg) and octants (.ref), as the
 * mesher of Lobos and González 2015 reads them. In both # begins a comment. */
#ifndef TM_FOREST_RULE_FILES_H
#define TM_FOREST_RULE_FILES_H

#include "../../base/extern_c.h"
#include "octree.h"

TM_EXTERN_C_BEGIN

typedef struct tm_octree_rules {
    size_t count;
    size_t room;
    tm_octree_rule *rule; /* malloc'ed; the regions and lists of leaves are not its own */
} tm_octree_rules;

/* Appends a rule. */
tm_status tm_octree_rules_add(tm_octree_rules *rules, const tm_octree_rule *rule,
                              tm_error *error);

void tm_octree_rules_free(tm_octree_rules *rules);

/* Appends a TM_RULE_BOX for each box of a .reg file: `n_regions` and how many there are,
 * then of each the smallest and the largest x y z and the level, on any lines.
 * TM_ERROR_INPUT names file and line; the rules are then as before. */
tm_status tm_reg_read(tm_octree_rules *rules, const char *bytes, size_t size,
                      const char *name, tm_error *error);

/* The numbers of a .ref file, one in each line; *leaf is malloc'ed, NULL after an error.
 * Whether there are such leaves is not checked. */
tm_status tm_ref_read(uint32_t **leaf, size_t *leaves, const char *bytes, size_t size,
                      const char *name, tm_error *error);

TM_EXTERN_C_END

#endif
