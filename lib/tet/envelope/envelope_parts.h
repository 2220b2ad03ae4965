/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of the envelope share; for these only. */
#ifndef TM_ENVELOPE_ENVELOPE_PARTS_H
#define TM_ENVELOPE_ENVELOPE_PARTS_H

#include "envelope.h"

/* A triangle asked about: corners p[0 … 2], and a triangle of the reference to begin
 * with.
 */
typedef struct tm_covered {
    const double *p[3];
    uint32_t below;
} tm_covered;

/* Whether the reference covers the triangle, as envelope.h says; e->flood has the
 * triangles of it that do, the one with the largest part first. */
bool tm_envelope_covers(tm_envelope *e, const tm_covered *triangle);

/* Whether triangle k of a change meets another one, or a face that is on the outside. */
bool tm_envelope_crosses(tm_envelope *e, const tm_tet_mesh *mesh,
                         const tm_surface_change *change, size_t k);

/* Whether it is known that a face is above triangle t of the reference. */
bool tm_envelope_is_linked(const tm_envelope *e, uint32_t t, uint32_t face);

/* Notes above which triangle of the reference each face is; false where memory is out. */
bool tm_envelope_link_all(tm_envelope *e, const tm_tet_mesh *mesh);

/* The squared distances from a point to a segment, and to a triangle. */
double tm_segment_distance2(const double p[3], const double a[3], const double b[3]);
double tm_triangle_distance2(const double p[3], const double a[3], const double b[3],
                             const double c[3]);

#endif
