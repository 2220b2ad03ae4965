/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_statistics.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../base/sum.h"
#include "poly_parts.h"

#include <math.h>
#include <stdlib.h>

/* Polyhedra that one thread measures at a time. */
enum { CHUNK = 256 };

typedef struct measuring {
    const tm_poly_arrays *mesh;
    bool with_tets;
    tm_poly_sums *chunk; /* one for each CHUNK of cells */
} measuring;

/* What a thread keeps from one polyhedron to the next. */
typedef struct workspace {
    tm_poly_boundary boundary;
    tm_poly_shape_memory shape;
} workspace;

static const double largest_angle = 360; /* degrees */

size_t tm_count_bin_begin(size_t bin)
{
    if (bin == 0)
        return 1;
    const size_t power = (size_t)1 << (bin - 1) / 2;
    return bin % 2 == 1 ? 2 * power : 3 * power;
}

size_t tm_count_bins(const size_t *histogram)
{
    size_t bins = TM_COUNT_BINS;
    while (bins > 0 && histogram[bins - 1] == 0)
        bins--;
    return bins;
}

static size_t count_bin(size_t count)
{
    size_t bin = 0;
    while (bin + 1 < TM_COUNT_BINS && count >= tm_count_bin_begin(bin + 1))
        bin++;
    return bin;
}

static size_t ratio_bin(double ratio)
{
    /* Convex polyhedra have 1 but for rounding. */
    const double rounding = 1e-9;
    const double bin = (ratio + rounding) * TM_KERNEL_RATIO_BINS;
    return bin < TM_KERNEL_RATIO_BINS ? (size_t)bin : TM_KERNEL_RATIO_BINS - 1;
}

void tm_poly_sums_begin(tm_poly_sums *sums)
{
    *sums = (tm_poly_sums){
        .part = {.min_volume = HUGE_VAL,
                 .min_edge = HUGE_VAL,
                 .min_face_area = HUGE_VAL,
                 .min_dihedral = largest_angle,
                 .edge_ratio = {.min = HUGE_VAL},
                 .kernel_radius = {.min = HUGE_VAL},
                 .kernel_ratio = {.min = HUGE_VAL},
                 .centroid_depth = {.min = HUGE_VAL},
                 .rho = {{.min = HUGE_VAL}, {.min = HUGE_VAL}, {.min = HUGE_VAL}}},
        .status = TM_OK};
}

static void add_value(tm_poly_range *range, double value)
{
    range->min = fmin(range->min, value);
    range->mean += value;
}

static void add_range(tm_poly_range *sum, const tm_poly_range *range)
{
    sum->min = fmin(sum->min, range->min);
    sum->mean += range->mean;
}

static size_t tets_of(const tm_poly_arrays *mesh, size_t c)
{
    return (size_t)mesh->attribute[c * mesh->attributes];
}

bool tm_poly_has_tets(const tm_poly_arrays *mesh)
{
    const double most = 4294967295;
    for (size_t c = 0; mesh->attribute && c < mesh->cells; c++) {
        const double tets = mesh->attribute[c * mesh->attributes];
        if (!(tets >= 1 && tets <= most && tets == floor(tets)))
            return false;
    }
    return mesh->attribute && mesh->attributes > 0 && mesh->cells > 0;
}

static void count_causes(tm_poly_statistics *s, unsigned causes)
{
    s->non_simple += causes != 0;
    for (size_t i = 0; i < TM_POLY_CAUSES; i++)
        s->cause[i] += causes >> i & 1;
}

static void count_tets(tm_poly_statistics *s, size_t tets)
{
    s->input.elements += tets;
    s->largest_tets = tets > s->largest_tets ? tets : s->largest_tets;
    s->tets[count_bin(tets)]++;
}

static void add_shape(tm_poly_sums *sums, const tm_poly_shape *shape)
{
    tm_poly_statistics *s = &sums->part;
    tm_sum_add(&sums->volume, shape->volume);
    s->min_volume = fmin(s->min_volume, shape->volume);
    s->min_edge = fmin(s->min_edge, shape->min_edge);
    s->min_face_area = fmin(s->min_face_area, shape->min_face_area);
    s->min_dihedral = fmin(s->min_dihedral, shape->min_dihedral);
    s->max_dihedral = fmax(s->max_dihedral, shape->max_dihedral);
    s->not_star_shaped += !shape->star_shaped;
    add_value(&s->edge_ratio,
              shape->diameter > 0 ? shape->min_edge / shape->diameter : 0);
    add_value(&s->kernel_radius, shape->kernel_radius);
    add_value(&s->kernel_ratio, shape->kernel_ratio);
    s->kernel_ratios[ratio_bin(shape->kernel_ratio)]++;
    s->centroid_outside += !(shape->centroid_depth > 0);
    add_value(&s->centroid_depth, shape->centroid_depth);
    for (int k = 0; k < 3; k++)
        add_value(&s->rho[k], shape->rho[k]);
    s->vem_indicator += shape->rho[0] * (shape->rho[1] + shape->rho[2]) / 2;
    s->max_diameter = fmax(s->max_diameter, shape->diameter);
}

static tm_status find_boundary(workspace *w, const tm_poly_arrays *mesh, size_t c)
{
    const size_t start = mesh->cell_start[c], faces = mesh->cell_start[c + 1] - start;
    return tm_poly_boundary_find(&w->boundary, mesh, mesh->cell_facet + start, faces,
                                 (uint32_t)c, NULL);
}

static void workspace_free(workspace *w)
{
    tm_poly_boundary_free(&w->boundary);
    tm_poly_shape_memory_free(&w->shape);
}

static void measure_cell(tm_poly_sums *sums, const measuring *m, workspace *w, size_t c)
{
    const tm_poly_arrays *mesh = m->mesh;
    const size_t faces = mesh->cell_start[c + 1] - mesh->cell_start[c];
    tm_poly_shape shape = {0};
    sums->status = find_boundary(w, mesh, c);
    if (sums->status == TM_OK)
        sums->status =
            tm_poly_shape_measure(&shape, &w->shape, &w->boundary, mesh->xyz, NULL);
    if (sums->status != TM_OK)
        return;
    count_causes(&sums->part, tm_poly_boundary_causes(&w->boundary));
    add_shape(sums, &shape);
    sums->part.faces[count_bin(faces)]++;
    sums->part.faces_per_polyhedron += (double)faces;
    if (faces > sums->part.largest_faces)
        sums->part.largest_faces = faces;
    if (m->with_tets)
        count_tets(&sums->part, tets_of(mesh, c));
}

static void measure_chunk(void *context, size_t first, size_t past)
{
    const measuring *m = context;
    workspace w = {.boundary = {0}};
    tm_poly_sums sums;
    tm_poly_sums_begin(&sums);
    for (size_t c = first; c < past && sums.status == TM_OK; c++)
        measure_cell(&sums, m, &w, c);
    workspace_free(&w);
    m->chunk[first / CHUNK] = sums;
}

static void add_counts(size_t *sum, const size_t *counts, size_t count)
{
    for (size_t i = 0; i < count; i++)
        sum[i] += counts[i];
}

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

static void add(tm_poly_statistics *sum, const tm_poly_statistics *s)
{
    sum->input.elements += s->input.elements;
    sum->non_simple += s->non_simple;
    sum->not_star_shaped += s->not_star_shaped;
    sum->largest_faces = larger(sum->largest_faces, s->largest_faces);
    sum->largest_tets = larger(sum->largest_tets, s->largest_tets);
    sum->faces_per_polyhedron += s->faces_per_polyhedron;
    sum->min_volume = fmin(sum->min_volume, s->min_volume);
    sum->min_edge = fmin(sum->min_edge, s->min_edge);
    sum->min_face_area = fmin(sum->min_face_area, s->min_face_area);
    sum->min_dihedral = fmin(sum->min_dihedral, s->min_dihedral);
    sum->max_dihedral = fmax(sum->max_dihedral, s->max_dihedral);
    add_range(&sum->edge_ratio, &s->edge_ratio);
    add_range(&sum->kernel_radius, &s->kernel_radius);
    add_range(&sum->kernel_ratio, &s->kernel_ratio);
    add_range(&sum->centroid_depth, &s->centroid_depth);
    for (int k = 0; k < 3; k++)
        add_range(&sum->rho[k], &s->rho[k]);
    sum->centroid_outside += s->centroid_outside;
    sum->vem_indicator += s->vem_indicator;
    sum->max_diameter = fmax(sum->max_diameter, s->max_diameter);
    add_counts(sum->cause, s->cause, TM_POLY_CAUSES);
    add_counts(sum->faces, s->faces, TM_COUNT_BINS);
    add_counts(sum->tets, s->tets, TM_COUNT_BINS);
    add_counts(sum->kernel_ratios, s->kernel_ratios, TM_KERNEL_RATIO_BINS);
}

/* Sums become means. */
static void divide(tm_poly_statistics *s, size_t polyhedra)
{
    const double count = (double)polyhedra;
    s->faces_per_polyhedron /= count;
    s->tets_per_polyhedron = (double)s->input.elements / count;
    s->edge_ratio.mean /= count;
    s->kernel_radius.mean /= count;
    s->kernel_ratio.mean /= count;
    s->centroid_depth.mean /= count;
    for (int k = 0; k < 3; k++)
        s->rho[k].mean /= count;
    s->vem_indicator = sqrt(s->vem_indicator / count);
}

void tm_poly_sums_add(tm_poly_sums *sums, const tm_poly_sums *chunk, size_t chunks)
{
    for (size_t i = 0; i < chunks; i++) {
        add(&sums->part, &chunk[i].part);
        tm_sum_add(&sums->volume, chunk[i].volume.high);
        tm_sum_add(&sums->volume, chunk[i].volume.low);
    }
}

void tm_poly_sums_finish(tm_poly_statistics *s, const tm_poly_sums *sums, size_t cells)
{
    *s = (tm_poly_statistics){0};
    if (cells == 0)
        return;
    *s = sums->part;
    divide(s, cells);
    s->volume = tm_sum_value(sums->volume);
}

tm_status tm_poly_sums_measure(tm_poly_sums **chunk, size_t *chunks,
                               const tm_poly_arrays *mesh, bool with_tets,
                               unsigned threads, tm_error *error)
{
    *chunks = tm_parallel_chunks(mesh->cells, CHUNK);
    measuring m = {mesh, with_tets, tm_new(*chunks, sizeof *m.chunk)};
    *chunk = m.chunk;
    if (!m.chunk)
        return tm_fail_memory(error);
    tm_parallel_runs(threads, mesh->cells, CHUNK, measure_chunk, &m);
    for (size_t i = 0; i < *chunks; i++)
        if (m.chunk[i].status != TM_OK)
            return tm_fail_memory(error);
    return TM_OK;
}

static tm_status measure_cells(tm_poly_statistics *s, const tm_poly_arrays *mesh,
                               unsigned threads, tm_error *error)
{
    tm_poly_sums sums, *chunk;
    size_t chunks;
    const tm_status status = tm_poly_sums_measure(&chunk, &chunks, mesh,
                                                  tm_poly_has_tets(mesh), threads, error);
    if (status == TM_OK) {
        tm_poly_sums_begin(&sums);
        tm_poly_sums_add(&sums, chunk, chunks);
        tm_poly_sums_finish(s, &sums, mesh->cells);
    }
    free(chunk);
    return status;
}

size_t tm_poly_boundary_triangles(const tm_poly_arrays *mesh, bool *all_are)
{
    size_t triangles = 0;
    *all_are = true;
    for (size_t f = 0; f < mesh->facets; f++) {
        if (mesh->side[f][1] != TM_NONE)
            continue;
        *all_are &= mesh->facet_start[f + 1] - mesh->facet_start[f] == 3;
        triangles++;
    }
    return triangles;
}

static void find_input_sizes(tm_poly_statistics *s, size_t nodes, size_t boundary,
                             int64_t euler)
{
    const size_t tets = s->input.elements;
    if (tets == 0)
        return;
    s->input.nodes = nodes;
    if (boundary == 0 || s->unmatched > 0)
        return;
    s->input.faces = (4 * tets + boundary) / 2;
    const int64_t edges =
        (int64_t)nodes + (int64_t)s->input.faces - (int64_t)tets - euler;
    if (s->non_simple == 0 && edges > 0)
        s->input.edges = (size_t)edges;
}

void tm_poly_find_sizes(tm_poly_statistics *s, const tm_examination *found, size_t nodes,
                        size_t facets, size_t cells, size_t boundary_triangles)
{
    s->swallowed = found->unused_nodes;
    s->unmatched = found->defect[TM_UNMATCHED_FACE].count;
    s->size = (tm_poly_sizes){
        .elements = cells, .faces = facets, .nodes = nodes - found->unused_nodes};
    s->size.edges = (size_t)((int64_t)s->size.nodes + (int64_t)facets - (int64_t)cells -
                             found->euler);
    find_input_sizes(s, nodes, boundary_triangles, found->euler);
}

static tm_status find_sizes(tm_poly_statistics *s, const tm_poly_arrays *mesh,
                            tm_error *error)
{
    tm_examination found = {0};
    bool all_triangles;
    const size_t boundary = tm_poly_boundary_triangles(mesh, &all_triangles);
    const tm_status status = tm_poly_examine_facets(&found, mesh, error);
    if (status == TM_OK)
        tm_poly_find_sizes(s, &found, mesh->nodes, mesh->facets, mesh->cells,
                           all_triangles ? boundary : 0);
    return status;
}

tm_status tm_poly_statistics_measure(tm_poly_statistics *statistics,
                                     const tm_poly_arrays *mesh, unsigned threads,
                                     tm_error *error)
{
    tm_status status = measure_cells(statistics, mesh, threads, error);
    if (status == TM_OK)
        status = find_sizes(statistics, mesh, error);
    if (status == TM_OK)
        status = tm_poly_finite_volume_measure(&statistics->fv, mesh, threads, error);
    return status;
}

const char *const tm_poly_use_names[TM_POLY_USES] = {
    [TM_USE_FV] = "fv", [TM_USE_VEM] = "vem", [TM_USE_DG] = "dg"};

bool tm_poly_is_fit(const tm_poly_statistics *s, tm_poly_use use)
{
    const tm_poly_finite_volume *fv = &s->fv;
    if (s->unmatched > 0 || s->non_simple > 0 ||
        (s->size.elements > 0 && !(s->min_volume > 0)))
        return false;
    return use == TM_USE_FV ? fv->non_orthogonal + fv->skew + fv->wrong_pyramids == 0
                            : use == TM_USE_DG || s->not_star_shaped == 0;
}

/* Each polyhedron alone ------------------------------------------------------------- */

typedef struct measuring_each {
    const tm_poly_arrays *mesh;
    double *volume, *kernel_radius;
    tm_status *status; /* one for each CHUNK of cells */
} measuring_each;

static void measure_each_of_chunk(void *context, size_t first, size_t past)
{
    const measuring_each *m = context;
    workspace w = {.boundary = {0}};
    tm_status status = TM_OK;
    for (size_t c = first; c < past && status == TM_OK; c++) {
        tm_poly_shape shape = {0};
        double center[3];
        status = find_boundary(&w, m->mesh, c);
        if (status == TM_OK)
            status = tm_poly_ball_measure(&shape, &w.shape, &w.boundary, m->mesh->xyz,
                                          center, NULL);
        m->volume[c] = shape.volume;
        m->kernel_radius[c] = shape.kernel_radius;
    }
    workspace_free(&w);
    m->status[first / CHUNK] = status;
}

tm_status tm_poly_measure_each(double *volume, double *kernel_radius,
                               const tm_poly_arrays *mesh, unsigned threads,
                               tm_error *error)
{
    const size_t chunks = tm_parallel_chunks(mesh->cells, CHUNK);
    measuring_each m = {mesh, volume, kernel_radius, tm_new(chunks, sizeof *m.status)};
    if (!m.status)
        return tm_fail_memory(error);
    tm_parallel_runs(threads, mesh->cells, CHUNK, measure_each_of_chunk, &m);
    tm_status status = TM_OK;
    for (size_t i = 0; i < chunks; i++)
        status = m.status[i] != TM_OK ? m.status[i] : status;
    free(m.status);
    return status == TM_OK ? TM_OK : tm_fail_memory(error);
}
