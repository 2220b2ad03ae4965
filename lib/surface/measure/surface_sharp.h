/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sharp edges of any set of triangles, and their corners. */
#ifndef TM_SURFACE_SURFACE_SHARP_H
#define TM_SURFACE_SURFACE_SHARP_H

#include "../surface.h"

/* Both as triangles of the nodes a b b and a a a: sets of triangles without area. Their
 * arrays xyz and triangle, and trees where they are not empty, are made here. */
typedef struct tm_surface_sharp {
    tm_surface curve;
    tm_surface corner;
    bool rough; /* many sharp edges end freely, as on a scan */
} tm_surface_sharp;

/* Finds what tm_surface_compare() says; edges between different markers only where they
 * count. *sharp is to be freed, after an error too. O(n log n). */
tm_status tm_surface_find_sharp(tm_surface_sharp *sharp, const tm_surface *surface,
                                double feature_angle, bool markers_count,
                                tm_error *error);
void tm_surface_sharp_free(tm_surface_sharp *sharp);

#endif
