/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "jens_statistics.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../element/aspect_ratio.h"
#include "../element/jens.h"
#include "../element/verdict.h"

#include <stdlib.h>

/* Sums are rounded chunk by chunk, so that the last digits of averages depend on their
 * size, but not on the threads. */
enum { CHUNK = TM_JENS_CHUNK };

const double tm_jens_edge[TM_JENS_BUCKETS] = {0.0333, 0.05, 0.1,  0.15, 0.2,  0.25, 0.3,
                                              0.35,   0.4,  0.45, 0.5,  0.55, 0.6,  0.65,
                                              0.7,    0.75, 0.8,  0.85, 0.9,  0.95, 1};

typedef struct measuring {
    const tm_elements *elements;
    const tm_jens_request *request;
    tm_jens_statistics *chunk; /* one for each CHUNK of elements */
} measuring;

static void clear(tm_jens_statistics *s, const tm_jens_request *request)
{
    *s = (tm_jens_statistics){.threshold = request->threshold};
    s->jens.all.worst = s->scaled_jacobian.all.worst = INFINITY;
    s->aspect_ratio.worst = INFINITY;
    s->verdict_scaled_jacobian.worst = s->verdict_shape.worst = INFINITY;
}

static void take(tm_spread *spread, double value)
{
    spread->worst = value < spread->worst ? value : spread->worst;
    spread->sum += value;
}

/* Guesses the bucket of a value that is not negative and lets the edges decide. */
static size_t bucket_of(double value)
{
    const double per_unit = 20;
    const double place = value * per_unit;
    size_t i = place < TM_JENS_BUCKETS ? (size_t)place : TM_JENS_BUCKETS - 1;
    while (i > 0 && value < tm_jens_edge[i - 1])
        i--;
    while (i < TM_JENS_BUCKETS - 1 && value >= tm_jens_edge[i])
        i++;
    return i;
}

static void count(tm_jens_histogram *h, double value, double threshold)
{
    take(&h->all, value);
    h->below += value < threshold;
    if (value < 0)
        h->negative++;
    else
        h->bucket[bucket_of(value)]++;
}

static void count_kind(tm_jens_statistics *s, size_t nodes)
{
    s->elements++;
    s->kind[tm_element_shapes[nodes].kind]++;
}

static void name(tm_certified *c, size_t element)
{
    if (c->count < TM_NAMED)
        c->first[c->count] = element;
    c->count++;
}

/* J_ENS, and J_S, which need the same corners. */
static void measure_corners(tm_jens_statistics *s, size_t nodes, const double (*xyz)[3],
                            const uint32_t *item, bool scaled)
{
    const tm_element_shape *shape = &tm_element_shapes[nodes];
    double jacobian[TM_ELEMENT_CORNERS];
    tm_scaled_jacobians(shape, xyz, item, jacobian);
    double least = 1, least_scaled = 1;
    for (size_t i = 0; i < shape->corners; i++) {
        const double value = tm_jens_of(jacobian[i], shape->k[i]);
        least = value < least ? value : least;
        least_scaled = jacobian[i] < least_scaled ? jacobian[i] : least_scaled;
    }
    count(&s->jens, least, s->threshold);
    if (scaled)
        count(&s->scaled_jacobian, least_scaled, s->threshold);
}

static void measure_chunk(void *context, size_t chunk)
{
    const measuring *m = context;
    const tm_elements *elements = m->elements;
    const tm_jens_request *request = m->request;
    const size_t first = chunk * CHUNK;
    const size_t end = elements->count - first < CHUNK ? elements->count : first + CHUNK;
    tm_jens_statistics s;
    clear(&s, request);
    for (size_t e = first; e < end; e++) {
        size_t nodes;
        const uint32_t *item = tm_element_at(elements, e, &nodes);
        count_kind(&s, nodes);
        measure_corners(&s, nodes, elements->xyz, item, request->scaled_jacobian);
        if (request->others) {
            take(&s.aspect_ratio, tm_aspect_ratio(nodes, elements->xyz, item));
            take(&s.verdict_scaled_jacobian,
                 tm_verdict_scaled_jacobian(nodes, elements->xyz, item));
            take(&s.verdict_shape, tm_verdict_shape(nodes, elements->xyz, item));
        }
        if (request->certify)
            name(&s.certified[tm_certify(nodes, elements->xyz, item)],
                 request->before + e);
    }
    m->chunk[chunk] = s;
}

static void add_spread(tm_spread *sum, const tm_spread *s)
{
    sum->worst = s->worst < sum->worst ? s->worst : sum->worst;
    sum->sum += s->sum;
}

static void add_histogram(tm_jens_histogram *sum, const tm_jens_histogram *h)
{
    add_spread(&sum->all, &h->all);
    sum->negative += h->negative;
    sum->below += h->below;
    for (size_t i = 0; i < TM_JENS_BUCKETS; i++)
        sum->bucket[i] += h->bucket[i];
}

static void add_certified(tm_certified *sum, const tm_certified *c)
{
    for (size_t i = 0; i < c->count && i < TM_NAMED && sum->count + i < TM_NAMED; i++)
        sum->first[sum->count + i] = c->first[i];
    sum->count += c->count;
}

static void add(tm_jens_statistics *sum, const tm_jens_statistics *s)
{
    sum->elements += s->elements;
    for (size_t i = 0; i < TM_ELEMENT_KINDS; i++)
        sum->kind[i] += s->kind[i];
    add_histogram(&sum->jens, &s->jens);
    add_histogram(&sum->scaled_jacobian, &s->scaled_jacobian);
    add_spread(&sum->aspect_ratio, &s->aspect_ratio);
    add_spread(&sum->verdict_scaled_jacobian, &s->verdict_scaled_jacobian);
    add_spread(&sum->verdict_shape, &s->verdict_shape);
    for (size_t i = 0; i < TM_CERTIFICATES; i++)
        add_certified(&sum->certified[i], &s->certified[i]);
}

static void finish(tm_spread *s, size_t elements)
{
    if (s->worst == INFINITY) /* nothing was measured */
        s->worst = 0;
    s->average = elements > 0 ? s->sum / (double)elements : 0;
}

tm_status tm_jens_statistics_chunks(tm_jens_statistics **chunk, size_t *chunks,
                                    const tm_elements *elements,
                                    const tm_jens_request *request, tm_error *error)
{
    *chunks = tm_parallel_chunks(elements->count, CHUNK);
    *chunk = tm_new(*chunks, sizeof **chunk);
    if (!*chunk)
        return tm_fail_memory(error);
    measuring m = {elements, request, *chunk};
    tm_parallel(request->threads, *chunks, measure_chunk, &m);
    return TM_OK;
}

void tm_jens_statistics_join(tm_jens_statistics *statistics,
                             const tm_jens_statistics *chunk, size_t chunks,
                             const tm_jens_request *request)
{
    clear(statistics, request);
    for (size_t i = 0; i < chunks; i++)
        add(statistics, &chunk[i]);
    const size_t elements = statistics->elements;
    finish(&statistics->jens.all, elements);
    finish(&statistics->scaled_jacobian.all, elements);
    finish(&statistics->aspect_ratio, elements);
    finish(&statistics->verdict_scaled_jacobian, elements);
    finish(&statistics->verdict_shape, elements);
}

tm_status tm_jens_statistics_measure(tm_jens_statistics *statistics,
                                     const tm_elements *elements,
                                     const tm_jens_request *request, tm_error *error)
{
    tm_jens_statistics *chunk;
    size_t chunks;
    const tm_status status =
        tm_jens_statistics_chunks(&chunk, &chunks, elements, request, error);
    if (status == TM_OK)
        tm_jens_statistics_join(statistics, chunk, chunks, request);
    free(chunk);
    return status;
}
