/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "partition.h"

#include "../base/array.h"
#include "../base/parallel.h"
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

/* So many nodes or tetrahedra are a thread's work at a time. */
enum { CHUNK = 8192 };

/* What the repair works with. */
typedef struct {
    const tm_tet_mesh *mesh;
    const tm_poly_options *options;
    tm_poly_report *report;
    tm_error *error;
    size_t pieces; /* have lower numbers */
    tm_shelling *shelling;
} repair;

/* Lets piece p take up small ones beside it, each whole. size[q] is that of piece q, 0
 * where it has been taken up, and large where it must not be. */
static tm_status take_up(repair *r, const tm_item_lists *l, uint32_t p, uint32_t *size)
{
    tm_shelling *s = r->shelling;
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
    const uint32_t *piece = r->shelling->piece;
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
        !tm_item_lists_make(&l, r->shelling->piece, r->mesh->slots, r->pieces, NULL))
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

/* Repairs the regions partition->cell, which become pieces. The shelling has these, too,
 * and is to be freed also after an error. */
static tm_status repair_regions(tm_partition *partition, tm_shelling *shelling,
                                const tm_tet_mesh *mesh, const tm_poly_options *options,
                                tm_poly_report *report, tm_error *error)
{
    repair r = {.mesh = mesh,
                .options = options,
                .report = report,
                .error = error,
                .pieces = mesh->slots,
                .shelling = shelling};
    tm_status status = tm_shelling_start(shelling, mesh, options, error);
    if (status == TM_OK)
        status = tm_take_apart(shelling, partition->cell, report, error);
    if (status == TM_OK && options->absorb)
        status = absorb(&r);
    if (status != TM_OK)
        return status;
    free(partition->cell);
    partition->cell = shelling->piece;
    partition->cells = r.pieces;
    shelling->piece = NULL;
    return TM_OK;
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

/* What is counted in a chunk of cells. */
typedef struct {
    size_t single, not_star;
    bool memory;
} star_count;

typedef struct {
    tm_shelling
        all; /* whose pieces are the cells; nothing but that where none is asked */
    tm_item_lists list;
    star_count *count; /* [chunks] */
} star_work;

/* Where no radius is given, only a flat tetrahedron can be no star. */
static void count_chunk(void *context, size_t from, size_t to)
{
    const star_work *w = context;
    const uint32_t *start = w->list.start;
    star_count *count = &w->count[from / CHUNK];
    tm_shelling s;
    tm_shelling_fork(&s, &w->all);
    count->memory = true;
    for (size_t c = from; c < to && count->memory; c++) {
        const size_t size = start[c + 1] - start[c];
        count->single += size == 1;
        if (!s.xyz || (size != 1 && s.options->star != TM_STAR_RADIUS))
            continue;
        count->memory =
            tm_shelling_resume(&s, (uint32_t)c, w->list.item + start[c], size);
        if (count->memory && !tm_shelling_is_star(&s, &count->memory))
            count->not_star++;
    }
    tm_shelling_end(&s);
}

/* Lists tetrahedra by their cells. With stars counts those that are of one tetrahedron,
 * and what is none for all repair, of which there is the shelling. */
static tm_status order_by_cell(tm_partition *partition, const tm_shelling *shelling,
                               const tm_tet_mesh *mesh, const tm_poly_options *options,
                               tm_poly_report *report, tm_error *error)
{
    const size_t chunks = options->star ? tm_parallel_chunks(partition->cells, CHUNK) : 0;
    star_work w = {.all = *shelling, .count = calloc(chunks + 1, sizeof *w.count)};
    w.all.piece = partition->cell;
    bool done = w.count && tm_item_lists_make(&w.list, partition->cell, mesh->slots,
                                              partition->cells + 1, NULL);
    if (done)
        tm_parallel_runs(options->threads, options->star ? partition->cells : 0, CHUNK,
                         count_chunk, &w);
    for (size_t c = 0; c < chunks && done; c++) {
        report->single += w.count[c].single;
        report->not_star += w.count[c].not_star;
        done = w.count[c].memory;
    }
    report->cells = partition->cells;
    partition->order = w.list.item;
    free(w.list.start);
    free(w.count);
    return done ? TM_OK : tm_fail_memory(error);
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

/* A mesh whose nodes are numbered otherwise. */
typedef struct {
    const tm_tet_mesh *mesh;
    const uint32_t *rank;
    tm_tet_mesh ranked;
} renumbering;

static void renumber_tets(void *context, size_t from, size_t to)
{
    const renumbering *r = context;
    for (size_t t = from; t < to; t++)
        for (int i = 0; i < 4; i++)
            r->ranked.tet[t][i] = r->rank[r->mesh->tet[t][i]];
}

static void renumber_nodes(void *context, size_t from, size_t to)
{
    const renumbering *r = context;
    for (size_t v = from; v < to; v++)
        memcpy(r->ranked.xyz[r->rank[v]], r->mesh->xyz[v], sizeof *r->ranked.xyz);
}

/* Labels tetrahedra by their regions. Ties are told by the numbers of nodes: so that they
 * do not depend on how the mesh was numbered, nodes are numbered by their places here. */
static tm_status find_regions(const tm_tet_mesh *mesh, const tm_poly_options *options,
                              tm_poly_label *find, uint32_t *label, size_t *regions,
                              tm_error *error)
{
    uint32_t *rank = tm_new(mesh->nodes, sizeof *rank);
    renumbering r = {.mesh = mesh, .rank = rank, .ranked = *mesh};
    r.ranked.xyz = tm_new(mesh->nodes, sizeof *r.ranked.xyz);
    r.ranked.tet = tm_new(mesh->slots, sizeof *r.ranked.tet);
    const bool done = rank && r.ranked.xyz && r.ranked.tet &&
                      tm_tet_mesh_rank_nodes(mesh, rank, options->threads);
    if (done) {
        tm_parallel_runs(options->threads, mesh->nodes, CHUNK, renumber_nodes, &r);
        tm_parallel_runs(options->threads, mesh->slots, CHUNK, renumber_tets, &r);
    }
    tm_status status =
        done ? find(&r.ranked, options, label, regions, error) : tm_fail_memory(error);
    free(rank);
    free(r.ranked.xyz);
    free(r.ranked.tet);
    return status;
}

tm_status tm_partition_outlets(const tm_tet_mesh *mesh, const tm_poly_options *options,
                               uint32_t *up, tm_error *error)
{
    size_t regions;
    return find_regions(mesh, options, tm_poly_outlets, up, &regions, error);
}

/* Numbers cells in the order of their first tetrahedra, what is in none behind them. */
static tm_status number_cells(tm_partition *partition, const tm_tet_mesh *mesh,
                              tm_error *error)
{
    uint32_t *cell = partition->cell;
    size_t other = mesh->slots;
    for (size_t t = mesh->slots; t-- > 0;)
        if (cell[t] == TM_NONE) {
            cell[t] = (uint32_t)mesh->slots;
            other = t;
        }
    partition->cells = mesh->slots + 1;
    const tm_status status = tm_number_sets(cell, mesh->slots, &partition->cells, error);
    if (status != TM_OK || other == mesh->slots)
        return status;
    const uint32_t none = cell[other], last = (uint32_t)--partition->cells;
    for (size_t t = 0; t < mesh->slots; t++)
        cell[t] = cell[t] == none ? last : cell[t] - (cell[t] > none);
    return TM_OK;
}

tm_status tm_partition_repair(tm_partition *partition, const tm_tet_mesh *mesh,
                              const tm_poly_options *options, tm_poly_report *report,
                              tm_error *error)
{
    tm_shelling shelling = {0};
    tm_status status = repair_regions(partition, &shelling, mesh, options, report, error);
    if (status == TM_OK)
        status = number_cells(partition, mesh, error);
    if (status == TM_OK)
        status = order_by_cell(partition, &shelling, mesh, options, report, error);
    tm_shelling_free(&shelling);
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
    tm_shelling shelling = {0};
    if (options->given)
        take_regions(mesh, options->given, partition->cell, &report->regions);
    else
        status = find_regions(mesh, options, tm_poly_modes[options->mode].label,
                              partition->cell, &report->regions, error);
    partition->cells = report->regions;
    if (status == TM_OK && options->repair)
        status = repair_regions(partition, &shelling, mesh, options, report, error);
    if (status == TM_OK)
        status = tm_number_sets(partition->cell, mesh->slots, &partition->cells, error);
    if (status == TM_OK && options->star == TM_STAR_CENTROID) {
        status = tm_calm_cells(mesh, partition->cell, &partition->cells, error);
        if (status == TM_OK)
            status =
                tm_number_sets(partition->cell, mesh->slots, &partition->cells, error);
    }
    if (status == TM_OK)
        status = order_by_cell(partition, &shelling, mesh, options, report, error);
    tm_shelling_free(&shelling);
    return status;
}
