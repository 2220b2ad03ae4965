/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The statistics by which tetrahedral meshes are compared: how many of all dihedral
 * angles are small or large, how many tetrahedra have such an angle, how many have
 * little volume for their longest edge (Balboa 2020). Limits are met within the
 * tolerance of tet_quality.h; the bins of the histograms hold lo ≤ value < hi within
 * the same one, the last bin also its upper end. */
#ifndef TM_EXAMINE_TET_STATISTICS_H
#define TM_EXAMINE_TET_STATISTICS_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "../text/json.h"
#include "../text/text.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

enum {
    TM_DIHEDRAL_BINS = 36,       /* of 5 degrees */
    TM_VOLUME_QUALITY_BINS = 20, /* of 0.05 */
    TM_LARGE_LIMITS = 4
};

#define TM_DIHEDRAL_BIN       5.0 /* degrees */
#define TM_VOLUME_QUALITY_BIN 0.05

/* 150, 160, 170, 175 degrees */
extern const double tm_large_limit[TM_LARGE_LIMITS];

typedef struct tm_tet_statistics {
    size_t nodes;
    size_t tets;
    double limit; /* degrees: an angle below it, or above 180 - limit, is bad */
    size_t bad;   /* tetrahedra with such an angle */
    double volume;
    double min_dihedral; /* degrees, like max_dihedral; both 0 without tetrahedra */
    double max_dihedral;
    size_t dihedral[TM_DIHEDRAL_BINS];             /* angles, six for each tetrahedron */
    size_t large[TM_LARGE_LIMITS];                 /* angles above tm_large_limit[] */
    size_t volume_quality[TM_VOLUME_QUALITY_BINS]; /* tetrahedra */
} tm_tet_statistics;

/* Measures tetrahedra that tet[t] lists by their nodes, right-hand positive; one that is
 * not counts as flat or with its negative volume. nodes is only noted. The same result
 * for every number of threads. TM_ERROR_SYSTEM where memory is out. O(tets). */
tm_status tm_tet_statistics_measure(tm_tet_statistics *statistics, const double (*xyz)[3],
                                    size_t nodes, const uint32_t (*tet)[4], size_t tets,
                                    double limit, unsigned threads, tm_error *error);

/* Its parts, for who has the tetrahedra in several places: the statistics of each
 * TM_STATISTICS_CHUNK of them, *chunk, to be freed; and all of these, in their order, as
 * one. */
enum { TM_STATISTICS_CHUNK = 8192 };
tm_status tm_tet_statistics_chunks(tm_tet_statistics **chunk, size_t *chunks,
                                   const double (*xyz)[3], const uint32_t (*tet)[4],
                                   size_t tets, double limit, unsigned threads,
                                   tm_error *error);
void tm_tet_statistics_join(tm_tet_statistics *statistics, const tm_tet_statistics *chunk,
                            size_t chunks, size_t nodes, double limit);

/* How many of the values lie below the upper end of a bin. */
size_t tm_count_through(const size_t *histogram, size_t bin);

/* Writes, into an object that the caller opened, the keys of tet-stats: nodes tets volume
 * min_dihedral max_dihedral bad_percent dihedral_percent volume_quality_percent and
 * the two histograms as [[upper end, count], …]. */
void tm_tet_statistics_json(tm_json *json, const tm_tet_statistics *statistics);

/* The same as an object of its own. */
void tm_tet_statistics_object(tm_json *json, const char *key,
                              const tm_tet_statistics *statistics);

/* Writes the tables to read; with before not NULL in two columns, and the sizes' ratio.
 */
void tm_tet_statistics_table(tm_text *text, const tm_tet_statistics *before,
                             const tm_tet_statistics *statistics);

TM_EXTERN_C_END

#endif
