/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plot.h"

#include <math.h>

/* So many sizes of stars, and counts of stars visited, have a bin of their own. */
enum { SIZES = 16, VISITED = 24 };

/* How much there was to do. */
static void legend(tm_text *script, const tm_lepp_report *r)
{
    tm_text_string(script, "set label 1 \"");
    plot_grouped(script, r->targets);
    tm_text_string(script, " targets, ");
    plot_grouped(script, r->closed);
    tm_text_string(script, " closed and ");
    plot_grouped(script, r->open);
    tm_text_string(script,
                   " open terminal stars\" at screen 0.07, 0.941 textcolor '#222222'\n");
}

/* Bins of counts beside each other, each named in its middle; the last one is of all that
 * are larger, too. */
static void count_tics(tm_text *script, size_t bins, size_t step)
{
    tm_text_string(script, "set xtics (");
    for (size_t i = 0; i + step < bins; i += step)
        tm_text_format(script, "'%zu' %zu.5, ", i, i);
    tm_text_format(script, "'≥%zu' %zu.5)\n", bins - 1, bins - 1);
}

/* The first bins; what is in those behind is in the last. */
static void shorten(const size_t *count, size_t all, size_t *bin, size_t bins)
{
    for (size_t i = 0; i < bins; i++)
        bin[i] = count[i];
    for (size_t i = bins; i < all; i++)
        bin[bins - 1] += count[i];
}

static void visited_panel(tm_text *script, const tm_lepp_report *r)
{
    const size_t step = 4;
    size_t visited[VISITED];
    shorten(r->visited, TM_LEPP_VISITS, visited, VISITED);
    plot_outline(script, "visited", visited, VISITED, 1, r->targets);
    count_tics(script, VISITED, step);
    tm_text_format(script,
                   "set lmargin screen 0.07\n"
                   "set rmargin screen 0.485\n"
                   "set ylabel 'share of targets, %%' offset 0.8,0\n"
                   "set xlabel 'terminal stars that their paths came to'\n"
                   "set xrange [0:%d]\nset yrange [0:%.6g]\nplot ",
                   VISITED, plot_axis(plot_highest(visited, VISITED, r->targets)));
    plot_blue(script, "visited");
    tm_text_string(script, "\n");
}

static void size_panel(tm_text *script, const tm_lepp_report *r)
{
    const size_t step = 2;
    size_t closed[SIZES], inserted[SIZES], swapped[SIZES];
    shorten(r->closed_size, TM_LEPP_SIZES, closed, SIZES);
    shorten(r->insertion_size, TM_LEPP_SIZES, inserted, SIZES);
    shorten(r->swap_size, TM_LEPP_SIZES, swapped, SIZES);
    plot_outline(script, "closed", closed, SIZES, 1, r->closed);
    plot_outline(script, "inserted", inserted, SIZES, 1, r->closed);
    plot_outline(script, "swapped", swapped, SIZES, 1, r->closed);
    count_tics(script, SIZES, step);
    tm_text_format(script,
                   "unset label\n"
                   "set lmargin screen 0.57\n"
                   "set rmargin screen 0.985\n"
                   "set ylabel 'share of closed stars, %%'\n"
                   "set xlabel 'size: all (grey), edge removed (blue), point inserted "
                   "(dashed)'\n"
                   "set xrange [0:%d]\nset yrange [0:%.6g]\n"
                   "plot $closed with filledcurves y=0 fillstyle solid 1 noborder "
                   "linecolor rgb grey, ",
                   SIZES, plot_axis(plot_highest(closed, SIZES, r->closed)));
    plot_blue(script, "swapped");
    tm_text_string(script, ", $inserted with lines linewidth 2 dashtype 2 linecolor rgb "
                           "'#333333'\n");
}

void lepp_plot_script(tm_text *script, const tm_lepp_report *report)
{
    plot_begin(script);
    legend(script, report);
    visited_panel(script, report);
    size_panel(script, report);
    plot_end(script);
}
