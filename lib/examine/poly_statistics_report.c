/* SPDX-License-Identifier: GPL-3.0-or-later */
/* poly_statistics.h as JSON and as tables. */
#include "tet_statistics.h"
#include "poly_shape.h"
#include "poly_statistics.h"

#include <math.h>
#include <stdio.h>

enum { LABEL_WIDTH = 40, COLUMN_WIDTH = 14, LONGEST_BAR = 30, CELL_CHARS = 64 };

static const char *const cause_key[TM_POLY_CAUSES] = {"edges", "vertices", "pieces",
                                                      "euler"};
static const char *const cause_label[TM_POLY_CAUSES] = {
    "an edge without two facets", "a vertex with more than one fan",
    "boundary not connected", "Euler's formula fails"};

static void size_json(tm_json *json, const char *key, size_t size)
{
    tm_json_integer(json, key, (int64_t)size);
}

/* What is not known is null. */
static void known_json(tm_json *json, const char *key, size_t size)
{
    if (size > 0)
        size_json(json, key, size);
    else
        tm_json_double(json, key, NAN);
}

static void range_json(tm_json *json, const char *key, const tm_poly_range *range)
{
    tm_json_open(json, key, '{');
    tm_json_double(json, "min", range->min);
    tm_json_double(json, "mean", range->mean);
    tm_json_close(json, '}');
}

static void causes_json(tm_json *json, const tm_poly_statistics *s)
{
    tm_json_open(json, "non_simple_by", '{');
    for (size_t i = 0; i < TM_POLY_CAUSES; i++)
        size_json(json, cause_key[i], s->cause[i]);
    tm_json_close(json, '}');
}

static double reduction(size_t size, size_t input)
{
    const double hundred = 100;
    return input == 0 ? NAN : hundred * (1 - (double)size / (double)input);
}

static void input_json(tm_json *json, const tm_poly_sizes *size,
                       const tm_poly_sizes *input)
{
    tm_json_open(json, "input", '{');
    known_json(json, "elements", input->elements);
    known_json(json, "faces", input->faces);
    known_json(json, "edges", input->edges);
    known_json(json, "nodes", input->nodes);
    tm_json_close(json, '}');
    tm_json_open(json, "reduction_percent", '{');
    tm_json_double(json, "elements", reduction(size->elements, input->elements));
    tm_json_double(json, "faces", reduction(size->faces, input->faces));
    tm_json_double(json, "edges", reduction(size->edges, input->edges));
    tm_json_double(json, "nodes", reduction(size->nodes, input->nodes));
    tm_json_close(json, '}');
}

static void counts_json(tm_json *json, const char *key, const size_t *histogram)
{
    const size_t bins = tm_count_bins(histogram);
    tm_json_open(json, key, '[');
    for (size_t i = 0; i < bins; i++) {
        tm_json_open(json, NULL, '[');
        size_json(json, NULL, tm_count_bin_begin(i + 1));
        size_json(json, NULL, histogram[i]);
        tm_json_close(json, ']');
    }
    tm_json_close(json, ']');
}

/* The upper end of a bin, as the double nearest to its decimals. */
static double ratio_end(size_t bin)
{
    return (double)(bin + 1) / TM_KERNEL_RATIO_BINS;
}

static void ratios_json(tm_json *json, const tm_poly_statistics *s)
{
    tm_json_open(json, "kernel_ratio_histogram", '[');
    for (size_t i = 0; i < TM_KERNEL_RATIO_BINS; i++) {
        tm_json_open(json, NULL, '[');
        tm_json_double(json, NULL, ratio_end(i));
        size_json(json, NULL, s->kernel_ratios[i]);
        tm_json_close(json, ']');
    }
    tm_json_close(json, ']');
}

void tm_poly_statistics_json(tm_json *json, const tm_poly_statistics *s)
{
    size_json(json, "polyhedra", s->size.elements);
    size_json(json, "facets", s->size.faces);
    size_json(json, "edges", s->size.edges);
    size_json(json, "nodes", s->size.nodes);
    size_json(json, "non_simple", s->non_simple);
    causes_json(json, s);
    size_json(json, "euler_failures", s->cause[TM_CAUSE_EULER]);
    size_json(json, "not_star_shaped", s->not_star_shaped);
    size_json(json, "swallowed_vertices", s->swallowed);
    tm_json_double(json, "faces_per_polyhedron", s->faces_per_polyhedron);
    size_json(json, "largest_faces", s->largest_faces);
    const bool with_tets = s->input.elements > 0;
    tm_json_double(json, "tets_per_polyhedron", with_tets ? s->tets_per_polyhedron : NAN);
    known_json(json, "largest_tets", s->largest_tets);
    input_json(json, &s->size, &s->input);
    tm_json_double(json, "volume", s->volume);
    tm_json_double(json, "min_volume", s->min_volume);
    tm_json_double(json, "min_edge", s->min_edge);
    tm_json_double(json, "min_face_area", s->min_face_area);
    tm_json_double(json, "min_dihedral", s->min_dihedral);
    tm_json_double(json, "max_dihedral", s->max_dihedral);
    range_json(json, "edge_ratio", &s->edge_ratio);
    range_json(json, "kernel_radius", &s->kernel_radius);
    range_json(json, "kernel_ratio", &s->kernel_ratio);
    counts_json(json, "faces_histogram", s->faces);
    counts_json(json, "tets_histogram", s->tets);
    ratios_json(json, s);
}

static void heading(tm_text *text, const char *what)
{
    tm_text_format(text, "\n%s\n", what);
}

static void count_row(tm_text *text, const char *what, size_t count)
{
    tm_text_format(text, "%-*s%*zu\n", LABEL_WIDTH, what, COLUMN_WIDTH, count);
}

static void number_row(tm_text *text, const char *what, const char *format, double value)
{
    char cell[CELL_CHARS];
    snprintf(cell, sizeof cell, format, value);
    tm_text_format(text, "%-*s%*s\n", LABEL_WIDTH, what, COLUMN_WIDTH, cell);
}

static void range_row(tm_text *text, const char *what, const tm_poly_range *range)
{
    tm_text_format(text, "%-*s%*.4g%*.4g\n", LABEL_WIDTH, what, COLUMN_WIDTH, range->min,
                   COLUMN_WIDTH, range->mean);
}

static void size_rows(tm_text *text, const tm_poly_statistics *s)
{
    count_row(text, "polyhedra", s->size.elements);
    count_row(text, "facets", s->size.faces);
    count_row(text, "edges", s->size.edges);
    count_row(text, "nodes", s->size.nodes);
    count_row(text, "swallowed vertices", s->swallowed);
    number_row(text, "volume", "%.7g", s->volume);
}

static void reduction_row(tm_text *text, const char *what, size_t size, size_t input)
{
    if (input > 0)
        tm_text_format(text, "%-*s%*zu%*zu%*.2f\n", LABEL_WIDTH, what, COLUMN_WIDTH,
                       input, COLUMN_WIDTH, size, COLUMN_WIDTH, reduction(size, input));
}

static void reduction_rows(tm_text *text, const tm_poly_statistics *s)
{
    if (s->input.elements == 0)
        return;
    tm_text_format(text, "\n%-*s%*s%*s%*s\n", LABEL_WIDTH, "of the tetrahedra",
                   COLUMN_WIDTH, "before", COLUMN_WIDTH, "now", COLUMN_WIDTH, "less, %");
    reduction_row(text, "  elements", s->size.elements, s->input.elements);
    reduction_row(text, "  faces", s->size.faces, s->input.faces);
    reduction_row(text, "  edges", s->size.edges, s->input.edges);
    reduction_row(text, "  nodes", s->size.nodes, s->input.nodes);
}

static void simple_rows(tm_text *text, const tm_poly_statistics *s)
{
    tm_text_string(text, "\n");
    count_row(text, "not simple", s->non_simple);
    for (size_t i = 0; i < TM_POLY_CAUSES; i++)
        tm_text_format(text, "  %-*s%*zu\n", LABEL_WIDTH - 2, cause_label[i],
                       COLUMN_WIDTH, s->cause[i]);
    count_row(text, "not star-shaped", s->not_star_shaped);
}

static void shape_rows(tm_text *text, const tm_poly_statistics *s)
{
    tm_text_string(text, "\n");
    number_row(text, "smallest volume", "%.4g", s->min_volume);
    number_row(text, "smallest facet", "%.4g", s->min_face_area);
    number_row(text, "shortest edge", "%.4g", s->min_edge);
    number_row(text, "smallest dihedral angle", "%.4f", s->min_dihedral);
    number_row(text, "largest dihedral angle", "%.4f", s->max_dihedral);
    tm_text_format(text, "\n%-*s%*s%*s\n", LABEL_WIDTH, "of each polyhedron",
                   COLUMN_WIDTH, "smallest", COLUMN_WIDTH, "mean");
    range_row(text, "  shortest edge / diameter", &s->edge_ratio);
    range_row(text, "  radius of the kernel's ball / diameter", &s->kernel_radius);
    range_row(text, "  volume of the kernel / volume", &s->kernel_ratio);
}

static void mean_row(tm_text *text, const char *what, double mean, size_t largest)
{
    tm_text_format(text, "%-*s%*.2f%*zu\n", LABEL_WIDTH, what, COLUMN_WIDTH, mean,
                   COLUMN_WIDTH, largest);
}

static void count_rows(tm_text *text, const tm_poly_statistics *s)
{
    tm_text_format(text, "\n%-*s%*s%*s\n", LABEL_WIDTH, "per polyhedron", COLUMN_WIDTH,
                   "mean", COLUMN_WIDTH, "largest");
    mean_row(text, "  facets", s->faces_per_polyhedron, s->largest_faces);
    if (s->input.elements > 0)
        mean_row(text, "  tetrahedra", s->tets_per_polyhedron, s->largest_tets);
}

/* A share in percent and a bar. */
static void bar_row(tm_text *text, const char *what, size_t count, size_t whole,
                    size_t longest)
{
    tm_text_format(text, "  %-*s%*.2f", LABEL_WIDTH - 2, what, COLUMN_WIDTH,
                   tm_percent(count, whole));
    const int stars =
        longest > 0 ? (int)lround(LONGEST_BAR * (double)count / (double)longest) : 0;
    tm_text_string(text, stars > 0 ? "   " : "");
    for (int i = 0; i < stars; i++)
        tm_text_string(text, "*");
    tm_text_string(text, "\n");
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
    heading(text, what);
    while (i < bins && histogram[i] == 0)
        i++;
    for (; i < bins; i++) {
        char label[CELL_CHARS];
        const size_t first = tm_count_bin_begin(i), last = tm_count_bin_begin(i + 1) - 1;
        if (first == last)
            snprintf(label, sizeof label, "%zu", first);
        else
            snprintf(label, sizeof label, "%zu to %zu", first, last);
        bar_row(text, label, histogram[i], whole, longest);
    }
}

static void ratio_histogram(tm_text *text, const tm_poly_statistics *s)
{
    size_t histogram[TM_KERNEL_RATIO_BINS / 2];
    for (size_t i = 0; i < TM_KERNEL_RATIO_BINS / 2; i++)
        histogram[i] = s->kernel_ratios[2 * i] + s->kernel_ratios[2 * i + 1];
    const size_t longest = highest(histogram, TM_KERNEL_RATIO_BINS / 2);
    heading(text, "histogram of volume of the kernel / volume, %");
    for (size_t i = 0; i < TM_KERNEL_RATIO_BINS / 2; i++) {
        char label[CELL_CHARS];
        snprintf(label, sizeof label, "%.1f to %.1f", i == 0 ? 0 : ratio_end(2 * i - 1),
                 ratio_end(2 * i + 1));
        bar_row(text, label, histogram[i], s->size.elements, longest);
    }
}

void tm_poly_statistics_table(tm_text *text, const tm_poly_statistics *s)
{
    size_rows(text, s);
    simple_rows(text, s);
    count_rows(text, s);
    reduction_rows(text, s);
    shape_rows(text, s);
    count_histogram(text, "histogram of facets per polyhedron, %", s->faces,
                    s->size.elements);
    if (s->input.elements > 0)
        count_histogram(text, "histogram of tetrahedra per polyhedron, %", s->tets,
                        s->size.elements);
    ratio_histogram(text, s);
}
