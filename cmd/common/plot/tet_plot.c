/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plot.h"

#include "../../../lib/element/tet_quality.h"

#include <math.h>

/* Objects of gnuplot have numbers. */
enum { BAD_LOW = 1, BAD_HIGH, LEGEND_BEFORE, LEGEND_AFTER };

/* A histogram of each mesh; without a mesh before, before is NULL. */
typedef struct panel {
    const char *name; /* of its data */
    size_t bins;
    double width; /* of a bin */
    const size_t *before;
    const size_t *after;
    size_t whole_before;
    size_t whole_after;
} panel;

/* An entry of the legend: how large a mesh is, and how bad. */
static void legend(tm_text *script, int object, double x, const char *colour,
                   const char *when, const tm_tet_statistics *s)
{
    const double size = 0.022;
    const double text_distance = 0.012;
    tm_text_format(script,
                   "set object %d rectangle from screen %g, 0.925 to screen %g, 0.957 "
                   "fillcolor rgb %s fillstyle solid noborder\n"
                   "set label %d \"%s",
                   object, x, x + size, colour, object, when);
    plot_grouped(script, s->tets);
    tm_text_format(script,
                   " tetrahedra, %.1f %% bad\" at screen %g, 0.941 textcolor '#222222'\n",
                   tm_percent(s->bad, s->tets), x + size + text_distance);
}

static void legends(tm_text *script, const tm_tet_statistics *before,
                    const tm_tet_statistics *s)
{
    const double left = 0.07;
    const double next = 0.42;
    if (before)
        legend(script, LEGEND_BEFORE, left, "grey", "before: ", before);
    legend(script, LEGEND_AFTER, before ? next : left, "blue", before ? "after: " : "",
           s);
}

static void plot(tm_text *script, const panel *p)
{
    enum { NAME = 32 };
    char after[NAME], before[NAME];
    double highest = plot_highest(p->after, p->bins, p->whole_after);
    snprintf(after, sizeof after, "%s_after", p->name);
    snprintf(before, sizeof before, "%s_before", p->name);
    plot_outline(script, after, p->after, p->bins, p->width, p->whole_after);
    if (p->before) {
        plot_outline(script, before, p->before, p->bins, p->width, p->whole_before);
        highest = fmax(highest, plot_highest(p->before, p->bins, p->whole_before));
    }
    tm_text_format(script, "set xrange [0:%g]\nset yrange [0:%.6g]\nplot ",
                   p->width * (double)p->bins, plot_axis(highest));
    if (p->before)
        tm_text_format(script,
                       "$%s with filledcurves y=0 fillstyle solid 1 noborder "
                       "linecolor rgb grey, ",
                       before);
    plot_blue(script, after);
    tm_text_string(script, "\n");
}

static void dihedral_panel(tm_text *script, const tm_tet_statistics *before,
                           const tm_tet_statistics *s)
{
    const double half_turn = 180;
    const panel p = {.name = "dihedral",
                     .bins = TM_DIHEDRAL_BINS,
                     .width = TM_DIHEDRAL_BIN,
                     .before = before ? before->dihedral : NULL,
                     .after = s->dihedral,
                     .whole_before = before ? TM_TET_EDGES * before->tets : 0,
                     .whole_after = TM_TET_EDGES * s->tets};
    tm_text_format(script,
                   "set object %d rectangle from graph 0, graph 0 to first %g, graph 1 "
                   "behind fillcolor rgb bad fillstyle solid noborder\n"
                   "set object %d rectangle from first %g, graph 0 to graph 1, graph 1 "
                   "behind fillcolor rgb bad fillstyle solid noborder\n"
                   "set lmargin screen 0.07\n"
                   "set rmargin screen 0.485\n"
                   "set xtics 30\n"
                   "set ylabel 'share of angles, %%' offset 0.8,0\n"
                   "set xlabel 'dihedral angle in degrees (bad: below %g, above %g)'\n",
                   BAD_LOW, s->limit, BAD_HIGH, half_turn - s->limit, s->limit,
                   half_turn - s->limit);
    plot(script, &p);
}

static void volume_quality_panel(tm_text *script, const tm_tet_statistics *before,
                                 const tm_tet_statistics *s)
{
    const panel p = {.name = "volume_quality",
                     .bins = TM_VOLUME_QUALITY_BINS,
                     .width = TM_VOLUME_QUALITY_BIN,
                     .before = before ? before->volume_quality : NULL,
                     .after = s->volume_quality,
                     .whole_before = before ? before->tets : 0,
                     .whole_after = s->tets};
    tm_text_string(script,
                   "unset object\n"
                   "unset label\n"
                   "set lmargin screen 0.57\n"
                   "set rmargin screen 0.985\n"
                   "set xtics 0.2\n"
                   "set ylabel 'share of tetrahedra, %'\n"
                   "set xlabel 'volume quality (1 for the regular tetrahedron)'\n");
    plot(script, &p);
}

void tet_plot_script(tm_text *script, const tm_tet_statistics *before,
                     const tm_tet_statistics *statistics)
{
    plot_begin(script);
    legends(script, before, statistics);
    dihedral_panel(script, before, statistics);
    volume_quality_panel(script, before, statistics);
    plot_end(script);
}
