/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A loop whose steps run in any order, on several threads. For results that do not
 * depend on the number of threads, cut the work into chunks of a fixed size, let each
 * step write what is its own, and put the parts together in order afterwards. */
#ifndef TM_BASE_PARALLEL_H
#define TM_BASE_PARALLEL_H

#include "extern_c.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

/* Calls work(context, chunk) once for each chunk in 0 … chunks-1 and returns when all
 * are done. At most `threads` of them, this one included, run at a time; fewer where
 * the system has no more threads to give. With threads 0 or 1 the chunks come in order,
 * on this thread. */
void tm_parallel(unsigned threads, size_t chunks,
                 void (*work)(void *context, size_t chunk), void *context);

/* The same of things 0 … count-1 in chunks of `size`, the last one of what is left: calls
 * work(context, first, past) for each chunk; first / size is its number. */
void tm_parallel_runs(unsigned threads, size_t count, size_t size,
                      void (*work)(void *context, size_t first, size_t past),
                      void *context);

/* How many chunks these are. */
static inline size_t tm_parallel_chunks(size_t count, size_t size)
{
    return count / size + (count % size != 0);
}

/* How many processors this process may use; at least 1. */
unsigned tm_cores(void);

/* So many of `threads` >= 1, `most` at most, that each gets 1024 items or more, as fewer
 * are not worth a thread; at least 1. */
static inline unsigned tm_threads_for(unsigned threads, unsigned most, size_t items)
{
    enum { LEAST = 1024 };
    const unsigned some = threads < most ? threads : most;
    const size_t worth = items / LEAST;
    return worth < 1 ? 1 : worth < some ? (unsigned)worth : some;
}

/* Marks something that other threads may mark too, or look at, at the same time: what
 * they find there is either value. */
static inline void tm_mark(bool *mark)
{
    if (!__atomic_load_n(mark, __ATOMIC_RELAXED))
        __atomic_store_n(mark, true, __ATOMIC_RELAXED);
}

/* Things that a chunk's work goes over at a time, where nothing else is said. */
enum { TM_CHUNK = 4096 };

TM_EXTERN_C_END

#endif
