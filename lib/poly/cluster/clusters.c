/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "clusters.h"

#include "../../base/array.h"
#include "../../geom/space_order.h"
#include "../../geom/vector.h"
#include "../compact.h"
#include "../item_sets.h"
#include "cluster_growth.h"

#include <stdlib.h>
#include <string.h>

/* Clusters of less than this part of the mean volume are small. */
static const double small_part = 1.0 / 3;

/* What the clusters are made with. */
typedef struct {
    const tm_cluster_mesh *mesh;
    const tm_poly_options *options;
    tm_poly_report *report;
    tm_error *error;
    bool *kept;          /* [facets] */
    double (*centre)[4]; /* [cells]: centroid, from the first node, and volume */
    uint32_t *order;     /* [cells] along the curve */
    tm_item_lists list;  /* of the cells of each set, along the curve */
} joiner;

static bool differ(const tm_cluster_mesh *mesh, uint32_t c, uint32_t d)
{
    const size_t width = mesh->attributes;
    return width > 1 &&
           memcmp(mesh->attribute + c * width + 1, mesh->attribute + d * width + 1,
                  (width - 1) * sizeof *mesh->attribute) != 0;
}

static void find_kept(joiner *j)
{
    const tm_cell_faces *faces = j->mesh->faces;
    for (size_t f = 0; f < faces->facets; f++) {
        const uint32_t *side = faces->side[f];
        j->kept[f] =
            side[0] == TM_NONE || side[1] == TM_NONE ||
            (faces->marker && faces->marker[f] != 0 && !j->mesh->ignore_markers) ||
            differ(j->mesh, side[0], side[1]);
    }
}

/* Centroids and volumes by the tetrahedra of the first node and the facets' triangles. */
static void measure(joiner *j)
{
    const tm_cell_faces *faces = j->mesh->faces;
    const double(*xyz)[3] = j->mesh->xyz;
    for (size_t c = 0; c < faces->cells; c++) {
        double *to = j->centre[c];
        memset(to, 0, sizeof j->centre[c]);
        for (size_t k = faces->cell_start[c]; k < faces->cell_start[c + 1]; k++) {
            const uint32_t f = faces->cell_facet[k];
            const uint32_t *n = faces->node + faces->start[f];
            for (size_t i = 1; i + 1 < faces->start[f + 1] - faces->start[f]; i++) {
                double v = -tm_tet_volume(xyz[n[0]], xyz[n[i]], xyz[n[i + 1]], xyz[0]);
                v *= tm_facet_is_outward(faces, f, c) ? 1 : -1;
                for (int x = 0; x < 3; x++)
                    to[x] +=
                        v *
                        (xyz[n[0]][x] + xyz[n[i]][x] + xyz[n[i + 1]][x] - 3 * xyz[0][x]) /
                        4;
                to[3] += v;
            }
        }
        for (int x = 0; x < 3; x++)
            to[x] = to[3] != 0 ? to[x] / to[3] : 0;
        to[3] = fabs(to[3]);
    }
}

/* Cells in the order of a curve through their centroids. */
static bool sort(joiner *j)
{
    const size_t cells = j->mesh->faces->cells;
    tm_curve_point *point = tm_new(cells, sizeof *point);
    double(*place)[3] = tm_new(cells, sizeof *place);
    bool done = point && place;
    for (size_t c = 0; c < cells && done; c++)
        memcpy(place[c], j->centre[c], sizeof *place);
    if (done) {
        const tm_space space = tm_space_around((const double(*)[3])place, cells);
        for (uint32_t c = 0; c < cells; c++)
            point[c] = (tm_curve_point){tm_space_position(&space, place[c]), c};
        done = tm_space_sort(point, cells, j->options->threads);
    }
    for (size_t k = 0; k < cells && done; k++)
        j->order[k] = point[k].item;
    free(point);
    free(place);
    return done;
}

static void fill_items(const joiner *j, const uint32_t *rank, tm_compact_items *items,
                       size_t *start)
{
    const tm_cell_faces *faces = j->mesh->faces;
    size_t count = 0;
    for (size_t k = 0; k < faces->cells; k++) {
        const uint32_t c = j->order[k];
        memcpy(items->centre[k], j->centre[c], sizeof *items->centre);
        start[k] = count;
        for (size_t i = faces->cell_start[c]; i < faces->cell_start[c + 1]; i++) {
            const uint32_t f = faces->cell_facet[i], *side = faces->side[f];
            const uint32_t *n = faces->node + faces->start[f];
            double area[3];
            tm_polygon_area(j->mesh->xyz, n, faces->start[f + 1] - faces->start[f], area);
            items->area[count] = tm_norm(area);
            items->beside[count++] =
                j->kept[f] ? TM_NONE : rank[side[0] == c ? side[1] : side[0]];
        }
    }
    start[faces->cells] = count;
}

/* Labels cells by compact clusters. */
static tm_status find_regions(joiner *j, uint32_t *label)
{
    const size_t cells = j->mesh->faces->cells;
    const size_t sides = j->mesh->faces->cell_start[cells];
    const bool is_sized = j->options->cells > 0 || j->options->size > 0;
    const size_t wanted =
        is_sized ? j->options->cells : (cells + TM_CLUSTER_CELLS - 1) / TM_CLUSTER_CELLS;
    size_t *start = tm_new(cells + 1, sizeof *start);
    uint32_t *rank = tm_new(cells, sizeof *rank), *sorted = tm_new(cells, sizeof *sorted);
    tm_compact_items items = {.items = cells,
                              .centre = tm_new(cells, sizeof *items.centre),
                              .start = start,
                              .beside = tm_new(sides, sizeof *items.beside),
                              .area = tm_new(sides, sizeof *items.area)};
    const bool memory =
        start && rank && sorted && items.centre && items.beside && items.area;
    tm_status status = memory ? TM_OK : tm_fail_memory(j->error);
    for (uint32_t k = 0; k < cells && memory; k++)
        rank[j->order[k]] = k;
    if (memory) {
        fill_items(j, rank, &items, start);
        status = tm_compact_label(&items, wanted, j->options->size, j->options->progress,
                                  sorted, &j->report->regions, j->error);
    }
    for (size_t k = 0; k < cells && status == TM_OK; k++)
        label[j->order[k]] = sorted[k];
    free(start);
    free(rank);
    free(sorted);
    free(items.centre);
    free(items.beside);
    free(items.area);
    return status;
}

/* The members of each set, along the curve. */
static bool list_members(joiner *j, const uint32_t *set, size_t sets)
{
    tm_item_lists_free(&j->list);
    return tm_item_lists_make(&j->list, set, j->mesh->faces->cells, sets, j->order);
}

/* Takes regions apart into balls; *pieces is how many. */
static bool take_apart(joiner *j, tm_growth *g, const uint32_t *label, size_t *pieces)
{
    bool memory = list_members(j, label, j->report->regions);
    *pieces = 0;
    for (size_t s = 0; s < j->report->regions && memory; s++) {
        const size_t first = *pieces;
        for (size_t k = j->list.start[s]; k < j->list.start[s + 1] && memory; k++) {
            const uint32_t c = j->list.item[k];
            if (g->piece[c] == TM_NONE)
                memory = tm_growth_begin(g, (uint32_t)(*pieces)++, &c, 1) &&
                         tm_growth_grow(g, label, (uint32_t)s);
        }
        j->report->taken_apart += *pieces > first + 1;
    }
    return memory;
}

/* Lets piece p take up small ones beside it, each whole. */
static bool take_up(joiner *j, tm_growth *g, uint32_t p, double *volume, double small)
{
    bool memory = tm_growth_begin(g, p, j->list.item + j->list.start[p],
                                  j->list.start[p + 1] - j->list.start[p]);
    for (size_t next = 0; next < g->queued && memory; next++) {
        const uint32_t q = g->piece[g->queue[next]];
        bool taken = false;
        if (q == p || !(volume[q] < small))
            continue;
        memory = tm_growth_add(g, j->list.item + j->list.start[q],
                               j->list.start[q + 1] - j->list.start[q], &taken);
        if (!taken)
            continue;
        j->report->absorbed += j->list.start[q + 1] - j->list.start[q];
        volume[p] = volume[q] = HUGE_VAL; /* the lists are not of pieces any more */
    }
    return memory;
}

/* Small pieces join those beside them: larger ones take them up, then what is left of
 * them each other. */
static bool absorb(joiner *j, tm_growth *g, size_t pieces)
{
    const size_t cells = j->mesh->faces->cells;
    double *volume = calloc(pieces + 1, sizeof *volume), all = 0;
    bool memory = volume && list_members(j, g->piece, pieces);
    for (size_t c = 0; c < cells && memory; c++) {
        volume[g->piece[c]] += j->centre[c][3];
        all += j->centre[c][3];
    }
    const double small = small_part * all / (double)(j->report->regions + !pieces);
    bool *is_large = calloc(pieces + 1, sizeof *is_large);
    memory = memory && is_large;
    for (size_t p = 0; p < pieces && memory; p++)
        is_large[p] = volume[p] >= small;
    for (int round = 0; round < 2; round++)
        for (uint32_t p = 0; p < pieces && memory; p++)
            if (is_large[p] == (round == 0) && volume[p] < HUGE_VAL)
                memory = take_up(j, g, p, volume, small);
    free(volume);
    free(is_large);
    return memory;
}

/* Numbers clusters in the order of their first cells; counts those of one. */
static tm_status number(joiner *j, uint32_t *set, size_t sets)
{
    const size_t cells = j->mesh->faces->cells;
    const tm_status status = tm_number_sets(set, cells, &sets, j->error);
    if (status != TM_OK)
        return status;
    if (!list_members(j, set, sets))
        return tm_fail_memory(j->error);
    j->report->cells = sets;
    for (size_t s = 0; s < sets; s++)
        j->report->single += j->list.start[s + 1] - j->list.start[s] == 1;
    return TM_OK;
}

static tm_status repair(joiner *j, uint32_t *label, size_t *pieces)
{
    tm_growth g;
    tm_status status = tm_growth_start(&g, j->mesh, j->options, j->kept, j->error);
    if (status == TM_OK && !(take_apart(j, &g, label, pieces) && absorb(j, &g, *pieces)))
        status = tm_fail_memory(j->error);
    if (status == TM_OK && j->mesh->faces->cells > 0)
        memcpy(label, g.piece, j->mesh->faces->cells * sizeof *label);
    tm_growth_free(&g);
    return status;
}

static tm_status join(joiner *j, uint32_t *label)
{
    const tm_cell_faces *faces = j->mesh->faces;
    j->kept = tm_new(faces->facets, sizeof *j->kept);
    j->centre = tm_new(faces->cells, sizeof *j->centre);
    j->order = tm_new(faces->cells, sizeof *j->order);
    if (!j->kept || !j->centre || !j->order)
        return tm_fail_memory(j->error);
    find_kept(j);
    measure(j);
    tm_status status = sort(j) ? find_regions(j, label) : tm_fail_memory(j->error);
    size_t sets = j->report->regions;
    if (status == TM_OK && j->options->repair)
        status = repair(j, label, &sets);
    return status == TM_OK ? number(j, label, sets) : status;
}

tm_status tm_cluster_cells(const tm_cluster_mesh *mesh, const tm_poly_options *options,
                           uint32_t *label, tm_poly_report *report, tm_error *error)
{
    joiner j = {.mesh = mesh, .options = options, .report = report, .error = error};
    *report = (tm_poly_report){.tets = mesh->faces->cells};
    tm_progress_stage(options->progress, "joining polyhedra");
    const tm_status status = join(&j, label);
    free(j.kept);
    free(j.centre);
    free(j.order);
    tm_item_lists_free(&j.list);
    return status;
}
