/* SPDX-License-Identifier: GPL-3.0-or-later */
/* surface-mend: a surface with gaps, doubles and turned pieces, made one that a mesher
 * takes. */
#include "common/input/mesh_input.h"
#include "common/input/surface_input.h"
#include "common/input/surface_stream.h"

#include "../lib/stream/coordinates.h"
#include "../lib/surface/mend/mend.h"
#include "../lib/surface/surface_apart.h"

#include <float.h>
#include <string.h>

enum { OPTION_WELD = FILTER_OWN, OPTION_FILL, OPTION_ISLANDS, OPTION_UNION };

static const struct option long_options[] = {
    {"weld", required_argument, NULL, OPTION_WELD},
    {"fill", required_argument, NULL, OPTION_FILL},
    {"islands", required_argument, NULL, OPTION_ISLANDS},
    {"union", no_argument, NULL, OPTION_UNION},
    FILTER_OPTIONS};

/* By tm_mend_step: for --json, and what is said of one and of several. */
static const struct {
    const char *key, *one, *several;
} words[TM_MEND_STEPS] = {
    [TM_MEND_WELDED] = {"welded", "node was joined to another",
                        "nodes were joined to others"},
    [TM_MEND_DEGENERATE] = {"degenerate", "triangle had a node twice, and is dropped",
                            "triangles had a node twice, and are dropped"},
    [TM_MEND_DOUBLE] = {"doubles", "triangle was there twice",
                        "triangles were there twice"},
    [TM_MEND_FLAT] = {"flat", "triangle had no area: its neighbour is divided instead",
                      "triangles had no area: their neighbours are divided instead"},
    [TM_MEND_SPLIT] = {"split", "node was in the middle of an edge, which is divided",
                       "nodes were in the middle of edges, which are divided"},
    [TM_MEND_FILLED] = {"filled", "hole is filled", "holes are filled"},
    [TM_MEND_ISLANDS] = {"islands", "small piece is dropped", "small pieces are dropped"},
    [TM_MEND_TURNED] = {"turned", "piece had triangles that are turned",
                        "pieces had triangles that are turned"},
};

static const char open_help[] = " (--fill D closes holes that are at most so large, "
                                "--weld D joins nodes that are so close)";
static const char crossing_help[] = " (octree-mesh --lenient takes it as it is)";

static void read_options(filter *f, tm_mend_options *o)
{
    for (int c; (c = filter_option(f)) != -1;) {
        if (c == OPTION_UNION)
            o->all_doubles = true;
        else if (c == OPTION_FILL)
            o->fill = filter_number(f, "--fill", optarg, 0, DBL_MAX);
        else if (c == OPTION_ISLANDS)
            o->islands = filter_number(f, "--islands", optarg, 0, DBL_MAX);
        else if (strcmp(optarg, "auto") == 0)
            o->weld_auto = true;
        else
            o->weld = filter_number(f, "--weld", optarg, 0, DBL_MAX);
    }
    filter_operands(f);
}

static void say(const filter *f, const tm_mend_report *report)
{
    const char *name = filter_input_name(f);
    for (int i = 0; i < TM_MEND_STEPS; i++) {
        const tm_mended *step = &report->step[i];
        if (step->count > 0)
            filter_note(f, "%s: %zu %s, %s(%g, %g, %g)", name, step->count,
                        step->count > 1 ? words[i].several : words[i].one,
                        step->count > 1 ? "such as at " : "at ", step->place[0],
                        step->place[1], step->place[2]);
    }
}

/* Whether that is plain without the surface that meshers make of it. */
static bool is_plainly_good(const filter *f, const tm_stream *stream,
                            const tm_mend_report *report)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *face = tm_stream_find(stream, ".face");
    bool apart = false;
    tm_error error;
    if (!report->manifold || face->count == 0)
        return false;
    if (tm_triangles_are_apart((const double(*)[3])node->real, node->count,
                               (const uint32_t(*)[3])face->integer, face->count, &apart,
                               &error) != TM_OK)
        filter_fail(f, &error);
    return apart;
}

/* Whether meshers take what there is now; *error says why not. What bounds the outside
 * beside walls is turned outward, which only that surface tells. */
static bool is_good(const filter *f, const tm_stream *stream, tm_mend_report *report,
                    tm_error *error)
{
    const tm_surface_options options = {
        .feature_angle = TM_FEATURE_ANGLE, .regions = true, .walls = true};
    tm_polygon_surface polygons;
    tm_surface surface;
    if (is_plainly_good(f, stream, report))
        return true;
    tm_polygon_surface_init(&polygons);
    tm_status status = surface_input_of_blocks(tm_stream_find(stream, ".node"),
                                               tm_stream_find(stream, ".face"),
                                               stream->base, &polygons, error);
    if (status == TM_OK) {
        status = tm_surface_build(&surface, &polygons, &options, error);
        if (status == TM_OK)
            tm_mend_turn_outward(tm_stream_find(stream, ".face"), &surface, &polygons,
                                 &report->step[TM_MEND_TURNED]);
        else
            surface_input_add_help(error, &polygons, &options,
                                   report->open_edges > 0 ? open_help : crossing_help);
        tm_surface_free(&surface);
    }
    tm_polygon_surface_free(&polygons);
    if (status != TM_OK && status != TM_ERROR_INPUT)
        filter_fail(f, error);
    return status == TM_OK;
}

static void write_json(filter *f, const tm_stream *stream, const tm_mend_report *report,
                       bool good)
{
    if (!f->json)
        return;
    tm_json *json = filter_json_begin(f);
    tm_json_integer(json, "nodes", (int64_t)mesh_rows(stream, ".node"));
    tm_json_integer(json, "triangles", (int64_t)mesh_rows(stream, ".face"));
    for (int i = 0; i < TM_MEND_STEPS; i++)
        tm_json_integer(json, words[i].key, (int64_t)report->step[i].count);
    tm_json_double(json, "weld", report->weld);
    tm_json_integer(json, "open_edges_before", (int64_t)report->open_before);
    tm_json_integer(json, "open_edges", (int64_t)report->open_edges);
    tm_json_bool(json, "good", good);
    filter_json_end(f);
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "surface-mend",
        .synopsis = "[--weld D|auto] [--fill D] [--islands D] [--union] [FILE]",
        .purpose =
            "Joins what is nearly one in a surface, drops what is there twice, divides\n"
            "edges that have a node in the middle, and turns pieces outward.",
        .help =
            "      --weld D        join nodes of open edges that are so close (1e-9 of "
            "the\n"
            "                      diagonal of the box); auto: as far as closes most\n"
            "      --fill D        close holes that are so large at most\n"
            "      --islands D     drop pieces that are so large at most\n"
            "      --union         of the wall that two bodies have nothing stays\n",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    tm_mend_options options = {.weld = -1};
    tm_mend_report report;
    tm_stream stream;
    tm_error error;
    filter_start(&f, argc, argv);
    read_options(&f, &options);
    surface_stream_read(&f, &stream);
    if (tm_stream_check_coordinates(&stream, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    filter_stage(&f, "mending");
    if (tm_mend(&stream, &options, &report, &error) != TM_OK)
        filter_fail(&f, &error);
    filter_stage(&f, "looking for crossings");
    const bool good = is_good(&f, &stream, &report, &error);
    say(&f, &report);
    if (!good)
        filter_note(&f, "%s: still: %s", filter_input_name(&f), error.what);
    write_json(&f, &stream, &report, good);
    filter_write(&f, &stream, "%zu open edges -> %zu, %zu triangles", report.open_before,
                 report.open_edges, mesh_rows(&stream, ".face"));
    tm_stream_free(&stream);
    return filter_finish(&f, good ? 0 : EXIT_GOAL);
}
