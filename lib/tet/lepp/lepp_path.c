/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a bad tetrahedron to terminal stars: Lepp-Simple and Lepp3D. */
#include "lepp_engine.h"

#include "../../base/array.h"

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
    step->is_terminal = false;
    if (e->depth > e->report->longest)
        e->report->longest = e->depth;
    return true;
}

/* Whether tetrahedron i around the edge of the step is one to step to: its own longest
 * edge is another one, and refinable. All around contain the edge, so theirs is longer if
 * it is another one. */
static inline bool leads_on(const tm_lepp_engine *e, const tm_lepp_step *step, size_t i)
{
    uint32_t t = step->star.tet[i];
    return !tm_lepp_is_blocked(e, t) &&
           (e->mark[t] & TM_LEPP_LONGEST) != step->star.edge[i];
}

/* A tetrahedron to step to; TM_NONE where the edge is terminal. */
static uint32_t next_on_path(const tm_lepp_engine *e, tm_lepp_step *step)
{
    while (step->searched < step->star.size) {
        size_t i = step->searched++;
        if (leads_on(e, step, i))
            return step->star.tet[i];
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
    if (tm_lepp_is_blocked(e, step->t))
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

/* Whether t comes into the Lepp3D only now. */
static bool is_new_in_graph(tm_lepp_engine *e, uint32_t t)
{
    return t >= e->graph.room || tm_tet_mark(&e->graph, t);
}

/* Pushes all tetrahedra that are to be stepped to from steps `from` and later, and from
 * those that it pushes. */
static tm_status search(tm_lepp_engine *e, size_t from)
{
    tm_status status = TM_OK;
    for (size_t s = from; s < e->depth; s++) {
        if (!refresh(e, &e->path[s], &status)) {
            if (status != TM_OK)
                return status;
            continue;
        }
        bool is_terminal = true;
        for (size_t i = 0; i < e->path[s].star.size; i++) {
            if (!leads_on(e, &e->path[s], i))
                continue;
            uint32_t t = e->path[s].star.tet[i];
            is_terminal = false;
            if (is_new_in_graph(e, t) && !push(e, t))
                return tm_fail_memory(e->error);
        }
        e->path[s].is_terminal = is_terminal;
    }
    return TM_OK;
}

/* Pushes what is to be stepped to from the last step: one tetrahedron, or all with
 * theirs. What is in the Lepp3D already is deeper in the stack; it is pushed again then,
 * and found gone or blocked later. */
static tm_status push_next(tm_lepp_engine *e, uint32_t next)
{
    size_t depth = e->depth;
    if (e->options->path == TM_LEPP_FULL) {
        tm_status status = search(e, depth - 1);
        if (status != TM_OK || e->depth > depth)
            return status;
    }
    return push(e, next) ? TM_OK : tm_fail_memory(e->error);
}

/* Pushes the whole path of the target, which is pushed. Of the tetrahedra to step to it
 * takes the last one around an edge: the thesis does not say which, and this comes
 * nearest to its figures. */
static tm_status walk(tm_lepp_engine *e)
{
    tm_status status = TM_OK;
    bool leads = true;
    while (leads && refresh(e, &e->path[e->depth - 1], &status)) {
        const tm_lepp_step *step = &e->path[e->depth - 1];
        size_t i = step->star.size;
        while (i > 0 && !leads_on(e, step, i - 1))
            i--;
        leads = i > 0;
        if (leads && !push(e, step->star.tet[i - 1]))
            return tm_fail_memory(e->error);
    }
    return status;
}

/* The first step, or the whole path or Lepp3D of the target. */
static tm_status start(tm_lepp_engine *e, uint32_t target)
{
    e->depth = 0;
    if (!push(e, target))
        return tm_fail_memory(e->error);
    if (e->options->path == TM_LEPP_FIXED)
        return walk(e);
    if (e->options->path != TM_LEPP_FULL)
        return TM_OK;
    if (!tm_tet_marks_clear(&e->graph, e->mesh->slot_room))
        return tm_fail_memory(e->error);
    tm_tet_mark(&e->graph, target);
    tm_status status = search(e, 0);
    size_t terminal = 0;
    for (size_t s = 0; s < e->depth; s++)
        terminal += e->path[s].is_terminal;
    e->report->branches[tm_lepp_bin(terminal, TM_LEPP_VISITS)]++;
    return status;
}

/* The next thing to do at the end of the path. *visited counts terminal stars; without
 * `is_needed` the target is gone, and only edges that were terminal are left to do. */
static tm_status go_on(tm_lepp_engine *e, bool is_needed, size_t *visited)
{
    tm_status status = TM_OK;
    tm_lepp_step *last = &e->path[e->depth - 1];
    if ((!is_needed && !last->is_terminal) || !refresh(e, last, &status)) {
        e->depth--;
        return status;
    }
    uint32_t next = next_on_path(e, last);
    if (next != TM_NONE && is_needed)
        return push_next(e, next);
    e->depth--; /* the step stays where it is until the next push */
    if (next != TM_NONE)
        return TM_OK;
    ++*visited;
    return tm_lepp_process_star(e, &last->star, *visited);
}

/* A tetrahedron that has the edge of a step, of those around its node a, and which edge
 * of it that is; TM_NONE where the edge is gone. */
static tm_status find_edge(tm_lepp_engine *e, const tm_lepp_step *step, uint32_t *found,
                           unsigned *edge)
{
    tm_lepp_sweeper *s = &e->sweeper;
    *found = TM_NONE;
    if (!tm_ball_around(e->mesh, s->tet_at[step->a], step->a, &s->marks, &s->ball))
        return tm_fail_memory(e->error);
    for (size_t i = 0; i < s->ball.size; i++) {
        const uint32_t *n = e->mesh->tet[s->ball.tet[i]];
        for (unsigned k = 0; k < TM_TET_EDGES; k++)
            if (is_same_edge(step->a, step->b, n[tm_edge_corner[k][0]],
                             n[tm_edge_corner[k][1]])) {
                *found = s->ball.tet[i];
                *edge = k;
                return TM_OK;
            }
    }
    return TM_OK;
}

/* TM_LEPP_FIXED: the edge of the last step, if it is still there, whether it is terminal
 * or not. */
static tm_status go_back(tm_lepp_engine *e, size_t *visited)
{
    tm_lepp_step *last = &e->path[--e->depth];
    uint32_t t;
    unsigned edge;
    tm_status status = find_edge(e, last, &t, &edge);
    if (status != TM_OK || t == TM_NONE)
        return status;
    if (!tm_star_around(e->mesh, t, edge, &last->star))
        return tm_fail_memory(e->error);
    ++*visited;
    return tm_lepp_process_star(e, &last->star, *visited);
}

/* After each operation the path goes on from its last step that still holds: what is not
 * at the star that changed is as it was (section 4.2). */
tm_status tm_lepp_follow(tm_lepp_engine *e, uint32_t target)
{
    uint32_t nodes[4];
    memcpy(nodes, e->mesh->tet[target], sizeof nodes);
    size_t visited = 0;
    tm_status status = start(e, target);
    while (e->depth > 0 && status == TM_OK) {
        bool is_needed = memcmp(nodes, e->mesh->tet[target], sizeof nodes) == 0;
        if (!is_needed && e->options->path != TM_LEPP_FULL)
            break;
        if (visited >= TM_LEPP_VISITS_MAX) {
            e->report->abandoned++;
            break;
        }
        status = e->options->path == TM_LEPP_FIXED ? go_back(e, &visited)
                                                   : go_on(e, is_needed, &visited);
    }
    e->report->targets++;
    e->report->visits += visited;
    e->report->visited[tm_lepp_bin(visited, TM_LEPP_VISITS)]++;
    if (visited > e->report->most_visited)
        e->report->most_visited = visited;
    return status;
}
