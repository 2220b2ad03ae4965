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
    uint64_t *seen; /* [runs][words]: which runs a run sees, or is seen by */
    size_t words;
    size_t *colour; /* [runs] */
} planner;

/* This rank's nodes of a run, [*first, *past) of its own. */
static void own_of(const tm_sweep *sweep, size_t run, size_t *first, size_t *past)
{
    const size_t begin = run * TM_SWEEP_RUN, end = begin + TM_SWEEP_RUN;
    const size_t own_end = sweep->first + sweep->count;
    *first = begin > sweep->first ? begin - sweep->first : 0;
    *past = end < own_end ? (end > sweep->first ? end - sweep->first : 0) : sweep->count;
}

static void look_from(void *context, size_t run)
{
    const planner *p = context;
    size_t first, past;
    own_of(p->sweep, run, &first, &past);
    for (size_t n = first; n < past; n++)
        p->look(p->context, n, p->seen + run * p->words);
}

static bool sees(const planner *p, size_t run, size_t other)
{
    return p->seen[run * p->words + other / BITS] >> other % BITS & 1;
}

/* What all ranks have seen: pairs of runs. */
static tm_status share_seen(const planner *p, tm_error *error)
{
    uint32_t *list = NULL;
    size_t count = 0, room = 0, total = 0;
    bool done = true;
    for (size_t run = 0; run < p->sweep->runs && done; run++)
        for (size_t other = 0; other < p->sweep->runs && done; other++)
            if (sees(p, run, other))
                done = tm_append(&list, &count, &room, (uint32_t)run) &&
                       tm_append(&list, &count, &room, (uint32_t)other);
    void *got = NULL;
    tm_status status = done ? TM_OK : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tm_ranks_share(list, count, sizeof *list, &got, &total, error);
    const uint32_t *pair = got;
    for (size_t i = 0; status == TM_OK && i + 1 < total; i += 2)
        p->seen[pair[i] * p->words + pair[i + 1] / BITS] |= (uint64_t)1
                                                            << pair[i + 1] % BITS;
    free(list);
    free(got);
    return status;
}

/* The first colour that no run before this one, of those that it has to do with, has. */
static size_t choose_colour(const planner *p, size_t run, size_t *taken)
{
    size_t colour = 0;
    for (size_t other = 0; other < run; other++)
        if (sees(p, run, other) || sees(p, other, run))
            taken[p->colour[other]] = run;
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
    size_t *pieces = p->colour; /* for the colours are known: of a run's colour */
    for (size_t run = 0; run < sweep->runs; run++)
        sweep->step[run] = SIZE_MAX;
    for (size_t c = 0; c < sweep->colours; c++)
        sweep->steps[c] = 1;
    for (size_t c = 0; c < sweep->colours; c++)
        for (size_t i = sweep->start[c]; i < sweep->start[c + 1]; i++)
            pieces[sweep->run[i]] = c;
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
            if (count > sweep->steps[pieces[run]])
                sweep->steps[pieces[run]] = count;
        }
    }
}

static tm_status plan(planner *p, size_t *taken, tm_error *error)
{
    tm_sweep *sweep = p->sweep;
    void *begin = NULL;
    if (sweep->runs > 1)
        tm_parallel(sweep->threads, sweep->runs, look_from, p);
    tm_status status = tm_ranks_count() > 1 ? share_seen(p, error) : TM_OK;
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
                        .steps = tm_new(runs, sizeof *sweep->steps),
                        .step = tm_new(runs, sizeof *sweep->step)};
    planner p = {.sweep = sweep,
                 .look = look,
                 .context = context,
                 .words = tm_parallel_chunks(runs, BITS),
                 .colour = tm_new(runs, sizeof *p.colour)};
    p.seen = calloc(runs * p.words + 1, sizeof *p.seen);
    size_t *taken = tm_new(runs, sizeof *taken);
    tm_status status = TM_OK;
    if (!sweep->start || !sweep->run || !sweep->steps || !sweep->step || !p.colour ||
        !p.seen || !taken)
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = plan(&p, taken, error);
    free(p.colour);
    free(p.seen);
    free(taken);
    return status;
}

void tm_sweep_free(tm_sweep *sweep)
{
    free(sweep->start);
    free(sweep->run);
    free(sweep->steps);
    free(sweep->step);
    *sweep = (tm_sweep){0};
}

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

tm_status tm_sweep_make(const tm_sweep *sweep,
                        void (*work)(void *context, size_t first, size_t past),
                        tm_status (*exchange)(void *context, tm_error *error),
                        void *context, tm_error *error)
{
    sweeping s = {.sweep = sweep, .work = work, .context = context};
    tm_status status = TM_OK;
    for (size_t colour = 0; colour < sweep->colours; colour++) {
        s.first = sweep->start[colour];
        for (s.step = 0; s.step < sweep->steps[colour] && status == TM_OK; s.step++) {
            tm_parallel(sweep->threads, sweep->start[colour + 1] - s.first, work_on, &s);
            if (tm_ranks_count() > 1)
                status = exchange(context, error);
        }
    }
    return status;
}
