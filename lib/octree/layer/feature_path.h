/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paths of interior boundary edges and diagonals along the curves of a surface: the
 * shortest ones, where an edge costs the length of curve that it runs along and more the
 * farther it is from it (Dijkstra 1959). */
#ifndef TM_LAYER_FEATURE_PATH_H
#define TM_LAYER_FEATURE_PATH_H

#include "feature_search.h"

/* Finds the path of a curve between the interior boundary nodes of its two ends and
 * enters it into feature, boundary->cut and on_path; *found says whether there is one.
 * Where the ends are the same, or TM_NONE, the path goes around. TM_ERROR_SYSTEM where
 * memory is out. */
tm_status tm_path_along_curve(tm_path_finder *finder, uint32_t curve, uint32_t from,
                              uint32_t to, bool *found, tm_error *error);

#endif
