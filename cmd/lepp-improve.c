/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lepp-improve: tetrahedra in, better tetrahedra out. */
#include "common/filter.h"

#include "../lib/base/json.h"
#include "../lib/quality/tet_statistics.h"
#include "../lib/tet/lepp.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MAX_STAR = FILTER_OWN };

static const struct option options[] = {{"algorithm", required_argument, NULL, 'a'},
                                        {"factor", required_argument, NULL, 'm'},
                                        {"angle", required_argument, NULL, 't'},
                                        {"quality", required_argument, NULL, 'Q'},
                                        {"stop", required_argument, NULL, 's'},
                                        {"max-star", required_argument, NULL, MAX_STAR},
                                        FILTER_OPTIONS};

static const char synopsis[] = "[-a ALGORITHM] [-m FACTOR] [-t DEG] [-Q dihedral|volume] "
                               "[-s original|N|converged] [--max-star N] [FILE]";

static const char own_help[] =
    "  -a, --algorithm A   selective (default): change a terminal star only where that\n"
    "                      makes it better; swap-centroid, centroid, wcentroid,\n"
    "                      bisection: change every one\n"
    "  -m, --factor M      selective: how many times better, 1 or more (default 1.1)\n"
    "  -t, --angle DEG     bad: a dihedral angle below DEG or above 180 - DEG (30)\n"
    "  -Q, --quality Q     compare stars by dihedral (default) or volume\n"
    "  -s, --stop WHEN     original: the bad tetrahedra of the input, once (default of\n"
    "                      all but selective); N: so many passes over the bad ones;\n"
    "                      converged: until nothing can be done (default of selective)\n"
    "      --max-star N    leave stars of more than N tetrahedra alone\n";

static const double default_factor = 1.1, most_factor = 100;
static const double default_angle = 30, right_angle = 90;

/* In the order of tm_lepp_algorithm. */
static const char *const algorithms[] = {"bisection", "centroid", "wcentroid",
                                         "swap-centroid", "selective"};

static void set_algorithm(const filter *f, tm_lepp_options *o, const char *name)
{
    for (size_t a = 0; a < sizeof algorithms / sizeof algorithms[0]; a++)
        if (strcmp(name, algorithms[a]) == 0) {
            o->algorithm = (tm_lepp_algorithm)a;
            return;
        }
    filter_usage_error(f,
                       "-a: '%s' is not an algorithm (bisection, centroid, wcentroid, "
                       "swap-centroid, selective)",
                       name);
}

static void set_measure(const filter *f, tm_lepp_options *o, const char *name)
{
    if (strcmp(name, "dihedral") == 0)
        o->measure = TM_MEASURE_DIHEDRAL;
    else if (strcmp(name, "volume") == 0)
        o->measure = TM_MEASURE_VOLUME;
    else
        filter_usage_error(f, "-Q: '%s' is not a quality (dihedral, volume)", name);
}

static void set_stop(const filter *f, tm_lepp_options *o, const char *text)
{
    const long most_passes = 1000000;
    if (strcmp(text, "original") == 0) {
        o->stop = TM_LEPP_ORIGINAL;
    } else if (strcmp(text, "converged") == 0) {
        o->stop = TM_LEPP_CONVERGED;
    } else {
        o->stop = TM_LEPP_PASSES;
        o->passes = (size_t)filter_integer(f, "-s", text, 1, most_passes);
    }
}

static tm_lepp_options read_options(filter *f)
{
    tm_lepp_options o = {.algorithm = TM_LEPP_SELECTIVE,
                         .factor = default_factor,
                         .angle = default_angle,
                         .measure = TM_MEASURE_DIHEDRAL};
    bool has_stop = false, has_factor = false;
    int c;
    while ((c = filter_option(f)) != -1) {
        if (c == 'a')
            set_algorithm(f, &o, optarg);
        else if (c == 'm')
            o.factor = filter_number(f, "-m", optarg, 1, most_factor);
        else if (c == 't')
            o.angle = filter_number(f, "-t", optarg, 0, right_angle);
        else if (c == 'Q')
            set_measure(f, &o, optarg);
        else if (c == 's')
            set_stop(f, &o, optarg);
        else if (c == MAX_STAR)
            o.max_star = (size_t)filter_integer(f, "--max-star", optarg, 1, INT32_MAX);
        has_stop |= c == 's';
        has_factor |= c == 'm';
    }
    bool selective = o.algorithm == TM_LEPP_SELECTIVE;
    if (!has_stop)
        o.stop = selective ? TM_LEPP_CONVERGED : TM_LEPP_ORIGINAL;
    if (!selective && has_factor)
        filter_usage_error(f, "-m is for selective: %s changes every star",
                           algorithms[o.algorithm]);
    if (!selective && o.stop == TM_LEPP_CONVERGED)
        filter_usage_error(f, "%s does not converge: -s original or -s N",
                           algorithms[o.algorithm]);
    return o;
}

/* What --json compares; nothing where that was not asked for. */
static void measure(const filter *f, const double (*xyz)[3], size_t nodes,
                    const uint32_t (*tet)[4], size_t tets, double limit,
                    tm_tet_statistics *statistics)
{
    tm_error error;
    if (f->json && tm_tet_statistics_measure(statistics, xyz, nodes, tet, tets, limit,
                                             f->threads, &error) != TM_OK)
        filter_fail(f, &error);
}

/* What the reading of the mesh found worth saying. */
static void note_input(const filter *f, const tm_tet_mesh *mesh)
{
    if (mesh->turned)
        filter_note(f, "%zu tetrahedra were left-handed and are turned", mesh->turned);
    if (mesh->flat)
        filter_note(f, "%zu tetrahedra are flat", mesh->flat);
    if (mesh->dropped_faces)
        filter_note(f, "%zu inner faces without marker are dropped from .face",
                    mesh->dropped_faces);
    if (mesh->dangling)
        filter_note(f, "%zu rows of .face are no face of a tetrahedron; they stay",
                    mesh->dangling);
    if (mesh->locked.count)
        filter_note(f, "%zu edges where the mesh only touches itself are left alone",
                    mesh->locked.count);
}

/* Drops the main mesh's blocks that are not known here: they may refer to the
 * tetrahedra, which have other numbers now. */
static void drop_unknown(const filter *f, tm_stream *stream)
{
    for (size_t b = stream->blocks; b > 0; b--) {
        tm_block *block = &stream->block[b - 1];
        if (block->kind != TM_UNKNOWN || block->name[0] != '.')
            continue;
        filter_note(f, "%s is dropped: the tetrahedra have other numbers now",
                    block->name);
        tm_stream_remove(stream, block);
    }
}

static void histogram(tm_json *json, const char *key, const size_t *count, size_t bins)
{
    tm_json_open(json, key, '[');
    for (size_t i = 0; i < bins; i++)
        tm_json_integer(json, NULL, (int64_t)count[i]);
    tm_json_close(json, ']');
}

static void stars_json(tm_json *json, const tm_lepp_report *r)
{
    tm_json_open(json, "stars", '{');
    tm_json_integer(json, "closed", (int64_t)r->closed);
    tm_json_integer(json, "open", (int64_t)r->open);
    tm_json_open(json, "refused", '{');
    tm_json_integer(json, "closed", (int64_t)r->refused_closed);
    tm_json_integer(json, "open", (int64_t)r->refused_open);
    tm_json_integer(json, "locked", (int64_t)r->locked);
    tm_json_integer(json, "above_max_star", (int64_t)r->above_max);
    tm_json_close(json, '}');
    tm_json_open(json, "invalid_centroids", '{');
    tm_json_integer(json, "outside", (int64_t)r->outside);
    tm_json_integer(json, "tangled", (int64_t)r->tangled);
    tm_json_close(json, '}');
    tm_json_open(json, "sizes", '{');
    histogram(json, "closed", r->closed_size, TM_LEPP_SIZES);
    histogram(json, "open", r->open_size, TM_LEPP_SIZES);
    histogram(json, "swapped", r->swap_size, TM_LEPP_SIZES);
    histogram(json, "inserted", r->insertion_size, TM_LEPP_SIZES);
    tm_json_close(json, '}');
    tm_json_integer(json, "too_large_to_swap", (int64_t)r->too_large);
    histogram(json, "visited", r->visited, TM_LEPP_VISITS);
    tm_json_integer(json, "most_visited", (int64_t)r->most_visited);
    tm_json_close(json, '}');
}

static void write_json(filter *f, const tm_tet_statistics *before,
                       const tm_tet_statistics *after, const tm_lepp_report *r,
                       double seconds)
{
    tm_text text = {0};
    tm_json json = {.text = &text};
    tm_json_open(&json, NULL, '{');
    tm_json_open(&json, "before", '{');
    tm_tet_statistics_json(&json, before);
    tm_json_close(&json, '}');
    tm_json_open(&json, "after", '{');
    tm_tet_statistics_json(&json, after);
    tm_json_close(&json, '}');
    tm_json_double(&json, "seconds", seconds);
    tm_json_integer(&json, "passes", (int64_t)r->passes);
    tm_json_integer(&json, "targets", (int64_t)r->targets);
    tm_json_open(&json, "operations", '{');
    tm_json_integer(&json, "edge_removals", (int64_t)r->swaps);
    tm_json_integer(&json, "centroids", (int64_t)r->centroids);
    tm_json_integer(&json, "midpoints", (int64_t)r->midpoints);
    tm_json_integer(&json, "boundary_midpoints", (int64_t)r->open_midpoints);
    tm_json_close(&json, '}');
    stars_json(&json, r);
    tm_json_close(&json, '}');
    tm_text_string(&text, "\n");
    filter_write_json(f, &text);
    tm_text_free(&text);
}

static double cpu_seconds(void)
{
    struct timespec now;
    const double nanosecond = 1e-9;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + nanosecond * (double)now.tv_nsec;
}

/* Improves the stream's mesh in place. */
static tm_lepp_report improve(filter *f, tm_stream *stream, const tm_lepp_options *o,
                              tm_tet_statistics *before, double *seconds)
{
    tm_error error;
    tm_tet_mesh mesh;
    tm_lepp_report report;
    if (tm_tet_mesh_take(&mesh, stream, &error) != TM_OK) {
        snprintf(error.file, sizeof error.file, "%s", filter_input_name(f));
        filter_fail(f, &error);
    }
    note_input(f, &mesh);
    measure(f, (const double(*)[3])mesh.xyz, mesh.nodes, (const uint32_t(*)[4])mesh.tet,
            mesh.slots, o->angle, before);
    *seconds = -cpu_seconds();
    if (tm_lepp_improve(&mesh, o, &report, &error) != TM_OK)
        filter_fail(f, &error);
    *seconds += cpu_seconds();
    if (tm_tet_mesh_give(&mesh, stream, &error) != TM_OK)
        filter_fail(f, &error);
    return report;
}

/* One line about the run. */
static void summarise(const tm_lepp_report *r, size_t tets, char *text, size_t size)
{
    double before = tm_percent(r->bad_before, r->tets_before);
    if (tm_lepp_operations(r) == 0)
        snprintf(text, size, "nothing to improve: %zu tetrahedra, %.2f%% bad", tets,
                 before);
    else
        snprintf(text, size,
                 "%zu -> %zu tetrahedra, %.2f%% -> %.2f%% bad; %zu edges removed, %zu "
                 "points inserted",
                 r->tets_before, tets, before, tm_percent(r->bad_after, tets), r->swaps,
                 tm_lepp_operations(r) - r->swaps);
}

int main(int argc, char **argv)
{
    filter f = {.name = "lepp-improve",
                .synopsis = synopsis,
                .purpose = "Improves a tetrahedral mesh along its longest edges.",
                .help = own_help,
                .options = options,
                .letters = "a:m:t:Q:s:" FILTER_LETTERS};
    filter_start(&f, argc, argv);
    tm_lepp_options o = read_options(&f);
    filter_operands(&f);

    tm_stream stream;
    filter_read(&f, &stream);
    tm_tet_statistics before, after;
    double seconds;
    tm_lepp_report report = improve(&f, &stream, &o, &before, &seconds);
    bool changed = tm_lepp_operations(&report) > 0;
    if (changed)
        drop_unknown(&f, &stream);

    const tm_block *node = tm_stream_find(&stream, ".node");
    const tm_block *ele = tm_stream_find(&stream, ".ele");
    size_t nodes = node ? node->count : 0, tets = ele ? ele->count : 0;
    measure(&f, node ? (const double(*)[3])node->real : NULL, nodes,
            ele ? (const uint32_t(*)[4])ele->integer : NULL, tets, o.angle, &after);
    char summary[256];
    summarise(&report, tets, summary, sizeof summary);
    filter_note(&f, "%s", summary);
    if (f.json)
        write_json(&f, &before, &after, &report, seconds);
    filter_write(&f, &stream, "%s", summary);
    tm_stream_free(&stream);
    return filter_finish(&f, EXIT_SUCCESS);
}
