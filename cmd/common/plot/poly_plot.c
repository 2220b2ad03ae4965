/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plot.h"

#include <math.h>

static void legend(tm_text *script, const tm_poly_statistics *s)
{
    tm_text_string(script, "set label 1 \"");
    plot_grouped(script, s->size.elements);
    tm_text_string(script, " polyhedra, ");
    plot_grouped(script, s->non_simple);
    tm_text_string(script, " not simple, ");
    plot_grouped(script, s->not_star_shaped);
    tm_text_string(script,
                   " not star-shaped\" at screen 0.08, 0.941 textcolor '#222222'\n");
}

/* Bins of counts beside each other, named by their first count. */
static void count_tics(tm_text *script, size_t bins)
{
    const size_t names = 12;
    const size_t step = bins / names + 1;
    tm_text_string(script, "set xtics (");
    for (size_t i = 0; i <= bins; i += step)
        tm_text_format(script, "%s'%zu' %zu", i > 0 ? ", " : "", tm_count_bin_begin(i),
                       i);
    tm_text_string(script, ")\n");
}

static void count_panel(tm_text *script, const tm_poly_statistics *s)
{
    const size_t face_bins = tm_count_bins(s->faces), tet_bins = tm_count_bins(s->tets);
    size_t bins = face_bins > tet_bins ? face_bins : tet_bins;
    bins = bins > 0 ? bins : 1;
    const double highest =
        fmax(plot_highest(s->faces, bins, s->size.elements),
             tet_bins > 0 ? plot_highest(s->tets, bins, s->size.elements) : 0);
    plot_outline(script, "tetrahedra", s->tets, bins, 1, s->size.elements);
    plot_outline(script, "facets", s->faces, bins, 1, s->size.elements);
    count_tics(script, bins);
    tm_text_format(script,
                   "set lmargin screen 0.08\n"
                   "set rmargin screen 0.485\n"
                   "set ylabel 'share of polyhedra, %%' offset 1.2,0\n"
                   "set xlabel 'facets%s per polyhedron'\n"
                   "set xrange [0:%zu]\nset yrange [0:%.6g]\nplot ",
                   tet_bins > 0 ? " (blue) and tetrahedra (grey)" : "", bins,
                   plot_axis(highest));
    if (tet_bins > 0)
        tm_text_string(script,
                       "$tetrahedra with filledcurves y=0 fillstyle solid 1 noborder "
                       "linecolor rgb grey, ");
    plot_blue(script, "facets");
    tm_text_string(script, "\n");
}

static void kernel_panel(tm_text *script, const tm_poly_statistics *s)
{
    plot_outline(script, "kernel", s->kernel_ratios, TM_KERNEL_RATIO_BINS,
                 1.0 / TM_KERNEL_RATIO_BINS, s->size.elements);
    tm_text_format(script,
                   "unset label\n"
                   "set lmargin screen 0.57\n"
                   "set rmargin screen 0.985\n"
                   "set xtics 0.2\n"
                   "set xlabel 'volume of the kernel / volume (1 for convex ones)'\n"
                   "set xrange [0:1]\nset yrange [0:%.6g]\n"
                   "plot ",
                   plot_axis(plot_highest(s->kernel_ratios, TM_KERNEL_RATIO_BINS,
                                          s->size.elements)));
    plot_blue(script, "kernel");
    tm_text_string(script, "\n");
}

void poly_plot_script(tm_text *script, const tm_poly_statistics *statistics)
{
    plot_begin(script);
    legend(script, statistics);
    count_panel(script, statistics);
    kernel_panel(script, statistics);
    plot_end(script);
}
