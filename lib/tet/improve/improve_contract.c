/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improver's contractions. */
#include "../operation/contraction.h"
#include "improve_engine.h"

/* Whether b is in a constrained face at the node of the ball. */
static bool is_in_facet(const tm_tet_mesh *mesh, const tm_ball *ball, uint32_t b)
{
    for (size_t k = 0; k < ball->constrained_count; k++) {
        if (tm_face_has_node(mesh->face[ball->constrained[k]].node, b))
            return true;
    }
    return false;
}

/* Whether the node of the ball may go to b with the surface as it is. */
static bool may_go_to(const tm_improver *m, uint32_t b)
{
    const uint32_t *line = m->features.line[m->ball.node];
    int dimension = m->features.dimension[m->ball.node];
    if (dimension == 1)
        return line[0] == b || line[1] == b;
    return dimension == 3 || is_in_facet(m->mesh, &m->ball, b);
}

/* Whether a tetrahedron of the ball came without volume: there it may overlap others. */
static bool has_flat(const tm_improver *m)
{
    for (size_t k = 0; k < m->ball.size && m->mesh->flat > 0; k++)
        if (m->quality[m->ball.tet[k]] == 0)
            return true;
    return false;
}

/* Whether the node of the ball is in a surface that may move. */
static bool moves_surface(const tm_improver *m)
{
    return m->features.may_move && m->features.dimension[m->ball.node] < 3;
}

/* The neighbour to which the node of the ball goes at the greatest gain; TM_NONE where
 * there is none. */
static uint32_t best_neighbour(tm_improver *m)
{
    const tm_ball *ball = &m->ball;
    uint32_t best = TM_NONE;
    double least, gain = TM_IMPROVE_GAIN;
    double old = tm_improve_old_cost(m, ball->tet, ball->size, &least);
    for (size_t k = 0; k < ball->size; k++)
        for (int i = 0; i < 3; i++) {
            size_t gone;
            uint32_t b = ball->face[k][i];
            if (!tm_tet_mark(&m->seen, b) || !may_go_to(m, b))
                continue;
            double most = old - gain + fmax(m->price, 0) * (double)ball->size;
            double cost = tm_contraction_cost(m->mesh, ball, b, moves_surface(m),
                                              &m->cost, least, most, &gone);
            double gained = old - cost - tm_improve_growth_cost(m, -(ptrdiff_t)gone);
            if (gained > gain &&
                (!moves_surface(m) || tm_improve_allows_contraction(m, b))) {
                gain = gained;
                best = b;
            }
        }
    return best;
}

bool tm_improve_contract_node(tm_improver *m, uint32_t t, uint32_t a)
{
    if (m->features.dimension[a] == 0 || m->contracted[a] > m->changed[a])
        return false;
    m->contracted[a] = m->change + 1;
    m->report->tried[TM_OP_CONTRACTION]++;
    if (!tm_ball_around(m->mesh, t, a, &m->marks, &m->ball) ||
        !tm_tet_marks_clear(&m->seen, m->mesh->nodes))
        return tm_improve_no_memory(m);
    if (!tm_improve_reserve(m, m->ball.size, 0) || has_flat(m))
        return false;
    uint32_t b = best_neighbour(m);
    bool moves = moves_surface(m);
    if (b == TM_NONE || (moves && !tm_improve_allows_contraction(m, b)))
        return false;
    size_t made = tm_contract(m->mesh, &m->ball, b, m->created);
    tm_improve_note(m, m->created, made);
    if (m->features.dimension[a] == 1)
        tm_features_join(&m->features, a, b);
    if (moves)
        tm_improve_follow_surface(m);
    tm_tet_mesh_delete_node(m->mesh, a);
    m->report->done.op[TM_OP_CONTRACTION]++;
    return true;
}

bool tm_improve_contract(tm_improver *m, uint32_t t)
{
    for (int i = 0; i < 4 && m->status == TM_OK; i++)
        if (tm_improve_contract_node(m, t, m->mesh->tet[t][i]))
            return true;
    return false;
}
