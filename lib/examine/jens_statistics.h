/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The statistics by which mixed meshes are compared: histograms of J_ENS and of the
 * scaled Jacobian (S. Donoso, 2022), averages of other measures, and how many elements
 * are proved to be valid. The buckets of a histogram hold lo <= q < hi, and nothing is
 * rounded. */
#ifndef TM_EXAMINE_JENS_STATISTICS_H
#define TM_EXAMINE_JENS_STATISTICS_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "../text/json.h"
#include "../text/text.h"
#include "../element/certify.h"
#include "../element/shape.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

enum { TM_JENS_BUCKETS = 21, TM_CERTIFICATES = 3, TM_NAMED = 10 };

/* The upper edges 0.0333, 0.05, 0.1, 0.15, … 1. */
extern const double tm_jens_edge[TM_JENS_BUCKETS];

/* Elements as they stand in a stream, which belong to the caller. Element e has the nodes
 * item[start[e]] … item[start[e + 1] - 1], 4, 5, 6 or 8; where start is NULL all are
 * tetrahedra. */
typedef struct tm_elements {
    const double (*xyz)[3];
    size_t count;
    const size_t *start;
    const uint32_t *item;
} tm_elements;

/* The nodes of element e, and how many. */
static inline const uint32_t *tm_element_at(const tm_elements *elements, size_t e,
                                            size_t *nodes)
{
    const size_t first = elements->start ? elements->start[e] : TM_TET_NODES * e;
    *nodes = elements->start ? elements->start[e + 1] - first : (size_t)TM_TET_NODES;
    return elements->item + first;
}

/* The least of all and the average; both 0 of nothing. */
typedef struct tm_spread {
    double worst;
    double sum;
    double average;
} tm_spread;

typedef struct tm_jens_histogram {
    size_t negative;
    size_t bucket[TM_JENS_BUCKETS]; /* of 0 and more; the last one has no upper end */
    size_t below;                   /* the threshold */
    tm_spread all;
} tm_jens_histogram;

/* Elements with one answer, and the first of them. */
typedef struct tm_certified {
    size_t count;
    size_t first[TM_NAMED];
} tm_certified;

/* What is to be measured besides J_ENS. */
typedef struct tm_jens_request {
    double threshold;
    bool scaled_jacobian;
    bool others; /* the aspect ratio and those of verdict.h */
    bool certify;
    unsigned threads;
    size_t before; /* number of the first element, where others are elsewhere */
} tm_jens_request;

typedef struct tm_jens_statistics {
    size_t elements;
    size_t kind[TM_ELEMENT_KINDS]; /* tetrahedra, pyramids, wedges, hexahedra */
    double threshold;
    tm_jens_histogram jens;
    tm_jens_histogram scaled_jacobian;
    tm_spread aspect_ratio;
    tm_spread verdict_scaled_jacobian;
    tm_spread verdict_shape;
    tm_certified certified[TM_CERTIFICATES]; /* by tm_certificate */
} tm_jens_statistics;

/* Measures elements; what was not asked for is 0. The same result for every number of
 * threads. TM_ERROR_SYSTEM where memory is out. O(elements). */
tm_status tm_jens_statistics_measure(tm_jens_statistics *statistics,
                                     const tm_elements *elements,
                                     const tm_jens_request *request, tm_error *error);

/* Its parts, for who has the elements in several places: the statistics of each
 * TM_JENS_CHUNK of them, *chunk, to be freed; and all of these, in their order, as one.
 */
enum { TM_JENS_CHUNK = 8192 };
tm_status tm_jens_statistics_chunks(tm_jens_statistics **chunk, size_t *chunks,
                                    const tm_elements *elements,
                                    const tm_jens_request *request, tm_error *error);
void tm_jens_statistics_join(tm_jens_statistics *statistics,
                             const tm_jens_statistics *chunk, size_t chunks,
                             const tm_jens_request *request);

/* Writes the histogram to read: the line "negative: N", a line "<EDGE : N" for each
 * bucket, then the number of elements, the worst and the average. */
void tm_jens_histogram_table(tm_text *text, const tm_jens_histogram *histogram,
                             size_t elements);

/* Writes it as a file .histo: "negative N", then "EDGE N" with six digits, where the
 * first edge is 0.030000. */
void tm_jens_histogram_file(tm_text *text, const tm_jens_histogram *histogram);

/* Writes how many are certified, how many not and why, and the first of those, by their
 * numbers from base. */
void tm_jens_certified_table(tm_text *text, const tm_jens_statistics *statistics,
                             unsigned base);

/* Writes, into an object that the caller opened, elements{tet pyramid wedge hex} negative
 * worst average histogram[[upper edge, count] …], and what else was asked for:
 * scaled_jacobian{negative worst average histogram}, aspect_ratio{worst average},
 * verdict{scaled_jacobian{worst average} shape{worst average}}, certified{positive
 * not_positive undecided first[…]}. */
void tm_jens_statistics_json(tm_json *json, const tm_jens_statistics *statistics,
                             const tm_jens_request *request, unsigned base);

TM_EXTERN_C_END

#endif
