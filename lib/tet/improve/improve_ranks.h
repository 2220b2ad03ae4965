/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improvement of a mesh that several ranks share: that of one process, in parts. */
#ifndef TM_IMPROVE_IMPROVE_RANKS_H
#define TM_IMPROVE_IMPROVE_RANKS_H

#include "../share/share.h"
#include "improve_forced.h"
#include "improve_parts.h"

TM_EXTERN_C_BEGIN

/* What tm_improve() does by parts, with what it works on then. */
typedef struct tm_improve_cut {
    size_t size; /* tetrahedra of a part, about */
    tm_improve_engine *engine;
} tm_improve_cut;
extern const tm_improve_cut tm_improve_usual_cut;

/* Whether tm_improve() cuts a mesh of so many tetrahedra with these options, of which so
 * many are bad. Of one with a set, or with rows of .face that are none, it never does. */
bool tm_improve_cuts(const tm_improve_options *options, size_t tets, size_t bad);

/* How many tetrahedra of all ranks have an angle below so many degrees, or above 180 less
 * that. */
size_t tm_improve_ranks_count_bad(const tm_tet_share *share, double degrees);

/* Improves a mesh that ranks have taken (share/take.h), as tm_improve_parts() does; of
 * report->nodes_free only with count_nodes something is said. *alone: one process is to
 * do it, as more is bad than before, so that it would have kept what it had; or as nodes
 * are to be counted, and their markers differ in a face that stays, where that takes the
 * whole mesh. *inner_faces is for tm_tet_share_give(). All ranks call it. */
tm_status tm_improve_ranks(tm_tet_share *share, const tm_improve_options *options,
                           const tm_improve_cut *cut, bool count_nodes,
                           tm_improve_report *report, bool *alone, size_t *inner_faces,
                           tm_error *error);

/* tm_forced_find() of all ranks' mesh: the numbers of all, and on rank 0 the sectors. */
tm_status tm_improve_ranks_forced(tm_tet_share *share, double degrees, tm_forced *forced,
                                  tm_error *error);

TM_EXTERN_C_END

#endif
