/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figure of mixed elements: histograms of J_ENS and of the scaled Jacobian beside
 * each other. */
#ifndef CMD_COMMON_JENS_PLOT_H
#define CMD_COMMON_JENS_PLOT_H

#include "../../../lib/base/text.h"
#include "../../../lib/examine/jens_statistics.h"

/* Appends the script for gnuplot_plot(). Both histograms must have been asked for. */
void jens_plot_script(tm_text *script, const tm_jens_statistics *statistics);

#endif
