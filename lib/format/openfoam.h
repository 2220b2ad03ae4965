/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OpenFOAM's polyMesh: five text files (OpenFOAM User Guide, section Mesh description).
 *
 * Faces inside come first, in upper-triangular order: by their owner, the lesser of their
 * two cells, then by the other one, their neighbour; their normals point to the
 * neighbour. Then those of the boundary, outward, patch by patch. */
#ifndef TM_FORMAT_OPENFOAM_H
#define TM_FORMAT_OPENFOAM_H

#include "../stream/stream.h"

enum { TM_OPENFOAM_FILES = 5 };

/* points, faces, owner, neighbour, boundary */
extern const char *const tm_openfoam_name[TM_OPENFOAM_FILES];

typedef struct tm_openfoam_counts {
    size_t points, cells, faces, patches;
} tm_openfoam_counts;

/* Appends the files of a stream's tetrahedra, mixed elements or polyhedra to file[i], in
 * the order of tm_openfoam_name. Boundary facets with the same marker are a patch named
 * marker_N, patches in the order of N; without markers there is one, marker_0. Nodes that
 * no cell has are left out. TM_ERROR_INPUT as tm_cell_faces_find(), or where there are no
 * cells. Expected O(n + b log b) for b facets of the boundary. */
tm_status tm_openfoam_write(tm_text file[TM_OPENFOAM_FILES], const tm_stream *stream,
                            tm_openfoam_counts *counts, tm_error *error);

#endif
