/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps over nodes that look at their neighbours, each as it is by then (Gauss and
 * Seidel), on several threads and ranks: nodes in a row are cut into runs, and runs that
 * see each other get different colours. Runs of a colour are swept at the same time,
 * colour by colour; what comes of it depends on the runs alone. Each rank has some nodes
 * in a row; of a run of several ranks each sweeps its piece when those before it are
 * done. */
#ifndef TM_LAYER_SWEEP_H
#define TM_LAYER_SWEEP_H

#include "../share/mesh_ghosts.h"

#include <stddef.h>
#include <stdint.h>

/* Nodes of a run; fewer are swept in their order. */
enum { TM_SWEEP_RUN = 16384 };

typedef struct tm_sweep {
    size_t first,
        count;        /* this rank's nodes have the numbers first … first + count - 1 */
    size_t all, runs; /* nodes of all ranks, and their runs */
    unsigned threads;
    size_t colours;
    size_t *start;      /* [colours + 1] */
    size_t *run;        /* [runs]: those of colour c are run[start[c]] … */
    size_t *first_step; /* [colours + 1]: of each, which has as many as the most pieces */
    size_t *step;       /* [runs]: in which this rank's piece of it is; SIZE_MAX: none */
} tm_sweep;

/* The runs that are seen, a bit for each; nodes by their numbers in all. */
static inline void tm_sweep_sees(uint64_t *seen, size_t node)
{
    enum { BITS = 64 };
    seen[node / TM_SWEEP_RUN / BITS] |= (uint64_t)1 << node / TM_SWEEP_RUN % BITS;
}

/* Plans sweeps over nodes of which this rank has `count`, behind those of the ranks
 * before it: look(context, n, seen), n = 0 … count-1, says by tm_sweep_sees() which
 * others its node n looks at; it is called for several nodes at the same time.
 * TM_ERROR_SYSTEM where memory is out; to be freed, after an error too. All ranks call
 * it. O(count), and little for each run. */
tm_status tm_sweep_plan(tm_sweep *sweep, size_t count, unsigned threads,
                        void (*look)(const void *context, size_t n, uint64_t *seen),
                        const void *context, tm_error *error);
void tm_sweep_free(tm_sweep *sweep);

/* The steps of a sweep. */
static inline size_t tm_sweep_steps(const tm_sweep *sweep)
{
    return sweep->first_step[sweep->colours];
}

/* Of ghosts, of nodes of a mesh, those that change in each step: (*by_step)[steps], with
 * which tm_sweep_free_ghosts() is called, after an error too. This rank's node n of the
 * sweep is node[n] of the mesh, or first + n where that is NULL; the mesh has `nodes`. */
tm_status tm_sweep_cut_ghosts(const tm_sweep *sweep, const tm_mesh_ghosts *ghosts,
                              size_t nodes, size_t first, const uint32_t *node,
                              tm_mesh_ghosts **by_step, tm_error *error);
void tm_sweep_free_ghosts(const tm_sweep *sweep, tm_mesh_ghosts *by_step);

/* Calls work(context, first, past) for each run, or this rank's piece of it, colour by
 * colour; of several ranks exchange(context, step) after each step, which gives others
 * what has changed in it. All ranks call it. */
void tm_sweep_make(const tm_sweep *sweep,
                   void (*work)(void *context, size_t first, size_t past),
                   void (*exchange)(void *context, size_t step), void *context);

#endif
