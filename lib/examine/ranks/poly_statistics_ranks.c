/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polyhedra are measured with all their facets by those who have them; facets are judged,
 * with the centroids of their cells, by those who have these. */
#include "parts.h"

#include "../../base/array.h"
#include "../poly/poly_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct measuring {
    const tm_poly_slices *mesh;
    tm_poly_statistics *statistics;
    tm_fv_sums fv;          /* of all ranks */
    tm_cell_centroid *cell; /* of this rank's cells */
    unsigned threads;
    tm_error *error;
} measuring;

/* Polyhedra ------------------------------------------------------------------------ */

typedef struct cell_chunks {
    tm_poly_sums *chunk;
    size_t chunks;
} cell_chunks;

static void add_cells(const void *context, void *sum)
{
    const cell_chunks *c = context;
    tm_poly_sums_add(sum, c->chunk, c->chunks);
}

static tm_status sum_cells(measuring *x, const tm_poly_arrays *mesh)
{
    const bool odd = mesh->cells > 0 && !tm_poly_has_tets(mesh);
    const bool with_tets = !tm_ranks_any(odd) && x->mesh->cells > 0;
    cell_chunks c;
    const tm_status status = tm_ranks_agree(
        tm_poly_sums_measure(&c.chunk, &c.chunks, mesh, with_tets, x->threads, x->error),
        x->error);
    if (status == TM_OK) {
        tm_poly_sums sums;
        tm_poly_sums_begin(&sums);
        tm_sum_in_turn(&sums, sizeof sums, add_cells, &c);
        tm_poly_sums_finish(x->statistics, &sums, x->mesh->cells);
    }
    free(c.chunk);
    return status;
}

typedef struct judged {
    tm_fv_sums *chunk;
    size_t chunks;
    double max_bend;
} judged;

static void add_judged(const void *context, void *sum)
{
    const judged *j = context;
    tm_fv_sums *sums = sum;
    tm_fv_sums_add(sums, j->chunk, j->chunks);
    sums->of.max_bend = fmax(sums->of.max_bend, j->max_bend);
}

/* Adds what is judged of the first `count` of this rank's facets, or cells. */
static tm_status judge(measuring *x, const tm_poly_centroids *m, tm_fv_judged what,
                       size_t count)
{
    judged j = {.max_bend = what == TM_FV_FACETS ? m->max_bend : 0};
    const tm_status status = tm_ranks_agree(
        tm_fv_judge(&j.chunk, &j.chunks, m, what, count, x->threads, x->error), x->error);
    if (status == TM_OK)
        tm_sum_in_turn(&x->fv, sizeof x->fv, add_judged, &j);
    free(j.chunk);
    return status;
}

/* A number that is larger where the real is. */
static uint64_t key_of(double real)
{
    const uint64_t sign = (uint64_t)1 << 63;
    uint64_t bits;
    memcpy(&bits, &real, sizeof bits);
    return bits & sign ? ~bits : bits | sign;
}

static double real_of(uint64_t key)
{
    const uint64_t sign = (uint64_t)1 << 63, bits = key & sign ? key & ~sign : ~key;
    double real;
    memcpy(&real, &bits, sizeof real);
    return real;
}

/* How many of ascending reals have a key up to that one. */
static size_t count_through(const double *sorted, size_t count, uint64_t key)
{
    size_t begin = 0, end = count;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (key_of(sorted[middle]) <= key)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

/* Of all ranks' reals, of which this one has some, ascending, those that so many are
 * before: each bit of their keys is found by counting. */
static void find_ordered(const double *sorted, size_t count, const size_t before[2],
                         double found[2])
{
    uint64_t low[2] = {0, 0}, high[2] = {UINT64_MAX, UINT64_MAX}, middle[2];
    for (int bit = 0; bit < 64; bit++) {
        size_t through[2];
        for (int i = 0; i < 2; i++) {
            middle[i] = low[i] + (high[i] - low[i]) / 2;
            through[i] = count_through(sorted, count, middle[i]);
        }
        tm_ranks_sum(through, 2);
        for (int i = 0; i < 2; i++)
            if (through[i] > before[i])
                high[i] = middle[i];
            else
                low[i] = middle[i] + 1;
    }
    for (int i = 0; i < 2; i++)
        found[i] = real_of(low[i]);
}

static tm_status find_spread(measuring *x)
{
    const size_t count = x->mesh->own.cells, all = x->mesh->cells, few = tm_fv_few(all);
    double *volume = tm_new(count, sizeof *volume), found[2];
    const tm_status status = tm_ranks_enough(volume, x->error);
    for (size_t c = 0; c < count && status == TM_OK; c++)
        volume[c] = x->cell[c].volume;
    if (all > 0 && status == TM_OK) {
        qsort(volume, count, sizeof *volume, tm_compare_reals);
        find_ordered(volume, count, (const size_t[2]){few, all - 1 - few}, found);
        x->fv.of.volume_spread = tm_fv_spread(found[0], found[1]);
    }
    free(volume);
    return status;
}

static tm_status measure_cells(measuring *x)
{
    tm_poly_part part;
    tm_poly_centroids m = {0};
    tm_status status = tm_poly_part_of_cells(&part, x->mesh, x->error);
    if (status == TM_OK)
        status = sum_cells(x, &part.mesh);
    /* With the cell that stands for those of other ranks. */
    tm_poly_arrays mesh = part.mesh;
    mesh.cells++;
    if (status == TM_OK)
        status = tm_ranks_agree(tm_poly_centroids_find(&m, &mesh, x->error), x->error);
    if (status == TM_OK)
        status = judge(x, &m, TM_FV_CELLS, part.mesh.cells);
    x->cell = m.cell;
    m.cell = NULL;
    tm_poly_centroids_free(&m);
    tm_poly_part_free(&part);
    return status;
}

/* Facets --------------------------------------------------------------------------- */

/* Sides become places among the cells that they name, whose centroids are got. */
static tm_status fetch_centroids(const measuring *x, tm_poly_part *part,
                                 tm_cell_centroid **cell)
{
    const tm_rows rows = tm_rows_of(x->mesh->cells);
    uint32_t *side = (uint32_t *)part->side;
    const size_t sides = 2 * part->mesh.facets;
    tm_number_set set = {0};
    tm_status status =
        tm_ranks_enough(tm_number_set_of(&set, side, sides, TM_NONE), x->error);
    for (size_t i = 0; i < sides && status == TM_OK; i++)
        if (side[i] != TM_NONE)
            side[i] = tm_number_set_below(&set, side[i]);
    if (status == TM_OK)
        status =
            tm_ranks_fetch(&rows, x->cell, sizeof **cell, &set, (void **)cell, x->error);
    part->mesh.cells = set.count;
    tm_number_set_free(&set);
    return status;
}

static tm_status measure_facets(measuring *x)
{
    tm_poly_part part;
    tm_poly_centroids m = {0};
    tm_cell_centroid *cell = NULL;
    tm_status status = tm_poly_part_of_slice(&part, x->mesh, x->error);
    if (status == TM_OK)
        status = fetch_centroids(x, &part, &cell);
    if (status == TM_OK)
        status = tm_ranks_agree(tm_poly_centroids_find_facets(&m, &part.mesh, x->error),
                                x->error);
    m.cell = cell;
    if (status == TM_OK)
        status = judge(x, &m, TM_FV_FACETS, part.mesh.facets);
    tm_poly_centroids_free(&m);
    tm_poly_part_free(&part);
    return status;
}

static tm_status find_sizes(measuring *x)
{
    tm_examination found;
    bool all_triangles;
    size_t triangles = tm_poly_boundary_triangles(&x->mesh->own, &all_triangles);
    tm_ranks_sum(&triangles, 1);
    if (tm_ranks_any(!all_triangles))
        triangles = 0;
    const tm_status status = tm_poly_count_ranks(&found, x->mesh, x->error);
    if (status == TM_OK)
        tm_poly_find_sizes(x->statistics, &found, x->mesh->nodes, x->mesh->facets,
                           x->mesh->cells, triangles);
    return status;
}

tm_status tm_poly_statistics_ranks(tm_poly_statistics *statistics,
                                   const tm_poly_slices *mesh, unsigned threads,
                                   tm_error *error)
{
    measuring x = {
        .mesh = mesh, .statistics = statistics, .threads = threads, .error = error};
    tm_fv_sums_begin(&x.fv);
    tm_status status = measure_cells(&x);
    if (status == TM_OK)
        status = measure_facets(&x);
    if (status == TM_OK)
        status = find_spread(&x);
    free(x.cell);
    if (status == TM_OK)
        status = find_sizes(&x);
    tm_fv_sums_finish(&x.fv, mesh->cells);
    statistics->fv = x.fv.of;
    return status;
}
