/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "correction.h"

#include "../base/array.h"
#include "../examine/poly/poly_finite_volume.h"
#include "../geom/predicates.h"
#include "../geom/vector.h"
#include "../tet/operation/ball.h"

#include <stdlib.h>

/* The gain of a cell is at most so much: then its neighbours' may add some to it. */
static const double most_gain = 0.6;
enum { ROUNDS_MAX = 100 };

typedef struct {
    double volume, centre[3];
    double gradient[3]; /* of a function that is 1 in the cell and 0 in all others */
    double solved, back;
    size_t tets;
    bool is_flat;   /* in part */
    bool is_steep;  /* seen from the worst one */
    uint32_t worst; /* the cell beside it by which most comes back */
    double most;
} cell_state;

typedef struct {
    const tm_tet_mesh *mesh;
    const uint32_t *cell;
    cell_state *state;
} calmer;

/* A face between two cells, or of the first one at the boundary. */
typedef struct {
    uint32_t cell[2];
    double area[3];   /* outward of the first one */
    double centre[3]; /* of the face */
    double rest[3];   /* k */
    double solved;    /* |Δ| / |d| */
    double weight[2]; /* of the cells in the value at the face */
    bool is_steep;
} face;

/* How far a cell's centroid is from the plane of a face, times its area. */
static double distance(const calmer *m, const face *f, int side)
{
    double to[3];
    tm_subtract(to, f->centre, m->state[f->cell[side]].centre);
    return fabs(tm_dot(f->area, to));
}

static void measure_inner(const calmer *m, face *f)
{
    double d[3], distances[2];
    tm_subtract(d, m->state[f->cell[1]].centre, m->state[f->cell[0]].centre);
    const double along = tm_dot(d, f->area);
    f->is_steep = along < TM_FV_COSINE * tm_norm(d) * tm_norm(f->area) * (1 - 1e-9);
    f->solved = along > 0 ? tm_norm2(f->area) / along : 0;
    for (int x = 0; x < 3; x++)
        f->rest[x] = f->area[x] - d[x] * f->solved;
    for (int i = 0; i < 2; i++)
        distances[i] = distance(m, f, i);
    for (int i = 0; i < 2; i++)
        f->weight[i] = distances[1 - i] / (distances[0] + distances[1]);
}

/* Whether face i of t is one between cells, seen from the first, or of the boundary. */
static bool find_face(const calmer *m, uint32_t t, uint32_t i, face *f)
{
    const uint32_t across = tm_tet_across(m->mesh, t, i);
    const double(*xyz)[3] = (const double(*)[3])m->mesh->xyz;
    uint32_t n[3];
    if (across != TM_NONE && (across / 4 < t || m->cell[across / 4] == m->cell[t]))
        return false;
    tm_tet_face_below(m->mesh, t, i, n);
    tm_triangle_normal(f->area, xyz[n[0]], xyz[n[2]], xyz[n[1]]);
    for (int x = 0; x < 3; x++) {
        f->area[x] /= 2;
        f->centre[x] = (xyz[n[0]][x] + xyz[n[1]][x] + xyz[n[2]][x]) / 3;
    }
    f->cell[0] = m->cell[t];
    f->cell[1] = across == TM_NONE ? TM_NONE : m->cell[across / 4];
    if (across != TM_NONE)
        measure_inner(m, f);
    return true;
}

/* Calls a function for each face. */
static void for_faces(const calmer *m, void (*visit)(const calmer *, const face *))
{
    face f;
    for (uint32_t t = 0; t < m->mesh->slots; t++)
        for (uint32_t i = 0; i < 4; i++)
            if (find_face(m, t, i, &f))
                visit(m, &f);
}

/* Centroids and volumes. */
static void measure_cells(const calmer *m, size_t cells)
{
    const double(*xyz)[3] = (const double(*)[3])m->mesh->xyz;
    for (uint32_t t = 0; t < m->mesh->slots; t++) {
        const uint32_t *n = m->mesh->tet[t];
        cell_state *c = &m->state[m->cell[t]];
        const double volume =
            fabs(tm_tet_volume(xyz[n[0]], xyz[n[1]], xyz[n[2]], xyz[n[3]]));
        c->tets++;
        c->volume += volume;
        for (int x = 0; x < 3; x++)
            for (int i = 0; i < 4; i++)
                c->centre[x] += volume * xyz[n[i]][x] / 4;
        c->is_flat |= m->mesh->flat > 0 &&
                      tm_orient3d(xyz[n[0]], xyz[n[1]], xyz[n[2]], xyz[n[3]]) == 0;
    }
    for (size_t c = 0; c < cells; c++)
        for (int x = 0; x < 3 && m->state[c].volume > 0; x++)
            m->state[c].centre[x] /= m->state[c].volume;
}

static void add_gradient(const calmer *m, const face *f)
{
    if (f->cell[1] == TM_NONE) {
        const double to = distance(m, f, 0);
        m->state[f->cell[0]].solved += to > 0 ? tm_norm2(f->area) / to : 0;
        return;
    }
    for (int i = 0; i < 2; i++) {
        cell_state *c = &m->state[f->cell[i]];
        c->solved += f->solved;
        for (int x = 0; x < 3 && c->volume > 0; x++)
            c->gradient[x] += (i ? -1 : 1) * f->area[x] * f->weight[i] / c->volume;
    }
}

/* What comes back through a face: by the gradient of the cell, and by what it makes of
 * that of the other one. */
static void add_back(const calmer *m, const face *f)
{
    for (int i = 0; i < 2 && f->cell[1] != TM_NONE; i++) {
        cell_state *c = &m->state[f->cell[i]];
        const cell_state *other = &m->state[f->cell[1 - i]];
        const int sign = i ? -1 : 1;
        double own = sign * f->weight[i] * tm_dot(f->rest, c->gradient), beside = 0;
        if (other->volume > 0)
            beside = -f->weight[1 - i] * f->weight[i] * tm_dot(f->rest, f->area) /
                     other->volume;
        c->back += own + beside;
        const double share = f->is_steep ? HUGE_VAL : fabs(own) + fabs(beside);
        if (other->tets > 1 && !other->is_flat && share > c->most) {
            c->most = share;
            c->is_steep = f->is_steep;
            c->worst = f->cell[1 - i];
        }
    }
}

/* Marks the cells that are to be taken apart. */
static bool mark(const calmer *m, bool *apart, size_t cells)
{
    bool any = false;
    for (size_t c = 0; c < cells; c++) {
        const cell_state *s = &m->state[c];
        if (!s->is_steep && fabs(s->back) <= most_gain * s->solved)
            continue;
        if (s->worst != TM_NONE)
            apart[s->worst] = true;
        else if (s->tets > 1 && !s->is_flat)
            apart[c] = true;
        else
            continue;
        any = true;
    }
    return any;
}

/* Each tetrahedron of a marked cell but the last becomes a cell. */
static void take_apart(const calmer *m, const bool *apart, uint32_t *cell, size_t *cells)
{
    for (uint32_t t = 0; t < m->mesh->slots; t++)
        if (cell[t] != TM_NONE && apart[cell[t]] && --m->state[cell[t]].tets > 0)
            cell[t] = TM_NONE;
    for (uint32_t t = 0; t < m->mesh->slots; t++)
        if (cell[t] == TM_NONE)
            cell[t] = (uint32_t)(*cells)++;
}

tm_status tm_calm_cells(const tm_tet_mesh *mesh, uint32_t *cell, size_t *cells,
                        tm_error *error)
{
    calmer m = {.mesh = mesh, .cell = cell};
    bool memory = true, again = true;
    for (int k = 0; k < ROUNDS_MAX && again && memory; k++) {
        bool *apart = calloc(*cells + 1, sizeof *apart);
        m.state = calloc(*cells + 1, sizeof *m.state);
        memory = apart && m.state;
        for (size_t c = 0; c < *cells && memory; c++)
            m.state[c].worst = TM_NONE;
        if (memory) {
            measure_cells(&m, *cells);
            for_faces(&m, add_gradient);
            for_faces(&m, add_back);
            again = mark(&m, apart, *cells);
            take_apart(&m, apart, cell, cells);
        }
        free(apart);
        free(m.state);
    }
    return memory ? TM_OK : tm_fail_memory(error);
}
