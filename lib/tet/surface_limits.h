/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far the surface of a mesh may move while the mesh is improved. */
#ifndef TM_TET_SURFACE_LIMITS_H
#define TM_TET_SURFACE_LIMITS_H

#include <stdbool.h>

typedef struct tm_surface_limits {
    double tolerance;     /* a length; 0: not at all */
    double feature_angle; /* degrees: an edge is a feature where normals differ by more */
    bool unless_rough;    /* none is, where many of those end freely: a scan */
} tm_surface_limits;

#endif
