/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lepp-improve: tetrahedra in, better tetrahedra out. */
#include "common/improve/improve_result.h"
#include "common/input/mesh_share.h"
#include "common/input/tet_input.h"
#include "common/input/tet_share.h"
#include "common/plot/plot.h"

#include "../lib/examine/tet_statistics.h"
#include "../lib/tet/improve/improve_ranks.h"
#include "../lib/tet/mesh_set.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

/* What --json compares; nothing where that was not asked for. */
static void measure(const filter *f, const double (*xyz)[3], size_t nodes,
                    const uint32_t (*tet)[4], size_t tets, double limit,
                    tm_tet_statistics *statistics)
{
    tm_error error;
    if (f->json)
        filter_stage(f, "measuring");
    if (f->json && tm_tet_statistics_measure(statistics, xyz, nodes, tet, tets, limit,
                                             f->threads, &error) != TM_OK)
        filter_fail(f, &error);
}
static double cpu_seconds(void)
{
    struct timespec now;
    const double nanosecond = 1e-9;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + nanosecond * (double)now.tv_nsec;
}

/* The length that the tolerance is, in a mesh of that size. */
static double tolerance_of(const improve_settings *o, const tm_tet_mesh *mesh)
{
    double low[3], high[3], diagonal2 = 0;
    for (int x = 0; x < 3; x++) {
        low[x] = HUGE_VAL;
        high[x] = -HUGE_VAL;
        for (size_t v = 0; v < mesh->nodes; v++) {
            low[x] = fmin(low[x], mesh->xyz[v][x]);
            high[x] = fmax(high[x], mesh->xyz[v][x]);
        }
        diagonal2 += (high[x] - low[x]) * (high[x] - low[x]);
    }
    double part = o->improve.surface.tolerance;
    return o->is_length || mesh->nodes == 0 ? part : part * sqrt(diagonal2);
}

/* The mesh of the stream, with the set that is asked for. */
static void take_mesh(const filter *f, tm_stream *stream, const improve_settings *o,
                      improve_result *r, tm_tet_mesh *mesh)
{
    tm_error error;
    bool *in_set = tet_set_find(f, &o->set, stream);
    if (o->lepp.sizes.attribute > 0)
        tet_set_check_sizes(f, stream, o->lepp.sizes.attribute, in_set);
    tet_mesh_from_stream(f, stream, mesh);
    if (!in_set)
        return;
    if (tm_tet_mesh_add_set(mesh, in_set, &error) != TM_OK)
        filter_fail(f, &error);
    free(in_set);
    r->set_before = tm_tet_mesh_count_set(mesh);
    if (r->set_before == 0)
        filter_note(f, "no tetrahedron is in the set");
}

/* Improves the stream's mesh in place. */
static void improve(filter *f, tm_stream *stream, improve_settings *o, improve_result *r)
{
    tm_error error;
    tm_tet_mesh mesh;
    take_mesh(f, stream, o, r, &mesh);
    measure(f, (const double(*)[3])mesh.xyz, mesh.nodes, (const uint32_t(*)[4])mesh.tet,
            mesh.slots, o->improve.angle, &r->before);
    o->improve.surface.tolerance = tolerance_of(o, &mesh);
    r->seconds = -cpu_seconds();
    tm_status status = o->is_improve ? tm_improve(&mesh, &o->improve, &r->improve, &error)
                                     : tm_lepp_improve(&mesh, &o->lepp, &r->lepp, &error);
    if (status != TM_OK)
        filter_fail(f, &error);
    r->seconds += cpu_seconds();
    if (o->is_improve &&
        tm_forced_find(&r->forced, &mesh, o->improve.angle, &error) != TM_OK)
        filter_fail(f, &error);
    r->changes =
        o->is_improve ? tm_improve_operations(&r->improve) : tm_lepp_changes(&r->lepp);
    r->set_after = mesh.has_set ? tm_tet_mesh_count_set(&mesh) : 0;
    tm_tet_mesh_remove_set(&mesh);
    for (size_t b = 0; b < stream->blocks; b++)
        if (tm_tet_mesh_invalidates(&mesh, &stream->block[b]))
            filter_leave_out(f, "the block %s, as nodes have other numbers now",
                             stream->block[b].name);
    if (tm_tet_mesh_to_stream(&mesh, stream, &error) != TM_OK)
        filter_fail(f, &error);
}
static void write_plot(const filter *f, const improve_settings *o,
                       const improve_result *r)
{
    tm_text script = {0};
    lepp_plot_script(&script, &r->lepp);
    plot_write(f, &script, o->plot);
}

/* Whether ranks can do it together: what improve() may do in parts. */
static bool is_for_ranks(const improve_settings *o)
{
    return o->is_improve && o->set.rules == 0 &&
           tm_improve_cuts(&o->improve, TM_TETS_MAX, TM_TETS_MAX);
}

/* measure() of slices. */
static void measure_slices(const filter *f, const tm_slices *slices, double limit,
                           tm_tet_statistics *statistics)
{
    tm_error error;
    size_t turned;
    const tm_element_slices mesh = mesh_share_tets(slices);
    if (!f->json)
        return;
    filter_stage(f, "measuring");
    filter_agree(
        f, tm_tet_statistics_ranks(statistics, &turned, &mesh, limit, f->threads, &error),
        &error);
}

/* The processor time of all ranks. */
static double seconds_of_all(void)
{
    const double million = 1e6;
    size_t microseconds = (size_t)(million * cpu_seconds());
    tm_ranks_sum(&microseconds, 1);
    return (double)microseconds / million;
}

/* Improves the mesh that ranks share; false, with nothing done, where that is better done
 * by one. */
static bool improve_share(filter *f, const improve_settings *o, tm_slices *slices,
                          improve_result *r)
{
    const tm_improve_cut *cut = &tm_improve_usual_cut;
    const tm_improve_options *how = &o->improve;
    tm_tet_share share;
    tm_share_notes notes;
    tm_error error;
    size_t inner_faces;
    measure_slices(f, slices, how->angle, &r->before);
    if (!tet_share_from_slices(f, slices, cut->size, &share, &notes))
        return false;
    bool alone = !tm_improve_cuts(how, share.all_tets,
                                  tm_improve_ranks_count_bad(&share, how->angle));
    if (!alone) {
        r->seconds = -seconds_of_all();
        filter_agree(f,
                     tm_improve_ranks(&share, how, cut, f->json, &r->improve, &alone,
                                      &inner_faces, &error),
                     &error);
        r->seconds += seconds_of_all();
    }
    if (alone) {
        tm_tet_share_free(&share);
        return false;
    }
    tet_share_note(f, &notes);
    filter_agree(f, tm_improve_ranks_forced(&share, how->angle, &r->forced, &error),
                 &error);
    r->changes = tm_improve_operations(&r->improve);
    filter_agree(f, tm_tet_share_give(&share, inner_faces, slices, &error), &error);
    measure_slices(f, slices, how->angle, &r->after);
    return true;
}

/* The work of ranks together, to its end; or *stream is what rank 0 goes on with alone.
 */
static bool work_together(filter *f, const improve_settings *o, tm_stream *stream,
                          int *status)
{
    tm_slices slices;
    tm_slice tets = {0, 0};
    improve_result r = {0};
    char summary[512];
    filter_read_slices(f, &slices);
    tm_slices_find(&slices, ".ele", &tets);
    if (!tm_improve_cuts(&o->improve, tets.total, tets.total) ||
        !improve_share(f, o, &slices, &r)) {
        mesh_share_leave(f, &slices, stream);
        return false;
    }
    if (r.changes > 0)
        tet_share_drop_unknown(f, &slices, "the tetrahedra have other numbers now");
    tm_slices_find(&slices, ".ele", &tets);
    improve_result_summarise(o, &r, tets.total, summary, sizeof summary);
    filter_note(f, "%s", summary);
    if (f->json)
        improve_result_json(f, o, &r);
    filter_write_slices(f, &slices, "%s", summary);
    tm_forced_free(&r.forced);
    tm_slices_free(&slices);
    *status = filter_finish(f, EXIT_SUCCESS);
    return true;
}

int main(int argc, char **argv)
{
    filter f = {.name = "lepp-improve",
                .synopsis = improve_synopsis,
                .purpose =
                    "Improves tetrahedra; the boundary stays where it is, or near.",
                .help = improve_help,
                .options = improve_options,
                .words = improve_words,
                .letters = improve_letters,
                .ranks = true};
    filter_start(&f, argc, argv);
    improve_settings o = improve_settings_read(&f);
    filter_operands(&f);
    plot_check_file(&f, o.plot);
    tm_stream stream;
    int status;
    if (!filter_together(&f, is_for_ranks(&o)))
        filter_read(&f, &stream);
    else if (work_together(&f, &o, &stream, &status))
        return status;

    improve_result r = {0};
    improve(&f, &stream, &o, &r);
    if (r.changes > 0)
        drop_unknown_blocks(&f, &stream, "the tetrahedra have other numbers now");

    const tm_block *node = tm_stream_find(&stream, ".node");
    const tm_block *ele = tm_stream_find(&stream, ".ele");
    size_t nodes = node ? node->count : 0, tets = ele ? ele->count : 0;
    measure(&f, node ? (const double(*)[3])node->real : NULL, nodes,
            ele ? (const uint32_t(*)[4])ele->integer : NULL, tets, o.improve.angle,
            &r.after);
    char summary[512];
    improve_result_summarise(&o, &r, tets, summary, sizeof summary);
    improve_result_note(&f, &o, &r);
    filter_note(&f, "%s", summary);
    if (f.json)
        improve_result_json(&f, &o, &r);
    if (o.plot)
        write_plot(&f, &o, &r);
    filter_write(&f, &stream, "%s", summary);
    tm_forced_free(&r.forced);
    tm_stream_free(&stream);
    tet_set_free(&o.set);
    const bool too_large = r.improve.too_large || r.lepp.larger_after > 0;
    return filter_finish(&f, too_large ? EXIT_GOAL : EXIT_SUCCESS);
}
