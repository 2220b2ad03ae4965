/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figure of polyhedra: histograms of facets and tetrahedra per polyhedron, and of
 * the kernel's share of the volume. */
#ifndef CMD_COMMON_POLY_PLOT_H
#define CMD_COMMON_POLY_PLOT_H

#include "../../../lib/base/text.h"
#include "../../../lib/examine/poly_statistics.h"

/* Appends the script for gnuplot_plot(). */
void poly_plot_script(tm_text *script, const tm_poly_statistics *statistics);

#endif
