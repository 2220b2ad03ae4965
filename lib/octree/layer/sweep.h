/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps over nodes that look at their neighbours, each as it is by then (Gauss and
 * Seidel), on several threads: nodes in a row are cut into runs, and runs that see each
 * other get different colours. Runs of a colour are swept at the same time, colour by
 * colour; what comes of it depends on the runs alone. */
#ifndef TM_LAYER_SWEEP_H
#define TM_LAYER_SWEEP_H

#include "../../base/error.h"

#include <stddef.h>
#include <stdint.h>

/* Nodes of a run; fewer are swept in their order. */
enum { TM_SWEEP_RUN = 16384 };

typedef struct tm_sweep {
    size_t count, runs; /* nodes, and their runs */
    unsigned threads;
    size_t colours;
    size_t *start; /* [colours + 1] */
    size_t *run;   /* [runs]: those of colour c are run[start[c]] … */
} tm_sweep;

/* The runs that are seen, a bit for each. */
static inline void tm_sweep_sees(uint64_t *seen, size_t node)
{
    enum { BITS = 64 };
    seen[node / TM_SWEEP_RUN / BITS] |= (uint64_t)1 << node / TM_SWEEP_RUN % BITS;
}

/* Plans sweeps over nodes 0 … count-1: look(context, n, seen) says by tm_sweep_sees()
 * which others node n looks at; it is called for several nodes at the same time.
 * TM_ERROR_SYSTEM where memory is out; to be freed, after an error too. O(count), and
 * little for each two runs. */
tm_status tm_sweep_plan(tm_sweep *sweep, size_t count, unsigned threads,
                        void (*look)(const void *context, size_t n, uint64_t *seen),
                        const void *context, tm_error *error);
void tm_sweep_free(tm_sweep *sweep);

/* Calls work(context, first, past) for each run, colour by colour. */
void tm_sweep_make(const tm_sweep *sweep,
                   void (*work)(void *context, size_t first, size_t past), void *context);

#endif
