/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cavity.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

void tm_cavity_free(tm_cavity *cavity)
{
    free(cavity->tet);
    free(cavity->face);
    free(cavity->beyond);
    *cavity = (tm_cavity){0};
}

bool tm_cavity_start(tm_cavity *cavity, const tm_tet_mesh *mesh, tm_tet_marks *marks)
{
    cavity->size = cavity->faces = 0;
    return tm_tet_marks_clear(marks, mesh->slots);
}

static bool add_face(tm_cavity *cavity, const tm_tet_mesh *mesh, uint32_t t, uint32_t i)
{
    uint32_t(*face)[3] =
        tm_grow(cavity->face, &cavity->face_room, cavity->faces + 1, sizeof *face);
    cavity->face = face ? face : cavity->face;
    uint32_t *beyond =
        tm_grow(cavity->beyond, &cavity->beyond_room, cavity->faces + 1, sizeof *beyond);
    cavity->beyond = beyond ? beyond : cavity->beyond;
    if (!face || !beyond)
        return false;
    tm_tet_face_below(mesh, t, i, face[cavity->faces]);
    beyond[cavity->faces++] = mesh->neighbour[t][i];
    return true;
}

bool tm_cavity_add(tm_cavity *cavity, const tm_tet_mesh *mesh, tm_tet_marks *marks,
                   uint32_t t)
{
    if (!tm_append(&cavity->tet, &cavity->size, &cavity->tet_room, t))
        return false;
    tm_tet_mark(marks, t);
    /* Faces that t shares with the cavity are inside now. */
    size_t kept = 0;
    for (size_t f = 0; f < cavity->faces; f++) {
        if (!(cavity->beyond[f] & TM_FACE_BIT) && cavity->beyond[f] / 4 == t)
            continue;
        memcpy(cavity->face[kept], cavity->face[f], sizeof cavity->face[f]);
        cavity->beyond[kept++] = cavity->beyond[f];
    }
    cavity->faces = kept;
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t across = mesh->neighbour[t][i];
        bool inside = !(across & TM_FACE_BIT) && tm_tet_is_marked(marks, across / 4);
        if (!inside && !add_face(cavity, mesh, t, i))
            return false;
    }
    return true;
}

static double cost_at(const tm_tet_mesh *mesh, const tm_cost *cost, const uint32_t n[3],
                      const double p[3])
{
    double quality =
        tm_cost_quality(cost, 0, mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]], p);
    return quality > 0 ? tm_cost_of(cost, quality) : 2 * tm_cost_of(cost, 0);
}

/* What the whole costs more with tetrahedron t in the cavity. */
static double cost_of_adding(const tm_tet_mesh *mesh, const tm_tet_marks *marks,
                             const double *quality, const tm_cost *cost, uint32_t t,
                             const double p[3])
{
    double more = -tm_cost_of(cost, quality[t]);
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t across = mesh->neighbour[t][i], face[3];
        tm_tet_face_below(mesh, t, i, face);
        if (!(across & TM_FACE_BIT) && tm_tet_is_marked(marks, across / 4)) {
            uint32_t swap = face[0];
            face[0] = face[1];
            face[1] = swap;
            more -= cost_at(mesh, cost, face, p);
        } else {
            more += cost_at(mesh, cost, face, p);
        }
    }
    return more;
}

bool tm_cavity_grow(tm_cavity *cavity, const tm_tet_mesh *mesh, tm_tet_marks *marks,
                    const double *quality, const tm_cost *cost, const double p[3])
{
    enum { FACES_MAX = 100 };
    const double gain = 1e-6;
    for (size_t f = 0; f < cavity->faces && cavity->faces < FACES_MAX;) {
        uint32_t beyond = cavity->beyond[f];
        if (beyond & TM_FACE_BIT || cost_at(mesh, cost, cavity->face[f], p) == 0 ||
            cost_of_adding(mesh, marks, quality, cost, beyond / 4, p) >= -gain) {
            f++;
            continue;
        }
        if (!tm_cavity_add(cavity, mesh, marks, beyond / 4))
            return false;
        f = 0;
    }
    return true;
}

tm_status tm_cavity_fill(tm_tet_mesh *mesh, const tm_cavity *cavity, uint32_t v,
                         tm_replacement_table *table, uint32_t (*node)[4],
                         uint32_t *created, tm_error *error)
{
    for (size_t f = 0; f < cavity->faces; f++) {
        memcpy(node[f], cavity->face[f], sizeof cavity->face[f]);
        node[f][3] = v;
    }
    tm_replacement what = {.old = cavity->tet,
                           .old_count = cavity->size,
                           .node = (const uint32_t(*)[4])node,
                           .count = cavity->faces,
                           .created = created};
    return tm_tet_replace(mesh, &what, table, error);
}
