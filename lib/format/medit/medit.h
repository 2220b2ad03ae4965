/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Medit's meshes and solutions, as Mmg, Gmsh, FreeFEM and libMeshb write them (P. Frey,
 * "Medit: an interactive mesh visualization software", INRIA RT-0253, 2001; L. Maréchal,
 * libMeshb, "The GMF format", 2018): text, or binary of versions 1 to 4 and either byte
 * order.
 *
 * References are the markers of vertices, edges, triangles and quadrilaterals and the
 * regions of elements. Comments of a text, "# termesh 2 11 inlet", are the rows of
 * .group: dimension, value, name. */
#ifndef TM_FORMAT_MEDIT_MEDIT_H
#define TM_FORMAT_MEDIT_MEDIT_H

#include "../../base/extern_c.h"
#include "../../stream/stream.h"
#include "../../text/text.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

typedef struct tm_medit_bytes {
    const char *name; /* of the file, for messages */
    const char *byte;
    size_t size;
} tm_medit_bytes;

/* What was done to be a stream, and what is not in it. */
typedef struct tm_medit_report {
    size_t turned;       /* left-handed elements */
    size_t cut;          /* quadrilaterals of a surface, cut into triangles */
    size_t higher_order; /* elements that are their corners now, */
    size_t middle_nodes; /* and nodes that are left out */
    size_t loose;        /* faces that no element has, left out */
    tm_text marks;       /* "8 corners, 24 ridges": left out */
    tm_text sections;    /* "Normals, Tangents": left out */
    tm_text attributes;  /* of nodes, of the solution: "solution_1, solution_2 (3)" */
} tm_medit_report;

void tm_medit_report_free(tm_medit_report *report);

/* Reads a mesh, and what `solution` has at its vertices as attributes of nodes: a number
 * for a scalar, two or three for a vector, three or six for a symmetric tensor (xx xy yy
 * xz yz zz); solution may be NULL. *stream must be empty and gets .node, .ele or .mix, or
 * .face where no element has a volume, .face or .facet, .edge and .group, from 1; after
 * an error it is empty again: TM_ERROR_INPUT with the file and, of text, the line. Memory
 * grows with what is there, not with what counts claim. Expected O(size). */
tm_status tm_medit_read(tm_stream *stream, const tm_medit_bytes *mesh,
                        const tm_medit_bytes *solution, tm_medit_report *report,
                        tm_error *error);

/* Appends the mesh to *text: text of version 2, or binary of version 2, or 3 where 31
 * bits do not do, little endian. Elements are in the order of their types. *polygons is
 * how many facets of more than four nodes are not in it. `threads` format; the bytes are
 * the same for any number. TM_ERROR_INPUT for polyhedra and without nodes,
 * TM_ERROR_SYSTEM where memory is out. O(n). */
tm_status tm_medit_write(tm_text *text, const tm_stream *stream, bool binary,
                         unsigned threads, size_t *polygons, tm_error *error);

/* What a value of a solution is; how many numbers it has is in the table. */
typedef enum tm_medit_kind {
    TM_MEDIT_SCALAR = 1,
    TM_MEDIT_VECTOR,
    TM_MEDIT_TENSOR,
    TM_MEDIT_KINDS
} tm_medit_kind;

extern const unsigned char tm_medit_numbers[TM_MEDIT_KINDS];

/* Appends the attributes of nodes as a solution at vertices, `kinds` values of these
 * kinds; none: all are scalars. TM_ERROR_INPUT where the nodes have none, or the kinds
 * another number of them. */
tm_status tm_medit_write_solution(tm_text *text, const tm_stream *stream,
                                  const tm_medit_kind *kind, size_t kinds, bool binary,
                                  unsigned threads, tm_error *error);

TM_EXTERN_C_END

#endif
