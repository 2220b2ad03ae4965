/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kicks of one bad tetrahedron after the other: each is kept or undone by itself, so that
 * what one gains is not lost by another, and costs what is around it only. */
#include "improve_engine.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

/* Rounds differ: the price of a tetrahedron, and by how many degrees what is nearly bad
 * is worked on too; only what is below the first of them is a kick's beginning. */
enum { PRICES = 3, WIDTHS = 3 };
static const double kick_price[PRICES] = {-1, -2, -4}, wider_by = 1.5;

/* Only where a part of the tries gains enough the others follow. */
enum { TRIAL = 2 };

/* See tm_improver.work. */
enum { WORK_OF_TRY = 3 };

/* A kick ends after so many passes, and when so many tetrahedra have changed. */
enum { PASSES_MAX = 4, CHANGES_MAX = 1000 };

/* What the tetrahedra of the part are in one of the two meshes. */
typedef struct {
    size_t tets, bad, bad_angles;
    double cost;
} tally;

static tally tally_of(const tm_improver *m, const tm_tet_mesh *mesh)
{
    tally sum = {0};
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    double limit = tm_bad_sine2(m->options->angle);
    for (size_t k = 0; k < m->changes.tets; k++) {
        uint32_t t = m->changes.tet[k];
        if (t >= mesh->slots || !tm_tet_lives(mesh, t))
            continue;
        const uint32_t *n = mesh->tet[t];
        double sine2 = tm_tet_sine2(x[n[0]], x[n[1]], x[n[2]], x[n[3]]);
        double quality =
            m->cost.measure == TM_MEASURE_DIHEDRAL
                ? sine2
                : tm_tet_measure_of(m->cost.measure, x[n[0]], x[n[1]], x[n[2]], x[n[3]]);
        sum.tets++;
        sum.bad += quality < m->cost.target;
        sum.bad_angles += sine2 < limit;
        sum.cost += tm_cost_of(&m->cost, quality);
    }
    return sum;
}

static bool copy_features(const tm_improver *m, tm_features *to, const tm_features *from,
                          size_t nodes)
{
    if (to->room < from->room && !tm_features_reserve(to, from->room, 0))
        return false;
    for (size_t k = 0; k < m->changes.nodes; k++)
        if (m->changes.node[k] < nodes)
            tm_features_copy_node(to, from, m->changes.node[k]);
    return true;
}

/* Makes what was kept the same as the mesh, or the mesh the same as what was kept. */
static void copy_changes(tm_improver *m, tm_tet_mesh *to, tm_features *to_features,
                         const tm_tet_mesh *from, const tm_features *from_features)
{
    m->status = tm_mesh_part_copy(&m->changes, to, from, m->error);
    if (m->status == TM_OK && !copy_features(m, to_features, from_features, from->nodes))
        tm_improve_no_memory(m);
}

static void keep_changes(tm_improver *m)
{
    tm_improve_state *kept = &m->earlier;
    kept->done = m->report->done;
    copy_changes(m, &kept->mesh, &kept->features, m->mesh, &m->features);
}

static void undo_changes(tm_improver *m)
{
    const tm_improve_state *kept = &m->earlier;
    m->report->done = kept->done;
    tm_envelope_undo(&m->features.envelope);
    copy_changes(m, m->mesh, &m->features, &kept->mesh, &kept->features);
    if (m->status != TM_OK)
        return;
    m->recording = false;
    for (size_t k = 0; k < m->changes.tets; k++) {
        uint32_t t = m->changes.tet[k];
        if (t < m->mesh->slots && tm_tet_lives(m->mesh, t))
            tm_improve_note(m, &t, 1);
    }
}

/* What is good for the mesh where it has changed. */
static void settle_changes(tm_improver *m)
{
    for (int pass = 0; pass < PASSES_MAX && m->status == TM_OK; pass++) {
        size_t count = m->changes.tets;
        bool any = false;
        for (size_t k = 0; k < count && m->status == TM_OK; k++) {
            uint32_t t = m->changes.tet[k];
            if (!tm_improve_is_bad(m, t) || !tm_improve_is_due(m, t))
                continue;
            if (m->changes.tets > CHANGES_MAX)
                return;
            if (tm_improve_try(m, t, TM_PHASE_ALL))
                any = true;
            else
                m->tried[t] = m->change + 1;
        }
        if (!any)
            return;
    }
}

/* Whether what has changed is better than it was. */
static bool is_better(const tm_improver *m, const tally *was, const tally *is)
{
    const tm_improve_state *kept = &m->earlier;
    if (m->cost.measure != TM_MEASURE_DIHEDRAL && is->bad_angles > was->bad_angles)
        return false;
    double before = tm_improve_badness(m, kept->mesh.tets, kept->bad);
    double now = tm_improve_badness(m, m->mesh->tets, kept->bad + is->bad - was->bad);
    return now < before || (now <= before && is->cost < was->cost - TM_IMPROVE_GAIN);
}

/* The bad tetrahedra at the nodes of t, which is one of them. */
static bool find_cluster(tm_improver *m, uint32_t t)
{
    m->cluster_size = 0;
    if (!tm_append(&m->cluster, &m->cluster_size, &m->cluster_room, t))
        return tm_improve_no_memory(m);
    for (int i = 0; i < 4; i++) {
        if (!tm_ball_around(m->mesh, t, m->mesh->tet[t][i], &m->marks, &m->ball))
            return tm_improve_no_memory(m);
        for (size_t k = 0; k < m->ball.size; k++)
            if (tm_improve_is_bad(m, m->ball.tet[k]) &&
                !tm_append(&m->cluster, &m->cluster_size, &m->cluster_room,
                           m->ball.tet[k]))
                return tm_improve_no_memory(m);
    }
    return true;
}

/* The kick itself; whether anything has changed. */
static bool kick_cluster(tm_improver *m, uint32_t t)
{
    bool any = false;
    double target = m->cost.target;
    unsigned width = m->fails / PRICES % WIDTHS;
    m->price = kick_price[m->fails % PRICES];
    m->cost.target = tm_improve_target(m, m->degrees + wider_by * width);
    if (find_cluster(m, t))
        for (size_t k = 0; k < m->cluster_size && m->status == TM_OK; k++)
            if (tm_improve_is_bad(m, m->cluster[k]))
                any |= tm_improve_try(m, m->cluster[k], TM_PHASE_ALL);
    m->price = 0;
    m->cost.target = target;
    return any;
}

/* Keeps what a kick at t has changed, or undoes it. */
static void judge(tm_improver *m, uint32_t t)
{
    tally was, is;
    if (!tm_mesh_part_close(&m->changes, m->mesh, &m->earlier.mesh, &m->marks)) {
        tm_improve_no_memory(m);
        return;
    }
    was = tally_of(m, &m->earlier.mesh);
    is = tally_of(m, m->mesh);
    if (!is_better(m, &was, &is)) {
        undo_changes(m);
        m->stubborn[t]++;
        return;
    }
    m->earlier.bad += is.bad;
    m->earlier.bad -= was.bad;
    keep_changes(m);
    for (size_t k = 0; k < m->changes.tets; k++)
        m->stubborn[m->changes.tet[k]] = 0;
}

static void kick_one(tm_improver *m, uint32_t t)
{
    tm_mesh_part_clear(&m->changes);
    m->recording = true;
    tm_envelope_record(&m->features.envelope, true);
    bool done = kick_cluster(m, t);
    if (done)
        settle_changes(m);
    m->recording = false;
    if (m->status == TM_OK && done)
        judge(m, t);
    else
        m->stubborn[t]++;
    tm_envelope_record(&m->features.envelope, false);
}

/* Kicks all bad ones; those that did not gain anything, the more rarely the more often
 * that was so. */
static void run_round(tm_improver *m, size_t tries_max)
{
    if (!tm_improve_find_targets(m, true))
        return;
    tm_improve_tell_pass(m);
    for (size_t k = 0; k < m->targets && m->status == TM_OK; k++) {
        uint32_t t = m->target[k];
        tm_progress_step(m->options->progress, &m->at, k);
        if (m->tries > tries_max)
            return;
        if (tm_improve_is_bad(m, t) && m->fails % (m->stubborn[t] + 1) == 0)
            kick_one(m, t);
    }
    m->report->kicks++;
    m->report->passes++;
}

void tm_improve_kick_locally(tm_improver *m, double enough, size_t tries)
{
    size_t before_all = m->tries;
    size_t tries_max = m->tries + tries, trial = m->tries + tries / TRIAL;
    unsigned poor = 0; /* rounds, one after the other */
    tm_improve_set_price(m, 0);
    memset(m->stubborn, 0, m->mesh->slots * sizeof *m->stubborn);
    tm_improve_snapshot(m, &m->earlier, m->best.bad, m->best.badness);
    for (m->fails = 1; poor < PRICES && m->tries <= trial; m->fails++) {
        double before = m->earlier.badness;
        if (m->earlier.bad == 0 || tm_improve_is_over(m))
            break;
        run_round(m, trial);
        m->earlier.badness = tm_improve_badness(m, m->mesh->tets, m->earlier.bad);
        if (m->earlier.badness < (1 - enough) * m->best.badness)
            trial = tries_max;
        poor = m->earlier.badness < (1 - enough) * before ? 0 : poor + 1;
    }
    m->work += WORK_OF_TRY * (m->tries - before_all);
    m->fails = 0;
}
