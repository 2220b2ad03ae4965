/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points are moved where that makes facets and cells better (fit.h): those of faces that
 * stay in their triangle or along their edge, those inside anywhere. */
#include "dual_steps.h"

#include "../../base/array.h"
#include "../../examine/poly/poly_all_geometry.h"
#include "../facets.h"
#include "../fit/fit.h"

#include <stdlib.h>
#include <string.h>

/* Of moving points; and so many times, after the work is spent, only nodes with a wrong
 * pyramid are taken apart. */
enum { ROUNDS = 36, LATE_ROUNDS = 50 };

/* The least barycentric coordinate that a point may have. */
static const double least_coordinate = 0.03;

/* Fills the corners of what a point may move in, before TM_NONE: none where that is in
 * nothing that has to stay; whether it may move. */
static bool find_corners(const tm_dual *d, size_t p, uint32_t corner[4])
{
    const uint32_t of = d->point[p].of;
    memset(corner, UINT8_MAX, 4 * sizeof *corner);
    switch ((tm_dual_place)d->point[p].place) {
    case TM_DUAL_IN_TET:
        return true;
    case TM_DUAL_IN_FACE:
        if (d->wall[of].constrained)
            tm_dual_half_nodes(d->mesh, d->wall[of].half, corner);
        return true;
    case TM_DUAL_ON_EDGE:
        if (d->edge[of].constrained)
            memcpy(corner, d->edge[of].node, 2 * sizeof *corner);
        return true;
    case TM_DUAL_AT_NODE:
        break;
    }
    return false;
}

static tm_status move_points(tm_dual *d, const tm_poly_arrays *mesh,
                             tm_dual_report *report, tm_error *error)
{
    bool *fixed = tm_new(d->points, sizeof *fixed);
    uint32_t(*corner)[4] = tm_new(d->points, sizeof *corner);
    tm_status status = fixed && corner ? TM_OK : tm_fail_memory(error);
    for (size_t p = 0; p < d->points && fixed && corner; p++)
        fixed[p] = !find_corners(d, p, corner[p]);
    if (d->most == 0)
        d->most =
            1 + (mesh->facets > 0 ? TM_DUAL_WORK * mesh->facet_start[mesh->facets] : 0);
    const tm_fit_options options = {.fixed = fixed,
                                    .corner = (const uint32_t(*)[4])corner,
                                    .point = (const double(*)[3])d->mesh->xyz,
                                    .least = least_coordinate,
                                    .convex = d->options->convex,
                                    .rounds = ROUNDS,
                                    .work = d->spent ? 1 : d->most - report->work};
    tm_fit_report fit;
    if (status == TM_OK)
        status = tm_polyhedra_fit(mesh, d->xyz, &options, &fit, error);
    free(fixed);
    free(corner);
    if (status != TM_OK)
        return status;
    report->moved += fit.moved;
    report->work += fit.work;
    report->rounds++;
    d->spent = report->work >= d->most;
    d->late += d->spent;
    report->bad_facets = tm_fit_faults_left(&fit) - fit.after[TM_FIT_CONCAVE];
    return TM_OK;
}

/* Whether the pyramid of a facet and its first (0) or second (1) cell has no volume. */
static bool is_wrong(const tm_poly_centroids *m, size_t f, int side)
{
    const uint32_t c = m->mesh->side[f][side];
    return c != TM_NONE &&
           !(tm_facet_pyramid(&m->face[f], m->cell[c].centre, side ? -1 : 1) > 0);
}

/* The node of a cell is to be cut one level further. */
static void cut_more(tm_dual *d, uint32_t c, tm_dual_level most)
{
    uint8_t *level = &d->level[d->cell_node[c]];
    const tm_dual_level next =
        d->spent ? TM_DUAL_PIECES : tm_dual_next_level((tm_dual_level)*level);
    if (next == *level || next > most)
        return;
    *level = (uint8_t)next;
    d->again = true;
}

static void cut_wrong(tm_dual *d, const tm_poly_centroids *m, tm_dual_level most,
                      tm_dual_report *report)
{
    report->wrong_pyramids = 0;
    for (size_t f = 0; f < d->facets; f++)
        for (int s = 0; s < 2; s++)
            if (is_wrong(m, f, s)) {
                report->wrong_pyramids++;
                cut_more(d, m->mesh->side[f][s], most);
            }
}

/* Takes the nodes beside those apart that are. */
static void take_more_apart(tm_dual *d)
{
    for (size_t t = 0; t < d->mesh->slots; t++)
        for (int i = 0; i < 4 && d->frozen[t]; i++)
            d->level[d->mesh->tet[t][i]] = TM_DUAL_PIECES;
}

/* Whether a cell is concave at a facet on a wall. */
static bool is_bent(const tm_dual *d, const tm_poly_centroids *m, uint32_t c)
{
    const tm_poly_arrays *mesh = m->mesh;
    const size_t begin = mesh->cell_start[c], end = mesh->cell_start[c + 1];
    for (size_t i = begin; i < end; i++) {
        const uint32_t f = mesh->cell_facet[i], *side = mesh->side[f];
        if (side[1] != TM_NONE && d->cell_node[side[0]] != d->cell_node[side[1]])
            continue;
        for (size_t k = begin; k < end; k++) {
            const uint32_t g = mesh->cell_facet[k];
            if (k != i && (tm_facet_beyond(m, f, g, c) > -TM_FV_PLANE ||
                           tm_facet_beyond(m, g, f, c) > -TM_FV_PLANE))
                return true;
        }
    }
    return false;
}

static void cut_concave(tm_dual *d, const tm_poly_centroids *m, tm_dual_level most,
                        tm_dual_report *report)
{
    report->concave = 0;
    for (uint32_t c = 0; c < d->cells; c++) {
        if (!tm_cell_is_concave(m, c))
            continue;
        report->concave++;
        if (d->options->convex && is_bent(d, m, c))
            cut_more(d, c, most);
    }
}

/* What is wrong is to be cut, or where points were not moved yet only what is whole. */
static tm_status cut(tm_dual *d, const tm_poly_arrays *mesh, bool moved,
                     tm_dual_report *report, tm_error *error)
{
    tm_poly_centroids m;
    const tm_status status = tm_poly_centroids_find(&m, mesh, error);
    d->again = false;
    if (status == TM_OK)
        cut_wrong(d, &m, moved ? TM_DUAL_PIECES : TM_DUAL_TO_CUT, report);
    d->again |= d->late == 1 && report->wrong_pyramids > 0;
    if (d->again && d->late > LATE_ROUNDS)
        take_more_apart(d);
    if (status == TM_OK && moved)
        cut_concave(d, &m, TM_DUAL_TO_CUT_MORE, report);
    tm_poly_centroids_free(&m);
    return status;
}

tm_status tm_dual_improve(tm_dual *d, bool move, tm_dual_report *report, tm_error *error)
{
    tm_block cells = {.kind = TM_CELL};
    tm_status status = tm_cells_from_facets(&d->facet, &cells, d->cells, error);
    const tm_poly_arrays mesh = {.nodes = d->points,
                                 .xyz = (const double(*)[3])d->xyz,
                                 .facets = d->facets,
                                 .side = (const uint32_t(*)[2])d->facet.integer,
                                 .facet_start = d->facet.start,
                                 .facet_node = d->facet.item,
                                 .cells = d->cells,
                                 .cell_start = cells.start,
                                 .cell_facet = cells.item};
    if (status == TM_OK && move)
        status = move_points(d, &mesh, report, error);
    if (status == TM_OK)
        status = cut(d, &mesh, move, report, error);
    if (status == TM_OK)
        status = tm_dual_find_no_balls(d, &mesh, error);
    if (status == TM_OK)
        memcpy(d->tet_xyz, d->xyz, d->mesh->slots * sizeof *d->tet_xyz);
    tm_block_clear(&cells);
    return status;
}
