/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "parts.h"

#include "../../base/array.h"
#include "../../element/tet_quality.h"
#include "../tet_statistics.h"

#include <stdlib.h>
#include <string.h>

tm_status tm_tet_statistics_ranks(tm_tet_statistics *statistics, size_t *turned,
                                  const tm_element_slices *mesh, double limit,
                                  unsigned threads, tm_error *error)
{
    const size_t tets = mesh->own.elements;
    const tm_rows rows = tm_rows_of(mesh->nodes);
    uint32_t(*tet)[4] = tm_new(tets, sizeof *tet);
    tm_part_nodes nodes = {0};
    tm_tet_statistics *chunk = NULL, *all = NULL;
    size_t chunks = 0, all_chunks;
    tm_status status = tm_ranks_enough(tet, error);
    if (status == TM_OK && tets > 0)
        memcpy(tet, mesh->own.item, tets * sizeof *tet);
    if (status == TM_OK)
        status = tm_part_nodes_make(&nodes, (uint32_t *)tet, 4 * tets, &rows,
                                    mesh->own.xyz, error);
    if (status == TM_OK) {
        const double(*xyz)[3] = (const double(*)[3])nodes.xyz;
        *turned = 0;
        for (size_t t = 0; t < tets; t++)
            *turned += tm_tet_turn(xyz, tet[t]) < 0;
        tm_ranks_sum(turned, 1);
        status = tm_ranks_agree(tm_tet_statistics_chunks(&chunk, &chunks, xyz,
                                                         (const uint32_t(*)[4])tet, tets,
                                                         limit, threads, error),
                                error);
    }
    if (status == TM_OK)
        status = tm_ranks_share(chunk, chunks, sizeof *chunk, (void **)&all, &all_chunks,
                                error);
    if (status == TM_OK)
        tm_tet_statistics_join(statistics, all, all_chunks, mesh->nodes, limit);
    tm_part_nodes_free(&nodes);
    free(tet);
    free(chunk);
    free(all);
    return status;
}
