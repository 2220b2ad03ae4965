/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the figures of the *-stats filters have in common: two panels beside each other,
 * a line above them. */
#ifndef CMD_COMMON_PLOT_STYLE_H
#define CMD_COMMON_PLOT_STYLE_H

#include "../../../lib/base/text.h"

#include <stddef.h>

/* The beginning of a script for gnuplot_plot(), which then needs `unset multiplot` at its
 * end. Colours are called bad, grey and blue. */
extern const char plot_settings[];

/* The number with a thin space before each group of three digits. */
void plot_grouped(tm_text *script, size_t number);

#endif
