/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contacts.h"

#include "../../base/array.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const tm_contact *p = a, *q = b;
    if (p->node != q->node)
        return p->node < q->node ? -1 : 1;
    return (p->leaf > q->leaf) - (p->leaf < q->leaf);
}

static bool add(tm_contacts *list, uint32_t node, uint32_t leaf)
{
    tm_contact *more =
        tm_grow(list->contact, &list->room, list->count + 1, sizeof *list->contact);
    if (!more)
        return false;
    list->contact = more;
    more[list->count++] = (tm_contact){node, leaf};
    return true;
}

tm_status tm_contacts_find(tm_contacts *list, const tm_octree *octree, const bool *bad,
                           tm_error *error)
{
    list->count = 0;
    for (uint32_t l = 0; l < octree->leaves; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t node = octree->node[l][p];
            if (node != TM_NONE && bad[node] && !add(list, node, l))
                return tm_fail_memory(error);
        }
    if (list->count > 0)
        qsort(list->contact, list->count, sizeof *list->contact, compare);
    return TM_OK;
}

size_t tm_contacts_next(const tm_contacts *list, size_t i)
{
    const uint32_t node = list->contact[i].node;
    while (i < list->count && list->contact[i].node == node)
        i++;
    return i;
}
