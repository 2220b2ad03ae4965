/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A part of tm_improve(): a large mesh, part by part. */
#ifndef TM_IMPROVE_IMPROVE_PARTS_H
#define TM_IMPROVE_IMPROVE_PARTS_H

#include "../../base/extern_c.h"
#include "../parts/parts.h"
#include "improve.h"

TM_EXTERN_C_BEGIN

/* What improves one mesh as a whole. */
typedef tm_status tm_improve_engine(tm_tet_mesh *mesh, const tm_improve_options *options,
                                    tm_improve_report *report, tm_error *error);

/* Cuts the mesh into parts of about `size` tetrahedra and improves each by the engine,
 * some rounds; with options->threads, always with the same result. Neither the number of
 * bad tetrahedra nor their share gets worse. The mesh has no set, a surface that stays,
 * and no rows of .face that are no faces; it may not have to become smaller. */
tm_status tm_improve_parts(tm_tet_mesh *mesh, const tm_improve_options *options,
                           size_t size, tm_improve_engine *engine,
                           tm_improve_report *report, tm_error *error);

/* What that is made of, for ranks that share a mesh (improve_ranks.c). */

enum { TM_IMPROVE_ROUNDS = 5 };

/* A round. */
typedef struct tm_improve_round_of {
    const tm_tet_mesh *mesh; /* of which the parts are */
    tm_improve_options options;
    tm_improve_engine *engine;
    unsigned round;
    const bool *due;     /* [nodes]: tetrahedra of these are worked on, but for */
    const bool *between; /* [nodes]: those that have one of these, which wait */
} tm_improve_round_of;

/* Takes the parts and improves them; what was done is added to the report. */
tm_status tm_improve_round(const tm_improve_round_of *what, const tm_tet_parts *parts,
                           tm_improve_report *report, tm_error *error);

/* Adds what was done in a part to the report of the whole. */
void tm_improve_report_add(tm_improve_report *to, const tm_improve_report *more);

/* Makes (*due)[nodes] what is due after a round: what was before it, when there were so
 * many nodes, and has a node between parts; what came since was not. */
bool tm_improve_find_due(const tm_tet_mesh *mesh, bool **due, const bool *between,
                         size_t nodes);

/* No more than `most` tetrahedra, if there is a limit, from so many on. */
void tm_improve_limit_growth(tm_improve_options *options, size_t most, size_t tets);

/* No part has become worse; that all are not, by the share that is bad, is looked at. */
bool tm_improve_is_worse(const tm_improve_report *report, size_t tets);

/* How many tetrahedra have a dihedral angle below so many degrees, or above 180 less
 * that. */
size_t tm_improve_count_bad_angles(const tm_tet_mesh *mesh, double degrees);

TM_EXTERN_C_END

#endif
