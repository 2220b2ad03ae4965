/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contraction.h"

#include "../../geom/predicates.h"

/* Whether tetrahedron t, which has both nodes, may go: the constrained face opposite b,
 * if there is one, takes the place of the face opposite a. */
static bool may_go(const tm_tet_mesh *mesh, uint32_t t, uint32_t a, uint32_t b,
                   bool surface_moves)
{
    if (!(mesh->neighbour[t][tm_tet_corner(mesh, t, b)] & TM_FACE_BIT))
        return true;
    /* Else it would be flat with b. */
    return surface_moves &&
           !(mesh->neighbour[t][tm_tet_corner(mesh, t, a)] & TM_FACE_BIT);
}

double tm_contraction_cost(const tm_tet_mesh *mesh, const tm_ball *ball, uint32_t b,
                           bool surface_moves, const tm_cost *cost, double least,
                           double most, size_t *gone)
{
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    double sum = 0;
    *gone = 0;
    for (size_t i = 0; i < ball->size; i++) {
        const uint32_t *f = ball->face[i];
        if (tm_face_has_node(f, b)) {
            if (!may_go(mesh, ball->tet[i], ball->node, b, surface_moves))
                return HUGE_VAL;
            ++*gone;
            continue;
        }
        double quality = tm_cost_quality(cost, least, x[f[0]], x[f[1]], x[f[2]], x[b]);
        if (quality < least)
            return HUGE_VAL;
        sum += tm_cost_of(cost, quality);
        if (!(sum < most))
            return HUGE_VAL;
    }
    for (size_t i = 0; i < ball->size; i++) {
        const uint32_t *f = ball->face[i];
        if (!tm_face_has_node(f, b) && tm_orient3d(x[f[0]], x[f[1]], x[f[2]], x[b]) <= 0)
            return HUGE_VAL;
    }
    return sum;
}

/* A constrained face of the ball: renamed, or forgotten where it has both nodes. */
static void move_face(tm_tet_mesh *mesh, uint32_t f, uint32_t a, uint32_t b)
{
    tm_constrained_face *face = &mesh->face[f];
    if (tm_face_has_node(face->node, a) && tm_face_has_node(face->node, b)) {
        face->side[0] = face->side[1] = TM_NONE;
        face->listed = false;
        return;
    }
    for (int i = 0; i < 3; i++)
        if (face->node[i] == a)
            face->node[i] = b;
}

/* Takes tetrahedron t, which has both nodes, out: what lies across its faces opposite a
 * and b meets. Returns what was across the one opposite a. */
static uint32_t collapse(tm_tet_mesh *mesh, uint32_t t, uint32_t a, uint32_t b)
{
    uint32_t beside_b = 4 * t + tm_tet_corner(mesh, t, a);
    uint32_t beside_a = 4 * t + tm_tet_corner(mesh, t, b);
    uint32_t with_b = mesh->neighbour[t][beside_b % 4];
    uint32_t with_a = mesh->neighbour[t][beside_a % 4];
    if (with_a & TM_FACE_BIT)
        tm_tet_replace_half(mesh, with_b, beside_a, with_a);
    else
        tm_tet_replace_half(mesh, with_a, beside_b, with_b);
    tm_tet_mesh_delete_tet(mesh, t);
    return with_b;
}

static void move_edge(tm_tet_mesh *mesh, uint32_t a, uint32_t x, uint32_t b)
{
    tm_marked_edge *edge = tm_tet_mesh_edge(mesh, a, x);
    if (!edge)
        return;
    uint32_t e = (uint32_t)(edge - mesh->edge);
    tm_edge_map_remove(&mesh->edge_of, a, x);
    if (x == b || tm_tet_mesh_edge(mesh, b, x)) {
        edge->gone = true;
        return;
    }
    edge->node[edge->node[1] == a] = b;
    tm_edge_map_put(&mesh->edge_of, b, x, e);
}

size_t tm_contract(tm_tet_mesh *mesh, const tm_ball *ball, uint32_t b, uint32_t *created)
{
    uint32_t a = ball->node;
    size_t made = 0;
    for (size_t i = 0; i < ball->size; i++)
        for (int k = 0; k < 3 && mesh->edge_of.count > 0; k++)
            move_edge(mesh, a, ball->face[i][k], b);
    for (size_t k = 0; k < ball->constrained_count; k++)
        move_face(mesh, ball->constrained[k], a, b);
    for (size_t i = 0; i < ball->size; i++) {
        uint32_t t = ball->tet[i];
        if (tm_face_has_node(ball->face[i], b)) {
            bool peeled = mesh->neighbour[t][tm_tet_corner(mesh, t, b)] & TM_FACE_BIT;
            uint32_t beyond = collapse(mesh, t, a, b);
            if (peeled)
                created[made++] = beyond / 4;
        } else {
            mesh->tet[t][tm_tet_corner(mesh, t, a)] = b;
            created[made++] = t;
        }
    }
    return made;
}
