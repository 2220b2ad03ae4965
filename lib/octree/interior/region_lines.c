/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The line of a curve is the cheapest way through states: a node, and sectors for the
 * octants around it (E. W. Dijkstra, 1959). A step goes along an edge, whose four leaves
 * are around both of its ends: of states with the same of these only one is kept. */
#include "region_layout.h"

#include "../../base/array.h"
#include "../../base/hash.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OCTANTS = 8, SIDES = 6 };

/* In shortest edges there: how far from its curve a line may be, how far from the end of
 * the curve one that has no node for its corner may end. */
static const double tube = 2.5, loose_end = 2;

/* What a step costs where octants and curve are as they should be; what the squares of
 * distances cost, in shortest edges; and about what a line costs by the length of its
 * curve, which leads the search (P. E. Hart, N. J. Nilsson and B. Raphael, A*, 1968). */
static const double step_cost = 0.3, distance_weight = 0.25, octant_weight = 0.5,
                    length_cost = 0.7;

/* A node as the line of one curve sees it. */
typedef struct {
    uint32_t node;
    bool near;
    double distance, param; /* to the curve in shortest edges; along it */
    double size;            /* shortest edge */
    uint32_t row;           /* of its states */
    uint8_t may[OCTANTS];   /* bit s: octant may be in sector s */
    uint8_t same[OCTANTS];  /* the first octant in the same leaf */
    float beside[OCTANTS][TM_SECTORS];
} view;

typedef struct {
    tm_region_layout *layout;
    tm_error *error;
    uint32_t *view_of; /* [nodes]: where view[view_of[n]].node is n */
    size_t views, view_room;
    view *view;
    tm_line_states states;
    double *length; /* along the curve up to each of its nodes */
    size_t length_room;
    /* of the curve */
    uint32_t curve;
    unsigned sectors;
    double total;
    bool closed;
    /* of the search */
    double middle, half; /* of the length where it may go */
    uint32_t goal;       /* a node; or TM_NONE: near goal_param */
    unsigned goal_side;  /* from which it is reached; SIDES: any */
    double goal_param;
} finder;

static const tm_line_patterns *patterns_of(const finder *f)
{
    return &f->layout->patterns[f->sectors - 3];
}

static double along_curve(const finder *f, double a, double b)
{
    const double d = fabs(a - b);
    return f->closed && d > f->total / 2 ? f->total - d : d;
}

/* Enters a state that costs so much, if none as cheap is there. */
static tm_status reach(finder *f, view *v, uint32_t pattern, uint32_t from, double cost)
{
    const tm_line_patterns *patterns = patterns_of(f);
    const tm_line_pattern *p = &patterns->pattern[pattern];
    const tm_line_state made = {
        .node = v->node, .code = p->code, .to = p->to, .from = from, .cost = cost};
    const double left = length_cost * along_curve(f, v->param, f->goal_param) / v->size;
    return tm_line_states_reach(&f->states, patterns->ends, p->end, &v->row, &made, left,
                                f->error);
}

/* Whether the leaf of an octant has a label that it keeps. */
static bool is_given(const tm_region_layout *layout, uint32_t leaf, double size)
{
    return leaf == TM_NONE || layout->fixed[leaf] ||
           tm_node_lattice_is_large(&layout->lattice, leaf, size);
}

/* Which sectors the octants around a node may be in, and how far they are from each. */
static void look_at_octants(const finder *f, view *v, const tm_sector_frame *frame,
                            const double offset[3])
{
    const tm_region_layout *layout = f->layout;
    const uint32_t *around = layout->lattice.leaf[v->node];
    const uint32_t *label = layout->sectors.label[f->curve];
    for (unsigned o = 0; o < OCTANTS; o++) {
        const uint32_t leaf = around[o];
        const bool given = is_given(layout, leaf, v->size);
        const uint32_t own = leaf == TM_NONE ? 0 : layout->interior->label[leaf];
        double direction[3];
        for (int c = 0; c < 3; c++)
            direction[c] = offset[c] / v->size + (o >> c & 1 ? 0.5 : -0.5);
        v->may[o] = 0;
        for (unsigned s = 0; s < f->sectors; s++) {
            if (!given || own == label[s])
                v->may[o] |= (uint8_t)(1u << s);
            v->beside[o][s] = (float)tm_sector_beside(frame, f->sectors, s, direction);
        }
        v->same[o] = 0;
        while (around[v->same[o]] != leaf)
            v->same[o]++;
    }
}

static tm_status view_node(finder *f, uint32_t node, view **found)
{
    const tm_surface *s = f->layout->surface;
    const tm_octree *octree = f->layout->lattice.octree;
    if (f->view_of[node] < f->views && f->view[f->view_of[node]].node == node) {
        *found = &f->view[f->view_of[node]];
        return TM_OK;
    }
    void *more = tm_grow(f->view, &f->view_room, f->views + 1, sizeof *f->view);
    if (!more)
        return tm_fail_memory(f->error);
    f->view = more;
    f->view_of[node] = (uint32_t)f->views;
    view *v = &f->view[f->views++];
    *v = (view){.node = node,
                .size = tm_node_lattice_size(&f->layout->lattice, node),
                .row = TM_NONE};
    double at[3], closest[3];
    size_t segment;
    tm_octree_point(octree, octree->grid[node], at);
    tm_surface_closest_on_curve(s, f->curve, at, closest, &segment);
    const size_t first = s->curve_start[f->curve] + segment;
    v->distance = sqrt(tm_distance2(at, closest)) / v->size;
    v->param =
        f->length[segment] + sqrt(tm_distance2(s->xyz[s->curve_node[first]], closest));
    v->near = v->distance <= tube;
    tm_subtract(at, at, closest);
    if (v->near)
        look_at_octants(f, v, &f->layout->sectors.frame[first], at);
    *found = v;
    return TM_OK;
}

/* What a pattern costs at a node; infinite where it cannot be. */
static double cost_of(const finder *f, const view *v, tm_line_code code)
{
    double sum = 0;
    for (unsigned o = 0; o < OCTANTS; o++) {
        const unsigned sector = tm_code_at(code, o);
        if (!(v->may[o] >> sector & 1) || tm_code_at(code, v->same[o]) != sector)
            return INFINITY;
        sum += v->beside[o][sector] * v->beside[o][sector];
    }
    return step_cost + (double)f->layout->history[v->node] +
           distance_weight * v->distance * v->distance + octant_weight * sum;
}

/* Whether the line may go by a node. */
static bool is_passable(const finder *f, const view *v)
{
    return !f->layout->taken[v->node] && v->near &&
           along_curve(f, v->param, f->middle) <= f->half + tube * v->size;
}

/* Goes on from a node towards side `to`. */
static tm_status step(finder *f, uint32_t node, tm_line_code code, unsigned to,
                      uint32_t from, double cost, bool *arrived)
{
    const tm_region_layout *layout = f->layout;
    const uint32_t next = layout->lattice.next[node][to];
    const unsigned side = to ^ 1;
    if (next == TM_NONE)
        return TM_OK;
    *arrived = next == f->goal && (f->goal_side == SIDES || f->goal_side == side);
    view *v;
    if (*arrived)
        return TM_OK;
    if (view_node(f, next, &v) != TM_OK)
        return TM_ERROR_SYSTEM;
    if (!is_passable(f, v))
        return TM_OK;
    unsigned around = 0;
    for (unsigned i = 0; i < 4; i++)
        around |= tm_code_at(code, tm_side_octants[side][i] ^ 1u << to / 2) << 2 * i;
    const tm_line_patterns *p = patterns_of(f);
    const unsigned bucket = TM_SIDE_CODES * side + around;
    for (uint32_t i = p->start[bucket]; i < p->start[bucket + 1]; i++) {
        const double more = cost_of(f, v, p->pattern[i].code);
        if (more < INFINITY && reach(f, v, i, from, cost + more) != TM_OK)
            return TM_ERROR_SYSTEM;
    }
    return TM_OK;
}

/* Whether a line may end with a state where there is no goal. */
static bool is_at_end(finder *f, const tm_line_state *s)
{
    const view *v = &f->view[f->view_of[s->node]];
    return f->goal == TM_NONE &&
           along_curve(f, v->param, f->goal_param) <= loose_end * v->size;
}

/* Searches from the states that are there; *last becomes the one at the end, TM_NONE
 * where the end is not reached. */
static tm_status search(finder *f, uint32_t *last)
{
    *last = TM_NONE;
    for (uint32_t i; (i = tm_line_states_next(&f->states)) != TM_NONE;) {
        const tm_line_state s = f->states.state[i];
        bool arrived = is_at_end(f, &s);
        if (!arrived && step(f, s.node, s.code, s.to, i, s.cost, &arrived) != TM_OK)
            return TM_ERROR_SYSTEM;
        if (arrived) {
            *last = i;
            return TM_OK;
        }
    }
    return TM_OK;
}

static void clear(finder *f)
{
    tm_line_states_clear(&f->states);
    f->views = 0;
}

/* Gives the leaves around the node of a state their labels. */
static void lay_state(const finder *f, const tm_line_state *s)
{
    tm_region_layout *layout = f->layout;
    const uint32_t *label = layout->sectors.label[f->curve];
    layout->taken[s->node] = true;
    layout->sharp[s->node] = layout->sectors.sharp[f->curve];
    for (unsigned o = 0; o < OCTANTS; o++) {
        const uint32_t leaf = layout->lattice.leaf[s->node][o];
        if (leaf != TM_NONE && !layout->fixed[leaf])
            tm_region_lay(layout, leaf, label[tm_code_at(s->code, o)]);
    }
}

/* The same of all states up to the last one. */
static void lay_states(const finder *f, uint32_t last)
{
    for (uint32_t i = last; i != TM_NONE; i = f->states.state[i].from)
        lay_state(f, &f->states.state[i]);
}

/* All that a search saw at its nodes, and that may change, after the hash of its ends. */
static uint64_t look_again(const finder *f, const tm_laid_line *line, uint64_t hash)
{
    const tm_region_layout *layout = f->layout;
    for (size_t i = 0; i < line->nodes; i++) {
        const uint32_t node = line->node[i];
        const double size = tm_node_lattice_size(&layout->lattice, node);
        uint32_t history;
        memcpy(&history, &layout->history[node], sizeof history);
        hash = tm_hash(hash, (uint64_t)history << 1 | layout->taken[node]);
        for (unsigned o = 0; o < OCTANTS; o++) {
            const uint32_t leaf = layout->lattice.leaf[node][o];
            const bool given = is_given(layout, leaf, size);
            const uint32_t own = leaf == TM_NONE ? 0 : layout->interior->label[leaf];
            hash = tm_hash(hash, given ? own + UINT64_C(1) : 0);
        }
    }
    return hash;
}

/* Keeps what was found, and what was seen for it. */
static tm_status keep_line(const finder *f, tm_laid_line *line, uint64_t hash,
                           uint32_t last)
{
    line->nodes = line->states = 0;
    for (uint32_t i = last; i != TM_NONE; i = f->states.state[i].from)
        line->states++;
    void *node = tm_grow(line->node, &line->node_room, f->views, sizeof *line->node);
    line->node = node ? node : line->node;
    void *state =
        tm_grow(line->state, &line->state_room, line->states, sizeof *line->state);
    line->state = state ? state : line->state;
    if (!node || !state) {
        line->states = 0;
        return tm_fail_memory(f->error);
    }
    for (; line->nodes < f->views; line->nodes++)
        line->node[line->nodes] = f->view[line->nodes].node;
    size_t k = 0;
    for (uint32_t i = last; i != TM_NONE; i = f->states.state[i].from)
        line->state[k++] = f->states.state[i];
    line->seen = look_again(f, line, hash);
    return TM_OK;
}

/* Begins at a node that stands for a corner, on the side where its octants turn as the
 * sectors do; false where there is none. */
static bool find_side(const finder *f, uint32_t node, bool ends, unsigned *side,
                      tm_line_code *code)
{
    const tm_region_layout *layout = f->layout;
    for (*side = 0; *side < SIDES; ++*side) {
        unsigned turn[4], k = 0;
        *code = 0;
        for (unsigned i = 0; i < 4 && k < f->sectors; i++) {
            const unsigned o = tm_side_octants[*side][i];
            const uint32_t own = layout->interior->octant[node][o];
            for (k = 0; k < f->sectors; k++)
                if (layout->sectors.label[f->curve][k] == own)
                    break;
            turn[ends ? 3 - i : i] = k;
            *code = (tm_line_code)(*code | k << 2 * o);
        }
        if (k < f->sectors && tm_sectors_turn(turn, f->sectors))
            return true;
    }
    return false;
}

/* Begins with all patterns at all nodes near a point of the curve. */
static tm_status begin_near(finder *f, const double point[3])
{
    enum { STEPS = 2 };
    uint32_t near[TM_NEAR_NODES];
    const unsigned count = tm_node_lattice_near(&f->layout->lattice, point, STEPS, near);
    const tm_line_patterns *p = patterns_of(f);
    for (unsigned i = 0; i < count; i++) {
        view *v;
        if (view_node(f, near[i], &v) != TM_OK)
            return TM_ERROR_SYSTEM;
        if (f->layout->taken[near[i]])
            continue;
        for (uint32_t k = 0; v->near && k < p->count; k++) {
            const double cost = cost_of(f, v, p->pattern[k].code);
            if (cost < INFINITY && reach(f, v, k, TM_NONE, cost) != TM_OK)
                return TM_ERROR_SYSTEM;
        }
    }
    return TM_OK;
}

static tm_status measure(finder *f)
{
    const tm_surface *s = f->layout->surface;
    const size_t begin = s->curve_start[f->curve];
    const size_t count = s->curve_start[f->curve + 1] - begin;
    void *room = tm_grow(f->length, &f->length_room, count, sizeof *f->length);
    if (!room)
        return tm_fail_memory(f->error);
    f->length = room;
    f->length[0] = 0;
    for (size_t i = 1; i < count; i++)
        f->length[i] =
            f->length[i - 1] + sqrt(tm_distance2(s->xyz[s->curve_node[begin + i - 1]],
                                                 s->xyz[s->curve_node[begin + i]]));
    f->total = f->length[count - 1];
    return TM_OK;
}

/* The line of a curve around: half of the way to a free end, and back to where it began.
 */
static tm_status go_around(finder *f, const double start[3])
{
    uint32_t last;
    f->goal = TM_NONE;
    f->goal_param = f->total / 2;
    f->middle = f->half = f->total / 4;
    if (begin_near(f, start) != TM_OK || search(f, &last) != TM_OK)
        return TM_ERROR_SYSTEM;
    if (last == TM_NONE)
        return TM_OK;
    lay_states(f, last);
    uint32_t first = last;
    while (f->states.state[first].from != TM_NONE)
        first = f->states.state[first].from;
    const tm_line_state from = f->states.state[last], to = f->states.state[first];
    bool arrived = false;
    clear(f);
    f->goal = to.node;
    f->goal_param = 0;
    f->middle = f->total * 3 / 4;
    for (f->goal_side = 0; f->goal_side < SIDES; f->goal_side++) {
        unsigned in[4];
        for (unsigned i = 0; i < 4; i++)
            in[3 - i] = tm_code_at(to.code, tm_side_octants[f->goal_side][i]);
        if (tm_sectors_turn(in, f->sectors))
            break;
    }
    if (step(f, from.node, from.code, from.to, TM_NONE, 0, &arrived) != TM_OK)
        return TM_ERROR_SYSTEM;
    if (!arrived && search(f, &last) != TM_OK)
        return TM_ERROR_SYSTEM;
    if (!arrived && last != TM_NONE)
        lay_states(f, last);
    return TM_OK;
}

/* The line of a curve from corner to corner, whose nodes may be TM_NONE. Where all is as
 * it was when the line was found it is the same. */
static tm_status go_along(finder *f, const double start[3], uint32_t from, uint32_t to)
{
    tm_laid_line *line = &f->layout->line[f->curve];
    tm_line_code code = 0;
    unsigned side = SIDES;
    uint32_t last;
    bool arrived = false;
    f->goal = to;
    f->goal_side = SIDES;
    f->goal_param = f->total;
    f->middle = f->half = f->total / 2;
    if (to != TM_NONE && !find_side(f, to, true, &f->goal_side, &code))
        f->goal = TM_NONE;
    const bool begins = from != TM_NONE && find_side(f, from, false, &side, &code);
    uint64_t hash = tm_hash(0, (uint64_t)f->goal << 8 | f->goal_side);
    hash = tm_hash(hash, begins ? (uint64_t)from << 32 | side << 16 | code : UINT64_MAX);
    if (line->nodes > 0 && line->seen == look_again(f, line, hash)) {
        f->layout->lost += line->states == 0;
        for (size_t i = 0; i < line->states; i++)
            lay_state(f, &line->state[i]);
        return TM_OK;
    }
    if (begins ? step(f, from, code, side, TM_NONE, 0, &arrived) != TM_OK
               : begin_near(f, start) != TM_OK)
        return TM_ERROR_SYSTEM;
    if (arrived)
        return TM_OK;
    if (search(f, &last) != TM_OK || keep_line(f, line, hash, last) != TM_OK)
        return TM_ERROR_SYSTEM;
    f->layout->lost += last == TM_NONE;
    lay_states(f, last);
    return TM_OK;
}

static tm_status lay_line(finder *f, uint32_t curve)
{
    const tm_surface *s = f->layout->surface;
    const uint32_t first = s->curve_node[s->curve_start[curve]];
    const uint32_t end = s->curve_node[s->curve_start[curve + 1] - 1];
    const uint32_t from = f->layout->corner_at[first], to = f->layout->corner_at[end];
    f->curve = curve;
    f->sectors = f->layout->sectors.count[curve];
    f->closed = first == end;
    clear(f);
    if (measure(f) != TM_OK)
        return TM_ERROR_SYSTEM;
    if (f->closed && from == TM_NONE)
        return go_around(f, s->xyz[first]);
    f->closed = false;
    return go_along(f, s->xyz[first],
                    from == TM_NONE ? TM_NONE : f->layout->corner_node[from],
                    to == TM_NONE ? TM_NONE : f->layout->corner_node[to]);
}

static void free_finder(finder *f)
{
    tm_line_states_free(&f->states);
    free(f->view_of);
    free(f->view);
    free(f->length);
}

tm_status tm_region_lay_lines(tm_region_layout *layout, tm_error *error)
{
    const tm_surface *s = layout->surface;
    finder f = {.layout = layout,
                .error = error,
                .view_of = calloc(layout->lattice.octree->nodes + 1, sizeof(uint32_t))};
    tm_status status = f.view_of ? TM_OK : tm_fail_memory(error);
    for (uint32_t c = 0; status == TM_OK && c < s->curves; c++)
        if (layout->sectors.count[c] > 0)
            status = lay_line(&f, c);
    free_finder(&f);
    return status;
}
