/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The restart file (.oct) of the mixed-element octree mesher (C. Lobos and others,
 * 2013-2021), text with ids from 0:
 *
 *     np ne no                       points, edges, octants
 *     x y z                          np lattice points
 *     a b m                          ne edges of octants and the point in the middle of
 *                                    each, 0 where there is none
 *     8 n0 … n7 l [id]               no times the corners and the level of an octant,
 *     k t1 … tk                      and the triangles of the surface that meet it
 *     Geometric Transform
 *     x y z
 *     a b c                          angles by which the octree is turned about x y z
 *     e1 … eno                       how many elements are in each octant
 *
 * Another version has four numbers in the first line, the last of which is how many
 * elements there are, and the element counts before the octants. Corners come as those of
 * a hexahedron in .m3d. The elements themselves are in the .m3d file beside it, in the
 * order of the octants.
 *
 * Either version may have an id at the end of each octant's row, by which a list (.ref)
 * names it, and then leaves octants out that are outside of the surface (S. Donoso, 2022,
 * 3.4.1 and 3.4.2). In a stream that is the first attribute of .octant. */
#ifndef TM_FORMAT_OCT_H
#define TM_FORMAT_OCT_H

#include "../base/extern_c.h"
#include "../stream/stream.h"

TM_EXTERN_C_BEGIN

enum { TM_OCT_CORNERS = 8 };

/* What is read of a file. */
typedef struct tm_oct {
    size_t points;
    double (*xyz)[3];
    size_t octants;
    uint32_t (*corner)[TM_OCT_CORNERS];
    unsigned char *level;
    uint32_t *elements; /* [octants] */
    uint32_t *id;       /* [octants], NULL where they have none */
} tm_oct;

/* Reads a file of either version; edges and triangles are only looked over.
 * TM_ERROR_INPUT with the line, also where the octree is turned, for octants of a stream
 * are along the axes. *oct is to be freed, after an error too. O(size). */
tm_status tm_oct_read(tm_oct *oct, const char *bytes, size_t size, const char *name,
                      tm_error *error);
void tm_oct_free(tm_oct *oct);

/* Adds .octant, with the ids as its attribute where there are some, and .root to a
 * stream. Where it has a .mix, that is the mesh of the
 * octants; else .node and .mix become the lattice points and the octants themselves as
 * hexahedra. The brick is over all lattice points; where the octants do not fit into one
 * that begins there, which can be where those at its side are missing, it begins where
 * they do. TM_ERROR_INPUT where octants are no cubes, of different trees, have not as
 * many elements as the mesh has, or have one id twice. *stream is as before after an
 * error, but for blocks added. O(n). */
tm_status tm_oct_to_stream(const tm_oct *oct, tm_stream *stream, const char *name,
                           tm_error *error);

/* Appends the file of the first version to *text: .octant, .root and .mix, and
 * surface.node and surface.face for the triangles that meet the closed octants; with
 * `ids`, those of tm_octant_ids() too. Point 0 is the middle of no edge. TM_ERROR_INPUT
 * where a block is missing, octants are not in the tree that .root says, overlap, or do
 * not have their elements in their own order. `threads` format. O(n log n). */
tm_status tm_oct_write(tm_text *text, const tm_stream *stream, bool ids, unsigned threads,
                       tm_error *error);

/* The ids of the rows of .octant, malloc'ed, NULL after an error. An id is the first
 * attribute of the row; where there are no attributes it is the row's number, from 0.
 * TM_ERROR_INPUT where one is no whole number or there twice; base is the stream's.
 * O(n log n). */
tm_status tm_octant_ids(uint32_t **id, const tm_block *octant, unsigned base,
                        tm_error *error);

/* Replaces a list of ids by the rows that have them, from 0: ascending, each once.
 * TM_ERROR_INPUT: no row has one of them, or as above; the list is then of no use. */
tm_status tm_octants_of_ids(uint32_t *list, size_t *count, const tm_block *octant,
                            unsigned base, tm_error *error);

TM_EXTERN_C_END

#endif
