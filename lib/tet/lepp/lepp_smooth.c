/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Smart Laplacian smoothing between passes of selective. */
#include "lepp_engine.h"

#include "../../base/array.h"

/* A mean is taken of differences to the node, so that it is exactly in a plane across an
 * axis. */
typedef struct mean {
    const tm_tet_mesh *mesh;
    const double *from;
    double sum[3];
    size_t count;
} mean;

static void add_to_mean(tm_lepp_sweeper *s, mean *m, uint32_t v)
{
    if (!tm_tet_mark(&s->seen, v))
        return;
    for (int k = 0; k < 3; k++)
        m->sum[k] += m->mesh->xyz[v][k] - m->from[k];
    m->count++;
}

/* The mean of the neighbours of the ball's node: of all inside, of those in its facet, of
 * the two along its edge. */
static void find_mean(tm_lepp_engine *e, int dimension, double p[3])
{
    tm_lepp_sweeper *s = &e->sweeper;
    mean m = {.mesh = e->mesh, .from = e->mesh->xyz[s->ball.node]};
    tm_tet_mark(&s->seen, s->ball.node);
    if (dimension == 1) {
        add_to_mean(s, &m, s->features.line[s->ball.node][0]);
        add_to_mean(s, &m, s->features.line[s->ball.node][1]);
    } else if (dimension == 2) {
        for (size_t k = 0; k < s->ball.constrained_count; k++)
            for (int i = 0; i < 3; i++)
                add_to_mean(s, &m, e->mesh->face[s->ball.constrained[k]].node[i]);
    } else {
        for (size_t k = 0; k < s->ball.size; k++)
            for (int i = 0; i < 3; i++)
                add_to_mean(s, &m, s->ball.face[k][i]);
    }
    for (int k = 0; k < 3; k++)
        p[k] = m.from[k] + m.sum[k] / (double)m.count;
}

/* Whether the worst tetrahedron of the ball is better with its node at p. What is known
 * of needles may be rounded otherwise than what is measured now, and a node that stays
 * where it is would gain, for ever: so where it seems better, both places are measured
 * alike. */
static bool is_better(const tm_lepp_engine *e, const tm_cavity_boundary *boundary,
                      const double p[3])
{
    const tm_ball *ball = &e->sweeper.ball;
    const double *here = e->mesh->xyz[ball->node];
    tm_tet_measure measure = e->options->measure;
    double worst = HUGE_VAL;
    for (size_t k = 0; k < ball->size; k++)
        worst = fmin(worst, e->quality[ball->tet[k]]);
    double least = tm_tet_measure_times(measure, worst, 1 + TM_LEPP_GAIN);
    const double there = tm_cavity_boundary_quality(boundary, measure, p, least);
    if (!(there > worst))
        return false;
    worst = tm_cavity_boundary_quality(boundary, measure, here, 0);
    if (!(there > tm_tet_measure_times(measure, worst, 1 + TM_LEPP_GAIN)))
        return false;
    for (size_t k = 0; k < boundary->count; k++) {
        const uint32_t *f = boundary->face[k];
        if (!tm_angles_are_within(&e->sweeper.limits, boundary->xyz[f[0]],
                                  boundary->xyz[f[1]], boundary->xyz[f[2]], p))
            return false;
    }
    return true;
}

static tm_status smooth_node(tm_lepp_engine *e, uint32_t v, size_t sweep)
{
    tm_lepp_sweep_report *report = &e->report->smooth;
    tm_lepp_sweeper *s = &e->sweeper;
    int dimension = s->features.dimension[v];
    double p[3];
    if (s->tet_at[v] == TM_NONE || dimension == 0)
        return TM_OK;
    if (!tm_ball_around(e->mesh, s->tet_at[v], v, &s->marks, &s->ball) ||
        !tm_tet_marks_clear(&s->seen, e->mesh->nodes))
        return tm_fail_memory(e->error);
    report->tried++;
    find_mean(e, dimension, p);
    tm_cavity_boundary boundary = tm_boundary_of_ball(&s->ball, e->mesh);
    if (!tm_cavity_boundary_sees(&boundary, p)) {
        report->invalid++;
        return TM_OK;
    }
    if (!is_better(e, &boundary, p))
        return TM_OK;
    tm_status status = tm_tet_mesh_reserve(e->mesh, 1, 0, 0, 0, e->error);
    if (status != TM_OK)
        return status;
    tm_ball_move_node(e->mesh, &s->ball, p);
    report->done[sweep]++;
    report->on_surface += dimension < 3;
    return tm_lepp_note(e, s->ball.tet, s->ball.size) &&
                   tm_lepp_unblock(e, s->ball.tet, s->ball.size)
               ? TM_OK
               : tm_fail_memory(e->error);
}

tm_status tm_lepp_smooth(tm_lepp_engine *e)
{
    tm_lepp_sweeper *s = &e->sweeper;
    size_t sweep = tm_lepp_bin(e->report->smooth.sweeps++, TM_LEPP_SWEEPS);
    tm_features_free(&s->features);
    tm_status status = tm_features_find(&s->features, e->mesh, NULL, &s->marks, e->error);
    if (status == TM_OK && !tm_lepp_place_nodes(e))
        status = tm_fail_memory(e->error);
    tm_progress_at at = {
        .what = "smoothing", .pass = e->report->smooth.sweeps, .of = e->mesh->nodes};
    for (uint32_t v = 0; v < e->mesh->nodes && status == TM_OK; v++) {
        tm_progress_step(e->options->progress, &at, v);
        status = smooth_node(e, v, sweep);
    }
    e->operations++; /* stars that paths have collected may have changed */
    return status;
}
