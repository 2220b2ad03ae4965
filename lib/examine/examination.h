/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an examination of a mesh finds: its sizes, and what is wrong with it, counted and
 * with the first few places. The same for all kinds of elements; examiners fill it. */
#ifndef TM_EXAMINE_EXAMINATION_H
#define TM_EXAMINE_EXAMINATION_H

#include "../base/extern_c.h"
#include "../element/shape.h"
#include "../base/error.h"
#include "../text/json.h"
#include "../text/text.h"
#include "../stream/stream.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* The kinds of defects, and the numbers (0-based) that say where one is. */
typedef enum tm_defect {
    TM_INVERTED,            /* element: its volume is negative, exactly; a mixed one: that
                               of a corner */
    TM_DEGENERATE,          /* element, node: names that node twice; TM_NONE: is flat;
                               facet, node, 1: a facet that names it twice */
    TM_UNMATCHED_FACE,      /* three nodes, elements: belongs to more than two; or what
                               tm_unmatched says for their number;
                               of polyhedra: facet: not to those that it names */
    TM_OVERLAPPING_FACE,    /* two elements: on the same side of their common face */
    TM_OPEN_EDGE,           /* two nodes, boundary faces: an odd number of them */
    TM_NON_MANIFOLD_EDGE,   /* two nodes, boundary faces: more than two */
    TM_NON_MANIFOLD_VERTEX, /* node, fans of boundary faces: more than one */
    TM_DUPLICATE_NODE,      /* node, an earlier one: equal coordinates */
    TM_DANGLING_FACE,       /* row of .face: no face of an element; row of .facet, 0, 1:
                               not one of those that it names */
    TM_REPEATED_FACE,       /* row of .face, the one that it repeats; of .facet: also 1 */
    TM_DANGLING_EDGE,       /* row of .edge: no edge of an element */
    TM_REPEATED_EDGE,       /* row of .edge, the one that it repeats */
    TM_UNCLOSED_EDGE,       /* polyhedron, two nodes, facets of it: not two */
    TM_UNORIENTED_EDGE,     /* polyhedron, two nodes: its facets run alike along them */
    TM_DEFECTS
} tm_defect;

/* What may stand for the number of elements in the place of an unmatched face. */
typedef enum tm_unmatched {
    TM_FACE_HALVED, /* a triangle of one and part of a quadrilateral of another */
    TM_FACE_IN_ANOTHER_ORDER, /* a quadrilateral with the nodes of another, which follow
                                 each other in another order */
} tm_unmatched;

enum { TM_DEFECTS_LISTED = 5, TM_DEFECT_NUMBERS = 4 };

/* All defects of one kind. The places are those that come first in the order of their
 * numbers, so that they do not depend on the order in which they were found. */
typedef struct tm_defect_list {
    size_t count;
    uint32_t place[TM_DEFECTS_LISTED]
                  [TM_DEFECT_NUMBERS]; /* min(count, TM_DEFECTS_LISTED) of them */
} tm_defect_list;

typedef struct tm_examination {
    const char *element;  /* "tetrahedron" */
    const char *elements; /* "tetrahedra" */
    bool polyhedra;       /* they have rows of .facet for faces */
    bool mixed;           /* they are of the kinds of tm_element_kind */
    size_t nodes;
    size_t element_count;
    size_t kind[TM_ELEMENT_KINDS]; /* mixed elements of each kind */
    size_t boundary_faces;         /* that belong to exactly one element */
    size_t components;             /* of elements connected through faces */
    size_t unused_nodes;           /* that are a corner of no element */
    int64_t euler;                 /* nodes in use - edges + faces - elements */
    double volume;                 /* the sum of signed volumes */
    double area;                   /* of the boundary faces */
    tm_defect_list defect[TM_DEFECTS];
} tm_examination;

/* Counts one more; unused numbers are 0. */
void tm_defect_add(tm_defect_list *list, const uint32_t place[TM_DEFECT_NUMBERS]);

/* Counts all that are in `more`. */
void tm_defect_add_list(tm_defect_list *list, const tm_defect_list *more);

/* Whether nothing is wrong: no defect of any kind. */
bool tm_examination_is_good(const tm_examination *found);

/* Looks for nodes with equal coordinates: counts each but the first at its place.
 * 0 and -0 are equal. Expected O(nodes). */
tm_status tm_examine_nodes(tm_examination *found, const double (*xyz)[3], size_t nodes,
                           tm_error *error);

/* Writes, into an object that the caller opened, the keys of mesh-check(1). */
void tm_examination_json(tm_json *json, const tm_examination *found);

/* Writes the sizes as a table, then what is wrong; numbers count from `base`. */
void tm_examination_text(tm_text *text, const tm_examination *found, unsigned base);

TM_EXTERN_C_END

#endif
