/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of a large mesh are improved each as a mesh of its own: by several threads, and
 * faster by one, as a part's memory is near. What touches a face between parts waits for
 * the next round, which cuts elsewhere; what waits still in the last one is improved up
 * to these faces. */
#include "improve_parts.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../operation/features.h"
#include "../mesh_set.h"
#include "../parts/parts.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

/* Of the nodes of a tetrahedron so many are due where it is. All four would leave out
 * what a bad one is improved with, one alone would try those again that were tried. */
enum { MOST_OF_FOUR = 3 };

typedef struct one_part {
    tm_improve_report report;
    tm_status status;
    tm_error error;
} one_part;

typedef struct round_of_parts {
    const tm_improve_round_of *what;
    const tm_tet_parts *parts;
    one_part *one;    /* [parts] */
    pthread_t caller; /* that is told of progress */
    tm_progress_at at;
    atomic_size_t done;
} round_of_parts;

/* Gives a part its set; false where that is empty, or memory is out. */
static bool add_set(const round_of_parts *r, size_t p, one_part *one)
{
    tm_tet_part *part = &r->parts->part[p];
    const bool *between =
        r->what->round + 1 < TM_IMPROVE_ROUNDS ? r->what->between : NULL;
    bool *in_set = tm_new(part->mesh.slots, sizeof *in_set), any = false;
    if (!in_set) {
        one->status = tm_fail_memory(&one->error);
        return false;
    }
    for (size_t t = 0; t < part->mesh.slots; t++) {
        int due = 0;
        bool is_between = false;
        for (int i = 0; i < 4; i++) {
            due += r->what->due[part->node[part->mesh.tet[t][i]]];
            is_between |= between && between[part->node[part->mesh.tet[t][i]]];
        }
        in_set[t] = due >= MOST_OF_FOUR && !is_between;
        any |= in_set[t];
    }
    if (any)
        one->status = tm_tet_mesh_add_set(&part->mesh, in_set, &one->error);
    free(in_set);
    return any && one->status == TM_OK;
}

static void tell(round_of_parts *r)
{
    if (!pthread_equal(pthread_self(), r->caller))
        return;
    r->at.done = atomic_load(&r->done);
    tm_progress_tell(r->what->options.progress, &r->at);
}

static void improve_part(void *context, size_t p)
{
    round_of_parts *r = context;
    one_part *one = &r->one[p];
    tm_tet_mesh *mesh = &r->parts->part[p].mesh;
    tm_improve_options options = r->what->options;
    options.progress = NULL;
    tell(r);
    one->status = tm_tet_part_take(r->parts, p, r->what->mesh, &one->error);
    if (one->status == TM_OK && add_set(r, p, one))
        one->status = r->what->engine(mesh, &options, &one->report, &one->error);
    tm_tet_mesh_remove_set(mesh);
    atomic_fetch_add(&r->done, 1);
}

void tm_improve_report_add(tm_improve_report *to, const tm_improve_report *more)
{
    to->passes = more->passes > to->passes ? more->passes : to->passes;
    to->kicks += more->kicks;
    to->done.edge_splits += more->done.edge_splits;
    to->done.swallowed += more->done.swallowed;
    for (int op = 0; op < TM_IMPROVE_OPS; op++) {
        to->done.op[op] += more->done.op[op];
        to->tried[op] += more->tried[op];
    }
}

bool tm_improve_find_due(const tm_tet_mesh *mesh, bool **due, const bool *between,
                         size_t nodes)
{
    bool *now = calloc(mesh->nodes + 1, sizeof *now);
    for (uint32_t t = 0; t < mesh->slots && now; t++) {
        const uint32_t *n = mesh->tet[t];
        bool was_due = true, is_between = false;
        for (int i = 0; i < 4; i++) {
            was_due &= n[i] >= nodes || (*due)[n[i]];
            is_between |= n[i] < nodes && between[n[i]];
        }
        for (int i = 0; i < 4 && was_due && is_between; i++)
            now[n[i]] = true;
    }
    free(*due);
    *due = now;
    return now;
}

tm_status tm_improve_round(const tm_improve_round_of *what, const tm_tet_parts *parts,
                           tm_improve_report *report, tm_error *error)
{
    const unsigned threads = what->options.threads > 1 ? what->options.threads : 1;
    round_of_parts r = {
        .what = what,
        .parts = parts,
        .one = calloc(parts->count + 1, sizeof *r.one),
        .caller = pthread_self(),
        .at = {.what = "improving", .pass = what->round + 1, .of = parts->count}};
    tm_status status = r.one ? TM_OK : tm_fail_memory(error);
    atomic_init(&r.done, 0);
    if (r.one)
        tm_parallel(threads, parts->count, improve_part, &r);
    for (size_t p = 0; status == TM_OK && p < parts->count; p++) {
        if (r.one[p].status != TM_OK)
            status = tm_fail_as(error, &r.one[p].error);
        tm_improve_report_add(report, &r.one[p].report);
    }
    free(r.one);
    return status;
}

void tm_improve_limit_growth(tm_improve_options *options, size_t most, size_t tets)
{
    if (options->max_growth > 0)
        options->max_growth = fmax(1, (double)most / (double)tets);
}

/* One round: improves what is due, and finds what is due then. */
static tm_status improve_round(tm_improve_round_of *what, tm_tet_mesh *mesh, size_t size,
                               bool **due, tm_improve_report *report, tm_error *error)
{
    const unsigned threads = what->options.threads > 1 ? what->options.threads : 1;
    const size_t nodes = mesh->nodes;
    tm_tet_parts parts;
    tm_status status = tm_tet_parts_cut(&parts, mesh, size, what->round, error);
    bool *between = tm_new(nodes, sizeof *between);
    if (status == TM_OK && !between)
        status = tm_fail_memory(error);
    if (status == TM_OK) {
        tm_tet_parts_between(&parts, mesh, between);
        what->due = *due;
        what->between = between;
        status = tm_improve_round(what, &parts, report, error);
    }
    if (status == TM_OK)
        status = tm_tet_parts_join(&parts, mesh, threads, error);
    if (status == TM_OK && !tm_improve_find_due(mesh, due, between, nodes))
        status = tm_fail_memory(error);
    tm_tet_parts_free(&parts);
    free(between);
    return status;
}

/* All rounds. */
static tm_status improve_rounds(tm_tet_mesh *mesh, const tm_improve_options *options,
                                size_t size, tm_improve_engine *engine,
                                tm_improve_report *report, tm_error *error)
{
    const size_t most = tm_tet_mesh_most(mesh, options->max_growth);
    bool *due = tm_new(mesh->nodes, sizeof *due);
    tm_status status = due ? TM_OK : tm_fail_memory(error);
    for (size_t v = 0; v < mesh->nodes && due; v++)
        due[v] = true;
    for (unsigned round = 0; round < TM_IMPROVE_ROUNDS && status == TM_OK; round++) {
        tm_improve_round_of what = {
            .mesh = mesh, .options = *options, .engine = engine, .round = round};
        tm_improve_limit_growth(&what.options, most, mesh->tets);
        status = improve_round(&what, mesh, size, &due, report, error);
    }
    free(due);
    return status;
}

/* How many nodes may move, and in how many dimensions. */
static tm_status count_free_nodes(const tm_tet_mesh *mesh,
                                  const tm_improve_options *options,
                                  tm_improve_report *report, tm_error *error)
{
    tm_features features;
    tm_tet_marks marks = {0};
    bool *used = calloc(mesh->nodes + 1, sizeof *used);
    tm_status status =
        tm_features_find(&features, mesh, &options->surface, &marks, error);
    if (status == TM_OK && !used)
        status = tm_fail_memory(error);
    for (uint32_t t = 0; status == TM_OK && t < mesh->slots; t++)
        for (int i = 0; i < 4; i++)
            used[mesh->tet[t][i]] = true;
    for (size_t v = 0; status == TM_OK && v < mesh->nodes; v++)
        report->nodes_free[features.dimension[v]] += used[v];
    free(used);
    tm_tet_marks_free(&marks);
    tm_features_free(&features);
    return status;
}

size_t tm_improve_count_bad_angles(const tm_tet_mesh *mesh, double degrees)
{
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    const double limit = tm_bad_sine2(degrees);
    size_t bad = 0;
    for (uint32_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        bad += tm_tet_lives(mesh, t) &&
               tm_tet_sine2(x[n[0]], x[n[1]], x[n[2]], x[n[3]]) < limit;
    }
    return bad;
}

bool tm_improve_is_worse(const tm_improve_report *report, size_t tets)
{
    const double before = (double)report->bad_before / (double)report->tets_before;
    return report->bad_after > report->bad_before ||
           (double)report->bad_after > before * (double)tets;
}

tm_status tm_improve_parts(tm_tet_mesh *mesh, const tm_improve_options *options,
                           size_t size, tm_improve_engine *engine,
                           tm_improve_report *report, tm_error *error)
{
    tm_tet_mesh input = {0};
    *report = (tm_improve_report){.tets_before = mesh->tets};
    report->bad_before = tm_improve_count_bad_angles(mesh, options->angle);
    tm_status status = count_free_nodes(mesh, options, report, error);
    if (status == TM_OK)
        status = tm_tet_mesh_copy(&input, mesh, error);
    const tm_improve_report nothing = *report;
    if (status == TM_OK)
        status = improve_rounds(mesh, options, size, engine, report, error);
    report->bad_after = tm_improve_count_bad_angles(mesh, options->angle);
    if (status == TM_OK && tm_improve_is_worse(report, mesh->tets)) {
        status = tm_tet_mesh_copy(mesh, &input, error);
        *report = nothing;
        report->bad_after = report->bad_before;
    }
    tm_tet_mesh_free(&input);
    return status;
}
