/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is wrong with a surface, for those who are to mesh what it closes in. */
#ifndef TM_EXAMINE_SURFACE_EXAMINE_H
#define TM_EXAMINE_SURFACE_EXAMINE_H

#include "../base/extern_c.h"
#include "../surface/surface_crossings.h"
#include "../surface/surface_defects.h"
#include "../text/json.h"
#include "../text/text.h"

TM_EXTERN_C_BEGIN

typedef struct tm_surface_examination {
    size_t nodes;
    size_t triangles;
    size_t components; /* shells: what is connected over edges */
    size_t nested;     /* of these, within another one; 0 where it is not closed */
    size_t regions;    /* that walls bound, or shells; 0 where it is not closed */
    int64_t euler;     /* nodes - edges + triangles, as surface.h has it */
    double volume;     /* within the outermost shells; 0 where it is not closed */
    double area;
    tm_surface_defects defects; /* by counting */
    size_t repeated_faces;      /* triangles with the nodes of an earlier one */
    size_t degenerate;          /* with a node twice, or without area, exactly */
    size_t turned_faces;  /* that turn another way than most of their shell; of a surface
                             with walls, those beside the outside that look inward */
    size_t turned_shells; /* outermost ones that look inward */
    size_t crossings;     /* pairs of triangles that meet elsewhere than in common nodes
                             and edges, by the rows of .face: */
    tm_crossing *crossing;
    struct {
        uint32_t repeated, degenerate, turned_face, turned_shell;
    } first;           /* row of .face of the first of each kind */
    char problem[512]; /* why meshers refuse it, as octree-mesh says it; "" */
} tm_surface_examination;

/* Examines triangles (facets of three nodes, one polygon each), changing nothing.
 * TM_ERROR_INPUT where coordinates are beyond what can be computed with
 * (stream/coordinates.h), TM_ERROR_SYSTEM where memory is out. O(n log n + crossings). */
tm_status tm_surface_examine(tm_surface_examination *found,
                             const tm_polygon_surface *surface, tm_error *error);

void tm_surface_examination_free(tm_surface_examination *found);

/* Whether nothing is wrong. Walls between regions and shells within others are not. */
bool tm_surface_examination_is_good(const tm_surface_examination *found);

/* Adds members to the object, and lines to a text; places are numbered from the base of
 * the surface. */
void tm_surface_examination_json(tm_json *json, const tm_surface_examination *found,
                                 const tm_polygon_surface *surface);
void tm_surface_examination_text(tm_text *text, const tm_surface_examination *found,
                                 const tm_polygon_surface *surface);

TM_EXTERN_C_END

#endif
