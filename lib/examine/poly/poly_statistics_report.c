/* SPDX-License-Identifier: GPL-3.0-or-later */
/* poly_statistics.h as JSON and as tables. */
#include "../../text/report.h"
#include "poly_statistics.h"

#include <math.h>
#include <stdio.h>

enum { LABEL_CHARS = 64 };

#define ROW(key, label, format, member)                                                  \
    TM_REPORT_ROW(key, label, format, tm_poly_statistics, member)
#define KNOWN(key, member) TM_REPORT_KNOWN_ROW(key, tm_poly_statistics, member)

static const tm_report_row sizes[] = {ROW("polyhedra", "polyhedra", NULL, size.elements),
                                      ROW("facets", "facets", NULL, size.faces),
                                      ROW("edges", "edges", NULL, size.edges),
                                      ROW("nodes", "nodes", NULL, size.nodes),
                                      {0}};
static const tm_report_row simple[] = {
    TM_REPORT_HEADING_ROW(""),
    ROW("non_simple", "not simple", NULL, non_simple),
    TM_REPORT_OPEN_ROW("non_simple_by"),
    ROW("edges", "  an edge without two facets", NULL, cause[TM_CAUSE_EDGE]),
    ROW("vertices", "  a vertex with more than one fan", NULL, cause[TM_CAUSE_VERTEX]),
    ROW("pieces", "  boundary not connected", NULL, cause[TM_CAUSE_PIECES]),
    ROW("euler", "  Euler's formula fails", NULL, cause[TM_CAUSE_EULER]),
    TM_REPORT_CLOSE_ROW,
    ROW("euler_failures", NULL, NULL, cause[TM_CAUSE_EULER]),
    ROW("not_star_shaped", "not star-shaped", NULL, not_star_shaped),
    {0}};
static const tm_report_row swallowed[] = {
    ROW("swallowed_vertices", "swallowed vertices", NULL, swallowed), {0}};
static const tm_report_row faces[] = {
    ROW("faces_per_polyhedron", NULL, NULL, faces_per_polyhedron),
    ROW("largest_faces", NULL, NULL, largest_faces),
    {0}};
static const tm_report_row input[] = {KNOWN("largest_tets", largest_tets),
                                      TM_REPORT_OPEN_ROW("input"),
                                      KNOWN("elements", input.elements),
                                      KNOWN("faces", input.faces),
                                      KNOWN("edges", input.edges),
                                      KNOWN("nodes", input.nodes),
                                      TM_REPORT_CLOSE_ROW,
                                      {0}};
static const tm_report_row volume[] = {ROW("volume", "volume", "%.7g", volume), {0}};
static const tm_report_row shape[] = {
    TM_REPORT_HEADING_ROW(""),
    ROW("min_volume", "smallest volume", "%.4g", min_volume),
    ROW(NULL, "smallest facet", "%.4g", min_face_area),
    ROW("min_edge", "shortest edge", "%.4g", min_edge),
    ROW("min_face_area", NULL, NULL, min_face_area),
    ROW("min_dihedral", "smallest dihedral angle", "%.4f", min_dihedral),
    ROW("max_dihedral", "largest dihedral angle", "%.4f", max_dihedral),
    ROW("max_diameter", "largest diameter", "%.4g", max_diameter),
    ROW("centroid_outside", "centroids outside of the kernel", NULL, centroid_outside),
    ROW("vem_indicator", "indicator for virtual elements", "%.3f", vem_indicator),
    {0}};

static const tm_report_row finite_volume[] = {
    TM_REPORT_HEADING_ROW(""),
    TM_REPORT_HEADING_ROW("from the centroids of cells and facets"),
    TM_REPORT_OPEN_ROW("finite_volume"),
    ROW("max_non_orthogonality", "  largest non-orthogonality", "%.2f",
        fv.max_non_orthogonality),
    ROW("mean_non_orthogonality", "  mean", "%.2f", fv.mean_non_orthogonality),
    ROW("non_orthogonal", "  facets above 70", NULL, fv.non_orthogonal),
    ROW("reversed", "  facets above 90", NULL, fv.reversed),
    ROW("max_skewness", "  largest skewness", "%.3f", fv.max_skewness),
    ROW("skew", "  facets above 4", NULL, fv.skew),
    ROW("min_pyramid", "  smallest pyramid", "%.4g", fv.min_pyramid),
    ROW("wrong_pyramids", "  pyramids without volume", NULL, fv.wrong_pyramids),
    ROW("unseen", "  facets that are not all seen", NULL, fv.unseen),
    ROW("no_fan", "  facets that are seen as no fan", NULL, fv.no_fan),
    ROW("max_bend", "  largest bend of a facet", "%.3g", fv.max_bend),
    ROW("volume_spread", "  volumes, 95 % to 5 %", "%.2f", fv.volume_spread),
    ROW("min_weight", "  smallest weight of a facet", "%.4f", fv.min_weight),
    ROW("small_weights", "  facets below 0.05", NULL, fv.small_weights),
    ROW("min_volume_ratio", "  smallest ratio of volumes side by side", "%.4f",
        fv.min_volume_ratio),
    ROW("small_volume_ratios", "  facets below 0.01", NULL, fv.small_volume_ratios),
    ROW("min_determinant", "  smallest determinant of a cell", "%.4f",
        fv.min_determinant),
    ROW("small_determinants", "  cells below 0.001", NULL, fv.small_determinants),
    ROW("concave", "  cells concave by planes of facets", NULL, fv.concave),
    TM_REPORT_CLOSE_ROW,
    {0}};

static const tm_report_row min_mean[] = {
    TM_REPORT_ROW("min", NULL, NULL, tm_poly_range, min),
    TM_REPORT_ROW("mean", NULL, NULL, tm_poly_range, mean),
    {0}};

static double reduction(size_t size, size_t before)
{
    const double hundred = 100;
    return before == 0 ? NAN : hundred * (1 - (double)size / (double)before);
}

static void reduction_json(tm_json *json, const tm_poly_sizes *size,
                           const tm_poly_sizes *before)
{
    tm_json_open(json, "reduction_percent", '{');
    tm_json_double(json, "elements", reduction(size->elements, before->elements));
    tm_json_double(json, "faces", reduction(size->faces, before->faces));
    tm_json_double(json, "edges", reduction(size->edges, before->edges));
    tm_json_double(json, "nodes", reduction(size->nodes, before->nodes));
    tm_json_close(json, '}');
}

static double count_end(size_t bin)
{
    return (double)tm_count_bin_begin(bin + 1);
}

/* The upper end of a bin, as the double nearest to its decimals. */
static double ratio_end(size_t bin)
{
    return (double)(bin + 1) / TM_KERNEL_RATIO_BINS;
}

void tm_poly_statistics_json(tm_json *json, const tm_poly_statistics *s)
{
    tm_report_json(json, sizes, s);
    tm_report_json(json, simple, s);
    tm_report_json(json, swallowed, s);
    tm_report_json(json, faces, s);
    tm_json_double(json, "tets_per_polyhedron",
                   s->input.elements > 0 ? s->tets_per_polyhedron : NAN);
    tm_report_json(json, input, s);
    reduction_json(json, &s->size, &s->input);
    tm_report_json(json, volume, s);
    tm_report_json(json, shape, s);
    tm_report_json(json, finite_volume, s);
    tm_json_open(json, "fit_for", '{');
    for (int use = 0; use < TM_POLY_USES; use++)
        tm_json_bool(json, tm_poly_use_names[use], tm_poly_is_fit(s, (tm_poly_use)use));
    tm_json_close(json, '}');
    tm_report_object(json, "edge_ratio", min_mean, &s->edge_ratio);
    tm_report_object(json, "kernel_radius", min_mean, &s->kernel_radius);
    tm_report_object(json, "kernel_ratio", min_mean, &s->kernel_ratio);
    tm_report_object(json, "centroid_depth", min_mean, &s->centroid_depth);
    tm_report_object(json, "rho1", min_mean, &s->rho[0]);
    tm_report_object(json, "rho2", min_mean, &s->rho[1]);
    tm_report_object(json, "rho3", min_mean, &s->rho[2]);
    tm_report_histogram(json, "faces_histogram", s->faces, tm_count_bins(s->faces),
                        count_end);
    tm_report_histogram(json, "tets_histogram", s->tets, tm_count_bins(s->tets),
                        count_end);
    tm_report_histogram(json, "kernel_ratio_histogram", s->kernel_ratios,
                        TM_KERNEL_RATIO_BINS, ratio_end);
}

static void table(tm_text *text, const tm_report_row *rows, const tm_poly_statistics *s)
{
    tm_report_table(text, rows, (const void *[]){s}, 1, TM_LABEL_WIDTH);
}

static void heading(tm_text *text, const char *what, const char *const *column,
                    size_t columns)
{
    tm_text_format(text, "\n%-*s", columns ? TM_LABEL_WIDTH : 0, what);
    for (size_t c = 0; c < columns; c++)
        tm_text_format(text, "%*s", TM_COLUMN_WIDTH, column[c]);
    tm_text_string(text, "\n");
}

static void reduction_row(tm_text *text, const char *what, size_t size, size_t before)
{
    if (before == 0)
        return;
    tm_report_cells(text, what, "%.0f", (double[]){(double)before, (double)size}, 2);
    tm_text_format(text, "%*.2f\n", TM_COLUMN_WIDTH, reduction(size, before));
}

static void reduction_rows(tm_text *text, const tm_poly_sizes *size,
                           const tm_poly_sizes *before)
{
    static const char *const column[] = {"before", "now", "less, %"};
    if (before->elements == 0)
        return;
    heading(text, "of the tetrahedra", column, 3);
    reduction_row(text, "  elements", size->elements, before->elements);
    reduction_row(text, "  faces", size->faces, before->faces);
    reduction_row(text, "  edges", size->edges, before->edges);
    reduction_row(text, "  nodes", size->nodes, before->nodes);
}

static void range_row(tm_text *text, const char *what, const tm_poly_range *range)
{
    tm_report_cells(text, what, "%.4g", (double[]){range->min, range->mean}, 2);
    tm_text_string(text, "\n");
}

static void range_rows(tm_text *text, const tm_poly_statistics *s)
{
    static const char *const column[] = {"smallest", "mean"};
    heading(text, "of each polyhedron", column, 2);
    range_row(text, "  shortest edge / diameter", &s->edge_ratio);
    range_row(text, "  radius of the kernel's ball / diameter", &s->kernel_radius);
    range_row(text, "  volume of the kernel / volume", &s->kernel_ratio);
    range_row(text, "  depth of the centroid in it / diameter", &s->centroid_depth);
    range_row(text, "  rho 1: kernels", &s->rho[0]);
    range_row(text, "  rho 2: sizes", &s->rho[1]);
    range_row(text, "  rho 3: numbers of facets and edges", &s->rho[2]);
}

static void mean_row(tm_text *text, const char *what, double mean, size_t largest)
{
    tm_report_cells(text, what, "%.2f", &mean, 1);
    tm_text_format(text, "%*zu\n", TM_COLUMN_WIDTH, largest);
}

static void mean_rows(tm_text *text, const tm_poly_statistics *s)
{
    static const char *const column[] = {"mean", "largest"};
    heading(text, "per polyhedron", column, 2);
    mean_row(text, "  facets", s->faces_per_polyhedron, s->largest_faces);
    if (s->input.elements > 0)
        mean_row(text, "  tetrahedra", s->tets_per_polyhedron, s->largest_tets);
}

/* A share in percent and a bar. */
static void bar_row(tm_text *text, const char *what, size_t count, size_t whole,
                    size_t longest)
{
    const double share = tm_percent(count, whole);
    tm_report_cells(text, what, "%.2f", &share, 1);
    tm_report_bar(text,
                  longest > 0 ? TM_LONGEST_BAR * (double)count / (double)longest : 0);
}

static size_t highest(const size_t *histogram, size_t bins)
{
    size_t most = 0;
    for (size_t i = 0; i < bins; i++)
        most = histogram[i] > most ? histogram[i] : most;
    return most;
}

/* From the first bin in use to the last. */
static void count_histogram(tm_text *text, const char *what, const size_t *histogram,
                            size_t whole)
{
    const size_t bins = tm_count_bins(histogram), longest = highest(histogram, bins);
    size_t i = 0;
    heading(text, what, NULL, 0);
    while (i < bins && histogram[i] == 0)
        i++;
    for (; i < bins; i++) {
        char label[LABEL_CHARS];
        const size_t first = tm_count_bin_begin(i), last = tm_count_bin_begin(i + 1) - 1;
        if (first == last)
            snprintf(label, sizeof label, "  %zu", first);
        else
            snprintf(label, sizeof label, "  %zu to %zu", first, last);
        bar_row(text, label, histogram[i], whole, longest);
    }
}

static void ratio_histogram(tm_text *text, const tm_poly_statistics *s)
{
    size_t histogram[TM_KERNEL_RATIO_BINS / 2];
    for (size_t i = 0; i < TM_KERNEL_RATIO_BINS / 2; i++)
        histogram[i] = s->kernel_ratios[2 * i] + s->kernel_ratios[2 * i + 1];
    const size_t longest = highest(histogram, TM_KERNEL_RATIO_BINS / 2);
    heading(text, "histogram of volume of the kernel / volume, %", NULL, 0);
    for (size_t i = 0; i < TM_KERNEL_RATIO_BINS / 2; i++) {
        char label[LABEL_CHARS];
        snprintf(label, sizeof label, "  %.1f to %.1f", i == 0 ? 0 : ratio_end(2 * i - 1),
                 ratio_end(2 * i + 1));
        bar_row(text, label, histogram[i], s->size.elements, longest);
    }
}

void tm_poly_statistics_table(tm_text *text, const tm_poly_statistics *s)
{
    table(text, sizes, s);
    table(text, swallowed, s);
    table(text, volume, s);
    table(text, simple, s);
    mean_rows(text, s);
    reduction_rows(text, &s->size, &s->input);
    table(text, shape, s);
    range_rows(text, s);
    table(text, finite_volume, s);
    count_histogram(text, "histogram of facets per polyhedron, %", s->faces,
                    s->size.elements);
    if (s->input.elements > 0)
        count_histogram(text, "histogram of tetrahedra per polyhedron, %", s->tets,
                        s->size.elements);
    ratio_histogram(text, s);
}
