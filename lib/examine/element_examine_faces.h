/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How elements fit together; a part of tm_element_examine(). */
#ifndef TM_EXAMINE_ELEMENT_EXAMINE_FACES_H
#define TM_EXAMINE_ELEMENT_EXAMINE_FACES_H

#include "../base/sum.h"
#include "element_examine.h"

/* What is known of an element: 1 upright, -1 turned, 0 without a side, or this. */
enum { TM_NODE_TWICE = 2 };

/* The beginning of an examination: what is looked at. */
tm_examination tm_element_examination(bool mixed, size_t nodes, size_t elements);

/* Of elements: chunks of TM_CHUNK (parallel.h) have these volumes. */
typedef struct tm_element_measures {
    int8_t *sign;   /* [elements]: see above */
    tm_sum *volume; /* [chunks] */
    size_t chunks;
} tm_element_measures;

/* Finds in *found: elements of each kind, inverted and degenerate ones. *measures is to
 * be freed also after an error. */
tm_status tm_element_measure(tm_examination *found, const tm_mesh_view *mesh,
                             tm_element_measures *measures, unsigned threads,
                             tm_error *error);
void tm_element_measures_free(tm_element_measures *measures);

/* Faces that belong to one element; the fourth node of a triangle is TM_NONE. */
typedef struct tm_boundary_faces {
    size_t count;
    size_t room;
    uint32_t (*node)[4];
} tm_boundary_faces;

/* Which faces and edges are looked at, those whose smallest node is one of these, and
 * what is known then. */
typedef struct tm_walked {
    uint32_t first, past;      /* nodes */
    const uint32_t *face_row;  /* [faces]: what the rows of .face are called, and */
    const uint32_t *facet_row; /* [facets]: of .facet; or NULL: as they are numbered */
    uint32_t *parent; /* [elements]: a tree for each component (disjoint_sets.h) */
    uint8_t *used;    /* [nodes]: 1 of those of edges */
    tm_boundary_faces boundary; /* in an order that depends on the mesh only */
} tm_walked;

void tm_walked_free(tm_walked *walked);

/* Finds in *found: unmatched faces of equal kind, overlapping, dangling and repeated
 * ones, dangling and repeated edges, the number of boundary faces, and of the Euler
 * number faces less edges. Fills *walked, of which the nodes are given; it is to be freed
 * also after an error. sign[elements]: see above. Each of threads >= 1 walks over a part
 * of the nodes. */
tm_status tm_element_examine_faces(tm_examination *found, const tm_mesh_view *mesh,
                                   const int8_t *sign, tm_walked *walked,
                                   unsigned threads, tm_error *error);

/* Finds in *found: triangles that are half of a quadrilateral, both on the boundary,
 * those whose smallest node is in first … past-1. Expected O(faces). */
tm_status tm_element_examine_nonconforming(tm_examination *found,
                                           const tm_boundary_faces *boundary,
                                           uint32_t first, uint32_t past,
                                           tm_error *error);

#endif
