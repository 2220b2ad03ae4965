/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ball.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

void tm_ball_free(tm_ball *ball)
{
    free(ball->tet);
    free(ball->face);
    free(ball->constrained);
    *ball = (tm_ball){0};
}

static bool reserve(tm_ball *ball, size_t needed)
{
    if (needed <= ball->room)
        return true;
    size_t room = ball->room, face_room = ball->room;
    uint32_t *tet = tm_grow(ball->tet, &room, needed, sizeof *tet);
    ball->tet = tet ? tet : ball->tet;
    uint32_t(*face)[3] = tm_grow(ball->face, &face_room, needed, sizeof *face);
    ball->face = face ? face : ball->face;
    if (tet && face)
        ball->room = room;
    return tet && face;
}

/* Appends tetrahedron t, for which there is room. */
static void append(const tm_tet_mesh *mesh, uint32_t t, tm_ball *ball)
{
    ball->tet[ball->size] = t;
    tm_tet_face_below(mesh, t, tm_tet_corner(mesh, t, ball->node),
                      ball->face[ball->size]);
    ball->size++;
}

bool tm_ball_around(const tm_tet_mesh *mesh, uint32_t t, uint32_t v, tm_tet_marks *marks,
                    tm_ball *ball)
{
    ball->node = v;
    ball->size = ball->constrained_count = 0;
    if (!tm_tet_marks_clear(marks, mesh->slots) || !reserve(ball, 1))
        return false;
    tm_tet_mark(marks, t);
    append(mesh, t, ball);
    for (size_t next = 0; next < ball->size; next++) {
        uint32_t u = ball->tet[next];
        if (!reserve(ball, ball->size + 3))
            return false;
        for (uint32_t i = 0; i < 4; i++) {
            if (mesh->tet[u][i] == v)
                continue;
            uint32_t across = mesh->neighbour[u][i];
            if (across & TM_FACE_BIT) {
                if (!tm_append(&ball->constrained, &ball->constrained_count,
                               &ball->constrained_room, across & ~TM_FACE_BIT))
                    return false;
                across = tm_tet_across(mesh, u, i);
                if (across == TM_NONE)
                    continue;
            }
            if (tm_tet_mark(marks, across / 4))
                append(mesh, across / 4, ball);
        }
    }
    return true;
}

void tm_ball_move_node(tm_tet_mesh *mesh, const tm_ball *ball, const double p[3])
{
    size_t width = mesh->node_attributes;
    if (width > 0) {
        double *value = mesh->node_attribute + mesh->nodes * width;
        tm_tet_interpolate(mesh, ball->tet, ball->size, p, value);
        memcpy(mesh->node_attribute + ball->node * width, value, width * sizeof *value);
    }
    memcpy(mesh->xyz[ball->node], p, sizeof mesh->xyz[ball->node]);
}
