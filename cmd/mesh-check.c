/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh-check: what is wrong with a mesh, as exit status and as a list. */
#include "common/input/against.h"
#include "common/input/mesh_input.h"
#include "common/input/mesh_share.h"
#include "common/input/surface_input.h"

#include "../lib/examine/element_examine.h"
#include "../lib/examine/poly/poly_examine.h"
#include "../lib/examine/ranks/examine_ranks.h"
#include "../lib/examine/surface_examine.h"

#include <math.h>

enum { WITHIN = FILTER_OWN };

static const struct option long_options[] = {
    AGAINST_OPTIONS, {"within", required_argument, NULL, WITHIN}, FILTER_OPTIONS};

typedef struct limits {
    against against;
    double within;  /* negative: not given */
    bool is_length; /* or a part of the diagonal */
} limits;

static void read_options(filter *f, limits *l)
{
    int c;
    while ((c = filter_option(f)) != -1) {
        if (c != WITHIN) {
            against_option(f, &l->against, c);
            continue;
        }
        l->is_length = optarg[0] == '=';
        l->within = filter_number(f, "--within", optarg + l->is_length, 0,
                                  l->is_length ? HUGE_VAL : 1);
    }
    filter_operands(f);
    against_check(f, &l->against);
    if (l->within >= 0 && !l->against.file)
        filter_usage_error(f, "--within goes with --against");
}

static bool is_within(const limits *l)
{
    const double rounding = 1e-14; /* of the diagonal */
    if (l->within < 0)
        return true;
    return against_most(&l->against) <=
           (l->is_length ? l->within : l->within * l->against.found.diagonal) +
               rounding * l->against.found.diagonal;
}

/* The blocks of elements; the first that there is, is examined. */
static const char *const element_block[] = {".ele", ".cell", ".mix"};
enum { TETRAHEDRA, POLYHEDRA, MIXED, ELEMENT_BLOCKS };

/* Which elements are examined, with a note for each other block; tetrahedra, of which
 * there are none, where there is no block. */
static int choose(const filter *f, const tm_stream *stream)
{
    int chosen = ELEMENT_BLOCKS;
    for (int i = 0; i < ELEMENT_BLOCKS; i++) {
        if (!tm_stream_find(stream, element_block[i]))
            continue;
        if (chosen == ELEMENT_BLOCKS)
            chosen = i;
        else
            filter_note(f, "%s: %s is not examined, only %s", filter_input_name(f),
                        element_block[i], element_block[chosen]);
    }
    return chosen == ELEMENT_BLOCKS ? TETRAHEDRA : chosen;
}

static void examine(const filter *f, const tm_stream *stream, tm_examination *found)
{
    tm_error error;
    tm_status status;
    const int chosen = choose(f, stream);
    filter_stage(f, "examining");
    if (chosen == POLYHEDRA) {
        const tm_poly_arrays mesh = tm_poly_arrays_of(stream);
        status = tm_poly_examine(found, &mesh, f->threads, &error);
    } else {
        const tm_mesh_view mesh = chosen == MIXED ? tm_mesh_view_of_mixed(stream)
                                                  : tm_mesh_view_of_tets(stream);
        status = tm_element_examine(found, &mesh, f->threads, &error);
    }
    if (status != TM_OK)
        filter_fail(f, &error);
}

/* The same by all ranks together. */
static void examine_slices(const filter *f, const tm_slices *slices,
                           tm_examination *found)
{
    tm_error error;
    tm_status status;
    const tm_stream *stream = &slices->stream;
    const int chosen = choose(f, stream);
    const size_t nodes = mesh_share_rows(slices, ".node");
    filter_stage(f, "examining");
    if (chosen == POLYHEDRA) {
        const tm_poly_slices mesh = {.own = tm_poly_arrays_of(stream),
                                     .nodes = nodes,
                                     .facets = mesh_share_rows(slices, ".facet"),
                                     .cells = mesh_share_rows(slices, ".cell")};
        status = tm_poly_examine_ranks(found, &mesh, f->threads, &error);
    } else {
        const tm_element_slices mesh = {
            .own = chosen == MIXED ? tm_mesh_view_of_mixed(stream)
                                   : tm_mesh_view_of_tets(stream),
            .nodes = nodes,
            .elements = mesh_share_rows(slices, element_block[chosen]),
            .faces = mesh_share_rows(slices, ".face"),
            .edges = mesh_share_rows(slices, ".edge"),
            .facets = chosen == MIXED ? mesh_share_rows(slices, ".facet") : 0};
        status = tm_element_examine_ranks(found, &mesh, f->threads, &error);
    }
    filter_agree(f, status, &error);
}

/* Nothing where standard output is for the JSON, or is to be quiet. */
static void write_report(filter *f, const tm_examination *found, const limits *l,
                         unsigned base)
{
    enum { LABEL_WIDTH = 28 };
    if (!filter_has_report(f) || (!f->output && f->verbosity < 0))
        return;
    tm_text text = {0};
    tm_examination_text(&text, found, base);
    against_text(&text, &l->against, LABEL_WIDTH);
    if (!is_within(l))
        tm_text_string(&text, "farther than --within allows\n");
    filter_write_text(f, &text);
    tm_text_free(&text);
}

/* A stream without elements: its surface. Returns the exit status. */
static int check_surface(filter *f, const tm_stream *stream, limits *l)
{
    tm_polygon_surface surface;
    tm_surface_examination found;
    tm_error error;
    const bool is_main = tm_stream_find(stream, ".face");
    if (l->against.file)
        filter_usage_error(f, "--against needs elements, but this is a surface");
    tm_polygon_surface_init(&surface);
    filter_stage(f, "examining");
    if (surface_input_of_blocks(
            tm_stream_find(stream, is_main ? ".node" : "surface.node"),
            tm_stream_find(stream, is_main ? ".face" : "surface.face"), stream->base,
            &surface, &error) != TM_OK ||
        tm_surface_examine(&found, &surface, &error) != TM_OK)
        mesh_input_fail(f, &error);
    if (f->json) {
        tm_surface_examination_json(filter_json_begin(f), &found, &surface);
        filter_json_end(f);
    }
    if (filter_has_report(f) && (f->output || f->verbosity >= 0)) {
        tm_text text = {0};
        tm_surface_examination_text(&text, &found, &surface);
        filter_write_text(f, &text);
        tm_text_free(&text);
    }
    const bool good = tm_surface_examination_is_good(&found);
    tm_surface_examination_free(&found);
    tm_polygon_surface_free(&surface);
    return good ? 0 : EXIT_GOAL;
}

static bool has_elements(const tm_stream *stream)
{
    for (int i = 0; i < ELEMENT_BLOCKS; i++)
        if (tm_stream_find(stream, element_block[i]))
            return true;
    return false;
}

/* What was found, as JSON and as text. Returns the exit status. */
static int report(filter *f, const tm_examination *found, const limits *l, unsigned base)
{
    if (f->json) {
        tm_json *json = filter_json_begin(f);
        tm_examination_json(json, found);
        against_json(json, &l->against);
        filter_json_end(f);
    }
    write_report(f, found, l, base);
    return tm_examination_is_good(found) && is_within(l) ? 0 : EXIT_GOAL;
}

/* Ranks other than the first have nothing to say of what that does alone. */
static void report_nothing(filter *f)
{
    filter_json_begin(f);
    filter_json_end(f);
}

/* All ranks; of a surface rank 0 gets the others' rows and works alone. */
static int check_together(filter *f, limits *l)
{
    tm_slices slices;
    tm_error error;
    int status = 0;
    mesh_share_read(f, &slices);
    if (has_elements(&slices.stream)) {
        tm_examination found;
        examine_slices(f, &slices, &found);
        status = report(f, &found, l, slices.stream.base);
    } else {
        filter_agree(f, tm_slices_gather(&slices, &error), &error);
        if (filter_speaks())
            status = check_surface(f, &slices.stream, l);
        else
            report_nothing(f);
    }
    tm_slices_free(&slices);
    return filter_finish(f, status);
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "mesh-check",
        .synopsis = AGAINST_SYNOPSIS " [--within [=]D] [FILE]",
        .purpose =
            "Says what is wrong with a mesh of tetrahedra, polyhedra or mixed elements:\n"
            "inverted, flat and overlapping ones, faces that do not match, polyhedra\n"
            "that are not closed, a boundary that is not closed or not manifold,\n"
            "duplicate nodes; of a surface open edges, crossings, doubles, turned "
            "pieces.\n"
            "Exit status 1 if anything is.",
        .help = AGAINST_HELP
        "      --within D      exit status 1 if any of these distances is above D: a "
        "part\n"
        "                      of the diagonal of SURFACE's bounding box; =D: a length\n",
        .options = long_options,
        .letters = FILTER_LETTERS,
        .json_is_output = true,
        .ranks = true,
    };
    filter_start(&f, argc, argv);
    limits l = {.against = against_start(), .within = -1};
    read_options(&f, &l);
    if (filter_together(&f, !l.against.file))
        return check_together(&f, &l);

    tm_stream stream;
    mesh_input_read_to_compute(&f, &stream);
    if (!has_elements(&stream)) {
        const int status = check_surface(&f, &stream, &l);
        tm_stream_free(&stream);
        return filter_finish(&f, status);
    }
    tm_examination found;
    examine(&f, &stream, &found);
    against_measure(&f, &l.against, &stream);
    const int status = report(&f, &found, &l, stream.base);
    tm_stream_free(&stream);
    return filter_finish(&f, status);
}
