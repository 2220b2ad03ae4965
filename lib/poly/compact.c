/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "compact.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../base/parallel.h"
#include "../geom/vector.h"
#include "../tet/operation/ball.h"

#include <stdlib.h>
#include <string.h>

/* The price of a border at last, by the volume of a cell. */
static const double border_price = 0.05;

/* Sweeps go on while more than this share of the tetrahedra changes sides. */
static const double enough_moves = 1e-3;
enum { SWEEPS_MAX = 40 };

/* So many tetrahedra are a thread's work at a time. */
enum { CHUNK = 8192 };

typedef struct {
    double volume, moment[3]; /* moment: volume times centroid */
    double centre[3];         /* the centroid */
    size_t items;
} cell;

typedef struct {
    const tm_compact_items *in;
    uint32_t *label;
    double volume; /* of all */
    cell *cell;
    size_t cells;
    double price; /* of an area between cells */
} compactor;

/* The cells beside an item that are asked, and the area to each. */
enum { BESIDE_MAX = 32 };

typedef struct {
    size_t count;
    uint32_t cell[BESIDE_MAX];
    double area[BESIDE_MAX];
    double own;  /* to the cell that it is in */
    bool inside; /* all is of that */
} surroundings;

/* An item comes to a cell, or goes. */
static void add(cell *c, const double centre[4], int sign)
{
    c->volume += sign * centre[3];
    for (int x = 0; x < 3; x++) {
        c->moment[x] += sign * centre[3] * centre[x];
        c->centre[x] = c->moment[x] / c->volume;
    }
    c->items += (size_t)sign;
}

/* By how much the first term of a cell changes with an item more, or less. */
static double spread(const cell *c, const double centre[4], int sign)
{
    double distance2 = 0, rest = c->volume + sign * centre[3];
    for (int x = 0; x < 3; x++) {
        double to = centre[x] - c->centre[x];
        distance2 += to * to;
    }
    return rest > 0 && c->volume > 0 ? centre[3] * c->volume / rest * distance2
                                     : HUGE_VAL;
}

static size_t start_of(const tm_compact_items *in, size_t i)
{
    return in->start ? in->start[i] : 4 * i;
}

static void look_around(const compactor *m, uint32_t i, surroundings *s)
{
    const size_t end = start_of(m->in, (size_t)i + 1);
    s->count = 0;
    s->own = 0;
    s->inside = true;
    for (size_t k = start_of(m->in, i); k < end; k++) {
        const uint32_t other = m->in->beside[k];
        if (other == TM_NONE)
            continue;
        const uint32_t c = m->label[other];
        if (c == m->label[i]) {
            s->own += m->in->area[k];
            continue;
        }
        size_t j = 0;
        while (j < s->count && s->cell[j] != c)
            j++;
        s->inside = false;
        if (j == BESIDE_MAX)
            continue;
        if (j == s->count) {
            s->cell[s->count] = c;
            s->area[s->count++] = 0;
        }
        s->area[j] += m->in->area[k];
    }
}

/* Moves an item to the cell beside it by which most is gained; whether there is one. */
static bool move(compactor *m, uint32_t i)
{
    const uint32_t from = m->label[i];
    const double *centre = m->in->centre[i];
    surroundings s;
    if (m->cell[from].items == 1)
        return false;
    look_around(m, i, &s);
    if (s.inside)
        return false;
    const double now = spread(&m->cell[from], centre, -1);
    double least = 0;
    uint32_t best = from;
    for (size_t k = 0; k < s.count; k++) {
        double change =
            m->price * (s.own - s.area[k]) + spread(&m->cell[s.cell[k]], centre, 1) - now;
        if (!(change < least))
            continue;
        least = change;
        best = s.cell[k];
    }
    if (best == from)
        return false;
    add(&m->cell[from], centre, -1);
    add(&m->cell[best], centre, 1);
    m->label[i] = best;
    return true;
}

static void settle(compactor *m, double price, const tm_progress *progress)
{
    tm_progress_at at = {.what = "moving borders", .of = SWEEPS_MAX};
    size_t moves = m->in->items;
    m->price = price;
    for (int k = 0; k < SWEEPS_MAX; k++) {
        if ((double)moves <= enough_moves * (double)m->in->items)
            break;
        tm_progress_step(progress, &at, (size_t)k);
        moves = 0;
        for (uint32_t i = 0; i < m->in->items; i++)
            moves += move(m, i);
    }
}

/* Parts that nothing joins: part[i] is the first item of that of i. */
static void find_parts(const tm_compact_items *in, uint32_t *part)
{
    for (uint32_t i = 0; i < in->items; i++)
        part[i] = i;
    for (uint32_t i = 0; i < in->items; i++)
        for (size_t k = start_of(in, i); k < start_of(in, (size_t)i + 1); k++)
            if (in->beside[k] != TM_NONE)
                tm_set_unite(part, i, in->beside[k]);
    for (uint32_t i = 0; i < in->items; i++)
        part[i] = tm_set_root(part, i);
}

/* A part: what cuts it into runs of even volume. */
typedef struct {
    double volume, filled;
    size_t items, runs;
    uint32_t first; /* cell */
} part_runs;

/* Cuts each part into runs: as many as its share of the whole says, one at least, and no
 * more than it has items. */
static bool cut_into_runs(compactor *m, double run)
{
    const tm_compact_items *in = m->in;
    uint32_t *part = tm_new(in->items, sizeof *part);
    part_runs *of = calloc(in->items + 1, sizeof *of); /* by the first item */
    m->cells = 0;
    if (part && of)
        find_parts(in, part);
    for (uint32_t i = 0; i < in->items && part && of; i++) {
        of[part[i]].volume += in->centre[i][3];
        of[part[i]].items++;
    }
    for (uint32_t i = 0; i < in->items && part && of; i++) {
        if (part[i] != i)
            continue;
        double runs = fmin(floor(of[i].volume / run + 0.5), (double)of[i].items);
        of[i].runs = (size_t)fmax(1, runs);
        of[i].first = (uint32_t)m->cells;
        m->cells += of[i].runs;
    }
    m->cell = part && of ? calloc(m->cells + 1, sizeof *m->cell) : NULL;
    for (uint32_t i = 0; i < in->items && m->cell; i++) {
        part_runs *p = &of[part[i]];
        double share = p->volume > 0 ? (p->filled + in->centre[i][3] / 2) / p->volume : 0;
        p->filled += in->centre[i][3];
        m->label[i] =
            p->first + (uint32_t)fmin(share * (double)p->runs, (double)p->runs - 1);
        add(&m->cell[m->label[i]], in->centre[i], 1);
    }
    free(part);
    free(of);
    return m->cell;
}

/* Numbers cells without holes: a run may be of no item. */
static size_t number_cells(const compactor *m)
{
    size_t count = 0;
    for (size_t c = 0; c < m->cells; c++)
        if (m->cell[c].items > 0)
            m->cell[c].items = ++count;
    for (uint32_t i = 0; i < m->in->items; i++)
        m->label[i] = (uint32_t)(m->cell[m->label[i]].items - 1);
    return count;
}

tm_status tm_compact_label(const tm_compact_items *items, size_t cells, double size,
                           const tm_progress *progress, uint32_t *label, size_t *regions,
                           tm_error *error)
{
    compactor m = {.in = items, .label = label};
    for (size_t i = 0; i < items->items; i++)
        m.volume += items->centre[i][3];
    double run = cells > 0 ? m.volume / (double)cells : pow(size, 3);
    *regions = 0;
    bool done = cut_into_runs(&m, run);
    if (done) {
        settle(&m, 0, progress);
        settle(&m, border_price * run, progress);
        *regions = number_cells(&m);
    }
    free(m.cell);
    return done ? TM_OK : tm_fail_memory(error);
}

/* Tetrahedra as items. */
typedef struct {
    const tm_tet_mesh *mesh;
    tm_compact_items items;
} measuring;

/* Tetrahedron t and what is beside it. */
static void measure_tet(const measuring *m, uint32_t t)
{
    const tm_tet_mesh *mesh = m->mesh;
    const uint32_t *n = mesh->tet[t];
    const double(*xyz)[3] = (const double(*)[3])mesh->xyz;
    const double *origin = xyz[mesh->tet[0][0]];
    double *centre = m->items.centre[t];
    for (int x = 0; x < 3; x++) {
        centre[x] = 0;
        for (int i = 0; i < 4; i++)
            centre[x] += (xyz[n[i]][x] - origin[x]) / 4;
    }
    centre[3] = fabs(tm_tet_volume(xyz[n[0]], xyz[n[1]], xyz[n[2]], xyz[n[3]]));
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t across = mesh->neighbour[t][i];
        const size_t k = 4 * (size_t)t + i;
        uint32_t face[3];
        m->items.beside[k] = across & TM_FACE_BIT ? TM_NONE : across / 4;
        m->items.area[k] = 0;
        if (across & TM_FACE_BIT)
            continue;
        tm_tet_face_below(mesh, t, i, face);
        m->items.area[k] = tm_triangle_area(xyz[face[0]], xyz[face[1]], xyz[face[2]]);
    }
}

static void measure_chunk(void *context, size_t from, size_t to)
{
    const measuring *m = context;
    for (size_t t = from; t < to; t++)
        measure_tet(m, (uint32_t)t);
}

tm_status tm_poly_compact(const tm_tet_mesh *mesh, const tm_poly_options *options,
                          uint32_t *label, size_t *regions, tm_error *error)
{
    measuring m = {mesh, {.items = mesh->slots}};
    tm_compact_items *items = &m.items;
    items->centre = tm_new(mesh->slots, sizeof *items->centre);
    items->beside = tm_new(4 * mesh->slots, sizeof *items->beside);
    items->area = tm_new(4 * mesh->slots, sizeof *items->area);
    const bool memory = items->centre && items->beside && items->area;
    if (memory)
        tm_parallel_runs(options->threads, mesh->slots, CHUNK, measure_chunk, &m);
    tm_status status = memory ? tm_compact_label(items, options->cells, options->size,
                                                 options->progress, label, regions, error)
                              : tm_fail_memory(error);
    free(items->centre);
    free(items->beside);
    free(items->area);
    return status;
}
