/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What Gmsh read as a stream. */
#ifndef CMD_COMMON_GMSH_STREAM_H
#define CMD_COMMON_GMSH_STREAM_H

#include "gmsh_elements.h"

/* What gmsh_to_stream() had to do. */
typedef struct gmsh_done {
    size_t nodes, cells, faces, edges, names;
    size_t turned; /* left-handed cells, which are turned */
    size_t flat;   /* cells without volume */
    size_t halved; /* quadrilaterals that became two triangles */
    size_t loose;  /* faces that no cell has: left out beside .mix */
    size_t repeated, degenerate, high_order, between; /* see gmsh_mesh */
    size_t several;                                   /* sets of several groups */
    size_t renumbered;                                /* see gmsh_sets */
} gmsh_done;

/* Makes .node, .ele or .mix, .face or .facet, .edge and .group of a model, and where it
 * is not NULL of the same file with swapped tags. *stream is empty, and of base 1. Cells
 * are .ele if all are tetrahedra; faces beside .mix are .facet, else .face, of which a
 * quadrilateral makes two triangles, cut along its shorter diagonal. Cells of negative
 * volume are turned. TM_ERROR_INPUT and TM_ERROR_SYSTEM as gmsh_mesh_take(), or where a
 * coordinate is not finite. */
tm_status gmsh_to_stream(tm_stream *stream, const gmsh_model *model,
                         const gmsh_model *swapped, gmsh_done *done, tm_error *error);

#endif
