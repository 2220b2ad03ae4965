/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How facets and cells fit together; a part of tm_poly_examine(). */
#ifndef TM_EXAMINE_POLY_EXAMINE_FACETS_H
#define TM_EXAMINE_POLY_EXAMINE_FACETS_H

#include "poly_examine.h"

/* Finds in *found: unmatched and repeated facets, those with a node twice, components,
 * unused nodes, Euler number. Expected O(nodes + corners). */
tm_status tm_poly_examine_facets(tm_examination *found, const tm_poly_arrays *mesh,
                                 tm_error *error);

#endif
