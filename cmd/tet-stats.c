/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tet-stats: how good the tetrahedra of a mesh are, or of two meshes side by side. */
#include "common/input/against.h"
#include "common/input/mesh_input.h"
#include "common/input/mesh_share.h"
#include "common/plot/plot.h"

#include "../lib/element/tet_quality.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_PLOT = FILTER_OWN, OPTION_LIST };

static const struct option long_options[] = {
    {"plot", required_argument, NULL, OPTION_PLOT},
    {"list", no_argument, NULL, OPTION_LIST},
    {"threshold", required_argument, NULL, 't'},
    AGAINST_OPTIONS,
    FILTER_OPTIONS};

typedef struct options {
    double threshold; /* degrees */
    const char *plot; /* NULL: none */
    bool list;
    bool compare;      /* there are two FILEs */
    const char *after; /* the second; NULL: standard input */
    bool together;     /* with other ranks */
    against against;
} options;

/* A stream of which the tetrahedra are used, all right-hand positive or flat. */
typedef struct mesh {
    tm_stream stream;
    const double (*xyz)[3];
    size_t nodes;
    uint32_t (*tet)[4];
    size_t tets;
} mesh;

static void read_mesh(const filter *f, mesh *m)
{
    mesh_input_read_to_compute(f, &m->stream);
    const tm_block *node = tm_stream_find(&m->stream, ".node");
    tm_block *ele = tm_stream_find(&m->stream, ".ele");
    m->xyz = node ? (const double(*)[3])node->real : NULL;
    m->nodes = node ? node->count : 0;
    m->tet = ele ? (uint32_t(*)[4])ele->integer : NULL;
    m->tets = ele ? ele->count : 0;
    if (node && ele)
        mesh_input_turn(f, &m->stream, ele, "are counted turned");
}

static void measure(const filter *f, const mesh *m, const options *o,
                    tm_tet_statistics *s)
{
    tm_error error;
    filter_stage(f, "measuring");
    if (tm_tet_statistics_measure(s, m->xyz, m->nodes, (const uint32_t(*)[4])m->tet,
                                  m->tets, o->threshold, f->threads, &error) != TM_OK)
        filter_fail(f, &error);
}

/* The same of a mesh of which each rank has a slice. */
static void measure_slices(const filter *f, const options *o, tm_tet_statistics *s)
{
    tm_slices slices;
    tm_error error;
    size_t turned;
    mesh_share_read(f, &slices);
    const tm_element_slices tets = mesh_share_tets(&slices);
    filter_stage(f, "measuring");
    filter_agree(
        f, tm_tet_statistics_ranks(s, &turned, &tets, o->threshold, f->threads, &error),
        &error);
    mesh_note_turned(f, turned, tets.elements, "are counted turned");
    tm_slices_free(&slices);
}

/* One line for each tetrahedron: its number in the stream, its smallest and its largest
 * dihedral angle, its volume quality. */
static void list(const mesh *m, tm_text *text)
{
    for (size_t t = 0; t < m->tets; t++) {
        const uint32_t *v = m->tet[t];
        const double *const corner[] = {m->xyz[v[0]], m->xyz[v[1]], m->xyz[v[2]],
                                        m->xyz[v[3]]};
        double angle[TM_TET_EDGES];
        tm_tet_dihedrals(corner[0], corner[1], corner[2], corner[3], angle);
        double least = angle[0];
        double largest = angle[0];
        for (size_t e = 1; e < TM_TET_EDGES; e++) {
            least = fmin(least, angle[e]);
            largest = fmax(largest, angle[e]);
        }
        tm_text_format(text, "%zu %.6f %.6f %.6f\n", t + m->stream.base, least, largest,
                       tm_tet_volume_quality(corner[0], corner[1], corner[2], corner[3]));
    }
}

static void write_json(filter *f, const options *o, const tm_tet_statistics *before,
                       const tm_tet_statistics *s)
{
    tm_json *json = filter_json_begin(f);
    if (before) {
        tm_tet_statistics_object(json, "before", before);
        tm_tet_statistics_object(json, "after", s);
    } else {
        tm_tet_statistics_json(json, s);
    }
    against_json(json, &o->against);
    filter_json_end(f);
}

static void write_plot(const filter *f, const options *o, const tm_tet_statistics *before,
                       const tm_tet_statistics *s)
{
    tm_text script = {0};
    if (!filter_speaks())
        return;
    tet_plot_script(&script, before, s);
    plot_write(f, &script, o->plot);
}

/* What standard output or -o gets; nothing where standard output is for the JSON. */
static void write_report(filter *f, const options *o, const mesh *m,
                         const tm_tet_statistics *before, const tm_tet_statistics *s)
{
    if (!filter_has_report(f))
        return;
    tm_text text = {0};
    if (o->list)
        list(m, &text);
    else
        tm_tet_statistics_table(&text, before, s);
    if (!o->list)
        against_text(&text, &o->against, TM_LABEL_WIDTH);
    filter_write_text(f, &text);
    tm_text_free(&text);
}

static void read_options(filter *f, options *o)
{
    const double right_angle = 90;
    int c;
    while ((c = filter_option(f)) != -1) {
        switch (c) {
        case 't':
            o->threshold = filter_number(f, "-t", optarg, 0, right_angle);
            break;
        case OPTION_PLOT:
            o->plot = optarg;
            break;
        case OPTION_LIST:
            o->list = true;
            break;
        default:
            against_option(f, &o->against, c);
        }
    }
    if (f->argc - optind > 2)
        filter_usage_error(f, "two files at most, but there is also '%s'",
                           f->argv[optind + 2]);
    o->compare = f->argc - optind == 2;
    if (o->compare)
        o->after = f->argv[--f->argc];
    filter_operands(f);
    plot_check_file(f, o->plot);
    against_check(f, &o->against);
    if (o->after && strcmp(o->after, "-") == 0)
        o->after = NULL;
    if (o->compare && !o->after && !f->input)
        filter_usage_error(f, "only one of the two files can be standard input");
    if (o->compare && o->list)
        filter_usage_error(f, "--list takes one file, not two");
    o->together = filter_together(f, !o->list && !o->against.file);
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "tet-stats",
        .synopsis =
            "[-t DEG] [--plot FILE.svg] [--list] " AGAINST_SYNOPSIS " [FILE [AFTER]]",
        .purpose =
            "Says how good the tetrahedra of a mesh are: shares and histograms of\n"
            "dihedral angles and of volume quality; with AFTER, of both meshes.",
        .help =
            "  -t, --threshold DEG an angle below DEG or above 180-DEG is bad (30)\n"
            "      --plot FILE.svg draw the histograms by gnuplot\n"
            "      --list          a line per tetrahedron: number, smallest and\n"
            "                      largest dihedral angle, volume quality\n" AGAINST_HELP,
        .options = long_options,
        .letters = "t:" FILTER_LETTERS,
        .json_is_output = true,
        .ranks = true,
    };
    options o = {.threshold = 30, .against = against_start()};
    mesh first = {0}, second = {0};
    tm_tet_statistics before, after;
    filter_start(&f, argc, argv);
    read_options(&f, &o);

    filter g = f;
    if (o.compare)
        g.input = o.after;
    if (o.together) {
        measure_slices(&f, &o, &before);
        if (o.compare)
            measure_slices(&g, &o, &after);
    } else {
        read_mesh(&f, &first);
        measure(&f, &first, &o, &before);
        if (o.compare) {
            read_mesh(&g, &second);
            measure(&g, &second, &o, &after);
        }
        against_measure(&g, &o.against, o.compare ? &second.stream : &first.stream);
    }
    const tm_tet_statistics *earlier = o.compare ? &before : NULL;
    const tm_tet_statistics *last = o.compare ? &after : &before;
    if (f.json)
        write_json(&f, &o, earlier, last);
    if (o.plot)
        write_plot(&f, &o, earlier, last);
    write_report(&f, &o, &first, earlier, last);
    tm_stream_free(&first.stream);
    tm_stream_free(&second.stream);
    return filter_finish(&f, 0);
}
