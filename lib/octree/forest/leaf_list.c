/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "leaf_list.h"

#include "../../base/array.h"

#include <string.h>
#include <unistd.h>

/* Of an octree, at least, while its nodes are numbered. */
enum { BYTES_PER_LEAF = 140 };

/* How many leaves an octree in the machine's memory can have: as the system gives more
 * than there is, nobody else would say so. */
static size_t leaves_in_memory(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page <= 0)
        return TM_LEAVES_MAX;
    return (size_t)pages / BYTES_PER_LEAF * (size_t)page;
}

tm_status tm_leaf_list_check(size_t count, tm_error *error)
{
    const size_t most = leaves_in_memory();
    if (count > TM_LEAVES_MAX)
        return tm_fail(error, TM_ERROR_INPUT,
                       "the octree has more than %zu leaves (ask for lower levels)",
                       TM_LEAVES_MAX);
    if (count > most)
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "the octree has more than %zu leaves: the machine's memory does "
                       "not hold it (ask for lower levels)",
                       most);
    return TM_OK;
}

/* Room for so many more. */
static tm_status grow(tm_leaf_list *list, size_t more, tm_error *error)
{
    const tm_status status = tm_leaf_list_check(list->count + more, error);
    if (status != TM_OK)
        return status;
    tm_leaf *grown =
        tm_grow(list->leaf, &list->room, list->count + more, sizeof *list->leaf);
    if (!grown)
        return tm_fail_memory(error);
    list->leaf = grown;
    return TM_OK;
}

tm_status tm_leaf_list_append(tm_leaf_list *list, const tm_leaf_list *more,
                              tm_error *error)
{
    if (list->room - list->count < more->count) {
        const tm_status status = grow(list, more->count, error);
        if (status != TM_OK)
            return status;
    }
    if (more->count > 0)
        memcpy(list->leaf + list->count, more->leaf, more->count * sizeof *list->leaf);
    list->count += more->count;
    return TM_OK;
}

tm_status tm_leaf_list_add(tm_leaf_list *list, const uint32_t anchor[3], unsigned level,
                           bool crossed, tm_error *error)
{
    if (list->count == list->room) {
        const tm_status status = grow(list, 1, error);
        if (status != TM_OK)
            return status;
    }
    list->leaf[list->count++] = (tm_leaf){.anchor = {anchor[0], anchor[1], anchor[2]},
                                          .level = (uint8_t)level,
                                          .crossed = crossed};
    return TM_OK;
}
