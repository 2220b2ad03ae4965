/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "parallel.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <unistd.h>

/* More would only wait for each other. */
enum { MAX_THREADS = 256 };

typedef struct loop {
    void (*work)(void *context, size_t chunk);
    void *context;
    size_t chunks;
    atomic_size_t next;
} loop;

static void *take_chunks(void *argument)
{
    loop *l = argument;
    size_t chunk;
    while ((chunk = atomic_fetch_add(&l->next, 1)) < l->chunks)
        l->work(l->context, chunk);
    return NULL;
}

void tm_parallel(unsigned threads, size_t chunks,
                 void (*work)(void *context, size_t chunk), void *context)
{
    loop l = {.work = work, .context = context, .chunks = chunks};
    atomic_init(&l.next, 0);
    pthread_t helper[MAX_THREADS];
    size_t helpers = 0;
    while (helpers < MAX_THREADS && helpers + 1 < threads && helpers + 1 < chunks &&
           pthread_create(&helper[helpers], NULL, take_chunks, &l) == 0)
        helpers++;
    take_chunks(&l);
    while (helpers > 0)
        pthread_join(helper[--helpers], NULL);
}

unsigned tm_cores(void)
{
    cpu_set_t usable;
    if (sched_getaffinity(0, sizeof usable, &usable) == 0)
        return (unsigned)CPU_COUNT(&usable);
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online > 0 ? (unsigned)online : 1;
}

typedef struct runs {
    void (*work)(void *context, size_t first, size_t past);
    void *context;
    size_t count, size;
} runs;

static void work_on_run(void *context, size_t chunk)
{
    const runs *r = context;
    const size_t first = chunk * r->size, left = r->count - first;
    r->work(r->context, first, first + (left < r->size ? left : r->size));
}

void tm_parallel_runs(unsigned threads, size_t count, size_t size,
                      void (*work)(void *context, size_t first, size_t past),
                      void *context)
{
    runs r = {work, context, count, size};
    tm_parallel(threads, tm_parallel_chunks(count, size), work_on_run, &r);
}
