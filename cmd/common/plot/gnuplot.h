/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures by gnuplot, for the *-stats filters. */
#ifndef CMD_COMMON_GNUPLOT_H
#define CMD_COMMON_GNUPLOT_H

#include "../../../lib/base/error.h"
#include "../../../lib/base/text.h"

/* Runs gnuplot on a script, which has its data inline and sets a terminal but no output,
 * and puts what it writes into `file`, whole or not at all. The script does not depend on
 * the user's own settings of gnuplot. TM_ERROR_SYSTEM where gnuplot is missing or fails
 * (it has then said why on standard error), or the file cannot be written. */
tm_status gnuplot_plot(const tm_text *script, const char *file, tm_error *error);

#endif
