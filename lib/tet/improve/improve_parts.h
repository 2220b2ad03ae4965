/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A part of tm_improve(): a large mesh, part by part. */
#ifndef TM_IMPROVE_IMPROVE_PARTS_H
#define TM_IMPROVE_IMPROVE_PARTS_H

#include "improve.h"

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

/* How many tetrahedra have a dihedral angle below so many degrees, or above 180 less
 * that. */
size_t tm_improve_count_bad_angles(const tm_tet_mesh *mesh, double degrees);

#endif
