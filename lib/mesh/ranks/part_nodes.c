/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "part_nodes.h"

#include "../../base/array.h"
#include "../../stream/stream.h"

#include <stdlib.h>

tm_status tm_part_nodes_make(tm_part_nodes *nodes, uint32_t *list, size_t count,
                             const tm_rows *rows, const double (*own)[3], tm_error *error)
{
    *nodes = (tm_part_nodes){0};
    bool enough = tm_number_set_of(&nodes->set, list, count, TM_NONE);
    nodes->number = enough ? tm_new(nodes->set.count, sizeof *nodes->number) : NULL;
    enough = nodes->number;
    if (enough)
        tm_number_set_list(&nodes->set, nodes->number);
    for (size_t i = 0; enough && i < count; i++)
        if (list[i] != TM_NONE)
            list[i] = tm_number_set_below(&nodes->set, list[i]);
    tm_status status = tm_ranks_enough(enough, error);
    if (status == TM_OK && rows)
        status = tm_ranks_fetch(rows, own, sizeof *own, &nodes->set, (void **)&nodes->xyz,
                                error);
    return status;
}

void tm_part_nodes_free(tm_part_nodes *nodes)
{
    tm_number_set_free(&nodes->set);
    free(nodes->number);
    free(nodes->xyz);
}
