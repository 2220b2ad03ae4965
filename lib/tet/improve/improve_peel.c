/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improver's peeling: a flat tetrahedron under the surface is best outside of it. */
#include "../operation/peel.h"
#include "improve_engine.h"

static bool peel(tm_improver *m, uint32_t t, uint32_t i)
{
    uint32_t face[3], beyond[3], apex = m->mesh->tet[t][i];
    m->report->tried[TM_OP_PEELING]++;
    m->status = tm_tet_mesh_reserve(m->mesh, 0, 0, 2, 0, m->error);
    if (m->status != TM_OK || !tm_improve_reserve(m, 0, 0) ||
        !tm_improve_allows_peel(m, t, i))
        return false;
    tm_peel_face(m->mesh, t, i, face, beyond);
    tm_features_classify_node(&m->features, apex, TM_EDGE_IN_FACET, 0, 0);
    tm_improve_note(m, beyond, 3);
    tm_improve_follow_surface(m);
    m->report->done.op[TM_OP_PEELING]++;
    return true;
}

bool tm_improve_peel(tm_improver *m, uint32_t t)
{
    bool is_gain = tm_cost_of(&m->cost, m->quality[t]) + m->price > TM_IMPROVE_GAIN;
    for (uint32_t i = 0; i < 4 && m->features.may_move && is_gain; i++)
        if (tm_peel_face_is_possible(m->mesh, t, i) &&
            m->features.dimension[m->mesh->tet[t][i]] == 3)
            return peel(m, t, i);
    return false;
}
