/* SPDX-License-Identifier: GPL-3.0-or-later */
/* octree-mesh: a closed surface in, hexahedra, wedges, pyramids and tetrahedra out. */
#include "common/filter.h"
#include "common/octree_output.h"
#include "common/surface_input.h"

#include "../lib/base/json.h"
#include "../lib/format/leaf_numbers.h"
#include "../lib/format/reg.h"
#include "../lib/octree/octree_mesh.h"

#include <stdlib.h>
#include <string.h>

enum { FEATURE_ANGLE = FILTER_OWN, RESOLVE, LENIENT };

static const struct option options[] = {
    {"all", required_argument, NULL, 'a'},
    {"surface", required_argument, NULL, 's'},
    {"boxes", required_argument, NULL, 'b'},
    {"region", required_argument, NULL, 'r'},
    {"leaves", required_argument, NULL, 'l'},
    {"levels", no_argument, NULL, 'u'},
    {"feature-angle", required_argument, NULL, FEATURE_ANGLE},
    {"resolve", required_argument, NULL, RESOLVE},
    {"lenient", no_argument, NULL, LENIENT},
    FILTER_OPTIONS};
