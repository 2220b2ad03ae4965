/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of the *-stats filters and of lepp-improve, by gnuplot: two panels beside
 * each other, a line above them. A script begins with plot_begin() and ends with
 * plot_end(). */
#ifndef CMD_COMMON_PLOT_H
#define CMD_COMMON_PLOT_H

#include "../../../lib/examine/jens_statistics.h"
#include "../../../lib/examine/poly/poly_statistics.h"
#include "../../../lib/examine/tet_statistics.h"
#include "../../../lib/tet/lepp/lepp.h"
#include "../app/filter.h"

/* Histograms of dihedral angles and of volume quality, before and after overlaid where
 * there are two meshes; before may be NULL. */
void tet_plot_script(tm_text *script, const tm_tet_statistics *before,
                     const tm_tet_statistics *statistics);

/* Histograms of J_ENS and of the scaled Jacobian; both must have been asked for. */
void jens_plot_script(tm_text *script, const tm_jens_statistics *statistics);

/* Histograms of facets and tetrahedra per polyhedron, and of the kernel's share of the
 * volume. */
void poly_plot_script(tm_text *script, const tm_poly_statistics *statistics);

/* Histograms of the terminal stars that each target's paths came to, and of closed stars
 * by size and by what was done: chapter 9 of Balboa (2020). */
void lepp_plot_script(tm_text *script, const tm_lepp_report *report);

/* Looks at the argument of --plot, which may be NULL: a usage error where it is the file
 * of -o or --json, or has the suffix of another kind of picture. */
void plot_check_file(const filter *f, const char *file);

/* Runs gnuplot on a script, which has its data inline, puts what it writes into `file`,
 * whole or not at all, and frees the script. The script does not depend on the user's own
 * settings of gnuplot. Exits where gnuplot is missing or fails (it has then said why on
 * standard error), or the file cannot be written. */
void plot_write(const filter *f, tm_text *script, const char *file);

/* What scripts have in common ------------------------------------------------------- */

/* The settings. Colours are called bad, grey and blue. */
void plot_begin(tm_text *script);
void plot_end(tm_text *script);

/* The number with a thin space before each group of three digits. */
void plot_grouped(tm_text *script, size_t number);

/* A data block: the outline of a histogram in percent of `whole`, whose bins are `width`
 * wide, from the left end to the right one. */
void plot_outline(tm_text *script, const char *name, const size_t *histogram, size_t bins,
                  double width, size_t whole);

/* The highest share of a bin, in percent. */
double plot_highest(const size_t *histogram, size_t bins, size_t whole);

/* Where the axis of shares ends, above the highest; of nothing, so that there is one. */
double plot_axis(double highest);

/* Of a plot command: the block, filled and with a line, in blue. */
void plot_blue(tm_text *script, const char *name);

#endif
