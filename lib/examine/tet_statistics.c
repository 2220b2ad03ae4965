/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_statistics.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../geom/vector.h"
#include "../element/tet_quality.h"

#include <stdlib.h>

/* The sum of volumes is rounded chunk by chunk, so that its last digits depend on their
 * size, but not on the threads. */
enum { CHUNK = TM_STATISTICS_CHUNK };

const double tm_large_limit[TM_LARGE_LIMITS] = {150, 160, 170, 175};

typedef struct measuring {
    const double (*xyz)[3];
    const uint32_t (*tet)[4];
    double bad_sine2;
    tm_tet_statistics *chunk; /* one for each CHUNK of tetrahedra */
} measuring;

static const double half_turn = 180; /* degrees */

static void clear(tm_tet_statistics *s)
{
    *s = (tm_tet_statistics){.min_dihedral = half_turn};
}

static size_t bin_of(double value, double width, size_t bins)
{
    const double bin = value / width;
    if (!(bin > 0))
        return 0;
    return bin < (double)bins ? (size_t)bin : bins - 1;
}

static void count_dihedral(tm_tet_statistics *s, double angle)
{
    s->dihedral[bin_of(angle + TM_ANGLE_TOLERANCE, TM_DIHEDRAL_BIN, TM_DIHEDRAL_BINS)]++;
    for (size_t i = 0; i < TM_LARGE_LIMITS && tm_angle_above(angle, tm_large_limit[i]);
         i++)
        s->large[i]++;
    s->min_dihedral = angle < s->min_dihedral ? angle : s->min_dihedral;
    s->max_dihedral = angle > s->max_dihedral ? angle : s->max_dihedral;
}

static void count_tetrahedron(tm_tet_statistics *s, const double a[3], const double b[3],
                              const double c[3], const double d[3], double bad_sine2)
{
    double angle[TM_TET_EDGES];
    tm_tet_dihedrals(a, b, c, d, angle);
    for (size_t e = 0; e < TM_TET_EDGES; e++)
        count_dihedral(s, angle[e]);
    const double quality = tm_tet_volume_quality(a, b, c, d);
    s->volume_quality[bin_of(quality + TM_VOLUME_QUALITY_TOLERANCE, TM_VOLUME_QUALITY_BIN,
                             TM_VOLUME_QUALITY_BINS)]++;
    s->volume += tm_tet_volume(a, b, c, d);
    s->bad += tm_tet_sine2(a, b, c, d) < bad_sine2;
    s->tets++;
}

static void measure_chunk(void *context, size_t first, size_t past)
{
    const measuring *m = context;
    tm_tet_statistics s;
    clear(&s);
    for (size_t t = first; t < past; t++) {
        const uint32_t *v = m->tet[t];
        count_tetrahedron(&s, m->xyz[v[0]], m->xyz[v[1]], m->xyz[v[2]], m->xyz[v[3]],
                          m->bad_sine2);
    }
    m->chunk[first / CHUNK] = s;
}

static void add(tm_tet_statistics *sum, const tm_tet_statistics *s)
{
    sum->tets += s->tets;
    sum->bad += s->bad;
    sum->volume += s->volume;
    sum->min_dihedral = fmin(sum->min_dihedral, s->min_dihedral);
    sum->max_dihedral = fmax(sum->max_dihedral, s->max_dihedral);
    for (size_t i = 0; i < TM_DIHEDRAL_BINS; i++)
        sum->dihedral[i] += s->dihedral[i];
    for (size_t i = 0; i < TM_LARGE_LIMITS; i++)
        sum->large[i] += s->large[i];
    for (size_t i = 0; i < TM_VOLUME_QUALITY_BINS; i++)
        sum->volume_quality[i] += s->volume_quality[i];
}

tm_status tm_tet_statistics_chunks(tm_tet_statistics **chunk, size_t *chunks,
                                   const double (*xyz)[3], const uint32_t (*tet)[4],
                                   size_t tets, double limit, unsigned threads,
                                   tm_error *error)
{
    *chunks = tm_parallel_chunks(tets, CHUNK);
    *chunk = tm_new(*chunks, sizeof **chunk);
    if (!*chunk)
        return tm_fail_memory(error);
    measuring m = {xyz, tet, tm_bad_sine2(limit), *chunk};
    tm_parallel_runs(threads, tets, CHUNK, measure_chunk, &m);
    return TM_OK;
}

void tm_tet_statistics_join(tm_tet_statistics *statistics, const tm_tet_statistics *chunk,
                            size_t chunks, size_t nodes, double limit)
{
    clear(statistics);
    for (size_t i = 0; i < chunks; i++)
        add(statistics, &chunk[i]);
    if (chunks == 0)
        statistics->min_dihedral = 0;
    statistics->nodes = nodes;
    statistics->limit = limit;
}

tm_status tm_tet_statistics_measure(tm_tet_statistics *statistics, const double (*xyz)[3],
                                    size_t nodes, const uint32_t (*tet)[4], size_t tets,
                                    double limit, unsigned threads, tm_error *error)
{
    tm_tet_statistics *chunk;
    size_t chunks;
    const tm_status status =
        tm_tet_statistics_chunks(&chunk, &chunks, xyz, tet, tets, limit, threads, error);
    if (status == TM_OK)
        tm_tet_statistics_join(statistics, chunk, chunks, nodes, limit);
    free(chunk);
    return status;
}

size_t tm_count_through(const size_t *histogram, size_t bin)
{
    size_t count = 0;
    for (size_t i = 0; i <= bin; i++)
        count += histogram[i];
    return count;
}
