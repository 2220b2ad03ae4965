/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "region_layout.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OCTANTS = 8, SIDES = 6, SAMPLES = 400 };

/* Ways that are looked at for a corner, at most: where eight regions meet there are many.
 */
enum { MOST_STEPS = 400000 };

static const double pi = 3.14159265358979323846;

/* What a side of a leaf between node and corner is worth in angles; and an edge's angle
 * with its curve beside an octant's with its region. */
static const double distance_weight = 0.5, edge_weight = 0.5;

/* A curve at a corner. */
typedef struct {
    uint32_t curve;
    bool ends;       /* there; else it begins */
    double along[3]; /* from the corner, of length 1 */
} spoke;

/* A corner and what the search for it has found. */
typedef struct {
    tm_region_layout *layout;
    double direction[SAMPLES][3]; /* all about as far from each other */
    const double *point;
    unsigned spokes;
    spoke spoke[SIDES];
    unsigned labels;
    uint32_t label[OCTANTS];
    uint8_t sampled[SAMPLES];             /* label in that direction */
    double octant_cost[OCTANTS][OCTANTS]; /* of octant o with label k */
    /* of the node that is tried */
    uint32_t node;
    double size;             /* shortest edge there */
    unsigned given[OCTANTS]; /* index of the label */
    unsigned steps;
    /* the best so far */
    double least;
    uint32_t best_node;
    unsigned best[OCTANTS];
} finder;

/* A curve that begins or ends at a corner. */
typedef struct {
    uint32_t corner, curve;
    bool ends;
} end_of_curve;

static int compare_ends(const void *a, const void *b)
{
    const end_of_curve *p = a, *q = b;
    if (p->corner != q->corner)
        return p->corner < q->corner ? -1 : 1;
    if (p->curve != q->curve)
        return p->curve < q->curve ? -1 : 1;
    return (int)p->ends - (int)q->ends;
}

static void find_directions(finder *f)
{
    const double golden = pi * (3 - sqrt(5));
    for (unsigned i = 0; i < SAMPLES; i++) {
        const double z = 1 - (2 * i + 1) / (double)SAMPLES, r = sqrt(1 - z * z);
        f->direction[i][0] = r * cos(golden * i);
        f->direction[i][1] = r * sin(golden * i);
        f->direction[i][2] = z;
    }
}

/* The regions around the corner, as far away as `reach`. False where there are too many.
 */
static bool look_around(finder *f, double reach)
{
    f->labels = 0;
    for (unsigned i = 0; i < SAMPLES; i++) {
        double point[3];
        for (int c = 0; c < 3; c++)
            point[c] = f->point[c] + reach * f->direction[i][c];
        const uint32_t label = tm_surface_region_at(f->layout->surface, point);
        unsigned k = 0;
        while (k < f->labels && f->label[k] != label)
            k++;
        if (k == OCTANTS)
            return false;
        if (k == f->labels)
            f->label[f->labels++] = label;
        f->sampled[i] = (uint8_t)k;
    }
    uint64_t set = 0;
    for (unsigned k = 0; k < f->labels; k++)
        set ^= tm_region_number(f->label[k]);
    return tm_walls_have(&f->layout->walls, set);
}

/* How far the octants around the node are from each region, seen from the corner, in
 * shortest edges there; squared. */
static void look_at_octants(finder *f)
{
    const tm_octree *octree = f->layout->lattice.octree;
    double offset[3];
    f->size = tm_node_lattice_size(&f->layout->lattice, f->node);
    tm_octree_point(octree, octree->grid[f->node], offset);
    tm_subtract(offset, offset, f->point);
    for (unsigned o = 0; o < OCTANTS; o++) {
        double out[3], most[OCTANTS];
        for (int c = 0; c < 3; c++)
            out[c] = offset[c] / f->size + (o >> c & 1 ? 0.5 : -0.5);
        const double far = tm_norm(out);
        for (unsigned k = 0; k < OCTANTS; k++)
            most[k] = -far;
        for (unsigned i = 0; i < SAMPLES; i++)
            most[f->sampled[i]] = fmax(most[f->sampled[i]], tm_dot(f->direction[i], out));
        for (unsigned k = 0; k < OCTANTS; k++) {
            const double away = far > 0 ? far * acos(fmin(1, most[k] / far)) : 0;
            f->octant_cost[o][k] = away * away;
        }
    }
}

/* The curves at the corner; false where octants cannot follow all of them. */
static bool list_spokes(finder *f, const end_of_curve *end, size_t count)
{
    const tm_surface *s = f->layout->surface;
    if (count > SIDES)
        return false;
    for (f->spokes = 0; f->spokes < count; f->spokes++) {
        const end_of_curve *e = &end[f->spokes];
        spoke *made = &f->spoke[f->spokes];
        const uint32_t *node = e->ends ? s->curve_node + s->curve_start[e->curve + 1] - 2
                                       : s->curve_node + s->curve_start[e->curve];
        if (f->layout->sectors.count[e->curve] == 0)
            return false;
        *made = (spoke){.curve = e->curve, .ends = e->ends};
        tm_subtract(made->along, s->xyz[node[e->ends ? 0 : 1]],
                    s->xyz[node[e->ends ? 1 : 0]]);
        const double length = tm_norm(made->along);
        for (int i = 0; i < 3; i++)
            made->along[i] /= length;
    }
    return true;
}

/* Whether octants on a side are those of a curve, in its order. */
static bool is_side_of(const finder *f, unsigned side, const spoke *s)
{
    const tm_wall_sectors *sectors = &f->layout->sectors;
    const unsigned count = sectors->count[s->curve];
    unsigned turn[4];
    for (unsigned i = 0; i < 4; i++) {
        const uint32_t label = f->label[f->given[tm_side_octants[side][i]]];
        unsigned k = 0;
        while (k < count && sectors->label[s->curve][k] != label)
            k++;
        if (k == count)
            return false;
        turn[s->ends ? 3 - i : i] = k;
    }
    return tm_sectors_turn(turn, count);
}

/* What the edge on a side costs: what is a curve's is added to *used. Infinite where it
 * can be none. */
static double side_cost(const finder *f, unsigned side, unsigned *used)
{
    unsigned met = 0, count = 0;
    uint64_t set = 0;
    for (unsigned i = 0; i < 4; i++)
        met |= 1u << f->given[tm_side_octants[side][i]];
    for (unsigned k = 0; k < f->labels; k++)
        if (met >> k & 1) {
            set ^= tm_region_number(f->label[k]);
            count++;
        }
    if (count < 2)
        return 0;
    if (count == 2)
        return tm_walls_have(&f->layout->walls, set) ? 0 : INFINITY;
    for (unsigned s = 0; s < f->spokes; s++) {
        const double cosine =
            side % 2 ? f->spoke[s].along[side / 2] : -f->spoke[s].along[side / 2];
        if (!(*used >> s & 1) && is_side_of(f, side, &f->spoke[s])) {
            *used |= 1u << s;
            return edge_weight * acos(fmax(-1, fmin(1, cosine)));
        }
    }
    return INFINITY;
}

/* Whether octant o can have that label at the node that is tried. */
static bool may_have(const finder *f, unsigned o, unsigned k)
{
    const uint32_t *around = f->layout->lattice.leaf[f->node];
    const uint32_t leaf = around[o], label = f->label[k];
    if (leaf == TM_NONE)
        return label == 0;
    if ((f->layout->fixed[leaf] ||
         tm_node_lattice_is_large(&f->layout->lattice, leaf, f->size)) &&
        f->layout->interior->label[leaf] != label)
        return false;
    for (unsigned i = 0; i < o; i++)
        if (around[i] == leaf && f->given[i] != k)
            return false;
    return true;
}

/* Gives octants from o on labels, in all ways that cost less than the best so far. */
static void give(finder *f, unsigned o, double cost, unsigned used)
{
    /* The side that is complete with octant o. */
    static const uint8_t complete[OCTANTS + 1] = {SIDES, SIDES, SIDES, SIDES, 4,
                                                  SIDES, 2,     0,     SIDES};
    if (f->steps++ > MOST_STEPS)
        return;
    if (o <= OCTANTS && complete[o] < SIDES)
        cost += side_cost(f, complete[o], &used);
    if (!(cost < f->least))
        return;
    if (o < OCTANTS) {
        for (unsigned k = 0; k < f->labels; k++)
            if (may_have(f, o, k)) {
                f->given[o] = k;
                give(f, o + 1, cost + f->octant_cost[o][k], used);
            }
        return;
    }
    for (unsigned side = 1; side < SIDES; side += 2)
        cost += side_cost(f, side, &used);
    if (!(cost < f->least) || used != (1u << f->spokes) - 1 ||
        !tm_octants_are_good(f->given, f->labels))
        return;
    f->least = cost;
    f->best_node = f->node;
    memcpy(f->best, f->given, sizeof f->best);
}

/* Tries the nodes near the corner, the closest first. */
static void try_nodes(finder *f, const uint32_t *near, unsigned count)
{
    const tm_octree *octree = f->layout->lattice.octree;
    double away[TM_NEAR_NODES];
    for (unsigned i = 0; i < count; i++) {
        double at[3];
        tm_octree_point(octree, octree->grid[near[i]], at);
        away[i] = sqrt(tm_distance2(at, f->point)) /
                  tm_node_lattice_size(&f->layout->lattice, near[i]);
        away[i] += f->layout->history[near[i]];
    }
    f->least = INFINITY;
    f->steps = 0;
    for (unsigned tried = 0; tried < count; tried++) {
        unsigned next = 0;
        for (unsigned i = 1; i < count; i++)
            if (away[i] < away[next])
                next = i;
        f->node = near[next];
        if (!(distance_weight * away[next] < f->least))
            break;
        if (!f->layout->taken[f->node]) {
            look_at_octants(f);
            give(f, 0, distance_weight * away[next], 0);
        }
        away[next] = INFINITY;
    }
}

static void lay_corner(finder *f, uint32_t corner, const end_of_curve *end, size_t count)
{
    enum { STEPS = 2 };
    const double within = 0.6; /* of the smallest leaf there */
    tm_region_layout *layout = f->layout;
    uint32_t near[TM_NEAR_NODES];
    f->point = layout->surface->xyz[layout->surface->corner[corner]];
    const unsigned nodes = tm_node_lattice_near(&layout->lattice, f->point, STEPS, near);
    if (nodes == 0 || !list_spokes(f, end, count) ||
        !look_around(f, within * tm_node_lattice_size(&layout->lattice, near[0])))
        return;
    try_nodes(f, near, nodes);
    if (!(f->least < INFINITY))
        return;
    layout->corner_node[corner] = f->best_node;
    layout->taken[f->best_node] = true;
    for (unsigned s = 0; s < f->spokes; s++)
        layout->sharp[f->best_node] |= layout->sectors.sharp[f->spoke[s].curve];
    for (unsigned o = 0; o < OCTANTS; o++)
        if (layout->lattice.leaf[f->best_node][o] != TM_NONE)
            tm_region_lay(layout, layout->lattice.leaf[f->best_node][o],
                          f->label[f->best[o]]);
}

/* Lists the ends of curves where walls meet, corner by corner. */
static size_t list_ends(const tm_region_layout *layout, end_of_curve *end)
{
    const tm_surface *s = layout->surface;
    size_t count = 0;
    for (uint32_t c = 0; c < s->curves; c++)
        for (int ends = 0; tm_curve_is_of_walls(s, c) && ends < 2; ends++) {
            const size_t at = ends ? s->curve_start[c + 1] - 1 : s->curve_start[c];
            const uint32_t corner = layout->corner_at[s->curve_node[at]];
            if (corner != TM_NONE)
                end[count++] = (end_of_curve){corner, c, ends == 1};
        }
    if (count > 0)
        qsort(end, count, sizeof *end, compare_ends);
    return count;
}

tm_status tm_region_lay_corners(tm_region_layout *layout, tm_error *error)
{
    const tm_surface *s = layout->surface;
    end_of_curve *end = tm_new(2 * s->curves, sizeof *end);
    if (!end)
        return tm_fail_memory(error);
    for (size_t k = 0; k < s->corners; k++)
        layout->corner_node[k] = TM_NONE;
    const size_t count = list_ends(layout, end);
    finder f = {.layout = layout};
    find_directions(&f);
    for (size_t i = 0, next; i < count; i = next) {
        next = i;
        while (next < count && end[next].corner == end[i].corner)
            next++;
        lay_corner(&f, end[i].corner, end + i, next - i);
    }
    free(end);
    return TM_OK;
}
