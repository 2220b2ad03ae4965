/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that say where an octree is refined: .reg and .ref. */
#include "target.h"

#include "../../../lib/octree/forest/rule_files.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const char *text = (const char *)bytes;
    tm_octree_rules rules = {0};
    uint32_t *leaf;
    size_t leaves;
    tm_error error;
    tm_status status = tm_reg_read(&rules, text, size, "file", &error);
    require(status == TM_OK ||
                (status == TM_ERROR_INPUT && error.what[0] && rules.count == 0),
            ".reg: not read, but no reason");
    for (size_t r = 0; r < rules.count; r++)
        for (int i = 0; i < 3; i++)
            require(rules.rule[r].low[i] <= rules.rule[r].high[i], "a box is none");
    tm_octree_rules_free(&rules);
    status = tm_ref_read(&leaf, &leaves, text, size, "file", &error);
    require(status == TM_OK || (status == TM_ERROR_INPUT && error.what[0] && !leaf),
            ".ref: not read, but no reason");
    free(leaf);
    return 0;
}
