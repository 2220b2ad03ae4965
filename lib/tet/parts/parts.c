/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the cuts are. */
#include "parts.h"

#include "../../base/array.h"
#include "../../geom/space_order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tm_tet_parts_turn(const double p[3], unsigned round, double q[3])
{
    memcpy(q, p, 3 * sizeof *q);
    for (int axis = 0; axis < 3 && round > 0; axis++) {
        const double angle = 0.6 + 0.35 * (double)(round + (unsigned)axis);
        const double c = cos(angle), s = sin(angle);
        double *u = &q[(axis + 1) % 3], *v = &q[(axis + 2) % 3];
        const double x = *u, y = *v;
        *u = c * x - s * y;
        *v = s * x + c * y;
    }
}

static bool find_order(tm_tet_parts *parts, const tm_tet_mesh *mesh, unsigned round)
{
    double(*xyz)[3] = tm_new(mesh->nodes, sizeof *xyz);
    tm_curve_point *placed = tm_new(mesh->tets, sizeof *placed);
    size_t count = 0;
    for (size_t v = 0; v < mesh->nodes && xyz; v++)
        tm_tet_parts_turn(mesh->xyz[v], round, xyz[v]);
    const tm_space space = xyz ? tm_space_around((const double(*)[3])xyz, mesh->nodes)
                               : (tm_space){.cells = 0};
    for (uint32_t t = 0; t < mesh->slots && placed && xyz; t++)
        if (tm_tet_lives(mesh, t))
            placed[count++] =
                (tm_curve_point){tm_space_position(&space, xyz[mesh->tet[t][0]]), t};
    const bool done = placed && xyz && tm_space_sort(placed, count, 1);
    for (uint32_t k = 0; k < count && done; k++) {
        parts->order[k] = placed[k].item;
        parts->place[placed[k].item] = k;
    }
    free(placed);
    free(xyz);
    return done;
}

bool tm_tet_parts_note_edges(tm_tet_parts *parts, const tm_tet_mesh *mesh)
{
    if (mesh->edges == 0)
        return true;
    parts->has_edge = calloc(mesh->nodes + 1, sizeof *parts->has_edge);
    parts->taken = calloc(mesh->edges, sizeof *parts->taken);
    for (size_t e = 0; e < mesh->edges && parts->has_edge; e++)
        for (int i = 0; i < 2 && !mesh->edge[e].gone; i++)
            parts->has_edge[mesh->edge[e].node[i]] = 1;
    return parts->has_edge && parts->taken;
}

size_t tm_tet_parts_count(size_t tets, size_t size)
{
    return tets > size ? 4 * ((tets + 4 * size - 1) / (4 * size)) : 1;
}

tm_status tm_tet_parts_cut(tm_tet_parts *parts, const tm_tet_mesh *mesh, size_t size,
                           unsigned round, tm_error *error)
{
    const size_t tets = mesh->tets;
    *parts = (tm_tet_parts){.count = tm_tet_parts_count(tets, size)};
    parts->order = tm_new(tets, sizeof *parts->order);
    parts->place = tm_new(mesh->slots, sizeof *parts->place);
    parts->part = calloc(parts->count, sizeof *parts->part);
    if (!parts->order || !parts->place || !parts->part ||
        !find_order(parts, mesh, round) || !tm_tet_parts_note_edges(parts, mesh))
        return tm_fail_memory(error);
    for (size_t p = 0; p < parts->count; p++) {
        parts->part[p].first = (uint32_t)(tets * p / parts->count);
        parts->part[p].past = (uint32_t)(tets * (p + 1) / parts->count);
        parts->part[p].mesh.first_dead = TM_NONE;
    }
    return TM_OK;
}

void tm_tet_parts_free(tm_tet_parts *parts)
{
    for (size_t p = 0; parts->part && p < parts->count; p++) {
        tm_tet_mesh_free(&parts->part[p].mesh);
        free(parts->part[p].node);
    }
    free(parts->part);
    free(parts->order);
    free(parts->place);
    free(parts->has_edge);
    free(parts->taken);
    *parts = (tm_tet_parts){0};
}

void tm_tet_parts_between(const tm_tet_parts *parts, const tm_tet_mesh *mesh,
                          bool *between)
{
    memset(between, 0, mesh->nodes * sizeof *between);
    for (size_t p = 0; p < parts->count; p++) {
        const tm_tet_part *part = &parts->part[p];
        for (uint32_t k = part->first; k < part->past; k++) {
            const uint32_t t = parts->order[k];
            for (uint32_t i = 0; i < 4; i++) {
                const uint32_t g = tm_tet_across(mesh, t, i);
                if (g == TM_NONE || (parts->place[g / 4] >= part->first &&
                                     parts->place[g / 4] < part->past))
                    continue;
                for (uint32_t j = 0; j < 4; j++)
                    if (j != i)
                        between[mesh->tet[t][j]] = true;
            }
        }
    }
}
