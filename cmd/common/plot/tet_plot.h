/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figure of tetrahedral quality: histograms of dihedral angles and of volume quality
 * beside each other, before and after overlaid where there are two meshes. */
#ifndef CMD_COMMON_TET_PLOT_H
#define CMD_COMMON_TET_PLOT_H

#include "../../../lib/base/text.h"
#include "../../../lib/examine/tet_statistics.h"

/* Appends the script for gnuplot_plot(). before may be NULL. */
void tet_plot_script(tm_text *script, const tm_tet_statistics *before,
                     const tm_tet_statistics *statistics);

#endif
