/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells that are no balls: at a node where the mesh, within one fan, touches itself or
 * has a tunnel. Only cells on the boundary, or beside others of their node, can be such.
 */
#include "dual_steps.h"

#include "../../examine/poly/poly_boundary.h"

static bool is_inner(const tm_dual *d, const tm_poly_arrays *mesh, size_t c)
{
    for (size_t i = mesh->cell_start[c]; i < mesh->cell_start[c + 1]; i++) {
        const uint32_t *side = mesh->side[mesh->cell_facet[i]];
        if (side[1] == TM_NONE || d->cell_node[side[0]] == d->cell_node[side[1]])
            return false;
    }
    return true;
}

tm_status tm_dual_find_no_balls(tm_dual *d, const tm_poly_arrays *mesh, tm_error *error)
{
    tm_poly_boundary b = {0};
    tm_status status = TM_OK;
    for (uint32_t c = 0; c < d->cells && status == TM_OK; c++) {
        const size_t start = mesh->cell_start[c];
        uint8_t *level = &d->level[d->cell_node[c]];
        if (*level == TM_DUAL_PIECES || is_inner(d, mesh, c))
            continue;
        status = tm_poly_boundary_find(&b, mesh, mesh->cell_facet + start,
                                       mesh->cell_start[c + 1] - start, c, error);
        if (status == TM_OK && tm_poly_boundary_causes(&b) != 0) {
            *level = TM_DUAL_PIECES;
            d->again = true;
        }
    }
    tm_poly_boundary_free(&b);
    return status;
}
