/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sweep.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

enum { BITS = 64 };

typedef struct {
    tm_sweep *sweep;
    void (*look)(const void *context, size_t n, uint64_t *seen);
    const void *context;
    size_t first_run, past_run; /* of which this rank has nodes */
    size_t words;
    uint64_t *seen;  /* [past_run - first_run][words]: which runs its nodes see */
    size_t *start;   /* [runs + 1] */
    uint32_t *other; /* that run r sees, or is seen by: other[start[r]] … */
    size_t *colour;  /* [runs] */
} planner;

/* This rank's nodes of a run, [*first, *past) of its own. */
static void own_of(const tm_sweep *sweep, size_t run, size_t *first, size_t *past)
{
    const size_t begin = run * TM_SWEEP_RUN, end = begin + TM_SWEEP_RUN;
    const size_t own_end = sweep->first + sweep->count;
    *first = begin > sweep->first ? begin - sweep->first : 0;
    *past = end < own_end ? (end > sweep->first ? end - sweep->first : 0) : sweep->count;
}

static void look_from(void *context, size_t i)
{
    const planner *p = context;
    size_t first, past;
    own_of(p->sweep, p->first_run + i, &first, &past);
    for (size_t n = first; n < past; n++)
        p->look(p->context, n, p->seen + i * p->words);
}

/* The pairs of runs that this rank has seen. */
static bool list_seen(const planner *p, uint32_t **list, size_t *count)
{
    size_t room = 0;
    bool done = true;
    for (size_t run = p->first_run; run < p->past_run; run++) {
        const uint64_t *seen = p->seen + (run - p->first_run) * p->words;
        for (size_t other = 0; other < p->sweep->runs && done; other++)
            if (seen[other / BITS] >> other % BITS & 1)
                done = tm_append(list, count, &room, (uint32_t)run) &&
                       tm_append(list, count, &room, (uint32_t)other);
    }
    return done;
}

/* Sorts pairs by both of their runs. */
static tm_status sort_seen(planner *p, const uint32_t *pair, size_t count,
                           tm_error *error)
{
    const size_t runs = p->sweep->runs;
    p->start = calloc(runs + 2, sizeof *p->start);
    p->other = tm_new(count, sizeof *p->other);
    if (!p->start || !p->other)
        return tm_fail_memory(error);
    for (size_t i = 0; i < count; i++)
        p->start[pair[i] + 2]++;
    for (size_t r = 0; r < runs; r++)
        p->start[r + 2] += p->start[r + 1];
    for (size_t i = 0; i < count; i++)
        p->other[p->start[pair[i] + 1]++] = pair[i ^ 1];
    return TM_OK;
}

/* What all ranks have seen. */
static tm_status share_seen(planner *p, tm_error *error)
{
    uint32_t *list = NULL;
    size_t count = 0, total = 0;
    void *got = NULL;
    tm_status status = tm_ranks_enough(list_seen(p, &list, &count), error);
    if (status == TM_OK)
        status = tm_ranks_share(list, count, sizeof *list, &got, &total, error);
    if (status == TM_OK)
        status = tm_ranks_agree(sort_seen(p, got, total, error), error);
    free(list);
    free(got);
    return status;
}

/* The first colour that no run before this one, of those that it has to do with, has. */
static size_t choose_colour(const planner *p, size_t run, size_t *taken)
{
    size_t colour = 0;
    for (size_t i = p->start[run]; i < p->start[run + 1]; i++)
        if (p->other[i] < run)
            taken[p->colour[p->other[i]]] = run;
    while (taken[colour] == run)
        colour++;
    return colour;
}

/* Colours runs, and sorts them by colour. taken[colours]: the last run that must not have
 * it. */
static void colour_runs(const planner *p, size_t *taken)
{
    tm_sweep *sweep = p->sweep;
    for (size_t run = 0; run < sweep->runs; run++)
        taken[run] = SIZE_MAX;
    for (size_t run = 0; run < sweep->runs; run++) {
        p->colour[run] = choose_colour(p, run, taken);
        if (p->colour[run] >= sweep->colours)
            sweep->colours = p->colour[run] + 1;
    }
    size_t next = 0;
    for (size_t colour = 0; colour < sweep->colours; colour++) {
        sweep->start[colour] = next;
        for (size_t run = 0; run < sweep->runs; run++)
            if (p->colour[run] == colour)
                sweep->run[next++] = run;
    }
    sweep->start[sweep->colours] = next;
}

/* Which piece of a run is this rank's, and how many pieces there are at most.
 * begin[ranks]: the first node of each rank. */
static void number_steps(const planner *p, const size_t *begin)
{
    tm_sweep *sweep = p->sweep;
    const unsigned ranks = tm_ranks_count();
    size_t *steps = sweep->first_step;
    for (size_t run = 0; run < sweep->runs; run++)
        sweep->step[run] = SIZE_MAX;
    steps[0] = 0;
    for (size_t c = 0; c < sweep->colours; c++)
        steps[c + 1] = 1;
    size_t last = SIZE_MAX, count = 0;
    for (unsigned r = 0; r < ranks; r++) {
        const size_t end = r + 1 < ranks ? begin[r + 1] : sweep->all;
        if (begin[r] == end)
            continue;
        for (size_t run = begin[r] / TM_SWEEP_RUN; run <= (end - 1) / TM_SWEEP_RUN;
             run++) {
            count = run == last ? count + 1 : 1;
            last = run;
            if (r == tm_rank())
                sweep->step[run] = count - 1;
            if (count > steps[p->colour[run] + 1])
                steps[p->colour[run] + 1] = count;
        }
    }
    for (size_t c = 0; c < sweep->colours; c++)
        steps[c + 1] += steps[c];
    for (size_t run = p->first_run; run < p->past_run; run++)
        sweep->step[run] += steps[p->colour[run]];
}

static tm_status plan(planner *p, size_t *taken, tm_error *error)
{
    tm_sweep *sweep = p->sweep;
    void *begin = NULL;
    if (sweep->runs > 1)
        tm_parallel(sweep->threads, p->past_run - p->first_run, look_from, p);
    tm_status status = share_seen(p, error);
    if (status == TM_OK)
        status =
            tm_ranks_share(&sweep->first, 1, sizeof sweep->first, &begin, NULL, error);
    if (status == TM_OK) {
        colour_runs(p, taken);
        number_steps(p, begin);
    }
    free(begin);
    return status;
}

tm_status tm_sweep_plan(tm_sweep *sweep, size_t count, unsigned threads,
                        void (*look)(const void *context, size_t n, uint64_t *seen),
                        const void *context, tm_error *error)
{
    size_t all;
    const size_t first = tm_ranks_before(count, &all);
    const size_t runs = tm_parallel_chunks(all, TM_SWEEP_RUN);
    *sweep = (tm_sweep){.first = first,
                        .count = count,
                        .all = all,
                        .runs = runs,
                        .threads = threads,
                        .start = tm_new(runs + 1, sizeof *sweep->start),
                        .run = tm_new(runs, sizeof *sweep->run),
                        .first_step = tm_new(runs + 1, sizeof *sweep->first_step),
                        .step = tm_new(runs, sizeof *sweep->step)};
    planner p = {.sweep = sweep,
                 .look = look,
                 .context = context,
                 .first_run = count > 0 ? first / TM_SWEEP_RUN : 0,
                 .past_run = count > 0 ? (first + count - 1) / TM_SWEEP_RUN + 1 : 0,
                 .words = tm_parallel_chunks(runs, BITS),
                 .colour = tm_new(runs, sizeof *p.colour)};
    p.seen = calloc((p.past_run - p.first_run) * p.words + 1, sizeof *p.seen);
    size_t *taken = tm_new(runs, sizeof *taken);
    tm_status status = tm_ranks_enough(sweep->start && sweep->run && sweep->first_step &&
                                           sweep->step && p.colour && p.seen && taken,
                                       error);
    if (status == TM_OK)
        status = plan(&p, taken, error);
    free(p.start);
    free(p.other);
    free(p.colour);
    free(p.seen);
    free(taken);
    return status;
}

void tm_sweep_free(tm_sweep *sweep)
{
    free(sweep->start);
    free(sweep->run);
    free(sweep->first_step);
    free(sweep->step);
    *sweep = (tm_sweep){0};
}

/* Ghosts ---------------------------------------------------------------------------- */

/* Those of one step after the other: step[nodes of the mesh]. */
static tm_status cut_ghosts(const tm_mesh_ghosts *ghosts, size_t nodes,
                            const uint32_t *step, bool *kept, tm_mesh_ghosts *by_step,
                            size_t steps, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t s = 0; s < steps && status == TM_OK; s++) {
        for (size_t n = 0; n < nodes; n++)
            kept[n] = step[n] == s;
        status = tm_mesh_ghosts_some(&by_step[s], ghosts, kept, error);
    }
    return status;
}

tm_status tm_sweep_cut_ghosts(const tm_sweep *sweep, const tm_mesh_ghosts *ghosts,
                              size_t nodes, size_t first, const uint32_t *node,
                              tm_mesh_ghosts **by_step, tm_error *error)
{
    const size_t steps = tm_sweep_steps(sweep);
    uint32_t *step = tm_new(nodes, sizeof *step);
    bool *kept = tm_new(nodes, sizeof *kept);
    *by_step = calloc(steps + 1, sizeof **by_step);
    tm_status status = tm_ranks_enough(step && kept && *by_step, error);
    for (size_t n = 0; n < nodes && status == TM_OK; n++)
        step[n] = TM_NONE;
    for (size_t n = 0; n < sweep->count && status == TM_OK; n++)
        step[node ? node[n] : first + n] =
            (uint32_t)sweep->step[(sweep->first + n) / TM_SWEEP_RUN];
    if (status == TM_OK)
        tm_mesh_ghosts_fill(ghosts, step, sizeof *step);
    if (status == TM_OK)
        status = cut_ghosts(ghosts, nodes, step, kept, *by_step, steps, error);
    free(step);
    free(kept);
    return status;
}

void tm_sweep_free_ghosts(const tm_sweep *sweep, tm_mesh_ghosts *by_step)
{
    for (size_t s = 0; by_step && s < tm_sweep_steps(sweep); s++)
        tm_mesh_ghosts_free(&by_step[s]);
    free(by_step);
}

/* Sweeping -------------------------------------------------------------------------- */

typedef struct {
    const tm_sweep *sweep;
    size_t first; /* of this colour */
    size_t step;
    void (*work)(void *context, size_t first, size_t past);
    void *context;
} sweeping;

static void work_on(void *context, size_t i)
{
    const sweeping *s = context;
    const size_t run = s->sweep->run[s->first + i];
    size_t first, past;
    if (s->sweep->step[run] != s->step)
        return;
    own_of(s->sweep, run, &first, &past);
    s->work(s->context, first, past);
}

void tm_sweep_make(const tm_sweep *sweep,
                   void (*work)(void *context, size_t first, size_t past),
                   void (*exchange)(void *context, size_t step), void *context)
{
    sweeping s = {.sweep = sweep, .work = work, .context = context};
    for (size_t colour = 0; colour < sweep->colours; colour++) {
        s.first = sweep->start[colour];
        for (s.step = sweep->first_step[colour]; s.step < sweep->first_step[colour + 1];
             s.step++) {
            tm_parallel(sweep->threads, sweep->start[colour + 1] - s.first, work_on, &s);
            if (tm_ranks_count() > 1)
                exchange(context, s.step);
        }
    }
}
