/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "leaf_list.h"

#include "../base/array.h"

tm_status tm_leaf_list_add(tm_leaf_list *list, const uint32_t anchor[3], unsigned level,
                           bool crossed, tm_error *error)
{
    if (list->count == list->room) {
        if (list->count >= TM_LEAVES_MAX)
            return tm_fail(error, TM_ERROR_INPUT,
                           "the octree has more than %zu leaves (ask for lower levels)",
                           TM_LEAVES_MAX);
        tm_leaf *grown =
            tm_grow(list->leaf, &list->room, list->count + 1, sizeof *list->leaf);
        if (!grown)
            return tm_fail_memory(error);
        list->leaf = grown;
    }
    list->leaf[list->count++] = (tm_leaf){.anchor = {anchor[0], anchor[1], anchor[2]},
                                          .level = (uint8_t)level,
                                          .crossed = crossed};
    return TM_OK;
}
