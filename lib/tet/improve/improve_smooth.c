/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improver's smoothing: a node goes to the mean of its neighbours or, if that is no
 * gain, from where it is to where the worst tetrahedron around it is best. */
#include "improve_engine.h"

#include "../../geom/vector.h"

#include <string.h>

/* Good enough is a little better than the target, so that rounding and the next
 * operation do not undo it. */
static const double beyond_target = 1.1;

/* The mean of the neighbours, as far as the node may go there. */
static void go_to_centre(const tm_cavity_boundary *boundary, const tm_freedom *freedom,
                         double p[3])
{
    double centre[3], way[3];
    tm_cavity_boundary_centre(boundary, centre);
    tm_subtract(way, centre, p);
    tm_freedom_restrict(freedom, way);
    for (int x = 0; x < 3; x++)
        p[x] += way[x];
}

/* A place that costs less than `most`; false where none is found. */
static bool find_place(const tm_improver *m, const tm_cavity_boundary *boundary,
                       const tm_freedom *freedom, double least, double most,
                       double place[3])
{
    enum { STEPS = 2 };
    for (int way = 0; way < 2; way++) {
        memcpy(place, m->mesh->xyz[m->ball.node], 3 * sizeof *place);
        if (way == 0)
            go_to_centre(boundary, freedom, place);
        else
            tm_cavity_boundary_climb(boundary, m->cost.measure, freedom,
                                     m->cost.target * beyond_target, STEPS, place);
        if (tm_cavity_boundary_cost(boundary, &m->cost, place, least, most) < most &&
            tm_cavity_boundary_sees(boundary, place))
            return true;
    }
    return false;
}

static bool smooth_node(tm_improver *m, uint32_t t, uint32_t v)
{
    if (m->features.dimension[v] == 0 || m->smoothed[v] > m->changed[v])
        return false;
    m->smoothed[v] = m->change + 1;
    m->report->tried[TM_OP_SMOOTHING]++;
    if (!tm_ball_around(m->mesh, t, v, &m->marks, &m->ball))
        return tm_improve_no_memory(m);
    if (!tm_improve_reserve(m, 0, 1))
        return false;
    tm_freedom freedom = tm_features_freedom(&m->features, m->mesh, &m->ball);
    tm_cavity_boundary boundary = tm_boundary_of_ball(&m->ball, m->mesh);
    double least, place[3];
    double old = tm_improve_old_cost(m, m->ball.tet, m->ball.size, &least);
    if (freedom.dimension == 0 ||
        !find_place(m, &boundary, &freedom, least, old - TM_IMPROVE_GAIN, place))
        return false;
    tm_ball_move_node(m->mesh, &m->ball, place);
    tm_improve_note(m, m->ball.tet, m->ball.size);
    m->report->done.op[TM_OP_SMOOTHING]++;
    return true;
}

bool tm_improve_smooth(tm_improver *m, uint32_t t)
{
    bool any = false;
    for (int i = 0; i < 4 && m->status == TM_OK && m->quality[t] < m->cost.target; i++)
        any |= smooth_node(m, t, m->mesh->tet[t][i]);
    return any;
}
