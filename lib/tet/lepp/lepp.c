/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Targets and passes. */
#include "lepp_engine.h"

#include "../../base/array.h"
#include "../../geom/space_order.h"

#include <stdlib.h>
#include <string.h>

/* Whether a pass over S has to do with t. A tetrahedron that was made in the place of one
 * of S is of S too if it is bad; but of a set that the caller has given, without what
 * comes of it, only the one itself is. */
static bool is_due(const tm_lepp_engine *e, uint32_t t)
{
    const bool alone = e->mesh->has_set && !e->reintroduce;
    const unsigned due = alone ? TM_LEPP_QUEUED : TM_LEPP_TARGET;
    return (e->mark[t] & due) && tm_tet_lives(e->mesh, t);
}

/* One pass over S, which may grow on the way. */
static tm_status improve_all(tm_lepp_engine *e)
{
    tm_status status = TM_OK;
    bool is_simple = e->options->path != TM_LEPP_FULL;
    e->report->passes++;
    e->at.pass = e->report->passes;
    e->at.of = e->targets;
    e->at.all_bad = e->at.bad > e->at.all_bad ? e->at.bad : e->at.all_bad;
    for (size_t i = 0; i < e->targets && status == TM_OK; i++) {
        uint32_t t = e->target[i];
        tm_progress_step(e->options->progress, &e->at, i);
        if (!is_due(e, t))
            continue;
        if (is_simple && tm_lepp_is_blocked(e, t)) { /* as most are: no path at all */
            e->report->targets++;
            e->report->visited[0]++;
        } else {
            status = tm_lepp_follow(e, t);
        }
    }
    return status;
}

/* How many living tetrahedra have the mark. */
static size_t count_marks(const tm_lepp_engine *e, unsigned mark)
{
    size_t count = 0;
    for (size_t t = 0; t < e->mesh->slots; t++)
        count += tm_tet_lives(e->mesh, (uint32_t)t) && (e->mark[t] & mark);
    return count;
}

/* S as it is in the mesh, along a space-filling curve: any order will do,
 * and this one is a quarter faster. */
static tm_status find_targets(tm_lepp_engine *e)
{
    const tm_tet_mesh *mesh = e->mesh;
    tm_space space = tm_space_around((const double(*)[3])mesh->xyz, mesh->nodes);
    tm_curve_point *placed = tm_new(count_marks(e, TM_LEPP_TARGET), sizeof *placed);
    if (!placed)
        return tm_fail_memory(e->error);
    size_t count = 0;
    for (uint32_t t = 0; t < mesh->slots; t++)
        if (tm_tet_lives(mesh, t) && (e->mark[t] & TM_LEPP_TARGET))
            placed[count++] = (tm_curve_point){
                tm_space_position(&space, mesh->xyz[mesh->tet[t][0]]), t};
    tm_status status = TM_OK;
    if (!tm_space_sort(placed, count, 1))
        status = tm_fail_memory(e->error);
    e->targets = 0;
    e->at.bad = count;
    for (size_t i = 0; i < count && status == TM_OK; i++) {
        if (!tm_lepp_add_target(e, placed[i].item))
            status = tm_fail_memory(e->error);
        if (!e->reintroduce)
            e->mark[placed[i].item] |= TM_LEPP_QUEUED;
    }
    free(placed);
    return status;
}

/* S as what is left of it, each once. */
static void keep_targets(tm_lepp_engine *e)
{
    size_t kept = 0;
    for (size_t i = 0; i < e->targets; i++) {
        uint32_t t = e->target[i];
        if (!tm_tet_lives(e->mesh, t) || !(e->mark[t] & TM_LEPP_TARGET) ||
            (e->mark[t] & TM_LEPP_QUEUED))
            continue;
        e->mark[t] |= TM_LEPP_QUEUED;
        e->target[kept++] = t;
    }
    e->targets = e->at.bad = kept;
    for (size_t i = 0; i < kept; i++)
        e->mark[e->target[i]] &= (uint16_t)~TM_LEPP_QUEUED;
}

static tm_status run_passes(tm_lepp_engine *e)
{
    tm_status status = TM_OK;
    bool idle = false;
    while (status == TM_OK && !idle && e->report->passes < e->options->passes) {
        size_t before = tm_lepp_operations(e->report);
        status = find_targets(e);
        if (status == TM_OK)
            status = improve_all(e);
        idle = tm_lepp_operations(e->report) == before;
    }
    return status;
}

/* Algorithm 7.1: sweeps, then one pass with no edge blocked; so many times, or until
 * neither changes anything. */
static tm_status run_with_sweeps(tm_lepp_engine *e)
{
    const tm_lepp_options *o = e->options;
    size_t most = o->stop == TM_LEPP_ORIGINAL ? 1
                  : o->stop == TM_LEPP_PASSES ? o->passes
                                              : SIZE_MAX;
    tm_status status = TM_OK;
    bool idle = false;
    while (status == TM_OK && !idle && e->report->passes < most) {
        size_t before = tm_lepp_changes(e->report);
        tm_lepp_start_round(e);
        if (o->sweeps & TM_SWEEP_SMOOTH)
            status = tm_lepp_smooth(e);
        if (status == TM_OK && o->sweeps & TM_SWEEP_SWAP)
            status = tm_lepp_swap(e);
        if (status == TM_OK)
            status = find_targets(e);
        if (status == TM_OK)
            status = improve_all(e);
        idle = tm_lepp_changes(e->report) == before;
    }
    return status;
}

/* Passes over what is left of S until one changes nothing; then all over with no edge
 * blocked, until that changes nothing either: a star that changed may lie behind an edge
 * that is still blocked. So a second run on the output finds nothing to do. */
static tm_status run_until_converged(tm_lepp_engine *e)
{
    size_t fresh, before;
    e->reintroduce = true;
    tm_status status = find_targets(e);
    do {
        fresh = tm_lepp_operations(e->report);
        tm_lepp_start_round(e);
        do {
            before = tm_lepp_operations(e->report);
            if (status == TM_OK)
                status = improve_all(e);
            keep_targets(e);
        } while (status == TM_OK && tm_lepp_operations(e->report) > before);
    } while (status == TM_OK && tm_lepp_operations(e->report) > fresh);
    return status;
}

static tm_status run(tm_lepp_engine *e)
{
    if (e->options->sweeps)
        return run_with_sweeps(e);
    if (e->options->stop == TM_LEPP_CONVERGED || tm_lepp_has_sizes(e->options))
        return run_until_converged(e);
    if (e->options->stop == TM_LEPP_PASSES)
        return run_passes(e);
    tm_status status = find_targets(e);
    return status == TM_OK ? improve_all(e) : status;
}

/* No angle may be bad and more extreme than those of the mesh. */
static void measure_angles(tm_lepp_engine *e)
{
    const tm_tet_mesh *mesh = e->mesh;
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    e->sweeper.limits = tm_angle_limits_none();
    for (uint32_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        if (tm_tet_lives(mesh, t))
            tm_angle_limits_include(&e->sweeper.limits, x[n[0]], x[n[1]], x[n[2]],
                                    x[n[3]]);
    }
    tm_angle_limits_widen(&e->sweeper.limits, e->options->angle);
}

static tm_status start(tm_lepp_engine *e)
{
    enum { SOME = 64 };
    tm_tet_mesh *mesh = e->mesh;
    e->at.what = "improving";
    tm_progress_tell(e->options->progress, &e->at);
    if (!tm_lepp_reserve(e, 0))
        return tm_fail_memory(e->error);
    uint32_t some[SOME];
    size_t count = 0;
    for (uint32_t t = 0; t < mesh->slots; t++) {
        if (tm_tet_lives(mesh, t))
            some[count++] = t;
        if (count == SOME || t + 1 == mesh->slots) {
            tm_lepp_measure(e, some, count);
            count = 0;
        }
    }
    e->is_input = false;
    e->report->bad_before = e->at.all_bad = count_marks(e, TM_LEPP_BAD);
    if (tm_lepp_has_sizes(e->options))
        e->report->larger_before = count_marks(e, TM_LEPP_TARGET);
    if (e->options->algorithm == TM_LEPP_DELAUNAY) {
        e->delaunay = tm_delaunay_for(mesh);
        e->report->not_delaunay_before = tm_tet_mesh_not_delaunay(mesh);
    }
    if (e->options->sweeps)
        measure_angles(e);
    return e->options->path != TM_LEPP_FIXED || tm_lepp_place_nodes(e)
               ? TM_OK
               : tm_fail_memory(e->error);
}

static void finish(tm_lepp_engine *e)
{
    e->report->bad_after = count_marks(e, TM_LEPP_BAD);
    if (tm_lepp_has_sizes(e->options))
        e->report->larger_after = count_marks(e, TM_LEPP_TARGET);
    if (e->options->algorithm == TM_LEPP_DELAUNAY) {
        e->report->not_delaunay_after = tm_tet_mesh_not_delaunay(e->mesh);
        e->report->delaunay = e->delaunay.cavity.report;
    }
}

static void free_sweeper(tm_lepp_sweeper *s)
{
    tm_features_free(&s->features);
    tm_ball_free(&s->ball);
    tm_tet_marks_free(&s->marks);
    tm_star_free(&s->star);
    tm_replacement_table_free(&s->table);
    free(s->tet_at);
    tm_tet_marks_free(&s->seen);
}

static void free_engine(tm_lepp_engine *e)
{
    free(e->mark);
    free(e->quality);
    tm_star_free(&e->around);
    tm_edge_map_free(&e->refused);
    for (size_t i = 0; i < e->path_room; i++)
        tm_star_free(&e->path[i].star);
    free(e->path);
    tm_tet_marks_free(&e->graph);
    free(e->target);
    free(e->created);
    tm_delaunay_free(&e->delaunay);
    free_sweeper(&e->sweeper);
}

tm_status tm_lepp_improve(tm_tet_mesh *mesh, const tm_lepp_options *options,
                          tm_lepp_report *report, tm_error *error)
{
    *report = (tm_lepp_report){.tets_before = mesh->tets};
    tm_lepp_engine e = {
        .mesh = mesh,
        .options = options,
        .report = report,
        .error = error,
        .bad_below = tm_bad_sine2(options->angle),
        .is_input = true,
        .gain = tm_gain_of(options->measure, fmax(options->factor, 1 + TM_LEPP_GAIN)),
        .most_tets = tm_tet_mesh_most(mesh, options->max_growth)};
    tm_status status = start(&e);
    if (status == TM_OK)
        status = run(&e);
    if (status == TM_OK)
        finish(&e);
    free_engine(&e);
    return status;
}
