/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches and zones of a polyMesh as markers, regions and their names. */
#ifndef TM_FORMAT_OPENFOAM_ZONES_H
#define TM_FORMAT_OPENFOAM_ZONES_H

#include "../../mesh/polyhedra.h"
#include "foam.h"
#include "openfoam.h"

/* openfoam_read.c: tm_foam_begin() of a file. */
tm_status tm_openfoam_begin(tm_foam *foam, const tm_openfoam_file *file, tm_error *error);

/* Gives .facet, of which the first `inside` rows have two cells, markers, and .cell
 * regions: see tm_openfoam_read(). TM_ERROR_INPUT where patches are not the faces of the
 * boundary one after another, or a zone names a face or cell that is not there. */
tm_status tm_openfoam_read_zones(tm_stream *stream,
                                 const tm_openfoam_file file[TM_OPENFOAM_FILES],
                                 size_t inside, tm_openfoam_report *report,
                                 tm_error *error);

#endif
