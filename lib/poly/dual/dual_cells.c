/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which pieces are one cell. */
#include "dual_parts.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "dual_steps.h"

#include <stdlib.h>
#include <string.h>

bool tm_dual_is_cut(const tm_dual *d, uint32_t piece, uint32_t face)
{
    return d->level[d->mesh->tet[piece / 4][piece % 4]] == TM_DUAL_PIECES ||
           (d->has_cuts && d->cuts[piece] >> face & 1);
}

/* Joins the pieces on both sides of face k of t. */
static void join_across(tm_dual *d, uint32_t t, uint32_t k)
{
    const tm_tet_mesh *mesh = d->mesh;
    const uint32_t n = mesh->neighbour[t][k];
    if (n & TM_FACE_BIT || n / 4 < t)
        return;
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t v = mesh->tet[t][i];
        if (i == k || !d->touched[v] || tm_dual_is_cut(d, 4 * t + i, k))
            continue;
        tm_set_unite(d->cell, 4 * t + i, n - n % 4 + tm_tet_corner(mesh, n / 4, v));
    }
}

static void touch_nodes(tm_dual *d)
{
    const tm_tet_mesh *mesh = d->mesh;
    for (size_t v = 0; v < mesh->nodes; v++) {
        d->touched[v] = d->level[v] != TM_DUAL_WHOLE;
        d->has_cuts |= d->level[v] == TM_DUAL_PIECES;
    }
    for (size_t f = 0; f < mesh->faces; f++)
        for (int i = 0; i < 3; i++)
            if (mesh->face[f].side[0] != TM_NONE || mesh->face[f].side[1] != TM_NONE)
                d->touched[mesh->face[f].node[i]] = true;
}

/* Numbers the sets of pieces as they come; *first has room for each node. */
static void number_cells(tm_dual *d, uint32_t *first)
{
    const tm_tet_mesh *mesh = d->mesh;
    d->cells = 0;
    for (size_t v = 0; v < mesh->nodes; v++)
        first[v] = TM_NONE;
    for (uint32_t p = 0; p < 4 * mesh->slots; p++) {
        const uint32_t v = mesh->tet[p / 4][p % 4];
        /* Roots are the first of their sets, and numbered by then. */
        if (d->touched[v] && d->cell[p] != p) {
            d->cell[p] = d->cell[d->cell[p]];
            continue;
        }
        if (!d->touched[v] && first[v] != TM_NONE) {
            d->cell[p] = first[v];
            continue;
        }
        first[v] = (uint32_t)d->cells;
        d->cell_node[d->cells] = v;
        d->cell[p] = (uint32_t)d->cells++;
    }
}

/* Raises the level of the nodes of faces that have to stay but have one cell on both
 * sides; whether there is one. */
static bool find_slits(tm_dual *d)
{
    const tm_tet_mesh *mesh = d->mesh;
    bool found = false;
    for (size_t f = 0; f < mesh->faces; f++) {
        const tm_constrained_face *face = &mesh->face[f];
        if (face->side[0] == TM_NONE || face->side[1] == TM_NONE)
            continue;
        const uint32_t t = face->side[0] / 4, u = face->side[1] / 4;
        for (int i = 0; i < 3; i++) {
            const uint32_t v = face->node[i];
            if (d->cell[4 * t + tm_tet_corner(mesh, t, v)] !=
                d->cell[4 * u + tm_tet_corner(mesh, u, v)])
                continue;
            d->level[v] = d->level[v] == TM_DUAL_WHOLE ? TM_DUAL_TO_CUT : TM_DUAL_PIECES;
            found = true;
        }
    }
    return found;
}

tm_status tm_dual_find_cells(tm_dual *d, tm_error *error)
{
    const tm_tet_mesh *mesh = d->mesh;
    uint32_t *first = tm_new(mesh->nodes, sizeof *first);
    tm_status status = first ? TM_OK : tm_fail_memory(error);
    for (bool again = true; again && status == TM_OK;) {
        status = tm_dual_cut(d, error);
        touch_nodes(d);
        for (uint32_t p = 0; p < 4 * mesh->slots; p++)
            d->cell[p] = p;
        for (uint32_t t = 0; t < mesh->slots; t++)
            for (uint32_t k = 0; k < 4; k++)
                join_across(d, t, k);
        number_cells(d, first);
        again = find_slits(d);
    }
    free(first);
    return status;
}
