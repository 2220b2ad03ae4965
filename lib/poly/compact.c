/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "compact.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../geom/vector.h"
#include "../tet/operation/ball.h"

#include <stdlib.h>
#include <string.h>

/* The price of a border at last, by the volume of a cell. */
static const double border_price = 0.05;

/* Sweeps go on while more than this share of the tetrahedra changes sides. */
static const double enough_moves = 1e-3;
enum { SWEEPS_MAX = 40 };

typedef struct {
    double volume, moment[3]; /* moment: volume times centroid */
    size_t tets;
} cell;

typedef struct {
    const tm_tet_mesh *mesh;
    uint32_t *label;
    double (*centre)[4]; /* [slots]: centroid, from the first node, and volume */
    double volume;       /* of all */
    cell *cell;
    size_t cells;
    double price; /* of an area between cells */
} compactor;

static void measure_tet(const tm_tet_mesh *mesh, uint32_t t, double centre[4])
{
    const uint32_t *n = mesh->tet[t];
    const double(*xyz)[3] = (const double(*)[3])mesh->xyz;
    const double *origin = xyz[mesh->tet[0][0]];
    for (int x = 0; x < 3; x++) {
        centre[x] = 0;
        for (int i = 0; i < 4; i++)
            centre[x] += (xyz[n[i]][x] - origin[x]) / 4;
    }
    centre[3] = fabs(tm_tet_volume(xyz[n[0]], xyz[n[1]], xyz[n[2]], xyz[n[3]]));
}

/* Sums over the tetrahedra, in the order of their numbers. */
static void measure(compactor *m)
{
    m->volume = 0;
    for (uint32_t t = 0; t < m->mesh->slots; t++) {
        measure_tet(m->mesh, t, m->centre[t]);
        m->volume += m->centre[t][3];
    }
}

/* A tetrahedron comes to a cell, or goes. */
static void add(cell *c, const double centre[4], int sign)
{
    c->volume += sign * centre[3];
    for (int x = 0; x < 3; x++)
        c->moment[x] += sign * centre[3] * centre[x];
    c->tets += (size_t)sign;
}

/* By how much the first term of a cell changes with a tetrahedron more, or less. */
static double spread(const cell *c, const double centre[4], int sign)
{
    double distance2 = 0, rest = c->volume + sign * centre[3];
    for (int x = 0; x < 3; x++) {
        double to = centre[x] - c->moment[x] / c->volume;
        distance2 += to * to;
    }
    return rest > 0 && c->volume > 0 ? centre[3] * c->volume / rest * distance2
                                     : HUGE_VAL;
}

/* The cell across face i of t; that of t at a kept face. */
static uint32_t cell_across(const compactor *m, uint32_t t, uint32_t i)
{
    uint32_t across = m->mesh->neighbour[t][i];
    return m->label[across & TM_FACE_BIT ? t : across / 4];
}

/* What the borders of t cost with its cell, and would with each of those beside it. */
static double find_borders(const compactor *m, uint32_t t, double cost[4])
{
    const double(*xyz)[3] = (const double(*)[3])m->mesh->xyz;
    uint32_t beside[4], n[3];
    double area[4], now = 0;
    for (uint32_t i = 0; i < 4; i++) {
        tm_tet_face_below(m->mesh, t, i, n);
        beside[i] = cell_across(m, t, i);
        area[i] = m->mesh->neighbour[t][i] & TM_FACE_BIT
                      ? 0
                      : m->price * tm_triangle_area(xyz[n[0]], xyz[n[1]], xyz[n[2]]);
    }
    for (int i = 0; i < 4; i++) {
        now += beside[i] != m->label[t] ? area[i] : 0;
        cost[i] = 0;
        for (int k = 0; k < 4; k++)
            cost[i] += beside[k] != beside[i] ? area[k] : 0;
    }
    return now;
}

/* Moves t to the cell beside it by which most is gained; whether there is one. */
static bool move(compactor *m, uint32_t t)
{
    uint32_t from = m->label[t], best = from;
    const double *centre = m->centre[t];
    double borders[4], least = 0;
    bool is_inner = true;
    for (uint32_t i = 0; i < 4; i++)
        is_inner &= cell_across(m, t, i) == from;
    if (is_inner || m->cell[from].tets == 1)
        return false;
    double now = find_borders(m, t, borders) + spread(&m->cell[from], centre, -1);
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t to = cell_across(m, t, i);
        double change = borders[i] + spread(&m->cell[to], centre, 1) - now;
        if (to == from || !(change < least))
            continue;
        least = change;
        best = to;
    }
    if (best == from)
        return false;
    add(&m->cell[from], centre, -1);
    add(&m->cell[best], centre, 1);
    m->label[t] = best;
    return true;
}

static void settle(compactor *m, double price, const tm_progress *progress)
{
    tm_progress_at at = {.what = "moving borders", .of = SWEEPS_MAX};
    size_t moves = m->mesh->slots;
    m->price = price;
    for (int k = 0; k < SWEEPS_MAX; k++) {
        if ((double)moves <= enough_moves * (double)m->mesh->slots)
            break;
        tm_progress_step(progress, &at, (size_t)k);
        moves = 0;
        for (uint32_t t = 0; t < m->mesh->slots; t++)
            moves += move(m, t);
    }
}

/* Parts of the mesh that no face but kept ones joins: part[t] is the first tetrahedron of
 * that of t. */
static void find_parts(const tm_tet_mesh *mesh, uint32_t *part)
{
    for (uint32_t t = 0; t < mesh->slots; t++)
        part[t] = t;
    for (uint32_t t = 0; t < mesh->slots; t++)
        for (int i = 0; i < 4; i++) {
            uint32_t across = mesh->neighbour[t][i];
            if (!(across & TM_FACE_BIT))
                tm_set_unite(part, t, across / 4);
        }
    for (uint32_t t = 0; t < mesh->slots; t++)
        part[t] = tm_set_root(part, t);
}

/* A part of the mesh: what cuts it into runs of even volume. */
typedef struct {
    double volume, filled;
    size_t tets, runs;
    uint32_t first; /* cell */
} mesh_part;

/* Cuts each part into runs: as many as its share of the whole says, one at least, and no
 * more than it has tetrahedra. */
static bool cut_into_runs(compactor *m, double run)
{
    const tm_tet_mesh *mesh = m->mesh;
    uint32_t *part = tm_new(mesh->slots, sizeof *part);
    mesh_part *of = calloc(mesh->slots + 1, sizeof *of); /* by the first tetrahedron */
    m->cells = 0;
    if (part && of)
        find_parts(mesh, part);
    for (uint32_t t = 0; t < mesh->slots && part && of; t++) {
        of[part[t]].volume += m->centre[t][3];
        of[part[t]].tets++;
    }
    for (uint32_t t = 0; t < mesh->slots && part && of; t++) {
        if (part[t] != t)
            continue;
        double runs = fmin(floor(of[t].volume / run + 0.5), (double)of[t].tets);
        of[t].runs = (size_t)fmax(1, runs);
        of[t].first = (uint32_t)m->cells;
        m->cells += of[t].runs;
    }
    m->cell = part && of ? calloc(m->cells + 1, sizeof *m->cell) : NULL;
    for (uint32_t t = 0; t < mesh->slots && m->cell; t++) {
        mesh_part *p = &of[part[t]];
        double share = p->volume > 0 ? (p->filled + m->centre[t][3] / 2) / p->volume : 0;
        p->filled += m->centre[t][3];
        m->label[t] =
            p->first + (uint32_t)fmin(share * (double)p->runs, (double)p->runs - 1);
        add(&m->cell[m->label[t]], m->centre[t], 1);
    }
    free(part);
    free(of);
    return m->cell;
}

/* Numbers cells without holes: a run may be of no tetrahedron. */
static size_t number_cells(const compactor *m)
{
    size_t count = 0;
    for (size_t c = 0; c < m->cells; c++)
        if (m->cell[c].tets > 0)
            m->cell[c].tets = ++count;
    for (uint32_t t = 0; t < m->mesh->slots; t++)
        m->label[t] = (uint32_t)(m->cell[m->label[t]].tets - 1);
    return count;
}

tm_status tm_poly_compact(const tm_tet_mesh *mesh, const tm_poly_options *options,
                          uint32_t *label, size_t *regions, tm_error *error)
{
    compactor m = {.mesh = mesh, .label = label};
    m.centre = tm_new(mesh->slots, sizeof *m.centre);
    bool done = m.centre;
    *regions = 0;
    if (done) {
        measure(&m);
        double run = options->cells > 0 ? m.volume / (double)options->cells
                                        : pow(options->size, 3);
        done = cut_into_runs(&m, run);
        if (done) {
            settle(&m, 0, options->progress);
            settle(&m, border_price * run, options->progress);
            *regions = number_cells(&m);
        }
    }
    free(m.centre);
    free(m.cell);
    return done ? TM_OK : tm_fail_memory(error);
}
