/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plot.h"

#include <math.h>

/* Bars of 0.05: the first two buckets share one, those that are negative have one to the
 * left of 0. */
enum { BARS = TM_JENS_BUCKETS - 1, SHADE = 1, LEGEND = 1 };

static const double width = 1.0 / BARS;

/* How many elements there are, and the worst. */
static void legend(tm_text *script, const tm_jens_statistics *s)
{
    tm_text_format(script, "set label %d \"", LEGEND);
    plot_grouped(script, s->elements);
    tm_text_string(script, " elements, ");
    plot_grouped(script, s->jens.negative);
    tm_text_format(script,
                   " negative; J_{ENS}: worst %.4f, average %.4f\" "
                   "at screen 0.07, 0.941 textcolor '#222222'\n",
                   s->jens.all.worst, s->jens.all.average);
}

/* The outline of the bars, and the bar of the negative ones. */
static void panel(tm_text *script, const char *name, const tm_jens_histogram *h,
                  size_t elements)
{
    const double negative = tm_percent(h->negative, elements);
    size_t bar[BARS];
    for (size_t i = 0; i < BARS; i++)
        bar[i] = i == 0 ? h->bucket[0] + h->bucket[1] : h->bucket[i + 1];
    plot_outline(script, name, bar, BARS, width, elements);
    tm_text_format(script,
                   "$%s_negative << END\n%g 0\n%g %.6g\n0 %.6g\n0 0\nEND\n"
                   "set xrange [%g:1]\nset yrange [0:%.6g]\n"
                   "set object %d rectangle from graph 0, graph 0 to first 0, graph 1 "
                   "behind fillcolor rgb bad fillstyle solid noborder\nplot ",
                   name, -width, -width, negative, negative, -width,
                   plot_axis(fmax(negative, plot_highest(bar, BARS, elements))), SHADE);
    plot_blue(script, name);
    tm_text_format(
        script, ", $%s_negative with lines linewidth 2 linecolor rgb '#c0392b'\n", name);
}

void jens_plot_script(tm_text *script, const tm_jens_statistics *statistics)
{
    plot_begin(script);
    legend(script, statistics);
    tm_text_string(script, "set lmargin screen 0.07\n"
                           "set rmargin screen 0.485\n"
                           "set xtics 0,0.2,1\n"
                           "set ylabel 'share of elements, %' offset 0.8,0\n"
                           "set xlabel 'J_{ENS}, negative ones left of 0'\n");
    panel(script, "jens", &statistics->jens, statistics->elements);
    tm_text_string(script, "unset object\n"
                           "unset label\n"
                           "set lmargin screen 0.57\n"
                           "set rmargin screen 0.985\n"
                           "set xlabel 'scaled Jacobian, negative ones left of 0'\n");
    panel(script, "scaled", &statistics->scaled_jacobian, statistics->elements);
    plot_end(script);
}
