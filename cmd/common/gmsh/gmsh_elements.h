/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The elements of a model by their dimension, in the order of their numbers, each once,
 * by their corners. */
#ifndef CMD_COMMON_GMSH_ELEMENTS_H
#define CMD_COMMON_GMSH_ELEMENTS_H

#include "gmsh_groups.h"
#include "gmsh_model.h"

#include <stdint.h>

/* Element e has count[e] corners, node[width e …], and its groups are set[e]. */
typedef struct gmsh_elements {
    size_t elements;
    size_t width;
    uint8_t *count;
    uint32_t *node; /* [elements][width] */
    uint32_t *set;
    size_t *tag;
} gmsh_elements;

/* All of a model: nodes in the order of their numbers. */
typedef struct gmsh_mesh {
    size_t nodes;
    double (*xyz)[3];
    gmsh_elements of[GMSH_DIMENSIONS];
    size_t repeated;   /* elements that were there before */
    size_t degenerate; /* that name a corner twice: left out */
    size_t high_order; /* elements of which only the corners are taken */
    size_t between;    /* that Gmsh makes between partitions: passed over */
} gmsh_mesh;

/* Takes them out of a model; `sets` has the groups of its entities, and takes in those
 * of elements that are there more than once. TM_ERROR_INPUT where an element has a node
 * that is not there, TM_ERROR_SYSTEM where memory is out or there are 2^32 nodes or
 * elements. *mesh is {0} and to be freed, after an error too. O(n log n) where numbers
 * are not in order, else expected O(n). */
tm_status gmsh_mesh_take(gmsh_mesh *mesh, const gmsh_model *model, gmsh_sets *sets,
                         tm_error *error);
void gmsh_mesh_free(gmsh_mesh *mesh);

#endif
