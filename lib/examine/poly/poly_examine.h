/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Examines polyhedra as they came, which may be wrong in any way. */
#ifndef TM_EXAMINE_POLY_EXAMINE_H
#define TM_EXAMINE_POLY_EXAMINE_H

#include "../../base/extern_c.h"
#include "../../base/error.h"
#include "../examination.h"
#include "../../mesh/poly_arrays.h"

TM_EXTERN_C_BEGIN

/* Fills *found, with `polyhedra` set. What is combinatorial is exact: each facet is
 * listed once by each cell that it names and by no other (TM_UNMATCHED_FACE), no two
 * facets have the same nodes (TM_REPEATED_FACE) and none a node twice, each edge of a
 * cell has two of its facets (TM_UNCLOSED_EDGE), which run along it in opposite senses
 * (TM_UNORIENTED_EDGE). The sign of a volume is that of tm_poly_sign(): exact for
 * tetrahedra; others are flat where the volume is below 16 units of rounding of the sum
 * of magnitudes. Facets need not be plane. The edges and vertices examined for being
 * open or not manifold are those of the facets that name only one cell. The result is the
 * same for every number of threads. TM_ERROR_SYSTEM where memory is out or the boundary
 * has 2^31 corners. Expected O(nodes + corners of facets). */
tm_status tm_poly_examine(tm_examination *found, const tm_poly_arrays *mesh,
                          unsigned threads, tm_error *error);

TM_EXTERN_C_END

#endif
