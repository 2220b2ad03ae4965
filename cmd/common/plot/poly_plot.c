/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_plot.h"

#include "plot_style.h"

#include "../../../lib/examine/tet_statistics.h"

#include <math.h>

/* Where the axis of shares ends, but for headroom; of nothing, so that there is one. */
static double highest_share(const size_t *histogram, size_t bins, size_t whole)
{
    const double of_nothing = 10;
    double highest = 0;
    for (size_t i = 0; i < bins; i++)
        highest = fmax(highest, tm_percent(histogram[i], whole));
    return highest > 0 ? highest : of_nothing;
}

/* A data block: the outline of a histogram whose bins are `width` wide. */
static void outline(tm_text *script, const char *name, const size_t *histogram,
                    size_t bins, double width, size_t whole)
{
    tm_text_format(script, "$%s << END\n0 0\n", name);
    for (size_t i = 0; i < bins; i++) {
        const double share = tm_percent(histogram[i], whole);
        tm_text_format(script, "%.4g %.6g\n%.4g %.6g\n", width * (double)i, share,
                       width * (double)(i + 1), share);
    }
    tm_text_format(script, "%.4g 0\nEND\n", width * (double)bins);
}

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
    const double headroom = 1.06;
    const size_t face_bins = tm_count_bins(s->faces), tet_bins = tm_count_bins(s->tets);
    size_t bins = face_bins > tet_bins ? face_bins : tet_bins;
    bins = bins > 0 ? bins : 1;
    const double highest =
        fmax(highest_share(s->faces, bins, s->size.elements),
             tet_bins > 0 ? highest_share(s->tets, bins, s->size.elements) : 0);
    outline(script, "tetrahedra", s->tets, bins, 1, s->size.elements);
    outline(script, "facets", s->faces, bins, 1, s->size.elements);
    count_tics(script, bins);
    tm_text_format(script,
                   "set lmargin screen 0.08\n"
                   "set rmargin screen 0.485\n"
                   "set ylabel 'share of polyhedra, %%' offset 1.2,0\n"
                   "set xlabel 'facets%s per polyhedron'\n"
                   "set xrange [0:%zu]\nset yrange [0:%.6g]\nplot ",
                   tet_bins > 0 ? " (blue) and tetrahedra (grey)" : "", bins,
                   headroom * highest);
    if (tet_bins > 0)
        tm_text_string(script,
                       "$tetrahedra with filledcurves y=0 fillstyle solid 1 noborder "
                       "linecolor rgb grey, ");
    tm_text_string(script,
                   "$facets with filledcurves y=0 fillstyle transparent solid 0.3 "
                   "noborder linecolor rgb blue, "
                   "$facets with lines linewidth 2 linecolor rgb blue\n");
}

static void kernel_panel(tm_text *script, const tm_poly_statistics *s)
{
    const double headroom = 1.06;
    outline(script, "kernel", s->kernel_ratios, TM_KERNEL_RATIO_BINS,
            1.0 / TM_KERNEL_RATIO_BINS, s->size.elements);
    tm_text_format(script,
                   "unset label\n"
                   "set lmargin screen 0.57\n"
                   "set rmargin screen 0.985\n"
                   "set xtics 0.2\n"
                   "set xlabel 'volume of the kernel / volume (1 for convex ones)'\n"
                   "set xrange [0:1]\nset yrange [0:%.6g]\n"
                   "plot $kernel with filledcurves y=0 fillstyle transparent solid 0.3 "
                   "noborder linecolor rgb blue, "
                   "$kernel with lines linewidth 2 linecolor rgb blue\n",
                   headroom * highest_share(s->kernel_ratios, TM_KERNEL_RATIO_BINS,
                                            s->size.elements));
}

void poly_plot_script(tm_text *script, const tm_poly_statistics *statistics)
{
    tm_text_string(script, plot_settings);
    legend(script, statistics);
    count_panel(script, statistics);
    kernel_panel(script, statistics);
    tm_text_string(script, "unset multiplot\n");
}
