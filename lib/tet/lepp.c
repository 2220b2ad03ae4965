/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "lepp.h"

#include "../base/array.h"
#include "../geom/space_order.h"
#include "lepp_engine.h"

#include <stdlib.h>
#include <string.h>

/* The nodes of the longest edge of t. */
static inline void longest_edge_of(const tm_lepp_engine *e, uint32_t t, uint32_t *a,
                                   uint32_t *b)
{
    const uint8_t *corner = tm_edge_corner[e->mark[t] & TM_LEPP_LONGEST];
    *a = e->mesh->tet[t][corner[0]];
    *b = e->mesh->tet[t][corner[1]];
}

static inline bool is_same_edge(uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    return (c == a && d == b) || (c == b && d == a);
}

static bool push(tm_lepp_engine *e, uint32_t t)
{
    if (e->depth == e->path_room) {
        tm_lepp_step *path = tm_grow(e->path, &e->path_room, e->depth + 1, sizeof *path);
        if (!path)
            return false;
        e->path = path;
        memset(path + e->depth, 0, (e->path_room - e->depth) * sizeof *path);
    }
    tm_lepp_step *step = &e->path[e->depth++];
    step->t = t;
    longest_edge_of(e, t, &step->a, &step->b);
    step->operations = SIZE_MAX;
    return true;
}

bool tm_lepp_add_target(tm_lepp_engine *e, uint32_t t)
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
static uint32_t next_on_path(const tm_lepp_engine *e, tm_lepp_step *step)
{
    while (step->searched < step->star.size) {
        uint32_t t = step->star.tet[step->searched++], a, b;
        longest_edge_of(e, t, &a, &b);
        if (!is_same_edge(step->a, step->b, a, b) && !tm_lepp_is_blocked(e, a, b))
            return t;
    }
    return TM_NONE;
}

/* Whether a step of the path still is one: its edge is not blocked, and its tetrahedron
 * lives, or another one came in its place that has the same longest edge. Collects its
 * star where an operation may have changed it. */
static bool refresh(tm_lepp_engine *e, tm_lepp_step *step, tm_status *status)
{
    if (step->operations != e->operations) {
        uint32_t a, b;
        if (!tm_tet_lives(e->mesh, step->t))
            return false;
        longest_edge_of(e, step->t, &a, &b);
        if (!is_same_edge(step->a, step->b, a, b))
            return false;
    }
    if (tm_lepp_is_blocked(e, step->a, step->b))
        return false;
    if (step->operations != e->operations) {
        step->operations = e->operations;
        step->searched = 0;
        if (!tm_star_around(e->mesh, step->t, e->mark[step->t] & TM_LEPP_LONGEST,
                            &step->star))
            *status = tm_fail_memory(e->error);
    }
    return *status == TM_OK;
}

/* Follows the path of one target until it is gone or its longest edge is blocked. After
 * each operation the path goes on from its last step that still holds. */
static tm_status improve_target(tm_lepp_engine *e, uint32_t target)
{
    uint32_t nodes[4];
    memcpy(nodes, e->mesh->tet[target], sizeof nodes);
    size_t visited = 0;
    tm_status status = TM_OK;
    e->depth = 0;
    if (!push(e, target))
        return tm_fail_memory(e->error);
    while (e->depth > 0 && memcmp(nodes, e->mesh->tet[target], sizeof nodes) == 0) {
        tm_lepp_step *last = &e->path[e->depth - 1];
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
        status = tm_lepp_process_star(e, &last->star, visited);
        if (status != TM_OK)
            return status;
        e->depth--;
    }
    e->report->targets++;
    e->report->visited[tm_lepp_bin(visited, TM_LEPP_VISITS)]++;
    if (visited > e->report->most_visited)
        e->report->most_visited = visited;
    return TM_OK;
}

/* One pass over S, which may grow on the way. */
static tm_status improve_all(tm_lepp_engine *e)
{
    tm_status status = TM_OK;
    e->report->passes++;
    for (size_t i = 0; i < e->targets && status == TM_OK; i++) {
        uint32_t t = e->target[i];
        if (tm_tet_lives(e->mesh, t) && (e->mark[t] & TM_LEPP_BAD))
            status = improve_target(e, t);
    }
    return status;
}

static size_t count_bad(const tm_lepp_engine *e)
{
    size_t bad = 0;
    for (size_t t = 0; t < e->mesh->slots; t++)
        bad += tm_tet_lives(e->mesh, (uint32_t)t) && (e->mark[t] & TM_LEPP_BAD);
    return bad;
}

/* S as all bad tetrahedra of the mesh, along a space-filling curve: any order will do,
 * and this one is a quarter faster. */
static tm_status find_targets(tm_lepp_engine *e)
{
    const tm_tet_mesh *mesh = e->mesh;
    tm_space space = tm_space_around((const double(*)[3])mesh->xyz, mesh->nodes);
    tm_placed *placed = tm_new(count_bad(e), sizeof *placed);
    if (!placed)
        return tm_fail_memory(e->error);
    size_t count = 0;
    for (uint32_t t = 0; t < mesh->slots; t++)
        if (tm_tet_lives(mesh, t) && (e->mark[t] & TM_LEPP_BAD))
            placed[count++] =
                (tm_placed){tm_space_place(&space, mesh->xyz[mesh->tet[t][0]]), t};
    tm_status status = TM_OK;
    if (!tm_space_sort(placed, count))
        status = tm_fail_memory(e->error);
    e->targets = 0;
    for (size_t i = 0; i < count && status == TM_OK; i++)
        if (!tm_lepp_add_target(e, placed[i].item))
            status = tm_fail_memory(e->error);
    free(placed);
    return status;
}

/* S as what is left of it, each once. */
static void keep_targets(tm_lepp_engine *e)
{
    size_t kept = 0;
    for (size_t i = 0; i < e->targets; i++) {
        uint32_t t = e->target[i];
        if (!tm_tet_lives(e->mesh, t) || !(e->mark[t] & TM_LEPP_BAD) ||
            (e->mark[t] & TM_LEPP_QUEUED))
            continue;
        e->mark[t] |= TM_LEPP_QUEUED;
        e->target[kept++] = t;
    }
    e->targets = kept;
    for (size_t i = 0; i < kept; i++)
        e->mark[e->target[i]] &= (uint8_t)~TM_LEPP_QUEUED;
}

static tm_status run_passes(tm_lepp_engine *e)
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
static tm_status run_until_converged(tm_lepp_engine *e)
{
    size_t fresh, before;
    tm_status status = find_targets(e);
    do {
        fresh = tm_lepp_operations(e->report);
        e->round++;
        do {
            before = tm_lepp_operations(e->report);
            if (status == TM_OK)
                status = improve_all(e);
            keep_targets(e);
        } while (status == TM_OK && tm_lepp_operations(e->report) > before);
    } while (status == TM_OK && tm_lepp_operations(e->report) > fresh);
    return status;
}

static tm_status run(tm_lepp_engine *e)
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
    tm_lepp_engine e = {.mesh = mesh,
                        .options = options,
                        .report = report,
                        .error = error,
                        .bad_below = tm_bad_sine2(options->angle),
                        .mark_room = mesh->slots,
                        .quality_room = mesh->slots};
    tm_status status = TM_OK;
    e.mark = tm_new(mesh->slots, sizeof *e.mark);
    e.quality = tm_new(mesh->slots, sizeof *e.quality);
    if (!e.mark || !e.quality)
        status = tm_fail_memory(error);
    for (size_t t = 0; t < mesh->slots && status == TM_OK; t++)
        if (tm_tet_lives(mesh, (uint32_t)t))
            tm_lepp_measure(&e, (uint32_t)t);
    if (status == TM_OK) {
        report->bad_before = count_bad(&e);
        /* As many edges as that are refused; later growth would cost a second table. */
        if (!tm_edge_map_reserve(&e.refused, report->bad_before))
            status = tm_fail_memory(error);
    }
    if (status == TM_OK) {
        status = run(&e);
        report->bad_after = count_bad(&e);
    }
    free(e.mark);
    free(e.quality);
    tm_edge_map_free(&e.refused);
    for (size_t i = 0; i < e.path_room; i++)
        tm_star_free(&e.path[i].star);
    free(e.path);
    free(e.target);
    free(e.created);
    return status;
}
