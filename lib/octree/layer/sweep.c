/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sweep.h"

#include "../../base/array.h"
#include "../../base/parallel.h"

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

static size_t end_of(const tm_sweep *sweep, size_t run)
{
    const size_t end = (run + 1) * TM_SWEEP_RUN;
    return end < sweep->count ? end : sweep->count;
}

static void look_from(void *context, size_t run)
{
    const planner *p = context;
    for (size_t n = run * TM_SWEEP_RUN; n < end_of(p->sweep, run); n++)
        p->look(p->context, n, p->seen + run * p->words);
}

static bool sees(const planner *p, size_t run, size_t other)
{
    return p->seen[run * p->words + other / BITS] >> other % BITS & 1;
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

tm_status tm_sweep_plan(tm_sweep *sweep, size_t count, unsigned threads,
                        void (*look)(const void *context, size_t n, uint64_t *seen),
                        const void *context, tm_error *error)
{
    const size_t runs = tm_parallel_chunks(count, TM_SWEEP_RUN);
    *sweep = (tm_sweep){.count = count,
                        .runs = runs,
                        .threads = threads,
                        .start = tm_new(runs + 1, sizeof *sweep->start),
                        .run = tm_new(runs, sizeof *sweep->run)};
    planner p = {.sweep = sweep,
                 .look = look,
                 .context = context,
                 .words = tm_parallel_chunks(runs, BITS),
                 .colour = tm_new(runs, sizeof *p.colour)};
    p.seen = calloc(runs * p.words + 1, sizeof *p.seen);
    size_t *taken = tm_new(runs, sizeof *taken);
    const bool done = sweep->start && sweep->run && p.colour && p.seen && taken;
    if (done && runs > 1)
        tm_parallel(threads, runs, look_from, &p);
    if (done)
        colour_runs(&p, taken);
    free(p.colour);
    free(p.seen);
    free(taken);
    return done ? TM_OK : tm_fail_memory(error);
}

void tm_sweep_free(tm_sweep *sweep)
{
    free(sweep->start);
    free(sweep->run);
    *sweep = (tm_sweep){0};
}

typedef struct {
    const tm_sweep *sweep;
    size_t first; /* of this colour */
    void (*work)(void *context, size_t first, size_t past);
    void *context;
} sweeping;

static void work_on(void *context, size_t i)
{
    const sweeping *s = context;
    const size_t run = s->sweep->run[s->first + i];
    s->work(s->context, run * TM_SWEEP_RUN, end_of(s->sweep, run));
}

void tm_sweep_make(const tm_sweep *sweep,
                   void (*work)(void *context, size_t first, size_t past), void *context)
{
    sweeping s = {.sweep = sweep, .work = work, .context = context};
    for (size_t colour = 0; colour < sweep->colours; colour++) {
        s.first = sweep->start[colour];
        tm_parallel(sweep->threads, sweep->start[colour + 1] - s.first, work_on, &s);
    }
}
