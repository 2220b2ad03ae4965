/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cells of a stream, in whichever block they stand, and the facets between them:
 * what the formats need that know cells by their faces. */
#ifndef TM_MESH_CELL_FACES_H
#define TM_MESH_CELL_FACES_H

#include "../base/extern_c.h"
#include "../stream/stream.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* What a stream's main mesh is: the last of these of which it has a row. Rows of .facet
 * without .cell do not make polyhedra: they are facets of .mix. */
typedef enum tm_content {
    TM_CONTENT_NOTHING,
    TM_CONTENT_POINTS,     /* .node alone */
    TM_CONTENT_SURFACE,    /* .face */
    TM_CONTENT_TETRAHEDRA, /* .ele */
    TM_CONTENT_MIXED,      /* .mix */
    TM_CONTENT_POLYHEDRA   /* .cell */
} tm_content;

/* O(blocks). */
tm_content tm_content_of(const tm_stream *stream);

/* The block that the content stands in, or NULL. */
tm_block *tm_content_block(const tm_stream *stream, tm_content content);

/* Facet f is the polygon node[start[f] … start[f + 1]). From inside cell side[f][0] it
 * is seen to turn clockwise: its normal points outward of that cell, to cell side[f][1],
 * which is TM_NONE on the boundary. Cell c has the facets
 * cell_facet[cell_start[c] … cell_start[c + 1]); each facet is in the lists of both of
 * its cells. A surface has facets but no cells; both sides of them are TM_NONE. */
typedef struct tm_cell_faces {
    size_t cells;
    size_t *cell_start;
    uint32_t *cell_facet;
    size_t facets;
    uint32_t (*side)[2];
    size_t *start;
    uint32_t *node;
    int32_t *marker; /* [facets], or NULL where the stream has none */
    bool borrowed;   /* the arrays are those of .facet and .cell */
} tm_cell_faces;

/* Finds the faces of a surface, of tetrahedra, of mixed elements or of polyhedra; points
 * have none. Facets are numbered, and turn, as .facet says; those of elements are
 * numbered in the order in which the elements come, and the first of its elements is side
 * 0. An element that is left-handed is taken as it would be turned. Rows of .face give
 * facets their markers, and after them those of .facet beside .mix. TM_ERROR_INPUT where
 * three elements meet at a face, or two of which none is flat are on the same side of
 * one, an element has a node twice, or .facet and .cell contradict each other;
 * TM_ERROR_SYSTEM where memory is out or tm_face_table_make() says so. *faces is
 * to be freed, after an error too. For polyhedra the stream must outlive it. Expected
 * O(n). */
tm_status tm_cell_faces_find(tm_cell_faces *faces, const tm_stream *stream,
                             tm_error *error);
void tm_cell_faces_free(tm_cell_faces *faces);

/* Whether cell c is the first of the two of facet f. */
static inline bool tm_facet_is_outward(const tm_cell_faces *faces, size_t f, size_t c)
{
    return faces->side[f][0] == c;
}

TM_EXTERN_C_END

#endif
