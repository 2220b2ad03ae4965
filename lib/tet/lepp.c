/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "lepp.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "edge_removal.h"
#include "star_insertion.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* On one target swap-centroid swaps at so many stars at most, then only inserts: swaps
 * alone may undo each other for ever, insertions end as bisection does. */
enum { SWAPS_PER_TARGET = 64 };

/* What is remembered of each tetrahedron. */
typedef struct {
    double quality;  /* by options->measure */
    uint8_t longest; /* edge 0 … 5 */
    bool bad;
    bool queued; /* in the list of the next pass */
} tet_state;

/* A step of the path: the tetrahedron and its longest edge, and how far the star of that
 * has been searched for the next step. */
typedef struct {
    uint32_t t;
    uint32_t a, b;
    tm_star star;
    size_t searched;
    size_t operations; /* done when the star was collected; SIZE_MAX: not collected */
} path_step;

typedef struct {
    tm_tet_mesh *mesh;
    const tm_lepp_options *options;
    tm_lepp_report *report;
    tm_error *error;
    double bad_below;
    tet_state *state; /* [mesh->slots] */
    size_t state_room;
    tm_edge_map blocked; /* the non-refinable edges */
    tm_edge_map refused; /* those whose star has not changed since it was refused */
    path_step *path;     /* [path_room]; the stars keep their memory */
    size_t depth, path_room;
    size_t operations;
    uint32_t *target; /* S */
    size_t targets, target_room;
    tm_edge_removal removal;
    uint32_t *created;
    size_t created_room;
} engine;

/* What is to be done with a terminal star. */
typedef enum { REFUSE, REMOVE_EDGE, INSERT_CENTROID, INSERT_MIDPOINT } operation;

static size_t bin(size_t value, size_t bins)
{
    return value < bins ? value : bins - 1;
}

/* The longest edge of a tetrahedron, 0 … 5. */
static uint8_t longest_edge(const tm_tet_mesh *mesh, uint32_t t)
{
    const uint32_t *n = mesh->tet[t];
    unsigned longest = 0;
    double longest_length = -1;
    uint64_t longest_key = 0;
    for (unsigned e = 0; e < 6; e++) {
        uint32_t a = n[tm_edge_corner[e][0]], b = n[tm_edge_corner[e][1]];
        double length = tm_distance2(mesh->xyz[a], mesh->xyz[b]);
        if (length < longest_length)
            continue;
        uint64_t key = tm_edge_key(a, b);
        if (length > longest_length || key > longest_key) {
            longest = e;
            longest_length = length;
            longest_key = key;
        }
    }
    return (uint8_t)longest;
}

static void measure(engine *e, uint32_t t)
{
    const tm_tet_mesh *mesh = e->mesh;
    const uint32_t *n = mesh->tet[t];
    const double *a = mesh->xyz[n[0]], *b = mesh->xyz[n[1]];
    const double *c = mesh->xyz[n[2]], *d = mesh->xyz[n[3]];
    double sine2 = tm_tet_sine2(a, b, c, d);
    tet_state *state = &e->state[t];
    state->quality = e->options->measure == TM_MEASURE_DIHEDRAL
                         ? sine2
                         : tm_tet_measure_of(e->options->measure, a, b, c, d);
    state->bad = sine2 < e->bad_below;
    state->longest = longest_edge(mesh, t);
    state->queued = false;
}

/* Whether the longest edge of t is a b; its nodes in *c and *d. */
static bool has_longest(const engine *e, uint32_t t, uint32_t a, uint32_t b, uint32_t *c,
                        uint32_t *d)
{
    const uint8_t *corner = tm_edge_corner[e->state[t].longest];
    *c = e->mesh->tet[t][corner[0]];
    *d = e->mesh->tet[t][corner[1]];
    return (*c == a && *d == b) || (*c == b && *d == a);
}

static bool push(engine *e, uint32_t t)
{
    if (e->depth == e->path_room) {
        path_step *path = tm_grow(e->path, &e->path_room, e->depth + 1, sizeof *path);
        if (!path)
            return false;
        e->path = path;
        memset(path + e->depth, 0, (e->path_room - e->depth) * sizeof *path);
    }
    path_step *step = &e->path[e->depth++];
    step->t = t;
    has_longest(e, t, 0, 0, &step->a, &step->b);
    step->operations = SIZE_MAX;
    return true;
}

static bool add_target(engine *e, uint32_t t)
{
    uint32_t *target =
        tm_grow(e->target, &e->target_room, e->targets + 1, sizeof *target);
    if (!target)
        return false;
    e->target = target;
    target[e->targets++] = t;
    return true;
}

/* A tetrahedron around the edge of the step whose own longest edge is longer, and
 * refinable; TM_NONE where the edge is terminal. All around contain the edge, so theirs
 * is longer if it is another one. */
static uint32_t next_on_path(const engine *e, path_step *step)
{
    while (step->searched < step->star.size) {
        uint32_t t = step->star.tet[step->searched++], a, b;
        if (!has_longest(e, t, step->a, step->b, &a, &b) &&
            !tm_edge_map_has(&e->blocked, a, b))
            return t;
    }
    return TM_NONE;
}

/* How good the tetrahedra must be that replace the star. */
static double least_quality(const engine *e, const tm_star *star)
{
    if (e->options->algorithm == TM_LEPP_SWAP_CENTROID)
        return DBL_MIN;
    double worst = HUGE_VAL;
    for (size_t i = 0; i < star->size; i++)
        worst = fmin(worst, e->state[star->tet[i]].quality);
    double factor = fmax(e->options->factor, 1 + TM_LEPP_GAIN);
    double times = tm_tet_measure_times(e->options->measure, worst, factor);
    return times > 0 ? nextafter(times, HUGE_VAL) : DBL_MIN;
}

/* Chooses the point to insert: the centroid where it is allowed and valid, else the
 * midpoint. REFUSE where that is not valid either. */
static operation choose_point(engine *e, const tm_star *star, double p[3])
{
    const tm_tet_mesh *mesh = e->mesh;
    if (tm_star_is_free(mesh, star)) {
        tm_star_centroid(mesh, star, p);
        if (tm_star_sees(mesh, star, p))
            return INSERT_CENTROID;
        if (tm_star_contains(mesh, star, p))
            e->report->tangled++;
        else
            e->report->outside++;
    }
    tm_star_midpoint(mesh, star, p);
    return tm_star_sees(mesh, star, p) ? INSERT_MIDPOINT : REFUSE;
}

/* The better of the best edge removal and the insertion, if it is good enough. */
static operation choose(engine *e, const tm_star *star, bool may_swap, double p[3])
{
    const tm_tet_mesh *mesh = e->mesh;
    if (tm_edge_map_has(&mesh->locked, star->a, star->b) ||
        !tm_star_is_simple(mesh, star)) {
        e->report->locked++;
        return REFUSE;
    }
    double least = least_quality(e, star), inserted = 0;
    if (least == HUGE_VAL)
        return REFUSE;
    operation insertion = choose_point(e, star, p);
    if (insertion != REFUSE)
        inserted = tm_star_insertion_quality(mesh, star, p, e->options->measure, least);
    e->report->too_large += star->closed && star->size > TM_REMOVAL_MAX;
    if (may_swap && tm_edge_is_removable(mesh, star) &&
        tm_edge_removal_plan(mesh, star, e->options->measure, fmax(least, inserted),
                             &e->removal))
        return REMOVE_EDGE;
    return inserted >= least ? insertion : REFUSE;
}

static void count_star(engine *e, const tm_star *star, operation chosen)
{
    tm_lepp_report *r = e->report;
    size_t size = bin(star->size, TM_LEPP_SIZES);
    bool is_free = tm_star_is_free(e->mesh, star);
    r->closed += star->closed;
    r->open += !star->closed;
    if (star->closed)
        r->closed_size[size]++;
    else
        r->open_size[size]++;
    r->refused_closed += chosen == REFUSE && star->closed;
    r->refused_open += chosen == REFUSE && !star->closed;
    r->swaps += chosen == REMOVE_EDGE;
    r->swap_size[size] += chosen == REMOVE_EDGE;
    r->centroids += chosen == INSERT_CENTROID;
    r->midpoints += chosen == INSERT_MIDPOINT && is_free;
    r->open_midpoints += chosen == INSERT_MIDPOINT && !is_free;
    r->insertion_size[size] +=
        star->closed && (chosen == INSERT_CENTROID || chosen == INSERT_MIDPOINT);
}

static void forget_refusal(engine *e, uint32_t a, uint32_t b)
{
    tm_edge_map_remove(&e->blocked, a, b);
    tm_edge_map_remove(&e->refused, a, b);
}

/* Frees the edges of the tetrahedra that an operation made. Those that it made new were
 * never blocked, and the one it removed was not: a path does not lead there. */
static void unblock(engine *e, const tm_star *star)
{
    for (size_t i = 0; i <= star->size; i++) {
        forget_refusal(e, star->a, star->ring[i]);
        forget_refusal(e, star->b, star->ring[i]);
        if (i < star->size)
            forget_refusal(e, star->ring[i], star->ring[i + 1]);
    }
}

/* Room in the engine's arrays for what an operation on the star makes. */
static bool reserve(engine *e, const tm_star *star)
{
    size_t most = 2 * star->size;
    tet_state *state =
        tm_grow(e->state, &e->state_room, e->mesh->slots + most, sizeof *state);
    if (state)
        e->state = state;
    uint32_t *created = tm_grow(e->created, &e->created_room, most, sizeof *created);
    if (created)
        e->created = created;
    return state && created;
}

/* Changes the star as chosen; measures what was made. */
static tm_status change(engine *e, const tm_star *star, operation chosen,
                        const double p[3])
{
    if (!reserve(e, star))
        return tm_fail_memory(e->error);
    size_t made = 2 * star->size;
    tm_status status;
    if (chosen == REMOVE_EDGE) {
        made -= 4;
        status = tm_edge_removal_apply(e->mesh, star, &e->removal, e->created, e->error);
    } else {
        status = tm_star_insert(e->mesh, star, p, chosen == INSERT_MIDPOINT, e->created,
                                e->error);
    }
    if (status != TM_OK)
        return status;
    unblock(e, star);
    e->operations++;
    for (size_t i = 0; i < made; i++) {
        measure(e, e->created[i]);
        if (e->options->stop == TM_LEPP_CONVERGED && e->state[e->created[i]].bad &&
            !add_target(e, e->created[i]))
            return tm_fail_memory(e->error);
    }
    return TM_OK;
}

/* The terminal star of the path: changes it, or blocks its edge. */
static tm_status process_star(engine *e, const tm_star *star, size_t visited)
{
    double p[3];
    uint32_t a = star->a, b = star->b;
    bool may_swap =
        e->options->algorithm == TM_LEPP_SELECTIVE || visited <= SWAPS_PER_TARGET;
    if (!tm_edge_map_has(&e->refused, a, b)) {
        operation chosen = choose(e, star, may_swap, p);
        count_star(e, star, chosen);
        if (chosen != REFUSE)
            return change(e, star, chosen, p);
    }
    if (!tm_edge_map_reserve(&e->blocked, 1) || !tm_edge_map_reserve(&e->refused, 1))
        return tm_fail_memory(e->error);
    tm_edge_map_put(&e->blocked, a, b, 0);
    tm_edge_map_put(&e->refused, a, b, 0);
    return TM_OK;
}

/* Whether a step of the path still is one: its edge is not blocked, and its tetrahedron
 * lives, or another one came in its place that has the same longest edge. Collects its
 * star where an operation may have changed it. */
static bool refresh(engine *e, path_step *step, tm_status *status)
{
    uint32_t a, b;
    if (step->operations != e->operations) {
        if (!tm_tet_lives(e->mesh, step->t) ||
            !has_longest(e, step->t, step->a, step->b, &a, &b))
            return false;
    }
    if (tm_edge_map_has(&e->blocked, step->a, step->b))
        return false;
    if (step->operations != e->operations) {
        step->operations = e->operations;
        step->searched = 0;
        if (!tm_star_around(e->mesh, step->t, e->state[step->t].longest, &step->star))
            *status = tm_fail_memory(e->error);
    }
    return *status == TM_OK;
}

/* Follows the path of one target until it is gone or its longest edge is blocked. After
 * each operation the path goes on from its last step that still holds. */
static tm_status improve_target(engine *e, uint32_t target)
{
    uint32_t nodes[4];
    memcpy(nodes, e->mesh->tet[target], sizeof nodes);
    size_t visited = 0;
    tm_status status = TM_OK;
    e->depth = 0;
    if (!push(e, target))
        return tm_fail_memory(e->error);
    while (e->depth > 0 && memcmp(nodes, e->mesh->tet[target], sizeof nodes) == 0) {
        path_step *last = &e->path[e->depth - 1];
        if (!refresh(e, last, &status)) {
            if (status != TM_OK)
                return status;
            e->depth--;
            continue;
        }
        uint32_t next = next_on_path(e, last);
        if (next != TM_NONE) {
            if (!push(e, next))
                return tm_fail_memory(e->error);
            continue;
        }
        visited++;
        status = process_star(e, &last->star, visited);
        if (status != TM_OK)
            return status;
        e->depth--;
    }
    e->report->targets++;
    e->report->visited[bin(visited, TM_LEPP_VISITS)]++;
    if (visited > e->report->most_visited)
        e->report->most_visited = visited;
    return TM_OK;
}

/* One pass over S, which may grow on the way. */
static tm_status improve_all(engine *e)
{
    tm_status status = TM_OK;
    e->report->passes++;
    for (size_t i = 0; i < e->targets && status == TM_OK; i++) {
        uint32_t t = e->target[i];
        if (tm_tet_lives(e->mesh, t) && e->state[t].bad)
            status = improve_target(e, t);
    }
    return status;
}

/* S as all bad tetrahedra of the mesh. */
static tm_status find_targets(engine *e)
{
    e->targets = 0;
    for (size_t t = 0; t < e->mesh->slots; t++)
        if (tm_tet_lives(e->mesh, (uint32_t)t) && e->state[t].bad &&
            !add_target(e, (uint32_t)t))
            return tm_fail_memory(e->error);
    return TM_OK;
}

/* S as what is left of it, each once. */
static void keep_targets(engine *e)
{
    size_t kept = 0;
    for (size_t i = 0; i < e->targets; i++) {
        uint32_t t = e->target[i];
        if (!tm_tet_lives(e->mesh, t) || !e->state[t].bad || e->state[t].queued)
            continue;
        e->state[t].queued = true;
        e->target[kept++] = t;
    }
    e->targets = kept;
    for (size_t i = 0; i < kept; i++)
        e->state[e->target[i]].queued = false;
}

static size_t count_bad(const engine *e)
{
    size_t bad = 0;
    for (size_t t = 0; t < e->mesh->slots && e->state; t++)
        bad += tm_tet_lives(e->mesh, (uint32_t)t) && e->state[t].bad;
    return bad;
}

static tm_status run_passes(engine *e)
{
    tm_status status = TM_OK;
    bool idle = false;
    while (status == TM_OK && !idle && e->report->passes < e->options->passes) {
        size_t before = tm_lepp_operations(e->report);
        status = find_targets(e);
        if (status == TM_OK)
            status = improve_all(e);
        idle = tm_lepp_operations(e->report) == before;
    }
    return status;
}

/* Passes over what is left of S until one changes nothing; then all over with no edge
 * blocked, until that changes nothing either: a star that changed may lie behind an edge
 * that is still blocked. So a second run on the output finds nothing to do. */
static tm_status run_until_converged(engine *e)
{
    tm_status status = TM_OK;
    size_t fresh, before;
    do {
        fresh = tm_lepp_operations(e->report);
        tm_edge_map_clear(&e->blocked);
        status = find_targets(e);
        do {
            before = tm_lepp_operations(e->report);
            if (status == TM_OK)
                status = improve_all(e);
            keep_targets(e);
        } while (status == TM_OK && tm_lepp_operations(e->report) > before);
    } while (status == TM_OK && tm_lepp_operations(e->report) > fresh);
    return status;
}

static tm_status run(engine *e)
{
    if (e->options->stop == TM_LEPP_CONVERGED)
        return run_until_converged(e);
    if (e->options->stop == TM_LEPP_PASSES)
        return run_passes(e);
    tm_status status = find_targets(e);
    return status == TM_OK ? improve_all(e) : status;
}

tm_status tm_lepp_improve(tm_tet_mesh *mesh, const tm_lepp_options *options,
                          tm_lepp_report *report, tm_error *error)
{
    *report = (tm_lepp_report){.tets_before = mesh->tets};
    engine e = {.mesh = mesh, .options = options, .report = report, .error = error};
    e.bad_below = tm_bad_sine2(options->angle);
    tm_status status = TM_OK;
    e.state = tm_new(mesh->slots, sizeof *e.state);
    e.state_room = mesh->slots;
    if (!e.state)
        status = tm_fail_memory(error);
    for (size_t t = 0; t < mesh->slots && status == TM_OK; t++)
        if (tm_tet_lives(mesh, (uint32_t)t))
            measure(&e, (uint32_t)t);
    report->bad_before = count_bad(&e);
    if (status == TM_OK)
        status = run(&e);
    report->bad_after = count_bad(&e);
    free(e.state);
    tm_edge_map_free(&e.blocked);
    tm_edge_map_free(&e.refused);
    for (size_t i = 0; i < e.path_room; i++)
        tm_star_free(&e.path[i].star);
    free(e.path);
    free(e.target);
    free(e.created);
    return status;
}
