/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "partition.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "correction.h"
#include "item_sets.h"
#include "shelling_star.h"
#include "take_apart.h"

#include <stdlib.h>
#include <string.h>

/* Pieces of so many tetrahedra are absorbed; by one that is small, too, until it has so
 * many, by a larger one as many as it had. */
enum { SMALL = 8, ENOUGH = 4 * SMALL };

/* What the repair works with. */
typedef struct {
    const tm_tet_mesh *mesh;
    const tm_poly_options *options;
    tm_poly_report *report;
    tm_error *error;
    size_t pieces; /* have lower numbers */
    tm_shelling shelling;
} repair;

/* Lets piece p take up small ones beside it, each whole. size[q] is that of piece q, 0
 * where it has been taken up, and large where it must not be. */
static tm_status take_up(repair *r, const tm_item_lists *l, uint32_t p, uint32_t *size)
{
    tm_shelling *s = &r->shelling;
    uint32_t had = l->start[p + 1] - l->start[p];
    const size_t most = had > ENOUGH / 2 ? 2 * (size_t)had : ENOUGH;
    if (!tm_shelling_resume(s, p, l->item + l->start[p], had))
        return tm_fail_memory(r->error);
    for (size_t next = 0; next < s->queued; next++) {
        uint32_t q = s->piece[s->queue[next]];
        bool taken;
        if (q == p || size[q] > SMALL || s->size + size[q] > most)
            continue;
        if (!tm_shelling_add(s, l->item + l->start[q], size[q], &taken))
            return tm_fail_memory(r->error);
        if (taken)
            size[q] = 0;
    }
    r->report->absorbed += s->size - had;
    if (s->size > had)
        size[p] = SMALL + 1; /* its list is not all of it */
    return TM_OK;
}

/* Compact cells may well be of few tetrahedra: only what has less than a third of the
 * mean volume is small then. The others get a size that is not. */
static bool spare_even_ones(const repair *r, uint32_t *size)
{
    const tm_tet_mesh *mesh = r->mesh;
    const uint32_t *piece = r->shelling.piece;
    double *volume = calloc(r->pieces + 1, sizeof *volume), all = 0;
    const bool done = volume;
    for (size_t t = 0; t < mesh->slots && volume; t++) {
        const uint32_t *n = mesh->tet[t];
        const double(*x)[3] = (const double(*)[3])mesh->xyz;
        double v = fabs(tm_tet_volume(x[n[0]], x[n[1]], x[n[2]], x[n[3]]));
        volume[piece[t]] += v;
        all += v;
    }
    for (size_t p = 0; p < r->pieces && volume; p++)
        if (size[p] <= SMALL && 3 * volume[p] >= all / (double)r->report->regions)
            size[p] = SMALL + 1;
    free(volume);
    return done;
}

/* Small pieces join those beside them: first larger ones take them up, then small ones.
 */
static tm_status absorb(repair *r)
{
    tm_item_lists l = {0};
    tm_status status = TM_OK;
    tm_progress_stage(r->options->progress, "absorbing");
    uint32_t *size = tm_new(r->pieces, sizeof *size);
    if (!size ||
        !tm_item_lists_make(&l, r->shelling.piece, r->mesh->slots, r->pieces, NULL))
        status = tm_fail_memory(r->error);
    for (size_t p = 0; p < r->pieces && status == TM_OK; p++)
        size[p] = l.start[p + 1] - l.start[p];
    if (status == TM_OK && r->options->mode == TM_POLY_COMPACT &&
        !spare_even_ones(r, size))
        status = tm_fail_memory(r->error);
    for (int round = 0; round < 2; round++)
        for (uint32_t p = 0; p < l.sets && status == TM_OK; p++)
            if (round == 0 ? size[p] > SMALL : size[p] > 0 && size[p] <= SMALL)
                status = take_up(r, &l, p, size);
    free(size);
    tm_item_lists_free(&l);
    return status;
}

/* Counts pieces that are no stars: where no radius is given, only a flat tetrahedron can
 * be none. */
static tm_status count_stars(repair *r)
{
    tm_shelling *s = &r->shelling;
    tm_item_lists l = {0};
    bool memory = tm_item_lists_make(&l, s->piece, r->mesh->slots, r->pieces, NULL);
    for (uint32_t p = 0; p < l.sets && memory; p++) {
        const size_t size = l.start[p + 1] - l.start[p];
        if (size != 1 && r->options->star != TM_STAR_RADIUS)
            continue;
        memory = size == 0 || tm_shelling_resume(s, p, l.item + l.start[p], size);
        if (memory && size > 0 && !tm_shelling_is_star(s, &memory))
            r->report->not_star++;
    }
    tm_item_lists_free(&l);
    return memory ? TM_OK : tm_fail_memory(r->error);
}

static tm_status repair_regions(tm_partition *partition, const tm_tet_mesh *mesh,
                                const tm_poly_options *options, tm_poly_report *report,
                                tm_error *error)
{
    repair r = {.mesh = mesh,
                .options = options,
                .report = report,
                .error = error,
                .pieces = mesh->slots};
    tm_status status = tm_shelling_start(&r.shelling, mesh, options, error);
    if (status == TM_OK)
        status = tm_take_apart(&r.shelling, partition->cell, report, error);
    if (status == TM_OK && options->absorb)
        status = absorb(&r);
    if (status == TM_OK && options->star)
        status = count_stars(&r);
    if (status == TM_OK) {
        memcpy(partition->cell, r.shelling.piece, mesh->slots * sizeof *partition->cell);
        partition->cells = r.pieces;
    }
    tm_shelling_free(&r.shelling);
    return status;
}

void tm_ignore_markers(tm_tet_mesh *mesh)
{
    size_t width = mesh->regions;
    for (size_t f = 0; f < mesh->faces; f++) {
        tm_constrained_face *face = &mesh->face[f];
        if (face->side[0] == TM_NONE || face->side[1] == TM_NONE)
            continue;
        if (width > 0 && memcmp(mesh->region + face->side[0] / 4 * width,
                                mesh->region + face->side[1] / 4 * width,
                                width * sizeof *mesh->region) != 0)
            continue;
        tm_tet_join(mesh, face->side[0], face->side[1]);
        face->side[0] = face->side[1] = TM_NONE;
        face->listed = false;
    }
}

void tm_partition_free(tm_partition *partition)
{
    free(partition->cell);
    free(partition->order);
    *partition = (tm_partition){0};
}

static tm_status order_by_cell(tm_partition *partition, size_t tets, tm_error *error)
{
    tm_item_lists l = {0};
    bool done = tm_item_lists_make(&l, partition->cell, tets, partition->cells, NULL);
    free(l.start);
    partition->order = l.item;
    return done ? TM_OK : tm_fail_memory(error);
}

/* How many cells are of one tetrahedron. */
static size_t count_single(const tm_partition *partition, size_t tets)
{
    const uint32_t *order = partition->order, *cell = partition->cell;
    size_t count = 0;
    for (size_t k = 0; k < tets; k++)
        count += !(k > 0 && cell[order[k - 1]] == cell[order[k]]) &&
                 !(k + 1 < tets && cell[order[k + 1]] == cell[order[k]]);
    return count;
}

/* Takes the regions as they are given. */
static void take_regions(const tm_tet_mesh *mesh, const uint32_t *given, uint32_t *label,
                         size_t *regions)
{
    *regions = 0;
    for (size_t t = 0; t < mesh->slots; t++) {
        label[t] = given[t];
        if (label[t] >= *regions)
            *regions = (size_t)label[t] + 1;
    }
}

/* Labels tetrahedra by their regions. Ties are told by the numbers of nodes: so that they
 * do not depend on how the mesh was numbered, nodes are numbered by their places here. */
static tm_status find_regions(const tm_tet_mesh *mesh, const tm_poly_options *options,
                              uint32_t *label, size_t *regions, tm_error *error)
{
    tm_tet_mesh ranked = *mesh;
    uint32_t *rank = tm_new(mesh->nodes, sizeof *rank);
    ranked.xyz = tm_new(mesh->nodes, sizeof *ranked.xyz);
    ranked.tet = tm_new(mesh->slots, sizeof *ranked.tet);
    bool done = rank && ranked.xyz && ranked.tet && tm_tet_mesh_rank_nodes(mesh, rank);
    for (size_t v = 0; v < mesh->nodes && done; v++)
        memcpy(ranked.xyz[rank[v]], mesh->xyz[v], sizeof *ranked.xyz);
    for (size_t t = 0; t < mesh->slots && done; t++)
        for (int i = 0; i < 4; i++)
            ranked.tet[t][i] = rank[mesh->tet[t][i]];
    tm_status status =
        done ? tm_poly_modes[options->mode].label(&ranked, options, label, regions, error)
             : tm_fail_memory(error);
    free(rank);
    free(ranked.xyz);
    free(ranked.tet);
    return status;
}

tm_status tm_partition_make(tm_partition *partition, const tm_tet_mesh *mesh,
                            const tm_poly_options *options, tm_poly_report *report,
                            tm_error *error)
{
    *report = (tm_poly_report){.tets = mesh->tets};
    *partition = (tm_partition){.cell = tm_new(mesh->slots, sizeof *partition->cell)};
    if (!partition->cell)
        return tm_fail_memory(error);
    tm_progress_stage(options->progress, "joining tetrahedra");
    tm_status status = TM_OK;
    if (options->given)
        take_regions(mesh, options->given, partition->cell, &report->regions);
    else
        status = find_regions(mesh, options, partition->cell, &report->regions, error);
    partition->cells = report->regions;
    if (status == TM_OK && options->repair)
        status = repair_regions(partition, mesh, options, report, error);
    if (status == TM_OK)
        status = tm_number_sets(partition->cell, mesh->slots, &partition->cells, error);
    if (status == TM_OK && options->star == TM_STAR_CENTROID) {
        status = tm_calm_cells(mesh, partition->cell, &partition->cells, error);
        if (status == TM_OK)
            status =
                tm_number_sets(partition->cell, mesh->slots, &partition->cells, error);
    }
    if (status == TM_OK)
        status = order_by_cell(partition, mesh->slots, error);
    report->cells = partition->cells;
    if (status == TM_OK && options->star)
        report->single = count_single(partition, mesh->slots);
    return status;
}
