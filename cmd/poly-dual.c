/* SPDX-License-Identifier: GPL-3.0-or-later */
/* poly-dual: tetrahedra in, a polyhedron for each node out. */
#include "common/app/filter.h"
#include "common/input/tet_input.h"

#include "../lib/poly/dual/dual.h"

#include <stdlib.h>

enum { FEATURE_ANGLE = FILTER_OWN, CONVEX };

static const struct option options[] = {
    {"feature-angle", required_argument, NULL, FEATURE_ANGLE},
    {"convex", no_argument, NULL, CONVEX},
    FILTER_OPTIONS};

static const double most_feature_angle = 90;

/* Puts the blocks of the dual in the place of those of the tetrahedra. */
static void put_blocks(filter *f, tm_stream *stream, tm_dual_blocks *made)
{
    static const char *const gone[] = {".ele", ".face"};
    tm_error error;
    const bool has_edges = tm_stream_find(stream, ".edge");
    for (size_t k = 0; k < sizeof gone / sizeof *gone; k++)
        if (tm_stream_find(stream, gone[k]))
            tm_stream_remove(stream, tm_stream_find(stream, gone[k]));
    if (tm_stream_put(stream, &made->node, &error) != TM_OK ||
        (has_edges && tm_stream_put(stream, &made->edge, &error) != TM_OK) ||
        tm_stream_put(stream, &made->facet, &error) != TM_OK ||
        tm_stream_put(stream, &made->cell, &error) != TM_OK)
        filter_fail(f, &error);
    tm_dual_blocks_free(made);
}

static void convert(filter *f, tm_stream *stream, tm_dual_options *o, tm_dual_report *r)
{
    tm_error error;
    tm_tet_mesh mesh;
    tm_dual_blocks made;
    const tm_block *face = tm_stream_find(stream, ".face");
    const bool has_markers = face && face->markers;
    if (tm_stream_find(stream, ".facet") || tm_stream_find(stream, ".cell")) {
        tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
                   "has .facet or .cell already, which the polyhedra would be");
        filter_fail(f, &error);
    }
    tet_mesh_from_stream(f, stream, &mesh);
    filter_stage(f, "sorting");
    if (tm_tet_mesh_sort(&mesh, NULL, f->threads, &error) != TM_OK ||
        tm_dual_make(&made, &mesh, o, r, &error) != TM_OK)
        filter_fail(f, &error);
    if (!has_markers) {
        free(made.facet.marker);
        made.facet.marker = NULL;
        made.facet.markers = false;
    }
    tm_tet_mesh_free(&mesh);
    put_blocks(f, stream, &made);
}

static void write_json(filter *f, const tm_dual_report *r)
{
#define ROW(key, member) TM_REPORT_ROW(key, NULL, NULL, tm_dual_report, member)
    static const tm_report_row rows[] = {ROW("tets", tets),
                                         ROW("polyhedra", cells),
                                         ROW("facets", facets),
                                         ROW("nodes", nodes),
                                         ROW("nodes_cut", cut),
                                         ROW("nodes_taken_apart", taken_apart),
                                         ROW("rounds", rounds),
                                         ROW("work", work),
                                         ROW("points_moved", moved),
                                         ROW("wrong_pyramids", wrong_pyramids),
                                         ROW("bad_facets", bad_facets),
                                         ROW("concave", concave),
                                         {0}};
    filter_write_json(f, rows, r);
}

/* Says what is not as it should be. */
static void note(filter *f, const tm_dual_report *r)
{
    if (r->lost_edges > 0)
        filter_leave_out(f, "%zu marked edges that are inside (.edge)", r->lost_edges);
    if (r->cut > 0)
        filter_note(f, "%zu cells were cut, where the surface is concave", r->cut);
    if (r->taken_apart > 0)
        filter_note(f, "%zu nodes have a cell for each of their tetrahedra",
                    r->taken_apart);
    if (r->wrong_pyramids > 0)
        filter_note(f, "%zu pyramids of a facet and a centroid have no volume",
                    r->wrong_pyramids);
}

int main(int argc, char **argv)
{
    filter f = {.name = "poly-dual",
                .synopsis = "[--feature-angle DEG] [--convex] [FILE]",
                .purpose = "Makes the dual of tetrahedra: a polyhedron for each node.",
                .help = "      --feature-angle DEG\n"
                        "                      the surface is smooth where it bends by "
                        "less: it may\n"
                        "                      change there; 0, the default, keeps it\n"
                        "      --convex        move points until cells are convex\n",
                .options = options,
                .letters = FILTER_LETTERS};
    tm_dual_options o = {0};
    int c;
    filter_start(&f, argc, argv);
    while ((c = filter_option(&f)) != -1)
        if (c == FEATURE_ANGLE)
            o.feature_angle =
                filter_number(&f, "--feature-angle", optarg, 0, most_feature_angle);
        else if (c == CONVEX)
            o.convex = true;
    o.progress = filter_progress(&f);
    filter_operands(&f);
    tm_stream stream;
    filter_read(&f, &stream);

    tm_dual_report r;
    convert(&f, &stream, &o, &r);
    note(&f, &r);
    drop_unknown_blocks(&f, &stream, "the elements are polyhedra now");
    char summary[256];
    snprintf(summary, sizeof summary, "%zu tetrahedra -> %zu polyhedra, %zu facets",
             r.tets, r.cells, r.facets);
    filter_note(&f, "%s", summary);
    write_json(&f, &r);
    filter_write(&f, &stream, "%s", summary);
    tm_stream_free(&stream);
    return filter_finish(&f, r.wrong_pyramids > 0 ? EXIT_GOAL : EXIT_SUCCESS);
}
